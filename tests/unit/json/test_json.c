/* SPDX-License-Identifier: MIT */
#include "fail_alloc.h"
#include "test.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "json/json.h"

static nt_json *parse(const char *text)
{
	nt_json *document;
	nt_error error;
	nt_error_clear(&error);
	const nt_status status = nt_json_parse(&document, text, strlen(text), "extras", &error);
	if (status)
		print_error("%s: %s\n", text, error.message);
	assert_int_equal(status, NT_OK);
	return document;
}

static nt_status append_text(void *user, const char *text, size_t size)
{
	nt_buffer *buffer = user;
	nt_buffer_append(buffer, text, size);
	return buffer->failed ? NT_ERROR_MEMORY : NT_OK;
}

static nt_status dump(const nt_json *document, nt_buffer *text, nt_error *error)
{
	return nt_json_write(document, append_text, text, error) ? nt_fail_memory(error) : NT_OK;
}

static void check_dump(const nt_json *document, const char *expected)
{
	nt_buffer text = {0};
	nt_error error;
	uint64_t size;
	assert_int_equal(dump(document, &text, &error), NT_OK);
	assert_string_equal(text.data, expected);
	assert_int_equal(nt_json_measure(document, &size, &error), NT_OK);
	assert_int_equal(size, text.size);
	nt_buffer_free(&text);
}

/* Parsing fails with INPUT at that byte. */
static void check_refused(const char *text, size_t size, uint64_t offset)
{
	nt_json *document;
	nt_error error;
	nt_error_clear(&error);
	assert_int_equal(nt_json_parse(&document, text, size, "extras", &error), NT_ERROR_INPUT);
	assert_null(document);
	assert_int_equal(error.status, NT_ERROR_INPUT);
	assert_true(strlen(error.message) > 10);
	if (error.place.offset != offset)
		print_error("%s: %s\n", text, error.message);
	assert_int_equal(error.place.offset, offset);
}

TEST(text_comes_back_as_it_was)
{
	static const char *const texts[] = {
		"{}",
		"[]",
		"{\"z\":1,\"a\":2,\"m\":{\"y\":null,\"b\":[]}}",
		"{\"big\":18446744073709551615,\"small\":-9223372036854775808,\"empty\":{}}",
		"[0.1,1.0,1e+300,-2.5e-08,true,false,null,\"\"]",
		"[\"\xC3\xA9\\n\\\"\\\\\\u0000\"]",
		"{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {}\n}",
		"{\n\t\"a\": 1\n}",
		" [ 1.0E+03 , -0.0 , 0e5,1E-400000 , 12345678901234567890123 ]\r\n",
		"{ \"\\u00e9\" : \"\\/\\u00E9\\ud83d\\ude00\" ,\n\t\"e\":[ ],\"o\":{\n} }",
		"{\"extras\":{\"a\":1e400,\"a\":[{\"b\":-1e999,\"b\":0}]}}",
		"{\"extras\":1e400}",
		"\"a\\u0000b\"",
		" null ",
		"3.50",
	};
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
		nt_json *document = parse(texts[i]);
		check_dump(document, texts[i]);
		nt_json_free(document);
	}
}

