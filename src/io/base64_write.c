/* SPDX-License-Identifier: MIT */
/*
 * Base64 into a sink: see base64_write.h. Groups of three bytes become four characters in a buffer on the
 * stack.
 */
#include "io/base64_write.h"

enum { BUFFER_GROUPS = 4096 };

static void encode_group(const unsigned char *in, char *out)
{
	static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	const unsigned bits = (unsigned)in[0] << 16 | (unsigned)in[1] << 8 | in[2];
	for (int i = 0; i < 4; i++)
		out[i] = digits[bits >> (18 - 6 * i) & 63];
}

nmtan_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error)
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
			const nmtan_status status = nt_sink_write(base64->sink, out, used, error);
			if (status != NMTAN_OK)
				return status;
			used = 0;
		}
		encode_group(in, out + used);
		used += 4;
	}
	while (size-- > 0)
		base64->rest[base64->rest_count++] = *in++;
	return used ? nt_sink_write(base64->sink, out, used, error) : NMTAN_OK;
}

nmtan_status nt_base64_end(nt_base64 *base64, nt_error *error)
{
	if (base64->rest_count == 0)
		return NMTAN_OK;
	const unsigned count = base64->rest_count;
	for (unsigned i = count; i < 3; i++)
		base64->rest[i] = 0;
	char out[4];
	encode_group(base64->rest, out);
	for (unsigned i = count + 1; i < 4; i++)
		out[i] = '=';
	base64->rest_count = 0;
	return nt_sink_write(base64->sink, out, sizeof out, error);
}
