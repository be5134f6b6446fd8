/* SPDX-License-Identifier: MIT */
#include "test.h"

#include <unistd.h>
#include "file/path.h"

/* The text that a function appends, as a string that lives until the next call. */
static const char *taken(nt_buffer *text)
{
	static char kept[300];
	assert_false(text->failed);
	snprintf(kept, sizeof kept, "%s", text->data ? text->data : "");
	nt_buffer_free(text);
	return kept;
}

static const char *uri(const char *folder, const char *path)
{
	nt_buffer text = {0};
	nt_link_uri(&text, folder, path);
	return taken(&text);
}

static const char *join(const char *folder, const char *name)
{
	nt_buffer text = {0};
	nt_path_join(&text, folder, name);
	return taken(&text);
}

TEST(uri_leads_from_folder_to_file)
{
	assert_string_equal(uri("/a/b", "/a/b/c.png"), "c.png");
	assert_string_equal(uri("/a/b", "/a/b/c/d.png"), "c/d.png");
	assert_string_equal(uri("/a/b", "/a/c.png"), "../c.png");
	assert_string_equal(uri("/a/bc", "/a/b/x.png"), "../b/x.png"); /* b is no folder of bc */
	assert_string_equal(uri("/a", "/ab/x.png"), "../ab/x.png");
	assert_string_equal(uri("/a/b/c", "/x/y.png"), "../../../x/y.png");
	assert_string_equal(uri("/", "/x/y.png"), "x/y.png");
}

TEST(uri_encodes_what_may_not_stand_in_a_path)
{
	assert_string_equal(uri("/a", "/a/b c%#?:.png"), "b%20c%25%23%3F%3A.png");
	assert_string_equal(uri("/a", "/a/\xc3\xa9-_~1.png"), "%C3%A9-_~1.png");
}

TEST(join_resolves_dots)
{
	assert_string_equal(join("/a/b", "c.png"), "/a/b/c.png");
	assert_string_equal(join("/a/b", "t/./u//c.png"), "/a/b/t/u/c.png");
	assert_string_equal(join("/a/b", "../c.png"), "/a/c.png");
	assert_string_equal(join("/a/b", "../../../../c.png"), "/c.png");
	assert_string_equal(join("/a/b", "/x/./y.png"), "/x/y.png");
	assert_string_equal(join("/", ".."), "/");
}

TEST(absolute_names_are_told)
{
	static const char *const absolute[] = {"/x", "\\\\host\\x", "C:\\x", "C:x", "c:/x", "http://x",
		"file:///x"};
	static const char *const relative[] = {"x", "a b/c", "../x", "a:b", ".x", "", "tex:1.png"};
	for (size_t i = 0; i < sizeof absolute / sizeof *absolute; i++)
		assert_true(nt_link_is_absolute(absolute[i]));
	for (size_t i = 0; i < sizeof relative / sizeof *relative; i++)
		assert_int_equal(nt_link_is_absolute(relative[i]), strcmp(relative[i], "a:b") == 0);
}

TEST(inside_means_below)
{
	assert_true(nt_link_is_inside("/a/b", "/a"));
	assert_true(nt_link_is_inside("/a", "/"));
	assert_false(nt_link_is_inside("/ab", "/a"));
	assert_false(nt_link_is_inside("/a", "/a"));
}

TEST(folder_of_a_name_may_be_missing_but_not_below_a_file)
{
	nt_buffer text = {0};
	nt_error error;
	assert_int_equal(nt_link_folder(&text, "/x.obj", &error), NT_OK);
	assert_string_equal(taken(&text), "/");
	assert_int_equal(nt_link_folder(&text, "/dev/null/y/x.obj", &error), NT_ERROR_MISSING);
	nt_buffer_free(&text);
	assert_int_equal(nt_link_folder(&text, "/dev/nowhere/x.obj", &error), NT_OK); /* it may come to be */
	assert_string_equal(taken(&text), "/dev/nowhere");
	assert_int_equal(nt_link_folder(&text, "x.obj", &error), NT_OK);
	assert_int_equal(taken(&text)[0], '/');
}

TEST(folders_are_named_without_their_slash)
{
	static const char *const rows[][2] = {{"x", "."}, {"/x", "/"}, {"a/b/c", "a/b"}, {"/a/", "/a"}, {"", "."}};
	static char longest[PATH_MAX + 2];
	char folder[PATH_MAX];
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_string_equal(nt_folder_of(rows[i][0], folder), rows[i][1]);
	memset(longest, 'a', PATH_MAX);
	longest[PATH_MAX - 1] = '/';
	assert_string_equal(nt_folder_of(longest, folder), "");
	assert_int_equal(strlen(nt_folder_of(longest + 1, folder)), PATH_MAX - 2);
}

TEST(absolute_paths_are_of_this_system)
{
	nt_buffer text = {0};
	nt_error error;
	char here[4096], expected[8192];
	assert_non_null(getcwd(here, sizeof here));
	assert_int_equal(nt_path_absolute(&text, "/a/./b//c/../d\\e", &error), NT_OK);
	assert_string_equal(taken(&text), "/a/b/d\\e");
	assert_int_equal(nt_path_absolute(&text, "/..", &error), NT_OK);
	assert_string_equal(taken(&text), "/");
	assert_int_equal(nt_path_absolute(&text, "./x/", &error), NT_OK);
	snprintf(expected, sizeof expected, "%s/x", here);
	assert_string_equal(taken(&text), expected);
}

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