TEST(faults_are_refused_with_their_place)
{
	check_refused("", 0, 0);
	check_refused("{]", 2, 1);
	check_refused("{\"a\":1", 6, 6);
	check_refused("\xEF\xBB\xBF{}", 5, 0);
	check_refused("{} x", 4, 3);
	check_refused("[1e400]", 7, 1);
	check_refused("[-1.5e309]", 10, 1);
	check_refused("[\"\xFF\"]", 5, 2);
	check_refused("[\"\\ud800\"]", 10, 2);
	check_refused("[\"\\udc00\\ud800\"]", 16, 2);
	check_refused("[\"\\ud800\\ud800\"]", 16, 2);
	/* beside the digits and letters on both sides */
	for (const char *none = "/:@G`g"; *none; none++) {
		const char text[] = {'[', '"', '\\', 'u', '1', '2', *none, '4', '"', ']', '\0'};
		check_refused(text, 10, 3);
	}
	check_refused("[\"\\x\"]", 6, 3);
	check_refused("[\"\\", 3, 3);
	check_refused("[\"\\u00", 6, 3);
	check_refused("[\"\\ud800\\", 9, 2);
	check_refused("[\"a", 3, 3);
	check_refused("[\"\xC3", 3, 2);
	check_refused("[\"\xED\xA0\x80\"]", 7, 2);
	check_refused("[\"12345678\n\"]", 13, 10);
	check_refused("[01]", 4, 2);
	check_refused("[-]", 3, 2);
	check_refused("[1.]", 4, 3);
	check_refused("[1e+]", 5, 4);
	check_refused("[+1]", 4, 1);
	check_refused("[.5]", 4, 1);
	check_refused("[NaN]", 5, 1);
	check_refused("[nul]", 5, 4);
	check_refused("-", 1, 1);
	check_refused("[1,]", 4, 3);
	check_refused("{\"a\":1,}", 8, 7);
	check_refused("{\"a\" 1}", 7, 5);
	check_refused("{a:1}", 5, 1);
	check_refused("[1}", 3, 2);
	check_refused("[1 2]", 5, 3);
	check_refused("\0", 1, 0);
	check_refused("{\"a\":1,\"b\":2,\"a\":3}", 19, 16);
	check_refused("{\"a\":1,\"\\u0061\" : \"b\"}", 22, 15);
	check_refused("[\"a\0b\"]", 7, 3);
}

TEST(duplicate_key_in_large_object_is_found)
{
	nt_buffer text = {0};
	nt_buffer_text(&text, "{");
	for (int i = 0; i < 1000; i++)
		nt_buffer_format(&text, "\"k%d\":%d,", i, i);
	const size_t end_of_good = text.size;
	nt_buffer_text(&text, "\"k7\":0}");
	check_refused(text.data, text.size, end_of_good + 4);
	nt_buffer_free(&text);
}

TEST(nesting_is_capped)
{
	char text[2 * NT_JSON_MAX_DEPTH + 2];
	memset(text, '[', NT_JSON_MAX_DEPTH + 1);
	memset(text + NT_JSON_MAX_DEPTH + 1, ']', NT_JSON_MAX_DEPTH + 1);
	check_refused(text, sizeof text, NT_JSON_MAX_DEPTH);
	nt_json *document;
	nt_error error;
	assert_int_equal(nt_json_parse(&document, text + 1, sizeof text - 2, NULL, &error), NT_OK);
	nt_json_free(document);
}

TEST(what_is_foreign_is_so_within_its_member_alone)
{
	check_refused("{\"extras\":{},\"b\":1e400}", 23, 17);
	check_refused("{\"extra\":1e400}", 15, 9);
	check_refused("[{\"extras\":{\"a\":1,\"a\":2}},{\"a\":1,\"a\":2}]", 40, 36);
	check_refused("{\"extras\":1,\"extras\":2}", 23, 20);
	nt_json *document;
	nt_error error;
	assert_int_equal(nt_json_parse(&document, "{\"extras\":1e400}", 16, NULL, &error), NT_ERROR_INPUT);
	document = parse("{\"extras\":{\"n\":1e400,\"k\":1,\"k\":2}}");
	nt_json_value *extras = nt_json_find(nt_json_root(document), "extras");
	double real = 7;
	uint64_t whole = 7;
	assert_false(nt_json_get_double(nt_json_find(extras, "n"), &real));
	assert_false(nt_json_get_uint64(nt_json_find(extras, "n"), &whole));
	assert_true(nt_json_get_uint64(nt_json_find(extras, "k"), &whole));
	assert_int_equal(whole, 1);
	nt_json_remove(document, extras, "k");
	check_dump(document, "{\"extras\":{\"n\":1e400}}");
	nt_json_free(document);
}

/* One edit: a member is set, put, or (value NULL) taken out; the path has keys and numbers of elements. */
typedef struct edit {
	const char *text, *path, *key, *value, *expected;
} edit;

static nt_json_value *walk(nt_json *document, const char *path)
{
	nt_json_value *value = nt_json_root(document);
	while (*path) {
		char part[20];
		const size_t length = strcspn(path, "/");
		snprintf(part, sizeof part, "%.*s", (int)length, path);
		value = nt_json_type_of(value) == NT_JSON_ARRAY ? nt_json_at(value, (size_t)atoi(part)) :
								   nt_json_find(value, part);
		assert_non_null(value);
		path += length + (path[length] == '/');
	}
	return value;
}

