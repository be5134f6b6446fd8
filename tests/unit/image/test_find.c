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
		.confined = true, .allow_outside = allow_outside};
}

/* The target of a name, from the test's folder. */
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

/* studio/models/obj/m.obj, its library in studio/models/obj/mtl, images in studio/models/tex and studio/shared. These
 * may lie below the folder above the OBJ, and below the user's; what is there and no image is not told from nothing. */
TEST(images_lie_below_the_folder_above_or_the_user_s)
{
	static const char *const folders[] = {"studio", "studio/models", "studio/models/obj", "studio/models/obj/mtl",
		"studio/models/tex", "studio/models/tex/deep", "studio/shared", "studio/models/obj/way"};
	for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
		mkdir(in_folder(folders[i]), 0777);
	static const char *const files[] = {"studio/models/tex/Wood.JPG", "studio/models/tex/deep/n.png",
		"studio/shared/s.png", "studio/models/top.png", "secret.png"};
	for (size_t i = 0; i < sizeof files / sizeof *files; i++)
		put_file(files[i], "\x89PNG\r\n\x1a\n", 8);
	put_text_file("studio/models/tex/key.txt", "secret");
	put_text_file("studio/shared/key.txt", "secret");
	assert_int_equal(symlink("../tex", in_folder("studio/models/obj/link")), 0);
	assert_int_equal(symlink("../../shared", in_folder("studio/models/obj/shared")), 0);
	assert_int_equal(symlink("../..", in_folder("studio/models/out")), 0);
	char absolute[300];
	snprintf(absolute, sizeof absolute, "%s", in_folder("studio/models/tex/Wood.JPG"));
	enum { ABOVE, ROOT, NO };
	const nt_image_found lies[] = {NT_IMAGE_FOUND, NT_IMAGE_FOUND_ELSEWHERE, NT_IMAGE_MISSING, NT_IMAGE_OUTSIDE};
	/* what is found without, with a root, and with neither: y as named, e elsewhere, m missing, o outside */
	const struct {
		const char *name, *found;
	} cases[] = {{"../../tex/Wood.JPG", "yyo"}, {"../../tex/wood.jpg", "eeo"}, {"../../TEX/wood.JPG", "eeo"},
		{"../../tex/gone.jpg", "mmo"}, {"../../tex/key.txt", "myo"}, {"../../tex/KEY.txt", "meo"},
		{"../../tex/deep/n.png", "yyo"}, {"../../tex", "mmo"}, {"../../top.png", "yyo"},
		{"../../../shared/s.png", "oyo"}, {"../../../SHARED/S.png", "oeo"}, {"../../../shared/gone.png", "omo"},
		{"../../../shared/key.txt", "oyo"}, {"../../../../secret.png", "ooo"}, {"../../../../gone.png", "ooo"},
		{"../../out/secret.png", "ooo"}, {"../../out/gone.png", "ooo"}, {"../../OUT/secret.png", "ooo"},
		{"../../OUT/gone.png", "ooo"}, {"../link/Wood.JPG", "yyo"}, {"../shared/s.png", "oyo"},
		{"../shared/gone.png", "omo"}, {absolute, "yyo"}, {"/etc/passwd", "ooo"}, {"/gone", "ooo"}};
	char library[300], obj[300], root[300];
	snprintf(library, sizeof library, "%s", in_folder("studio/models/obj/mtl/m.mtl"));
	snprintf(obj, sizeof obj, "%s", in_folder("studio/models/obj/m.obj"));
	snprintf(root, sizeof root, "%s", in_folder("studio/"));
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		for (int k = ABOVE; k <= NO; k++) {
			const nt_image_places places = {.document = library, .input = obj,
				.root = k == ABOVE ? NULL : root, .confined = k == NO};
			nt_buffer path = {0};
			nt_image_found found;
			nt_error error;
			assert_int_equal(nt_image_find(&places, cases[i].name, &path, &found, &error), NT_OK);
			if (found != lies[strchr("yemo", cases[i].found[k]) - "yemo"])
				fail_msg("%s, %d: found %d (%s)", cases[i].name, k, found, path.data);
			nt_buffer_free(&path);
		}
}

/* The root of the file system is no folder above, and none of the user's. */
TEST(the_root_of_the_system_gives_no_leave)
{
	const nt_image_places places = {.document = "/tmp/m.mtl", .input = "/tmp/m.obj", .root = "/"};
	nt_buffer path = {0};
	nt_image_found found;
	nt_error error;
	assert_int_equal(nt_image_find(&places, "../etc/passwd", &path, &found, &error), NT_OK);
	assert_true(found == NT_IMAGE_OUTSIDE);
	nt_buffer_free(&path);
}

TEST(finding_without_memory_is_an_error)
{
	nt_image_places places = places_here(false);
	places.confined = false;
	places.root = in_folder("");
	static const char *const names[] = {"x/TEX/B.png", "../MTL/TEX/B.png"};
	for (size_t i = 0; i < 2; i++)
		for (size_t n = 0, failed = 1; failed; n++) {
			nt_buffer path = {0};
			nt_image_found found;
			nt_error error;
			fail_allocations_from(n);
			const nt_status status = nt_image_find(&places, names[i], &path, &found, &error);
			failed = stop_failing_allocations();
			nt_buffer_free(&path);
			assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		}
}

AROUND_ALL(make_folder, remove_folder)
