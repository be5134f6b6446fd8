/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <stdio.h>
#include "ext/json.h"

static nt_json *parse(const char *text)
{
	nt_json *document;
	nt_error error;
	nt_error_clear(&error);
	const nt_status status = nt_json_parse(&document, text, strlen(text), &error);
	if (status)
		print_error("%s: %s\n", text, error.message);
	assert_int_equal(status, NT_OK);
	return document;
}

static void check_dump(const nt_json *document, const char *expected)
{
	nt_buffer text = {0};
	nt_error error;
	assert_int_equal(nt_json_dump(document, &text, &error), NT_OK);
	assert_string_equal(text.data, expected);
	nt_buffer_free(&text);
}

/* Parsing fails with INPUT at that byte. */
static void check_refused(const char *text, size_t size, uint64_t offset)
{
	nt_json *document;
	nt_error error;
	nt_error_clear(&error);
	assert_int_equal(nt_json_parse(&document, text, size, &error), NT_ERROR_INPUT);
	assert_null(document);
	assert_int_equal(error.status, NT_ERROR_INPUT);
	assert_true(strlen(error.message) > 10);
	if (error.place.offset != offset)
		print_error("%s: %s\n", text, error.message);
	assert_int_equal(error.place.offset, offset);
}

static void text_comes_back_as_it_was(void **state)
{
	(void)state;
	static const char *const texts[] = {
		"{}",
		"[]",
		"{\"z\":1,\"a\":2,\"m\":{\"y\":null,\"b\":[]}}",
		"{\"big\":18446744073709551615,\"small\":-9223372036854775808,\"empty\":{}}",
		"[0.1,1.0,1e+300,-2.5e-08,true,false,null,\"\"]",
		"[\"\xC3\xA9\\n\\\"\\\\\\u0000\"]",
		"{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {}\n}",
		"{\n\t\"a\": 1\n}",
	};
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
		nt_json *document = parse(texts[i]);
		check_dump(document, texts[i]);
		nt_json_free(document);
	}
}

static void faults_are_refused_with_their_place(void **state)
{
	(void)state;
	check_refused("", 0, 0);
	check_refused("{]", 2, 1);
	check_refused("{\"a\":1", 6, 6);
	check_refused("\xEF\xBB\xBF{}", 5, 0);
	check_refused("{} x", 4, 3);
	check_refused("[1e400]", 7, 5);
	check_refused("[\"\xFF\"]", 5, 2);
	check_refused("[\"\\ud800\"]", 10, 8);
	check_refused("[01]", 4, 2);
	check_refused("{\"a\":1,\"b\":2,\"a\":3}", 19, 16);
	check_refused("[\"a\0b\"]", 7, 3);
}

static void duplicate_key_in_large_object_is_found(void **state)
{
	(void)state;
	nt_buffer text = {0};
	nt_buffer_text(&text, "{");
	for (int i = 0; i < 1000; i++)
		nt_buffer_format(&text, "\"k%d\":%d,", i, i);
	const size_t end_of_good = text.size;
	nt_buffer_text(&text, "\"k7\":0}");
	check_refused(text.data, text.size, end_of_good + 4);
	nt_buffer_free(&text);
}

static void nesting_is_capped(void **state)
{
	(void)state;
	char text[2 * NT_JSON_MAX_DEPTH + 2];
	memset(text, '[', NT_JSON_MAX_DEPTH + 1);
	memset(text + NT_JSON_MAX_DEPTH + 1, ']', NT_JSON_MAX_DEPTH + 1);
	check_refused(text, sizeof text, NT_JSON_MAX_DEPTH);
	nt_json *document;
	nt_error error;
	assert_int_equal(nt_json_parse(&document, text + 1, sizeof text - 2, &error), NT_OK);
	nt_json_free(document);
}