TEST(edits_change_their_members_alone)
{
	static const edit edits[] = {
		/* a value of its own */
		{"{ \"a\" : 1.0E0 , \"b\":\"\\/\" }", "", "b", "7", "{ \"a\" : 1.0E0 , \"b\":7 }"},
		{"{ \"a\" : {\"x\":[1 , 2]} , \"b\":\"\\/\" }", "", "a", "7", "{ \"a\" : 7 , \"b\":\"\\/\" }"},
		{"{\"a\":[1E0, {\"n\" : \"\\u00e9\"}]}", "a/1", "n", "7", "{\"a\":[1E0, {\"n\" : 7}]}"},
		/* the same value leaves its spelling */
		{"{\"a\": 1.0E+03}", "", "a", "1000", "{\"a\": 1.0E+03}"},
		/* new members come as the document does, but on one line in an object that is */
		{"{\"a\":1}", "", "b", "2", "{\"a\":1,\"b\":2}"},
		{"{\"a\": 1, \"c\": 3}", "", "b", "2", "{\"a\": 1, \"c\": 3, \"b\": 2}"},
		{"{\r\n  \"a\": 1\r\n}\r\n", "", "b", "2", "{\r\n  \"a\": 1,\r\n  \"b\": 2\r\n}\r\n"},
		{"{\n  \"a\": {}\n}", "a", "b", "2", "{\n  \"a\": {\n    \"b\": 2\n  }\n}"},
		{"{\n  \"a\": { \"x\": [] }\n}", "a", "b", "2", "{\n  \"a\": { \"x\": [], \"b\": 2 }\n}"},
		{"{\"a\":1, \"c\": [ 3,4 ]}", "", "b", "2", "{\"a\":1, \"c\": [ 3,4 ], \"b\":2}"},
		{"{\n \"a\":{\n   \"x\" : [1 ,2] }\n}", "a", "b", "2",
			"{\n \"a\":{\n   \"x\" : [1 ,2],\n  \"b\":2 }\n}"},
		{"{\"\\u0061\":{\"\\/\":0}}", "a", "b", "2", "{\"\\u0061\":{\"\\/\":0,\"b\":2}}"},
		{"{\n\t\"a\":{\n\t\t\"x\":1\n\t}\n}", "a", "b", "2", "{\n\t\"a\":{\n\t\t\"x\":1,\n\t\t\"b\":2\n\t}\n}"},
		{"{}", "", "b", "2", "{\"b\":2}"},
		{" { } ", "", "b", "2", " {\"b\":2} "},
		/* an object that loses one is laid out so */
		{"{ \"a\":1 , \"b\":2 ,\"c\":3 }", "", "a", NULL, "{\"b\":2 , \"c\":3}"},
		{"{ \"a\":1 , \"b\":2 ,\"c\":3 }", "", "b", NULL, "{\"a\":1 , \"c\":3}"},
		{"{ \"a\":1 , \"b\":2 ,\"c\":3 }", "", "c", NULL, "{\"a\":1 , \"b\":2}"},
		{"{\n\t\"a\":1,\n\t\"b\":[ 2, 3 ],\n\t\"c\":3\n}", "", "a", NULL,
			"{\n\t\"b\":[ 2, 3 ],\n\t\"c\":3\n}"},
		{"{ \"a\\n\":1 , \"b\":[{},\"\\\"\"] }", "", "b", NULL, "{\"a\\n\":1}"},
		{"{ \"b\":[[1,{\"]\":\"[\"}]] }", "", "b", NULL, "{}"},
		{"[{\"\\u0061\" :1,\"b\":2, \"\\\\\\\"\\\"\":[{}] }]", "0", "b", NULL,
			"[{\"\\u0061\" :1,\"\\\\\\\"\\\"\":[{}]}]"},
	};
	for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
		const edit *e = &edits[i];
		nt_json *document = parse(e->text);
		nt_json_value *object = walk(document, e->path);
		if (e->value)
			nt_json_set_uint64(document, nt_json_put(document, object, e->key),
				strtoull(e->value, NULL, 10));
		else
			nt_json_remove(document, object, e->key);
		check_dump(document, e->expected);
		nt_json_free(document);
	}
}

