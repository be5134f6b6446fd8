/* SPDX-License-Identifier: MIT */
/*
 * Which files are meant, in a fresh folder that is the current one.
 */
#include "batch/inputs.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

#include <sys/stat.h>
#include <unistd.h>

static const nt_folder_rules files_only, folders = {.recursive = true};

/* All names, each with a blank behind it. */
static void are(nt_inputs *inputs, const char *expected)
{
	char names[256] = "";
	for (size_t i = 0; i < inputs->count; i++) {
		strcat(names, inputs->names[i]);
		strcat(names, " ");
	}
	assert_string_equal(names, expected);
	nt_inputs_free(inputs);
}

TEST(names_are_taken_as_they_are_and_folders_only_if_wished)
{
	nt_inputs inputs = {0};
	nt_error error;
	assert_int_equal(mkdir("d", 0700), 0);
	assert_int_equal(mkdir("d/B", 0700), 0);
	assert_int_equal(mkdir("d/out", 0700), 0);
	assert_int_equal(symlink("..", "d/loop"), 0);
	assert_int_equal(symlink("a.obj", "d/link.OBJ"), 0);
	assert_int_equal(symlink("nowhere", "d/broken.obj"), 0);
	for (size_t i = 0; i < 5; i++)
		put_text_file(((const char *const[]){"d/a.obj", "d/notes.txt", "d/B/z.glb", "d/B/c.ply",
			"d/out/a.glb"})[i], "");
	assert_int_equal(nt_inputs_add(&inputs, "missing", &files_only, &error), NT_OK);
	assert_int_equal(nt_inputs_add(&inputs, "d", &files_only, &error), NT_OK);
	are(&inputs, "missing d ");

	assert_int_equal(nt_inputs_add(&inputs, "d/notes.txt", &folders, &error), NT_OK);
	assert_int_equal(nt_inputs_add(&inputs, "d", &folders, &error), NT_OK);
	are(&inputs, "d/notes.txt d/B/c.ply d/B/z.glb d/a.obj d/link.OBJ d/out/a.glb ");

	const nt_folder_rules without_outputs = {.recursive = true, .leave_out = "d/out"};
	assert_int_equal(nt_inputs_add(&inputs, "d/", &without_outputs, &error), NT_OK);
	are(&inputs, "d/B/c.ply d/B/z.glb d/a.obj d/link.OBJ ");
}

TEST(patterns_choose_in_folders)
{
	nt_inputs inputs = {0};
	nt_error error;
	const char *const plys[] = {"*.ply", "out/*"}, *const no_b[] = {"B"};
	const nt_folder_rules some = {.recursive = true, .include = plys, .include_count = 2},
		others = {.recursive = true, .exclude = no_b, .exclude_count = 1};
	assert_int_equal(nt_inputs_add(&inputs, "d", &some, &error), NT_OK);
	are(&inputs, "d/B/c.ply d/out/a.glb ");
	assert_int_equal(nt_inputs_add(&inputs, "d", &others, &error), NT_OK);
	are(&inputs, "d/a.obj d/link.OBJ d/out/a.glb ");
}

TEST(lists_have_a_name_a_line_or_one_before_each_nul)
{
	nt_inputs inputs = {0};
	nt_error error;
	put_text_file("lines", "\nb.obj\n\na b.obj\n-\nlast");
	put_file("nuls", "x\ny.obj\0\0-\0z", 12);
	assert_int_equal(nt_inputs_add(&inputs, "first", &files_only, &error), NT_OK);
	assert_int_equal(nt_inputs_add_list(&inputs, "lines", 0, &files_only, &error), NT_OK);
	are(&inputs, "first b.obj a b.obj ./- last ");
	assert_int_equal(nt_inputs_add_list(&inputs, "nuls", 0, &files_only, &error), NT_OK);
	are(&inputs, "x\ny.obj ./- z ");
	put_text_file("none", "");
	assert_int_equal(nt_inputs_add_list(&inputs, "none", 0, &files_only, &error), NT_OK);
	are(&inputs, "");
	assert_int_equal(nt_inputs_add_list(&inputs, "nowhere", 0, &files_only, &error), NT_ERROR_MISSING);
	nt_inputs_free(&inputs);
}

TEST(an_exhausted_memory_is_told)
{
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		nt_inputs inputs = {0};
		nt_error error;
		fail_allocations_from(n);
		nt_status status = nt_inputs_add(&inputs, "d", &folders, &error);
		if (!status)
			status = nt_inputs_add_list(&inputs, "lines", 0, &folders, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		nt_inputs_free(&inputs);
		assert_true(n < 100);
	}
}

AROUND_ALL(enter_folder, leave_folder)
