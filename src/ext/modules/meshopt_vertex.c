/* SPDX-License-Identifier: MIT */
/*
 * Version 1 of meshoptimizer's vertex codec and the colour filter, decoded: what KHR_meshopt_compression has beyond
 * EXT_meshopt_compression, and meshoptimizer 0.18 does not know. After appendices A and B of the extension's text.
 *
 * A stream is a byte 0xA1, blocks, and a tail: padding, an element before the first, and the mode of each channel (4
 * bytes of an element). A block has the deltas of up to 256 elements, the first byte of all of them, then the second,
 * and so on; how each byte is packed is said by two bits before all of them. Nothing is read that is not there: a
 * stream has to end where its tail begins.
 */
#include "ext/modules/meshopt_vertex.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { GROUP = 16, BLOCK_BYTES = 8192, BLOCK_MOST = 256, MAX_STRIDE = 256, TAIL_LEAST = 24 };

/* The rest of the blocks. */
typedef struct cursor {
	const unsigned char *at, *end;
} cursor;

static const unsigned char *take(cursor *from, size_t size)
{
	const unsigned char *at = from->at;
	if ((size_t)(from->end - at) < size)
		return NULL;
	from->at += size;
	return at;
}

/* ---- bytes of a block ---- */

/* The deltas of 16 elements in so many bits each: 1, 2 or 4; the number of all ones stands for a byte behind them. The
 * first of 1 bit is the lowest of its byte, the first of others the highest. */
static inline bool read_bits(cursor *from, unsigned bits, unsigned char *deltas)
{
	const unsigned all = (1u << bits) - 1, per_byte = 8 / bits;
	const unsigned char *packed = take(from, GROUP / per_byte), *more = from->at;
	for (unsigned i = 0; packed && i < GROUP; i++) {
		const unsigned place = bits == 1 ? i % per_byte : per_byte - 1 - i % per_byte;
		const unsigned delta = packed[i / per_byte] >> place * bits & all;
		if (delta == all && more == from->end)
			return false;
		deltas[i] = delta == all ? *more++ : (unsigned char)delta;
	}
	from->at = more;
	return packed != NULL;
}

/* mode: 0 to 4, for 0, 1, 2, 4 and 8 bits. */
static bool read_group(cursor *from, unsigned mode, unsigned char *deltas)
{
	const unsigned char *packed;
	switch (mode) {
	case 0:
		memset(deltas, 0, GROUP);
		return true;
	case 1:
		return read_bits(from, 1, deltas);
	case 2:
		return read_bits(from, 2, deltas);
	case 3:
		return read_bits(from, 4, deltas);
	default:
		packed = take(from, GROUP);
		if (packed)
			memcpy(deltas, packed, GROUP);
		return packed != NULL;
	}
}

/* The deltas of one byte of all elements. control: 0 and 1: groups in 0 to 4 bits, or in 1 to 8; 2: all are zero; 3: as
 * they are. deltas: room for whole groups. */
static bool read_byte(cursor *from, unsigned control, size_t count, unsigned char *deltas)
{
	const size_t group_count = (count + GROUP - 1) / GROUP;
	if (control == 2) {
		memset(deltas, 0, count);
		return true;
	}
	const unsigned char *head = take(from, control == 3 ? count : (group_count + 3) / 4);
	if (control == 3 && head)
		memcpy(deltas, head, count);
	bool sound = head != NULL;
	for (size_t g = 0; sound && control < 2 && g < group_count; g++)
		sound = read_group(from, (head[g / 4] >> g % 4 * 2 & 3) + control, deltas + g * GROUP);
	return sound;
}

/* ---- channels ---- */

static uint32_t unfold(uint32_t delta)
{
	return delta >> 1 ^ (0 - (delta & 1));
}

/* Byte deltas. deltas: of the first byte; those of the others follow, BLOCK_MOST apart each. */
static void add_bytes(const unsigned char *deltas, size_t count, size_t stride, unsigned char *last,
	unsigned char *out)
{
	for (size_t k = 0; k < 4; k++) {
		unsigned value = last[k];
		for (size_t i = 0; i < count; i++) {
			value += unfold(deltas[k * BLOCK_MOST + i]);
			out[i * stride + k] = (unsigned char)value;
		}
		last[k] = (unsigned char)value;
	}
}

