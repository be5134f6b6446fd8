/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "report/codes.h"

static void every_code_has_a_complete_row_and_is_found_by_its_name(void **state)
{
	(void)state;
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		assert_non_null(row->name);
		assert_true(row->message && row->meaning && row->remedy && row->example);
		nt_code found;
		assert_true(nt_code_find(row->name, &found));
		assert_int_equal(found, i);
	}
	nt_code found;
	assert_false(nt_code_find("UV_MIRROR", &found));
	assert_false(nt_code_find("", &found));
}

static void sentence_is(nt_code code, size_t count, const char *detail, const char *expected)
{
	nt_buffer out = {0};
	nt_code_sentence(code, count, detail, &out);
	assert_string_equal(out.data, expected);
	nt_buffer_free(&out);
}

static void sentences_count_and_carry_the_detail(void **state)
{
	(void)state;
	sentence_is(NT_CODE_TAN_ZERO, 1, NULL, "1 tangent has no length");
	sentence_is(NT_CODE_TAN_ZERO, 7, "", "7 tangents have no length");
	sentence_is(NT_CODE_MTL_MISSING, 1, "a.mtl", "material library cannot be read: a.mtl");
}

static void severities_have_names(void **state)
{
	(void)state;
	nt_severity severity;
	assert_true(nt_severity_find("warning", &severity));
	assert_int_equal(severity, NT_SEVERITY_WARNING);
	assert_false(nt_severity_find("fatal", &severity));
	assert_string_equal(nt_severity_name(NT_SEVERITY_ERROR), "error");
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_code_has_a_complete_row_and_is_found_by_its_name),
		cmocka_unit_test(sentences_count_and_carry_the_detail),
		cmocka_unit_test(severities_have_names),
	};
	return cmocka_run_group_tests_name("report/codes", tests, NULL, NULL);
}
