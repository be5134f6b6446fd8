/* SPDX-License-Identifier: MIT */
/*
 * Names in reports: of inputs, and of files that these refer to.
 */
#include "file/shown_path.h"
#include "test.h"

#include <string.h>

TEST(names_are_relative_to_the_folder_of_the_run_or_of_the_inputs)
{
	static const struct {
		const char *inputs[3], *prefix, *path, *shown;
	} rows[] = {
		{{"a.obj"}, NULL, "./a.obj", "a.obj"},
		{{"b/../a.obj", "b/a.obj"}, NULL, "b//a.obj", "b/a.obj"},
		{{"/x/a.obj"}, NULL, "/x/a.obj", "a.obj"},
		{{"/x/y/a.obj", "/x/z/a.obj"}, NULL, "/x/z/a.obj", "z/a.obj"},
		/* a common beginning is no common folder */
		{{"/x/ya/a.obj", "/x/yb/a.obj"}, NULL, "/x/ya/a.obj", "ya/a.obj"},
		{{"/x/y/a.obj", "/x/y.obj"}, NULL, "/x/y.obj", "y.obj"},
		{{"/x/a.obj", "/y/a.obj"}, NULL, "/x/a.obj", "x/a.obj"},
		{{"/a.obj"}, NULL, "/a.obj", "a.obj"},
		{{"-", "/x/a.obj"}, NULL, "-", "-"},
		{{"-"}, NULL, "c/d.mtl", "c/d.mtl"},
		/* what is elsewhere tells nothing of the machine */
		{{"a.obj"}, NULL, "/there/m.mtl", "m.mtl"},
		{{"a.obj"}, "art", "a.obj", "art/a.obj"},
		{{"/x/a.obj"}, "art/", "/x/a.obj", "art/a.obj"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_shown_paths paths;
		nt_error error;
		nt_buffer shown = {0};
		size_t count = 0;
		while (count < 3 && rows[i].inputs[count])
			count++;
		assert_int_equal(nt_shown_paths_begin(&paths, rows[i].inputs, count, rows[i].prefix, &error), NT_OK);
		nt_shown_path(&paths, rows[i].path, &shown);
		assert_string_equal(shown.data, rows[i].shown);
		nt_buffer_free(&shown);
		nt_shown_paths_free(&paths);
	}
}

TEST(without_paths_names_are_as_they_are_spelled)
{
	nt_buffer shown = {0};
	nt_shown_path(NULL, "../a.obj", &shown);
	assert_string_equal(shown.data, "../a.obj");
	nt_buffer_free(&shown);
}
