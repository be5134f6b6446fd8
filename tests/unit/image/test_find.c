/* SPDX-License-Identifier: MIT */
/*
 * Finding images: the order of the places, and what is not looked at. tests/cli/test_textures.sh has the whole way.
 */
#include "image/find.h"

#include <sys/stat.h>
#include <unistd.h>
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

static char document[300], input[300], more[300];

static nt_image_places places_here(bool allow_outside)
{
	static const char *folders[1];
	folders[0] = more;
	snprintf(document, sizeof document, "%s", in_folder("mtl/m.mtl"));
	snprintf(input, sizeof input, "%s", in_folder("obj/m.obj"));
	snprintf(more, sizeof more, "%s", in_folder("more"));
	return (nt_image_places){.document = document, .input = input, .folders = folders, .folder_count = 1,
		.allow_outside = allow_outside};
}

/* What a name leads to, from the test's folder. */
static void assert_found(const char *name, bool allow_outside, nt_image_found expected, const char *file)
{
	const nt_image_places places = places_here(allow_outside);
	nt_buffer path = {0};
	nt_image_found found;
	nt_error error;
	assert_int_equal(nt_image_find(&places, name, &path, &found, &error), NT_OK);
	if (found != expected)
		fail_msg("%s: %d, expected %d (%s)", name, found, expected, path.data);
	char *wanted = realpath(in_folder(""), NULL);
	assert_string_equal(path.data + strlen(wanted) + 1, file);
	free(wanted);
	nt_buffer_free(&path);
}

static void make_files(void)
{
	static const char *const folders[] = {"mtl", "mtl/tex", "obj", "obj/tex", "more", "more/tex", "elsewhere"};
	for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
		mkdir(in_folder(folders[i]), 0777);
	static const char *const files[] = {"mtl/a.png", "mtl/tex/b.png", "obj/b.png", "obj/tex/c.png", "more/d.png",
		"more/tex/c.png", "mtl/E.png", "mtl/e.PNG", "elsewhere/f.png", "mtl/tex/f.png"};
	for (size_t i = 0; i < sizeof files / sizeof *files; i++)
		put_file(files[i], "x", 1);
	assert_int_equal(symlink("../elsewhere/f.png", in_folder("mtl/link.png")), 0);
}

TEST(places_come_in_their_order)
{
	make_files();
	assert_found("a.png", false, NT_IMAGE_FOUND, "mtl/a.png");
	assert_found("./tex/../a.png", false, NT_IMAGE_FOUND, "mtl/a.png");
	assert_found("old/tex/b.png", false, NT_IMAGE_FOUND_ELSEWHERE, "mtl/tex/b.png");
	assert_found("b.png", false, NT_IMAGE_FOUND_ELSEWHERE, "obj/b.png");
	assert_found("C:\\x\\tex\\c.png", false, NT_IMAGE_FOUND_ELSEWHERE, "obj/tex/c.png");
	assert_found("//host/share/d.png", false, NT_IMAGE_FOUND_ELSEWHERE, "more/d.png");
	assert_found("file:///C:/x/a.png", false, NT_IMAGE_FOUND_ELSEWHERE, "mtl/a.png");
	/* without case, the first in the order of bytes */
	assert_found("e.png", false, NT_IMAGE_FOUND_ELSEWHERE, "mtl/E.png");
	assert_found("TEX/B.png", false, NT_IMAGE_FOUND_ELSEWHERE, "mtl/tex/b.png");
	assert_found("gone.png", false, NT_IMAGE_MISSING, "mtl/gone.png");
	assert_found("D:\\x\\gone.png", false, NT_IMAGE_MISSING, "mtl/gone.png");
}

TEST(outside_needs_leave)
{
	assert_found("link.png", false, NT_IMAGE_OUTSIDE, "mtl/link.png");
	assert_found("link.png", true, NT_IMAGE_FOUND, "mtl/link.png");
	assert_found("../elsewhere/f.png", true, NT_IMAGE_FOUND, "elsewhere/f.png");
	/* nobody learns from this whether it is there */
	assert_found("../elsewhere/gone.png", false, NT_IMAGE_OUTSIDE, "elsewhere/gone.png");
	assert_found("../elsewhere/f.png", false, NT_IMAGE_OUTSIDE, "elsewhere/f.png");
	assert_found("/gone/gone.png", false, NT_IMAGE_OUTSIDE, "mtl/gone.png");
	/* not there, but its last part is somewhere inside */
	assert_found("../elsewhere/tex/f.png", false, NT_IMAGE_FOUND_ELSEWHERE, "mtl/tex/f.png");
	char absolute[300];
	snprintf(absolute, sizeof absolute, "%s", in_folder("elsewhere/f.png"));
	const nt_image_places places = places_here(false);
	nt_buffer path = {0};
	nt_image_found found;
	nt_error error;
	assert_int_equal(nt_image_find(&places, absolute, &path, &found, &error), NT_OK);
	assert_int_equal(found, NT_IMAGE_OUTSIDE);
	nt_buffer_free(&path);
	assert_found(absolute, true, NT_IMAGE_FOUND, "elsewhere/f.png");
}

TEST(finding_without_memory_is_an_error)
{
	const nt_image_places places = places_here(false);
	for (size_t n = 0, failed = 1; failed; n++) {
		nt_buffer path = {0};
		nt_image_found found;
		nt_error error;
		fail_allocations_from(n);
		const nt_status status = nt_image_find(&places, "x/TEX/B.png", &path, &found, &error);
		failed = stop_failing_allocations();
		nt_buffer_free(&path);
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
	}
}

int main(void)
{
	return run_group_within("image/find", make_folder, remove_folder);
}