TEST(several_edits_of_one_container)
{
	nt_json *document = parse("{\n  \"a\": [\n    1E0,\n    2E0,\n    3E0,\n    4E0\n  ]\n}\n");
	nt_json_value *a = nt_json_find(nt_json_root(document), "a");
	nt_json_remove_at(document, a, 1);
	nt_json_remove_at(document, a, 1);
	nt_json_set_uint64(document, nt_json_at(a, 1), 5);
	nt_json_value *object = nt_json_append(document, a);
	nt_json_set_string(document, nt_json_put(document, object, "s"), "\xC3\xA9/\x01", 4);
	nt_json_set_object(document, nt_json_put(document, object, "e"));
	nt_json_append(document, nt_json_put(document, object, "n"));
	check_dump(document,
		"{\n  \"a\": [\n    1E0,\n    5,\n    {\n      \"s\": \"\xC3\xA9/\\u0001\",\n      \"e\": {},\n"
		"      \"n\": [\n        null\n      ]\n    }\n  ]\n}\n");
	nt_json_remove_at(document, a, 0);
	nt_json_remove_at(document, a, 0);
	check_dump(document, "{\n  \"a\": [\n    {\n      \"s\": \"\xC3\xA9/\\u0001\",\n      \"e\": {},\n"
		"      \"n\": [\n        null\n      ]\n    }\n  ]\n}\n");
	nt_json_remove_at(document, a, 0);
	check_dump(document, "{\n  \"a\": []\n}\n");
	nt_json_free(document);
	document = parse("[{\"n\":1E0,\"s\":\"\\u0041\",\"extras\":{\"d\":1e400,\"d\":[]}} ]");
	nt_json_set_copy(document, nt_json_append(document, nt_json_root(document)),
		nt_json_at(nt_json_root(document), 0));
	check_dump(document, "[{\"n\":1E0,\"s\":\"\\u0041\",\"extras\":{\"d\":1e400,\"d\":[]}},"
		"{\"n\":1E0,\"s\":\"A\",\"extras\":{\"d\":1e400,\"d\":[]}} ]");
	nt_json_free(document);
}

/* White space is repeated for new members, but not without bound. */
TEST(long_white_space_is_not_repeated)
{
	nt_buffer text = {0};
	nt_buffer_text(&text, "[");
	memset(nt_buffer_extend(&text, 100000), ' ', 100000);
	nt_buffer_text(&text, "1]");
	nt_json *document = parse(text.data);
	for (int i = 0; i < 1000; i++)
		nt_json_append(document, nt_json_root(document));
	nt_buffer out = {0};
	nt_error error;
	assert_int_equal(dump(document, &out, &error), NT_OK);
	assert_true(out.size < 110000);
	nt_json_free(document);
	nt_buffer_free(&text);
	nt_buffer_free(&out);
}

TEST(numbers_have_checked_types)
{
	static const struct {
		const char *text;
		bool whole, real;
		uint64_t value;
	} rows[] = {{"-1", false, true, 0}, {"9223372036854775807", true, true, INT64_MAX},
		{"9223372036854775808", true, true, UINT64_C(1) << 63}, {"1.0", true, true, 1}, {"1.5", false, true, 0},
		{"\"1\"", false, false, 0}, {"1e19", true, true, UINT64_C(10000000000000000000)},
		{"true", false, false, 0}, {"2e1", true, true, 20}, {"18446744073709551616", false, true, 0}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_json *document = parse(rows[i].text);
		uint64_t whole = 77;
		double real = 77;
		assert_int_equal(nt_json_get_uint64(nt_json_root(document), &whole), rows[i].whole);
		assert_true(whole == (rows[i].whole ? rows[i].value : 77));
		assert_int_equal(nt_json_get_double(nt_json_root(document), &real), rows[i].real);
		assert_true(real == (rows[i].real ? strtod(rows[i].text, NULL) : 77));
		nt_json_free(document);
	}
}

