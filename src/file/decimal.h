/* SPDX-License-Identifier: MIT */
/*
 * The numbers that text formats are full of, "-0.2352573" and "81734": eight digits at a time where the
 * number is short, fast_float where it is not. The value is the same bit for bit.
 *
 * Eight digits as one word: D. Lemire's fast_float popularised the trick; the test for a digit is that
 * a byte b ^ '0' is at most 9, which b + 0x76 shows in its top bit.
 *
 * Why the short way is exact: w / 10^k with w <= 2^53 and k <= 22 is one division of two exact doubles,
 * so d is the double nearest to the number x (W. D. Clinger, "How to Read Floating Point Numbers
 * Accurately", 1990). Rounding d to float gives the float nearest to x unless d is the midpoint of two
 * floats, because rounding keeps order: x below a midpoint makes d at most the midpoint. Midpoints have
 * the low 29 bits 1 0...0 and go the long way. x is 0 or at least 10^-22, so no float is subnormal.
 *
 * Every function reads up to 8 bytes from where it stands: the caller sees to it that they are there.
 */
#ifndef NT_FILE_DECIMAL_H
#define NT_FILE_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "ext/linked.h"

/* Eight characters, the first in the low byte. */
static inline uint64_t nt_load8(const char *p)
{
	uint64_t word;
	memcpy(&word, p, 8);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
	word = __builtin_bswap64(word);
#endif
	return word;
}

/* How many of eight characters, given as word ^ "00000000", are digits before the first that is not. */
static inline unsigned nt_digit_count(uint64_t word)
{
	const uint64_t other = ((word + 0x7676767676767676u) | word) & 0x8080808080808080u;
	return other ? (unsigned)__builtin_ctzll(other) >> 3 : 8;
}

/* The value of eight digits, the first in the low byte: neighbours are joined to two digits in every
 * second byte, those to four, those to eight. */
static inline uint32_t nt_eight_digits(uint64_t word)
{
	word = (word * (10 * 256 + 1)) >> 8;
	word = ((word & 0x00FF00FF00FF00FFu) * (100 * 65536 + 1)) >> 16;
	return (uint32_t)(((word & 0x0000FFFF0000FFFFu) * (10000 * (UINT64_C(1) << 32) + 1)) >> 32);
}

/* The value of the first `count` of eight digits. */
static inline uint32_t nt_digits_value(uint64_t word, unsigned count)
{
	const unsigned half_shift = 4 * (8 - count); /* in two steps, as a shift by 64 is not defined */
	return nt_eight_digits(word << half_shift << half_shift); /* which brings leading zeros */
}

/* Digits at p, at most 8 of them are taken; the count is returned. */
static inline unsigned nt_read_digits(const char *p, uint32_t *value)
{
	const uint64_t word = nt_load8(p) ^ 0x3030303030303030u;
	const unsigned count = nt_digit_count(word);
	*value = nt_digits_value(word, count);
	return count;
}

/* The same for numbers of at most 7 digits, which is quicker: the value of the digits at p, whose count
 * is left in *count. The next character is a digit if there are more. */
static inline uint32_t nt_read_short_digits(const char *p, unsigned *count)
{
	const uint64_t word = nt_load8(p) ^ 0x3030303030303030u;
	const uint64_t other = ((word + 0x7676767676767676u) | word) & 0x8080808080808080u;
	const unsigned bit = (unsigned)__builtin_ctzll(other | UINT64_C(1) << 63); /* 8 * count + 7 */
	*count = bit >> 3;
	return nt_eight_digits(word << (63 - bit) << 8);
}

/* w / 10^fraction as a float; false: only fast_float knows. w is at most 2^53, fraction at most 16. */
static inline bool nt_decimal_value(uint64_t w, unsigned fraction, bool negative, float *value)
{
	static const double power[2][17] = {
		{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16},
		{-1e0, -1e1, -1e2, -1e3, -1e4, -1e5, -1e6, -1e7, -1e8, -1e9, -1e10, -1e11, -1e12, -1e13, -1e14,
			-1e15, -1e16},
	};
	const double number = (double)(int64_t)w / power[negative][fraction];
	uint64_t bits;
	memcpy(&bits, &number, sizeof bits);
	*value = (float)number;
	return (bits & 0x1FFFFFFF) != 0x10000000;
}

static const uint32_t nt_integer_power[9] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000,
	100000000};

/* Reads what most numbers are: a sign or none, at most 7 digits, and a point with at most 7 digits behind
 * it or none. NULL: it is something else, or no number at all. The caller has to see that a blank or a
 * line end follows, not a digit or an exponent. */
static inline const char *nt_read_plain_decimal(const char *p, float *value)
{
	const bool negative = *p == '-';
	p += negative;
	uint32_t whole = (unsigned char)*p - (uint32_t)'0', part = 0;
	unsigned digits = 1, fraction = 0;
	if (whole > 9 || p[1] != '.') {
		whole = nt_read_short_digits(p, &digits);
		if (digits == 0)
			return NULL;
	}
	p += digits;
	if (*p == '.') {
		part = nt_read_short_digits(++p, &fraction);
		p += fraction;
	}
	const uint64_t w = (uint64_t)whole * nt_integer_power[fraction] + part;
	return nt_decimal_value(w, fraction, negative, value) ? p : NULL;
}

/* Reads a float at p as nt_read_float does, to which the long way leads; end bounds only that. */
static inline const char *nt_read_decimal(const char *p, const char *end, float *value)
{
	const char *const begin = p;
	const bool negative = *p == '-';
	p += negative;
	uint32_t digits;
	const unsigned whole = nt_read_digits(p, &digits);
	uint64_t w = digits;
	unsigned fraction = 0;
	p += whole;
	if (*p == '.') {
		fraction = nt_read_digits(++p, &digits);
		w = w * nt_integer_power[fraction] + digits;
		p += fraction;
		if (fraction == 8) {
			const unsigned more = nt_read_digits(p, &digits);
			w = w * nt_integer_power[more] + digits;
			p += more;
			fraction += more;
		}
	}
	/* w cannot have overflowed where there were at most 18 digits. */
	const unsigned count = whole + fraction;
	const bool plain = count > 0 && count <= 18 && whole < 8 && fraction < 16 && (*p | 0x20) != 'e' &&
		w <= UINT64_C(1) << 53;
	return plain && nt_decimal_value(w, fraction, negative, value) ? p :
		nt_read_float(begin, end, value);
}

#endif
