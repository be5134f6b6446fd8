/* SPDX-License-Identifier: MIT */
#include "format/format.h"
#include "test.h"

static nt_format of_input(const char *text, size_t size, const char *path)
{
	const nt_format_entry *entry = nt_format_of_input((const unsigned char *)text, size, path);
	return entry ? entry->format : NT_FORMAT_UNKNOWN;
}

static nt_format of_path(const char *path)
{
	const nt_format_entry *entry = nt_format_of_path(path);
	return entry ? entry->format : NT_FORMAT_UNKNOWN;
}

static void format_of_a_name_is_its_extension_in_any_case(void **state)
{
	(void)state;
	assert_int_equal(of_path("a.obj"), NT_FORMAT_OBJ);
	assert_int_equal(of_path("dir.gltf/a.PLY"), NT_FORMAT_PLY);
	assert_int_equal(of_path("a.obj.gltf"), NT_FORMAT_GLTF);
	assert_int_equal(of_path(".glb"), NT_FORMAT_GLB);
	assert_int_equal(of_path("a.drc"), NT_FORMAT_DRC);
	assert_int_equal(of_path("dir.gltf/a"), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_path("a.gltf2"), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_path("a."), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_path("-"), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_path(""), NT_FORMAT_UNKNOWN);
}

static void format_of_an_input_is_its_content_before_its_name(void **state)
{
	(void)state;
	assert_int_equal(of_input("DRACO\2\2", 7, "a.obj"), NT_FORMAT_DRC);
	assert_int_equal(of_input("ply\n", 4, "a.gltf"), NT_FORMAT_PLY);
	assert_int_equal(of_input("ply\rformat", 10, "-"), NT_FORMAT_PLY);
	assert_int_equal(of_input("plyx", 4, "-"), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_input("", 0, "a.obj"), NT_FORMAT_OBJ);
	assert_int_equal(of_input("", 0, "a.txt"), NT_FORMAT_UNKNOWN);
	assert_int_equal(of_input("\0\1\2\3", 4, "-"), NT_FORMAT_UNKNOWN);
}

static void every_format_is_found_by_its_number(void **state)
{
	(void)state;
	const char *const paths[] = {"a.obj", "a.ply", "a.gltf", "a.glb", "a.drc"};
	for (size_t i = 0; i < 5; i++) {
		const nt_format_entry *entry = nt_format_of_path(paths[i]);
		assert_non_null(entry);
		assert_string_equal(entry->name, paths[i] + 2);
		assert_ptr_equal(nt_format_find(entry->format), entry);
	}
	assert_null(nt_format_find(NT_FORMAT_UNKNOWN));
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(format_of_a_name_is_its_extension_in_any_case),
		cmocka_unit_test(format_of_an_input_is_its_content_before_its_name),
		cmocka_unit_test(every_format_is_found_by_its_number),
	};
	return cmocka_run_group_tests_name("format/format", tests, NULL, NULL);
}
