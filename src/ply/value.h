/* SPDX-License-Identifier: MIT */
/*
 * The types of a PLY file's values, and how one value is read where it lies: as text or as bytes of
 * either order. Text is read up to the end that is given; that enough bytes are there, the caller knows.
 */
#ifndef NT_PLY_VALUE_H
#define NT_PLY_VALUE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "ext/number.h"
#include "file/decimal.h"

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG } ply_encoding;

typedef enum ply_type {
	PLY_INT8,
	PLY_UINT8,
	PLY_INT16,
	PLY_UINT16,
	PLY_INT32,
	PLY_UINT32,
	PLY_FLOAT32,
	PLY_FLOAT64
} ply_type;

/* Bytes behind its begin that nt_read_decimal may touch: sign, 8 digits, point, 24 digits. */
enum { PLY_DECIMAL_MARGIN = 40 };

static inline bool ply_is_blank(unsigned char c)
{
	return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static inline bool ply_is_line_end(unsigned char c)
{
	return c == '\n' || c == '\r';
}

/* Any character that ends a value. */
static inline bool ply_is_space(unsigned char c)
{
	return c == ' ' || (unsigned char)(c - '\t') <= '\r' - '\t';
}

/* Within an ASCII row: to the next value; behind the value at `at`. */
static inline const unsigned char *ply_skip_blanks(const unsigned char *at, const unsigned char *end)
{
	while (at < end && ply_is_blank(*at))
		at++;
	return at;
}

static inline const unsigned char *ply_skip_value(const unsigned char *at, const unsigned char *end)
{
	while (at < end && !ply_is_space(*at))
		at++;
	return at;
}

/* Reads the ASCII number at `at`; NULL when there is none or something sticks to it. */
static inline const unsigned char *ply_read_float(const unsigned char *at, const unsigned char *end,
	float *value)
{
	const char *const p = (const char *)at;
	const unsigned char *after = (const unsigned char *)(end - at > PLY_DECIMAL_MARGIN
			? nt_read_decimal(p, (const char *)end, value)
			: nt_read_float(p, (const char *)end, value));
	return after && (after == end || ply_is_space(*after)) ? after : NULL;
}

/* The same for an integer; one that does not fit is cut to a number that is out of every range. */
static inline const unsigned char *ply_read_integer(const unsigned char *at, const unsigned char *end,
	int64_t *value)
{
	const bool negative = at < end && *at == '-';
	at += negative || (at < end && *at == '+');
	const unsigned char *const digits = at;
	int64_t sum = 0;
	for (; at < end && *at >= '0' && *at <= '9'; at++)
		sum = sum < INT64_MAX / 100 ? sum * 10 + (*at - '0') : sum;
	*value = negative ? -sum : sum;
	const bool ends = at == end || ply_is_space(*at);
	return at > digits && ends ? at : NULL;
}

static inline size_t ply_size(ply_type type)
{
	static const unsigned char sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
	return sizes[type];
}

static inline bool ply_is_signed(ply_type type)
{
	return type == PLY_INT8 || type == PLY_INT16 || type == PLY_INT32;
}

/* The number that stands for 1 in colours and normals: the largest number of an integer type. */
static inline double ply_one(ply_type type)
{
	static const double largest[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1};
	return largest[type];
}

static inline bool ply_swaps(ply_encoding encoding)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
	return encoding == PLY_LITTLE;
#else
	return encoding == PLY_BIG;
#endif
}

static inline uint16_t ply_load16(const unsigned char *at, bool swap)
{
	uint16_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap16(bits) : bits;
}

static inline uint32_t ply_load32(const unsigned char *at, bool swap)
{
	uint32_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap32(bits) : bits;
}

static inline uint64_t ply_load64(const unsigned char *at, bool swap)
{
	uint64_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap64(bits) : bits;
}

/* An integer of that type; float types give their value cut off, which nobody asks for. */
static inline int64_t ply_load_integer(const unsigned char *at, ply_type type, bool swap)
{
	switch (type) {
	case PLY_INT8:
		return (int8_t)*at;
	case PLY_UINT8:
		return *at;
	case PLY_INT16:
		return (int16_t)ply_load16(at, swap);
	case PLY_UINT16:
		return ply_load16(at, swap);
	case PLY_INT32:
		return (int32_t)ply_load32(at, swap);
	default:
		return ply_load32(at, swap);
	}
}

static inline double ply_load_double(const unsigned char *at, ply_type type, bool swap)
{
	if (type == PLY_FLOAT32) {
		const uint32_t bits = ply_load32(at, swap);
		float value;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	if (type == PLY_FLOAT64) {
		const uint64_t bits = ply_load64(at, swap);
		double value;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	return (double)ply_load_integer(at, type, swap);
}

static inline float ply_load_float(const unsigned char *at, ply_type type, bool swap)
{
	return (float)ply_load_double(at, type, swap);
}

#endif
