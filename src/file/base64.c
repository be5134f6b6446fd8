/* SPDX-License-Identifier: MIT */
/*
 * Base64. Groups of three bytes become four characters, on their way to a sink in a buffer on the
 * stack.
 */
#include "file/output.h"

#include <string.h>

enum { BUFFER_GROUPS = 4096 };

static void encode_group(const unsigned char *in, char *out)
{
	static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	const unsigned bits = (unsigned)in[0] << 16 | (unsigned)in[1] << 8 | in[2];
	for (int i = 0; i < 4; i++)
		out[i] = digits[bits >> (18 - 6 * i) & 63];
}

nt_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error)
{
	const unsigned char *in = bytes;
	char out[4 * BUFFER_GROUPS];
	size_t used = 0;
	while (base64->rest_count > 0 && base64->rest_count < 3 && size > 0) {
		base64->rest[base64->rest_count++] = *in++;
		size--;
	}
	if (base64->rest_count == 3) {
		encode_group(base64->rest, out);
		used = 4;
		base64->rest_count = 0;
	}
	for (; size >= 3; in += 3, size -= 3) {
		if (used == sizeof out) {
			const nt_status status = nt_sink_write(base64->sink, out, used, error);
			if (status != NT_OK)
				return status;
			used = 0;
		}
		encode_group(in, out + used);
		used += 4;
	}
	while (size-- > 0)
		base64->rest[base64->rest_count++] = *in++;
	return used ? nt_sink_write(base64->sink, out, used, error) : NT_OK;
}

/* Less than three bytes, with what stands for those that lack. */
static void encode_last(const unsigned char *in, size_t count, char out[4])
{
	unsigned char group[3] = {0};
	memcpy(group, in, count);
	encode_group(group, out);
	memset(out + count + 1, '=', 3 - count);
}

nt_status nt_base64_end(nt_base64 *base64, nt_error *error)
{
	if (base64->rest_count == 0)
		return NT_OK;
	char out[4];
	encode_last(base64->rest, base64->rest_count, out);
	base64->rest_count = 0;
	return nt_sink_write(base64->sink, out, sizeof out, error);
}

void nt_base64_append(nt_buffer *buffer, const void *bytes, size_t size)
{
	const unsigned char *in = bytes;
	char *out = nt_buffer_extend(buffer, (size / 3 + (size % 3 != 0)) * 4);
	if (!out)
		return;
	for (; size >= 3; in += 3, out += 4, size -= 3)
		encode_group(in, out);
	if (size)
		encode_last(in, size, out);
}
