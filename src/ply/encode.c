/* SPDX-License-Identifier: MIT */
/*
 * Values become bytes or text, and go to the sink: see encode.h.
 */
#include "ply/encode.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include "ext/number.h"

enum { DRAIN_BYTES = 64 * 1024 };

/* The low bytes of a number in the order of the encoding. */
static unsigned char *store_bits(const ply_output *out, uint64_t bits, size_t size, unsigned char *to)
{
	for (size_t i = 0; i < size; i++)
		to[out->encoding == PLY_BIG ? size - 1 - i : i] = (unsigned char)(bits >> 8 * i);
	return to + size;
}

void ply_put_floats(ply_output *out, const float *values, size_t count)
{
	unsigned char bytes[PLY_MOST_FLOATS * NT_FLOAT_TEXT], *end = bytes;
	assert(count <= PLY_MOST_FLOATS);
	for (size_t i = 0; i < count; i++) {
		uint32_t bits;
		memcpy(&bits, &values[i], sizeof bits);
		if (out->encoding != PLY_ASCII) {
			end = store_bits(out, bits, sizeof bits, end);
		} else {
			*end++ = ' ';
			end = (unsigned char *)nt_write_float((char *)end, values[i]);
		}
	}
	nt_buffer_append(&out->buffer, bytes, (size_t)(end - bytes));
}

void ply_put_doubles(ply_output *out, const double *values, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		unsigned char bytes[8];
		uint64_t bits;
		memcpy(&bits, &values[i], sizeof bits);
		store_bits(out, bits, sizeof bits, bytes);
		nt_buffer_append(&out->buffer, bytes, sizeof bytes);
	}
}

void ply_put_value(ply_output *out, float value, ply_type type)
{
	const bool ascii = out->encoding == PLY_ASCII;
	char text[NT_FLOAT_TEXT], *end = text;
	if (type < PLY_FLOAT32) {
		const double clamped = value < -1 ? -1 : value > 1 ? 1 : value;
		const int32_t number = (int32_t)rint(clamped * ply_one(type));
		end += ascii ? snprintf(text, sizeof text, "%d", (int)number) : 0;
		if (!ascii)
			end = (char *)store_bits(out, (uint32_t)number, ply_size(type), (unsigned char *)text);
	} else if (ascii) {
		end = nt_write_float(text, value);
	} else if (type == PLY_FLOAT32) {
		uint32_t bits;
		memcpy(&bits, &value, sizeof bits);
		end = (char *)store_bits(out, bits, sizeof bits, (unsigned char *)text);
	} else {
		const double number = value;
		uint64_t bits;
		memcpy(&bits, &number, sizeof bits);
		end = (char *)store_bits(out, bits, sizeof bits, (unsigned char *)text);
	}
	nt_buffer_append(&out->buffer, text, (size_t)(end - text));
}

void ply_put_integer(ply_output *out, uint32_t value, ply_type type)
{
	if (out->encoding != PLY_ASCII) {
		unsigned char bytes[4];
		store_bits(out, value, ply_size(type), bytes);
		nt_buffer_append(&out->buffer, bytes, ply_size(type));
		return;
	}
	char text[10];
	size_t begin = sizeof text;
	do
		text[--begin] = (char)('0' + value % 10);
	while (value /= 10);
	nt_buffer_append(&out->buffer, text + begin, sizeof text - begin);
}

nt_status ply_drain(ply_output *out, nt_error *error)
{
	if (out->buffer.failed)
		return nt_fail_memory(error);
	return out->buffer.size < DRAIN_BYTES ? NT_OK : ply_put_bytes(out, NULL, 0, error);
}

nt_status ply_put_bytes(ply_output *out, const void *bytes, size_t size, nt_error *error)
{
	if (out->buffer.failed)
		return nt_fail_memory(error);
	const nt_status status = nt_sink_write(out->sink, out->buffer.data, out->buffer.size, error);
	out->buffer.size = 0;
	return status || size == 0 ? status : nt_sink_write(out->sink, bytes, size, error);
}