/* Some are kept as numbers, some as text. */
TEST(integers_of_all_sizes_are_set)
{
	static const uint64_t numbers[] = {0, 7, 0xFFFFFFFFFFFFu, 0x1000000000000u, UINT64_MAX};
	nt_json *document = parse("{\"old\":[1,2,3,4,5],\"end\":0}");
	nt_json_value *root = nt_json_root(document);
	for (size_t i = 0; i < 5; i++) {
		nt_json_value *new = nt_json_append(document, nt_json_put(document, root, "new"));
		nt_json_set_uint64(document, new, numbers[i]);
		nt_json_set_uint64(document, nt_json_at(nt_json_find(root, "old"), i), numbers[i]);
		uint64_t read;
		assert_true(nt_json_get_uint64(new, &read));
		assert_int_equal(read, numbers[i]);
	}
	assert_true(nt_json_equal(nt_json_find(root, "old"), nt_json_find(root, "new")));
	nt_json_set_copy(document, nt_json_put(document, root, "copy"), nt_json_find(root, "new"));
	check_dump(document, "{\"old\":[0,7,281474976710655,281474976710656,18446744073709551615],\"end\":0,"
		"\"new\":[0,7,281474976710655,281474976710656,18446744073709551615],"
		"\"copy\":[0,7,281474976710655,281474976710656,18446744073709551615]}");
	nt_json_set_uint64(document, nt_json_find(root, "copy"), 5);
	nt_json_set_bool(document, nt_json_find(root, "end"), true);
	nt_json_remove(document, root, "new");
	check_dump(document,
		"{\"old\":[0,7,281474976710655,281474976710656,18446744073709551615],\"end\":true,\"copy\":5}");
	nt_json_free(document);
}

typedef struct pieces {
	size_t count, most;
} pieces;

static nt_status count_piece(void *user, const char *text, size_t size)
{
	(void)text;
	(void)size;
	pieces *p = user;
	p->count++;
	return p->count == p->most ? NT_ERROR_IO : NT_OK;
}

/* Strings, whose quotes are put back, begin and end everywhere in the pieces. */
TEST(long_text_comes_in_pieces)
{
	nt_buffer text = {0};
	nt_buffer_text(&text, "[");
	for (unsigned i = 0; i < 30000; i++)
		nt_buffer_format(&text, "%s{\"%.*s\":\"\xC3\xA9%u\"}", i ? "," : "", (int)(1 + i % 11),
			"abcdefghijkl", i);
	nt_buffer_text(&text, "]");
	nt_json *document = parse(text.data);
	check_dump(document, text.data);
	nt_error error;
	pieces all = {0}, some = {.most = 3};
	assert_int_equal(nt_json_write(document, count_piece, &all, &error), NT_OK);
	assert_true(all.count > 5);
	assert_int_equal(nt_json_write(document, count_piece, &some, &error), NT_ERROR_IO);
	assert_int_equal(some.count, 3);
	nt_json_free(document);
	nt_buffer_free(&text);
}

TEST(escapes_are_what_they_stand_for)
{
	nt_json *document = parse("{\"\\u006be\\u0000y\":\""
		"\\\"\\\\\\/\\b\\f\\n\\r\\t|\\u0041\\u00e9\\uA041\\ud83d\\uDE00\\uffff\\u0000.\"}");
	static const char expected[] = "\"\\/\b\f\n\r\t|A\xC3\xA9\xEA\x81\x81\xF0\x9F\x98\x80\xEF\xBF\xBF\0.";
	size_t length;
	const char *text = nt_json_get_string(nt_json_at(nt_json_root(document), 0), &length);
	assert_int_equal(length, sizeof expected - 1);
	assert_memory_equal(text, expected, sizeof expected);
	assert_memory_equal(nt_json_key(nt_json_root(document), 0, &length), "ke\0y", 5);
	assert_int_equal(length, 4);
	assert_null(nt_json_find(nt_json_root(document), "ke"));
	nt_json_free(document);
}

/* Each object after each other one: keys that are the same, fewer, more, in another order, longer, shorter, or spelled
 * otherwise, where an escape and a key that says the same without one are to be told apart. */
