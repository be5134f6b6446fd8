/* SPDX-License-Identifier: MIT */
/*
 * URIs in glTF documents, and why some of them are not followed. A document comes from anywhere; a URI
 * in it must not make us read a file outside the document's folder, neither by its text ("..", an
 * absolute path, a drive letter, a scheme) nor through a symbolic link. The text is checked after percent
 * decoding and with both kinds of slash, the link by comparing real paths.
 */
#include "file/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "file/input.h"
#include "file/output.h"

enum { SHOWN = 200 }; /* characters of a URI that a message shows */

static bool is_letter(char c)
{
	return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

static int hex_digit(char c)
{
	if (is_digit(c))
		return c - '0';
	if (c >= 'a' && c <= 'f')
		return c - 'a' + 10;
	if (c >= 'A' && c <= 'F')
		return c - 'A' + 10;
	return -1;
}

/* Decodes %xx; a percent sign that begins no such group stands for itself, as in names that nobody
 * encoded. Returns the decoded length; out may be in. */
static size_t percent_decode(const char *in, size_t length, char *out)
{
	size_t count = 0;
	for (size_t i = 0; i < length; i++) {
		const int high = in[i] == '%' && i + 2 < length ? hex_digit(in[i + 1]) : -1;
		const int low = high >= 0 ? hex_digit(in[i + 2]) : -1;
		if (low >= 0) {
			out[count++] = (char)(high * 16 + low);
			i += 2;
		} else {
			out[count++] = in[i];
		}
	}
	return count;
}

/* ---- data URIs ---- */

bool nt_uri_is_data(const char *uri, size_t length)
{
	return length >= 5 && strncasecmp(uri, "data:", 5) == 0;
}

static int base64_digit(char c)
{
	if (c >= 'A' && c <= 'Z')
		return c - 'A';
	if (c >= 'a' && c <= 'z')
		return c - 'a' + 26;
	if (is_digit(c))
		return c - '0' + 52;
	if (c == '+' || c == '-')
		return 62;
	if (c == '/' || c == '_')
		return 63;
	return -1;
}

/* Decodes base64 at uri[begin, length). Padding may be left out. */
static nt_status base64_decode(const char *uri, size_t begin, size_t length, unsigned char *out,
	size_t *size, nt_error *error)
{
	size_t end = length;
	while (end > begin && length - end < 2 && uri[end - 1] == '=')
		end--;
	uint32_t group = 0;
	size_t count = 0, digits = 0;
	for (size_t i = begin; i < end; i++) {
		const int digit = base64_digit(uri[i]);
		if (digit < 0)
			return nt_fail(error, NT_ERROR_INPUT,
				"character %zu of the data URI is not base64", i + 1);
		group = group << 6 | (uint32_t)digit;
		if (++digits == 4) {
			out[count++] = (unsigned char)(group >> 16);
			out[count++] = (unsigned char)(group >> 8);
			out[count++] = (unsigned char)group;
			digits = 0;
			group = 0;
		}
	}
	if (digits == 1)
		return nt_fail(error, NT_ERROR_INPUT,
			"the base64 text of the data URI ends in the middle of a byte");
	if (digits >= 2)
		out[count++] = (unsigned char)(group >> (digits == 2 ? 4 : 10));
	if (digits == 3)
		out[count++] = (unsigned char)(group >> 2);
	*size = count;
	return NT_OK;
}

nt_status nt_uri_decode_data(const char *uri, size_t length, unsigned char **bytes, size_t *size,
	nt_error *error)
{
	*bytes = NULL;
	const char *comma = memchr(uri, ',', length);
	if (!comma)
		return nt_fail(error, NT_ERROR_INPUT, "the data URI has no comma before its data");
	const size_t head = (size_t)(comma - uri), begin = head + 1;
	const bool base64 = head >= 7 && strncasecmp(comma - 7, ";base64", 7) == 0;
	unsigned char *block = nt_alloc(length - begin + 1, 1);
	if (!block)
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	if (base64)
		status = base64_decode(uri, begin, length, block, size, error);
	else
		*size = percent_decode(uri + begin, length - begin, (char *)block);
	if (status)
		free(block);
	else
		*bytes = block;
	return status;
}

void nt_uri_append_data(nt_buffer *buffer, const char *media_type, const void *bytes, size_t size)
{
	nt_buffer_format(buffer, "data:%s;base64,", media_type);
	nt_base64_append(buffer, bytes, size);
}

/* ---- files ---- */

/* "http:", "file:", and with one letter a drive. */
static bool has_scheme(const char *name)
{
	size_t i = 0;
	if (!is_letter(name[0]))
		return false;
	while (is_letter(name[i]) || is_digit(name[i]) || name[i] == '+' || name[i] == '-' ||
		name[i] == '.')
		i++;
	return name[i] == ':';
}

bool nt_uri_has_parent_step(const char *name)
{
	for (const char *part = name; *part;) {
		const size_t length = strcspn(part, "/\\");
		if (length == 2 && part[0] == '.' && part[1] == '.')
			return true;
		part += length + (part[length] != '\0');
	}
	return false;
}

/* The fault in the text of a decoded name; NULL: nothing. */
static const char *check_text(const char *name, size_t length, bool allow_outside)
{
	if (length == 0)
		return "is empty";
	if (memchr(name, '\0', length))
		return "contains a NUL";
	if (allow_outside)
		return NULL;
	if (name[0] == '/' || name[0] == '\\')
		return "is an absolute path (refused without --outside=yes)";
	if (nt_uri_has_parent_step(name))
		return "leaves the folder of the file (refused without --outside=yes)";
	return NULL;
}

/* Refuses a name that leaves the folder by a link, and one that is not there. */
static nt_status check_links(
	const char *path, const char *document, const char *name, const char *uri, nt_error *error)
{
	char folder[PATH_MAX];
	nt_buffer real = {0};
	bool inside = true;
	struct stat info;
	nt_status status = nt_path_real(&real, nt_folder_of(document, folder), error);
	if (!status)
		status = nt_path_stays_inside(real.data, name, &inside, error);
	if (!inside && !status)
		status = nt_fail(error, NT_ERROR_INPUT,
			"the URI \"%.*s\" leaves the folder of the file through a "
			"symbolic link (refused without --outside=yes)",
			NT_CUT(SHOWN, uri));
	nt_buffer_free(&real);
	if (!status)
		status = nt_lookup(path, &info, error);
	if (status == NT_ERROR_IO || status == NT_ERROR_MISSING)
		return nt_fail(
			error, status, "cannot open \"%.*s\": %s", NT_CUT(SHOWN, uri), strerror(errno));
	return status;
}

nt_status nt_uri_resolve(nt_arena *arena, const char *document, const char *uri, size_t length,
	bool allow_outside, const char **path, nt_error *error)
{
	char *name = nt_arena_text(arena, uri, length);
	if (!name)
		return nt_fail_memory(error);
	const size_t name_length = percent_decode(uri, length, name);
	name[name_length] = '\0';
	const char *fault = check_text(name, name_length, allow_outside);
	if (fault)
		return nt_fail(error, NT_ERROR_INPUT, "the URI \"%.*s\" %s", NT_CUT_OF(SHOWN, length, uri), fault);
	if (has_scheme(name))
		return nt_fail(error, name[1] == ':' ? NT_ERROR_INPUT : NT_ERROR_UNSUPPORTED,
			name[1] == ':' ? "the URI \"%.*s\" names a drive" :
					 "the URI \"%.*s\" has a scheme; only data: and relative names are read",
			NT_CUT_OF(SHOWN, length, uri));

	if (nt_name_is_too_long(name))
		return nt_fail(error, NT_ERROR_MISSING, "the URI \"%.*s\" has %zu bytes, which no file's name has",
			NT_CUT_OF(SHOWN, length, uri), name_length);

	nt_buffer text = {0};
	nt_path_beside(&text, document, name);
	*path = text.failed ? NULL : nt_arena_text(arena, text.data, text.size);
	nt_buffer_free(&text);
	if (!*path)
		return nt_fail_memory(error);
	return allow_outside ? NT_OK : check_links(*path, document, name, uri, error);
}

void nt_uri_append_decoded(nt_buffer *text, const char *uri, size_t length)
{
	char *decoded = nt_buffer_extend(text, length);
	if (!decoded)
		return;
	text->size = text->size - length + percent_decode(uri, length, decoded);
	text->data[text->size] = '\0';
}

bool nt_uri_append_name(nt_buffer *name, const char *uri, size_t length)
{
	const size_t begin = name->size;
	nt_uri_append_decoded(name, uri, length);
	if (name->failed)
		return false;
	const char *decoded = name->data + begin;
	return name->size > 0 && strlen(decoded) == name->size && !strpbrk(decoded, "/\\") && !has_scheme(decoded) &&
	       strcmp(decoded, ".") != 0 && strcmp(decoded, "..") != 0;
}

void nt_uri_append_path(nt_buffer *buffer, const char *path)
{
	for (const char *c = path; *c; c++) {
		if (is_letter(*c) || is_digit(*c) || strchr("-._~/", *c))
			nt_buffer_append(buffer, c, 1);
		else
			nt_buffer_format(buffer, "%%%02X", (unsigned char)*c);
	}
}

void nt_link_uri(nt_buffer *text, const char *folder, const char *path)
{
	nt_buffer relative = {0};
	nt_path_relative(&relative, folder, path);
	nt_uri_append_path(text, relative.data ? relative.data : "");
	nt_buffer_free_into(&relative, text);
}
