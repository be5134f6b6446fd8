/* SPDX-License-Identifier: MIT */
/*
 * The short way of reading numbers equals strtof (glibc's is correctly rounded, in the C locale that
 * tests run in) in every bit.
 */
#include "test.h"
#include "file/decimal.h"

static uint64_t seed = 1;

static uint32_t random_number(void)
{
	seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
	return (uint32_t)(seed >> 33);
}

static void assert_reads(const char *text)
{
	char padded[64] = {0};
	snprintf(padded, sizeof padded, "%s\n", text);
	char *end;
	const float expected = strtof(padded, &end);
	float value = -12345;
	assert_ptr_equal(nt_read_decimal(padded, padded + strlen(padded), &value), end);
	if (memcmp(&value, &expected, sizeof value) != 0)
		print_message("%s: %a, expected %a\n", text, (double)value, (double)expected);
	assert_memory_equal(&value, &expected, sizeof value);
}

TEST(numbers_of_every_shape)
{
	static const char *const texts[] = {"0", "-0", "0.0", "-0.0", "1", "-1", "+1", "1.", ".5", "-.5", "1e5",
		"1E-5", "1.5e+3", "12345678", "123456789", "1234567.12345678", "0.12345678",
		"0.123456789", "0.1234567890123456", "0.12345678901234567", "0.00000000000000000001",
		"9007199254740993", "0.9007199254740993", "16777217", "16777216.5", "3.4028235e38", "1e-45",
		"0.000000001", "99999999.99999999", "1234567.8901234567890123", "-2123.6666666666665",
		"18446744073709551616", "0.36287340521812439"};
	for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
		assert_reads(texts[i]);
}

TEST(what_is_no_number_is_refused)
{
	static const char *const texts[] = {"", "-", "+", ".", "-.", "x", "e5", "--1", "+-1", "/", ":"};
	for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
		char padded[32] = {0};
		float value;
		snprintf(padded, sizeof padded, "%s\n", texts[i]);
		assert_null(nt_read_decimal(padded, padded + strlen(padded), &value));
	}
}

TEST(random_decimals_of_all_lengths)
{
	for (int i = 0; i < 200000; i++) {
		char text[48], *p = text;
		const unsigned whole = random_number() % 9, fraction = random_number() % 18;
		if (random_number() % 2)
			*p++ = '-';
		for (unsigned k = 0; k < whole; k++)
			*p++ = (char)('0' + random_number() % 10);
		if (whole == 0)
			*p++ = '0';
		if (fraction)
			*p++ = '.';
		for (unsigned k = 0; k < fraction; k++)
			*p++ = (char)('0' + random_number() % 10);
		*p = '\0';
		assert_reads(text);
	}
}

/* Midpoints of two floats, and their neighbours in the last decimal: where rounding twice goes wrong.
 * 1 + (2k + 1) 2^-24 has 24 fraction digits, of which 15 are written: above, at or below it. */
TEST(numbers_beside_midpoints)
{
	for (int i = 0; i < 200000; i++) {
		const uint32_t k = random_number() & 0x7FFFFF;
		const double middle = 1 + (2.0 * k + 1) / 16777216;
		char text[48];
		const double scale = (double)(1u << random_number() % 20);
		snprintf(text, sizeof text, "%.*f", (int)(8 + random_number() % 9), middle * scale);
		assert_reads(text);
	}
}

TEST(floats_written_and_read_back)
{
	for (int i = 0; i < 200000; i++) {
		const uint32_t bits = (random_number() & 0x807FFFFF) | ((96 + random_number() % 56) << 23);
		float value, back;
		char text[80];
		memcpy(&value, &bits, sizeof value);
		snprintf(text, sizeof text, i % 2 ? "%.9g\n" : "%.10f\n", (double)value);
		assert_non_null(nt_read_decimal(text, text + strlen(text), &back));
		assert_true(back == strtof(text, NULL));
	}
}
