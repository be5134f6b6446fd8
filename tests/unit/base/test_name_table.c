/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "base/name_table.h"

TEST(equal_names_have_one_number)
{
	nt_name_table table = {0};
	char texts[1000][8];
	assert_int_equal(nt_name_find(&table, "a", 1), UINT32_MAX);
	for (uint32_t i = 0; i < 1000; i++) {
		snprintf(texts[i], sizeof texts[i], "%u", i);
		assert_int_equal(nt_name_add(&table, texts[i], strlen(texts[i])), i);
	}
	for (uint32_t i = 0; i < 1000; i++) {
		assert_int_equal(nt_name_add(&table, texts[i], strlen(texts[i])), i);
		assert_int_equal(nt_name_find(&table, texts[i], strlen(texts[i])), i);
	}
	assert_int_equal(table.count, 1000);
	assert_int_equal(nt_name_find(&table, "1000", 4), UINT32_MAX);
	assert_int_equal(nt_name_find(&table, "12", 1), 1);
	assert_int_equal(nt_name_add(&table, "", 0), 1000);
	nt_name_table_free(&table);
}

TEST(text_becomes_utf8)
{
	static const struct {
		const char *from, *to;
	} cases[] = {
		{"plain", "plain"},
		{"", ""},
		{"\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80", "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80"},
		{"\xE9t\xE9", "\xC3\xA9t\xC3\xA9"},          /* Latin-1 */
		{"\xC3", "\xC3\x83"},                        /* cut */
		{"\xC0\x80", "\xC3\x80\xC2\x80"},            /* overlong */
		{"\xE0\x80\x80", "\xC3\xA0\xC2\x80\xC2\x80"},
		{"\xED\xA0\x80", "\xC3\xAD\xC2\xA0\xC2\x80"}, /* a surrogate */
		{"\xF4\x90\x80\x80", "\xC3\xB4\xC2\x90\xC2\x80\xC2\x80"}, /* beyond U+10FFFF */
	};
	nt_arena arena = {0};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
		assert_string_equal(nt_utf8_text(&arena, cases[i].from, strlen(cases[i].from)), cases[i].to);
	nt_arena_free(&arena);
}