/* Deltas of two bytes. */
static void add_pairs(const unsigned char *deltas, size_t count, size_t stride, unsigned char *last,
	unsigned char *out)
{
	for (size_t k = 0; k < 4; k += 2) {
		uint32_t value = last[k] | (uint32_t)last[k + 1] << 8;
		for (size_t i = 0; i < count; i++) {
			const unsigned char *low = deltas + k * BLOCK_MOST + i;
			value += unfold(low[0] | (uint32_t)low[BLOCK_MOST] << 8);
			out[i * stride + k] = (unsigned char)value;
			out[i * stride + k + 1] = (unsigned char)(value >> 8);
		}
		last[k] = (unsigned char)value;
		last[k + 1] = (unsigned char)(value >> 8);
	}
}

/* Differences of four bytes by exclusive or, which the encoder turned to the left by some bits. */
static void turn_words(const unsigned char *deltas, size_t count, size_t stride, unsigned turn, unsigned char *last,
	unsigned char *out)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t delta = 0;
		for (size_t k = 0; k < 4; k++)
			delta |= (uint32_t)deltas[k * BLOCK_MOST + i] << 8 * k;
		delta = delta >> turn | delta << (32 - turn) % 32;
		for (size_t k = 0; k < 4; k++) {
			last[k] ^= (unsigned char)(delta >> 8 * k);
			out[i * stride + k] = last[k];
		}
	}
}

/* ---- the whole ---- */

static bool decode_block(cursor *from, size_t count, size_t stride, const unsigned char *modes, unsigned char *last,
	unsigned char *out)
{
	unsigned char deltas[4 * BLOCK_MOST];
	const unsigned char *controls = take(from, stride / 4);
	for (size_t c = 0; c < stride / 4; c++) {
		for (size_t k = 0; k < 4; k++)
			if (!controls || !read_byte(from, controls[c] >> 2 * k & 3, count, deltas + k * BLOCK_MOST))
				return false;
		if (modes[c] == 0)
			add_bytes(deltas, count, stride, last + 4 * c, out + 4 * c);
		else if (modes[c] == 1)
			add_pairs(deltas, count, stride, last + 4 * c, out + 4 * c);
		else
			turn_words(deltas, count, stride, modes[c] >> 4, last + 4 * c, out + 4 * c);
	}
	return true;
}

bool nt_meshopt_decode_vertex_1(unsigned char *bytes, size_t count, size_t stride, const unsigned char *packed,
	size_t size)
{
	const size_t tail = stride + stride / 4, padded = tail < TAIL_LEAST ? TAIL_LEAST : tail;
	const size_t room = BLOCK_BYTES / stride / GROUP * GROUP, most = room < BLOCK_MOST ? room : BLOCK_MOST;
	if (size < 1 + padded || packed[0] != NT_MESHOPT_VERTEX_1)
		return false;
	const unsigned char *modes = packed + size - stride / 4;
	unsigned char last[MAX_STRIDE];
	memcpy(last, packed + size - tail, stride);
	cursor from = {packed + 1, packed + size - padded};
	bool sound = true;
	for (size_t i = 0; sound && i < stride / 4; i++)
		sound = modes[i] <= 1 || (modes[i] & 15) == 2;
	for (size_t i = 0; sound && i < count; i += most)
		sound = decode_block(
			&from, count - i < most ? count - i : most, stride, modes, last, bytes + i * stride);
	return sound && from.at == from.end;
}

/* ---- colours ---- */

/* YCoCg and alpha of `bytes` bytes each, which are as many bits wide as the alpha's highest bit says. */
static void decode_color(unsigned char *element, size_t bytes)
{
	int32_t in[4];
	for (size_t k = 0; k < 4; k++) {
		const int32_t value = bytes == 1 ? element[k] : element[2 * k] | element[2 * k + 1] << 8;
		const int32_t sign = bytes == 1 ? 0x80 : 0x8000;
		in[k] = k == 1 || k == 2 ? (value ^ sign) - sign : value;
	}
	int32_t most = 1; /* of so many bits */
	while (most < in[3])
		most = 2 * most + 1;
	const int32_t alpha = in[3] & most >> 1;
	const int32_t out[4] = {
		in[0] + in[1] - in[2], in[0] + in[2], in[0] - in[1] - in[2], alpha << 1 | (alpha & 1)};
	const float scale = (bytes == 1 ? 255.0f : 65535.0f) / (float)most;
	for (size_t k = 0; k < 4; k++) {
		const long long value = llroundf(
			(float)out[k] * scale); /* of what is no colour it may have 34 bits */
		for (size_t i = 0; i < bytes; i++)
			element[bytes * k + i] = (unsigned char)(value >> 8 * i);
	}
}

void nt_meshopt_decode_colors(unsigned char *bytes, size_t count, size_t stride)
{
	for (size_t i = 0; i < count; i++)
		decode_color(bytes + i * stride, stride / 4);
}