static void numbers_have_checked_types(void **state)
{
	(void)state;
	nt_json *document = parse("[-1,9223372036854775807,9223372036854775808,1.0,1.5,\"1\",1e19,true,2e1,18446744073709551616]");
	const nt_json_value *root = nt_json_root(document);
	uint64_t unsigned_value = 77;
	double real = 77;
	assert_false(nt_json_get_uint64(nt_json_at(root, 0), &unsigned_value));
	assert_int_equal(unsigned_value, 77);
	assert_true(nt_json_get_uint64(nt_json_at(root, 1), &unsigned_value));
	assert_true(unsigned_value == INT64_MAX);
	assert_true(nt_json_get_uint64(nt_json_at(root, 2), &unsigned_value));
	assert_true(unsigned_value == (uint64_t)1 << 63);
	assert_true(nt_json_get_uint64(nt_json_at(root, 3), &unsigned_value));
	assert_int_equal(unsigned_value, 1);
	assert_false(nt_json_get_uint64(nt_json_at(root, 4), &unsigned_value));
	assert_true(nt_json_get_double(nt_json_at(root, 4), &real));
	assert_true(real == 1.5);
	assert_false(nt_json_get_double(nt_json_at(root, 5), &real));
	assert_true(nt_json_get_uint64(nt_json_at(root, 6), &unsigned_value));
	assert_true(unsigned_value == 10000000000000000000u);
	assert_false(nt_json_get_double(nt_json_at(root, 7), &real));
	assert_true(nt_json_get_uint64(nt_json_at(root, 8), &unsigned_value));
	assert_int_equal(unsigned_value, 20);
	assert_false(nt_json_get_uint64(nt_json_at(root, 9), &unsigned_value)); /* 2^64 */
	nt_json_free(document);
}

static void look_ups_of_nothing_give_nothing(void **state)
{
	(void)state;
	nt_json *document = parse("{\"a\":{\"b\":[10,\"x\"]}}");
	const nt_json_value *root = nt_json_root(document);
	const nt_json_value *b = nt_json_find(nt_json_find(root, "a"), "b");
	assert_int_equal(nt_json_count(b), 2);
	assert_null(nt_json_at(b, 2));
	assert_null(nt_json_find(b, "c"));
	assert_null(nt_json_find(nt_json_find(root, "c"), "b"));
	assert_int_equal(nt_json_count(NULL), 0);
	assert_null(nt_json_get_string(NULL, NULL));
	assert_null(nt_json_key(b, 0, NULL));
	assert_int_equal(nt_json_type_of(NULL), NT_JSON_NONE);
	assert_string_equal(nt_json_type_text(b), "an array");
	size_t length;
	assert_string_equal(nt_json_key(root, 0, &length), "a");
	assert_int_equal(length, 1);
	nt_json_free(document);
}

static void changes_keep_the_order_of_the_rest(void **state)
{
	(void)state;
	nt_json *document = parse("{\"z\":1,\"y\":{\"deep\":[1,2]},\"x\":3}");
	nt_json_value *root = nt_json_root(document);
	const nt_json_value *deep = nt_json_at(nt_json_find(nt_json_find(root, "y"), "deep"), 1);
	nt_json_set_uint64(document, nt_json_put(document, root, "z"), 7);
	nt_json_set_string(document, nt_json_put(document, root, "new"), "n\0w", 3);
	nt_json_set_double(document, nt_json_put(document, root, "mid"), 0.1);
	nt_json_value *array = nt_json_put(document, root, "list");
	nt_json_set_bool(document, nt_json_append(document, array), true);
	nt_json_set_object(document, nt_json_append(document, array));
	nt_json_set_copy(document, nt_json_append(document, array), nt_json_find(root, "y"));
	/* values deep inside members that moved stay where they were */
	uint64_t two = 0;
	assert_true(nt_json_get_uint64(deep, &two));
	assert_int_equal(two, 2);
	nt_json_remove(document, root, "x");
	nt_json_remove(document, root, "absent");
	nt_json_remove_at(document, nt_json_find(root, "list"), 1);
	check_dump(document, "{\"z\":7,\"y\":{\"deep\":[1,2]},\"new\":\"n\\u0000w\",\"mid\":0.1,"
		"\"list\":[true,{\"deep\":[1,2]}]}");
	assert_false(nt_json_failed(document));
	nt_json_free(document);
}

static void equality_looks_at_values_and_order(void **state)
{
	(void)state;
	nt_json *document = parse("[{\"a\":1,\"b\":2},{\"a\":1.0,\"b\":2},{\"b\":2,\"a\":1},{\"a\":1}]");
	const nt_json_value *root = nt_json_root(document);
	assert_true(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 1)));
	assert_false(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 2)));
	assert_false(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 3)));
	assert_false(nt_json_equal(nt_json_at(root, 0), NULL));
	nt_json_free(document);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(text_comes_back_as_it_was),
		cmocka_unit_test(faults_are_refused_with_their_place),
		cmocka_unit_test(duplicate_key_in_large_object_is_found),
		cmocka_unit_test(nesting_is_capped),
		cmocka_unit_test(numbers_have_checked_types),
		cmocka_unit_test(look_ups_of_nothing_give_nothing),
		cmocka_unit_test(changes_keep_the_order_of_the_rest),
		cmocka_unit_test(equality_looks_at_values_and_order),
	};
	return cmocka_run_group_tests_name("ext/json", tests, NULL, NULL);
}
