/* SPDX-License-Identifier: MIT */
/*
 * Every pair of first bytes and the borders of RFC 3629's table; mbrtoc32 of the C library, in a UTF-8 locale,
 * judges every sequence of up to three bytes.
 */
#include "base/text.h"
#include "test.h"

#include <locale.h>
#include <uchar.h>

TEST(every_sequence_of_three_bytes_is_judged_as_the_c_library_does)
{
	if (!setlocale(LC_CTYPE, "C.UTF-8"))
		skip();
	for (unsigned bits = 1; bits < 1u << 24; bits++) {
		const char text[4] = {(char)(bits & 0xff), (char)(bits >> 8 & 0xff), (char)(bits >> 16), 0};
		if (!text[0])
			continue;
		mbstate_t shift = {0};
		char32_t code;
		const size_t expected = mbrtoc32(&code, text, 3, &shift);
		const size_t found = nt_utf8_length(text, 3);
		/* (size_t)-1: none, -2: the beginning of one that is longer */
		assert_int_equal(found, expected > 3 ? 0 : expected);
	}
	setlocale(LC_CTYPE, "C");
}

TEST(four_bytes_end_at_10ffff)
{
	assert_int_equal(nt_utf8_length("\xf0\x90\x80\x80", SIZE_MAX), 4); /* U+10000 */
	assert_int_equal(nt_utf8_length("\xf0\x8f\xbf\xbf", SIZE_MAX), 0); /* overlong */
	assert_int_equal(nt_utf8_length("\xf4\x8f\xbf\xbf", SIZE_MAX), 4); /* U+10FFFF */
	assert_int_equal(nt_utf8_length("\xf4\x90\x80\x80", SIZE_MAX), 0);
	assert_int_equal(nt_utf8_length("\xf5\x80\x80\x80", SIZE_MAX), 0);
}

/* Unicode's categories Cc, Zl, Zp, the bidirectional controls but for the marks, and XML 1.0, production 2. */
TEST(unsafe_are_controls_turns_and_what_xml_excludes)
{
	static const struct { unsigned first, last; } unsafe[] = {{1, 0x1f}, {0x7f, 0x9f}, {0x2028, 0x202e},
		{0x2066, 0x2069}, {0xfffe, 0xffff}};
	for (unsigned code = 1; code < 0x110000; code++) {
		if (code >= 0xd800 && code < 0xe000)
			continue;
		char text[5];
		size_t length = 0;
		if (code < 0x80)
			text[length++] = (char)code;
		else {
			const unsigned more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
			text[length++] = (char)("\x00\xc0\xe0\xf0"[more] | code >> 6 * more);
			for (unsigned i = more; i-- > 0;)
				text[length++] = (char)(0x80 | (code >> 6 * i & 0x3f));
		}
		text[length] = 0;
		assert_int_equal(nt_utf8_length(text, SIZE_MAX), length);
		bool expected = false;
		for (size_t i = 0; i < sizeof unsafe / sizeof *unsafe; i++)
			expected |= code >= unsafe[i].first && code <= unsafe[i].last;
		assert_int_equal(nt_utf8_is_unsafe(text, length), expected);
	}
	char line[] = "a\x1b\xc2\x9b\xff" "b\xe2\x80\xae\xc3\xa4";
	nt_utf8_mask(line);
	assert_string_equal(line, "a????b???\xc3\xa4");
}

TEST(texts_are_cut_between_sequences)
{
	assert_int_equal(nt_utf8_cut("abc", 5), 3);
	assert_int_equal(nt_utf8_cut("abc", 3), 3);
	assert_int_equal(nt_utf8_cut("abc", 2), 2);
	for (size_t most = 1; most < 5; most++)
		assert_int_equal(nt_utf8_cut("a\xf0\x90\x80\x80" "b", most), 1);
	assert_int_equal(nt_utf8_cut("a\xf0\x90\x80\x80" "b", 5), 5);
	assert_int_equal(nt_utf8_cut("\xff\xff\xff", 2), 2); /* no UTF-8: anywhere */
}

static void formatted(size_t room, const char *text, const char *expected, ...)
{
	char to[16];
	va_list arguments;
	va_start(arguments, expected);
	nt_utf8_format(to, room, text, arguments);
	va_end(arguments);
	assert_string_equal(to, expected);
}

TEST(formatted_texts_without_room_end_with_a_sequence)
{
	formatted(16, "%s", "a\xc3\xa9", "a\xc3\xa9");
	formatted(4, "%s", "a\xc3\xa9", "a\xc3\xa9");
	formatted(3, "%s", "a", "a\xc3\xa9");
	for (size_t room = 2; room < 6; room++)
		formatted(room, "%s", "a", "a\xf0\x90\x80\x80" "b");
	formatted(6, "%s", "a\xf0\x90\x80\x80", "a\xf0\x90\x80\x80" "b");
	formatted(3, "%s", "\xff\xff", "\xff\xff\xff");
	formatted(3, "%s", "ab", "abc");
	formatted(1, "%s", "", "abc");
	formatted(16, "a%.*sb", "aab", NT_CUT(2, "a\xc3\xa9"));
}

TEST(a_cut_sequence_is_none)
{
	char *bytes = malloc(3); /* of its exact size, for the sanitizers */
	memcpy(bytes, "\xf0\x9f\x98", 3);
	assert_int_equal(nt_utf8_length(bytes, 3), 0);
	free(bytes);
	assert_int_equal(nt_utf8_length("\xc3", SIZE_MAX), 0);
	assert_int_equal(nt_utf8_length("\xe2\x82", SIZE_MAX), 0);
}

TEST(a_text_without_room_keeps_its_end)
{
	char room[8];
	nt_utf8_keep_end(room, sizeof room, "a/b.obj");
	assert_string_equal(room, "a/b.obj");
	nt_utf8_keep_end(room, sizeof room, "folder/b.ob");
	assert_string_equal(room, "...b.ob");
	nt_utf8_keep_end(room, sizeof room, "folder/\xc3\xa4.o"); /* the first byte of the character has no room */
	assert_string_equal(room, "...\xc3\xa4.o");
	nt_utf8_keep_end(room, sizeof room, "folder/\xc3\xa4.ob");
	assert_string_equal(room, "....ob");
}