TEST(objects_after_others_have_their_own_keys)
{
	enum { MOST = 4 };
	static const struct {
		const char *text;
		const char *keys[MOST]; /* NULL: no more */
	} objects[] = {
		{"{\"bufferView\":0,\"count\":1,\"type\":2}", {"bufferView", "count", "type"}},
		{"{\"bufferView\":0,\"count\":1,\"type\":2,\"min\":3}", {"bufferView", "count", "type", "min"}},
		{"{ \"bufferView\" : 0 , \"count\" : { } }", {"bufferView", "count"}},
		{"{\"count\":0,\"bufferView\":1,\"type\":2}", {"count", "bufferView", "type"}},
		{"{\"bufferViews\":0,\"coun\":1,\"type\":2}", {"bufferViews", "coun", "type"}},
		{"{\"bufferView\":0,\"c\\u006Funt\":1,\"type\":2}", {"bufferView", "count", "type"}},
		{"{\"a\\bc\":0,\"d\":1}", {"a\bc", "d"}},
		{"{\"a\\\\bc\":0,\"d\":1}", {"a\\bc", "d"}},
		{"{\"a\\\"\":0,\"\":1}", {"a\"", ""}},
		{"{\"a\":0,\"\":1}", {"a", ""}},
		{"{}", {NULL}},
	};
	enum { COUNT = sizeof objects / sizeof *objects };
	for (size_t i = 0; i < COUNT * COUNT * COUNT; i++) {
		const size_t order[] = {i % COUNT, i / COUNT % COUNT, i / COUNT / COUNT};
		char text[300];
		snprintf(text, sizeof text, "[%s,%s,%s]", objects[order[0]].text, objects[order[1]].text,
			objects[order[2]].text);
		nt_json *document = parse(text);
		check_dump(document, text);
		for (size_t k = 0; k < 3; k++) {
			nt_json_value *object = nt_json_at(nt_json_root(document), k);
			const size_t count = nt_json_count(object);
			nt_json_put(document, object, "new");
			assert_string_equal(nt_json_key(object, count, NULL), "new");
			for (size_t m = 0; m < MOST && (m < count || objects[order[k]].keys[m]); m++) {
				const char *wanted = objects[order[k]].keys[m], *key = nt_json_key(object, m, NULL);
				assert_non_null(wanted);
				assert_string_equal(key, wanted);
				uint64_t number;
				const bool is_number = nt_json_get_uint64(nt_json_find(object, wanted), &number);
				assert_true(is_number ? number == m
					: nt_json_type_of(nt_json_find(object, wanted)) == NT_JSON_OBJECT);
			}
		}
		nt_json_free(document);
	}
	/* a text that ends in a key that was expected, or has something else there, and keys that occur twice */
	static const char alike[] = "[{\"count\":1,\"type\":2},{\"count\":1,\"type\":2}]";
	for (size_t size = 0; size + 1 < sizeof alike; size++)
		check_refused(alike, size, size);
	check_refused("[{\"a\":1,\"b\":2},{\"a\" 1}]", 23, 20);
	check_refused("[{\"a\":1,\"b\":2},{\"a\":1,b\":2}]", 28, 22);
	check_refused("[{\"a\":1},{\"a\":1,\"a\":2}]", 23, 19);
	check_refused("[{\"a\":1,\"b\":2},{\"a\":1,\"a\":2}]", 29, 25);
	nt_json_free(parse("[{\"extras\":{\"a\":1,\"a\":2}},{\"extras\":{\"a\":1,\"a\":2}}]"));
}

TEST(equality_looks_at_values_and_order)
{
	nt_json *document = parse("[{\"a\":1,\"b\":2},{\"a\":1.0,\"b\":2},{\"b\":2,\"a\":1},{\"a\":1}]");
	const nt_json_value *root = nt_json_root(document);
	assert_true(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 1)));
	assert_false(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 2)));
	assert_false(nt_json_equal(nt_json_at(root, 0), nt_json_at(root, 3)));
	assert_false(nt_json_equal(nt_json_at(root, 0), NULL));
	nt_json_free(document);
}

