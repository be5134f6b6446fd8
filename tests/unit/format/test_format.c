/* SPDX-License-Identifier: MIT */
#include "format/format.h"
#include "test.h"

/* "": unknown */
static void is_called(const nt_format_entry *entry, const char *name)
{
	assert_string_equal(entry ? entry->name : "", name);
}

TEST(format_of_a_name_is_its_extension_in_any_case)
{
	static const char *const rows[][2] = {{"a.obj", "obj"}, {"dir.gltf/a.PLY", "ply"}, {"a.obj.gltf", "gltf"},
		{".glb", "glb"}, {"dir.gltf/.obj", "obj"}, {"a.drc", "drc"}, {"dir.gltf/a", ""}, {"a.gltf2", ""},
		{"a.", ""}, {"-", ""}, {"", ""}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		is_called(nt_format_of_path(rows[i][0]), rows[i][1]);
}

TEST(format_of_an_input_is_its_content_before_its_name)
{
	static const struct {
		const char *bytes;
		size_t size;
		const char *path, *name;
	} rows[] = {{"DRACO\2\2", 7, "a.obj", "drc"}, {"ply\n", 4, "a.gltf", "ply"}, {"ply\rformat", 10, "-", "ply"},
		{"plyx", 4, "-", ""}, {"", 0, "a.obj", "obj"}, {"", 0, "a.txt", ""}, {"\0\1\2\3", 4, "-", ""},
		{"v 0 0 0\n", 8, "-", "obj"}, {"# x\n\n  o a\n", 11, "-", "obj"}, {"g\n", 2, "-", "obj"},
		{"\xEF\xBB\xBF# x\r\nmtllib a.mtl\r\n", 22, "-", "obj"}, {"# only comments\n", 16, "-", ""},
		{"newmtl a\n", 9, "-", ""}, {"v", 1, "-", ""}, {"vertex 1 2 3\n", 13, "-", ""}, {"v\1 0\n", 5, "-", ""},
		{"\0v 1 2 3\n", 9, "-", ""}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		is_called(nt_format_of_input((const unsigned char *)rows[i].bytes, rows[i].size, rows[i].path),
			rows[i].name);
}

TEST(every_format_is_found_by_its_number)
{
	const char *const paths[] = {"a.obj", "a.ply", "a.gltf", "a.glb", "a.drc"};
	for (size_t i = 0; i < 5; i++) {
		const nt_format_entry *entry = nt_format_of_path(paths[i]);
		assert_non_null(entry);
		assert_string_equal(entry->name, paths[i] + 2);
		assert_ptr_equal(nt_format_find(entry->format), entry);
	}
	assert_null(nt_format_find(NT_FORMAT_UNKNOWN));
}