static nt_status edit_all(nt_buffer *out, nt_error *error)
{
	static const char text[] =
		"{\"a\":[1,2,{\"\\u0061\":\"\\n\"}],\"k0\":0,\"k1\":0,\"k2\":0,\"k3\":0,\"k4\":0,\"k5\":0,"
		"\"k6\":0,\"k7\":0,\"k8\":0,\"k9\":0,\"l0\":0,\"l1\":0,\"l2\":0,\"l3\":0,\"l4\":0,\"l5\":0,\"l6\":0}";
	nt_json *document;
	nt_status status = nt_json_parse(&document, text, sizeof text - 1, NULL, error);
	if (status) {
		assert_null(document);
		return status;
	}
	nt_json_value *root = nt_json_root(document);
	nt_json_set_copy(document, nt_json_put(document, root, "copy"), nt_json_find(root, "a"));
	nt_json_set_double(document, nt_json_append(document, nt_json_put(document, root, "new")), 0.5);
	nt_json_set_string(document, nt_json_put(document, root, "text"), "t", 1);
	nt_json_set_uint64(document, nt_json_find(root, "k0"), 7);
	nt_json_remove(document, root, "k1");
	status = dump(document, out, error);
	assert_true(status == NT_OK || status == NT_ERROR_MEMORY);
	nt_json_free(document);
	return status;
}

TEST(every_allocation_may_fail)
{
	size_t count = 0;
	for (nt_status status = NT_ERROR_MEMORY; status; count++) {
		nt_buffer out = {0};
		nt_error error;
		nt_error_clear(&error);
		fail_allocations_from(count);
		status = edit_all(&out, &error);
		stop_failing_allocations();
		if (status)
			assert_int_equal(error.status, NT_ERROR_MEMORY);
		else
			assert_non_null(strstr(out.data,
				",\"copy\":[1,2,{\"a\":\"\\n\"}],\"new\":[0.5],\"text\":\"t\"}"));
		nt_buffer_free(&out);
	}
	assert_true(count > 6);
}

TEST(what_is_no_number_becomes_null_and_is_copied)
{
	nt_json *document = parse("[1,2]");
	nt_json_value *root = nt_json_root(document);
	nt_json_set_double(document, nt_json_at(root, 0), (double)NAN);
	nt_json_set_copy(document, nt_json_at(root, 1), nt_json_at(root, 0));
	nt_json_set_copy(document, nt_json_append(document, root), nt_json_at(root, 0));
	check_dump(document, "[null,null,null]");
	nt_json_free(document);
}

static nt_status take_open(void *user, const char *text, size_t size)
{
	nt_buffer *to = user;
	nt_buffer_append(to, size ? text : "REST", size ? size : 4);
	return NT_OK;
}

/* The taker writes the end of an open string; set again it is a string like others. */
TEST(strings_may_be_left_open)
{
	nt_json *json;
	nt_buffer text = {0};
	uint64_t size;
	assert_int_equal(nt_json_parse(&json, "{\"a\":\"x\",\"b\":\"y\"}", 17, NULL, NULL), NT_OK);
	for (int open = 1; open >= 0; open--) {
		nt_json_value *b = nt_json_find(nt_json_root(json), "b");
		if (open)
			nt_json_set_open(json, b, "data:,", 6);
		else
			nt_json_set_string(json, b, "z", 1);
		text.size = 0;
		assert_int_equal(nt_json_write(json, take_open, &text, NULL), NT_OK);
		nt_buffer_append(&text, "", 1);
		assert_string_equal(text.data,
			open ? "{\"a\":\"x\",\"b\":\"data:,REST\"}" : "{\"a\":\"x\",\"b\":\"z\"}");
		assert_int_equal(nt_json_measure(json, &size, NULL), NT_OK);
		assert_int_equal(size, open ? 22 : 17);
	}
	nt_buffer_free(&text);
	nt_json_free(json);
}

TEST(arrays_may_be_left_open)
{
	nt_json *json;
	nt_buffer text = {0};
	uint64_t size;
	assert_int_equal(nt_json_parse(&json, "{}", 2, NULL, NULL), NT_OK);
	nt_json_set_open_array(json, nt_json_put(json, nt_json_root(json), "a"));
	nt_json_put_uint64(json, nt_json_root(json), "b", 1);
	assert_int_equal(nt_json_write(json, take_open, &text, NULL), NT_OK);
	nt_buffer_append(&text, "", 1);
	assert_string_equal(text.data, "{\"a\":[REST],\"b\":1}");
	assert_int_equal(nt_json_measure(json, &size, NULL), NT_OK);
	assert_int_equal(size, strlen("{\"a\":[],\"b\":1}"));
	nt_buffer_free(&text);
	nt_json_free(json);
}
