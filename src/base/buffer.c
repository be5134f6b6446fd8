/* SPDX-License-Identifier: MIT */
/*
 * Growing bytes: see text.h.
 */
#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

void *nt_buffer_extend(nt_buffer *buffer, size_t size)
{
	size_t needed;
	if (buffer->failed || !nt_size_add(buffer->size, size, &needed) ||
		!nt_size_add(needed, 1, &needed) ||
		!nt_grow((void **)&buffer->data, &buffer->capacity, needed, 1)) {
		buffer->failed = true;
		return NULL;
	}
	char *begin = buffer->data + buffer->size;
	buffer->size += size;
	buffer->data[buffer->size] = '\0';
	return begin;
}

bool nt_buffer_reserve(nt_buffer *buffer, size_t size)
{
	const size_t before = buffer->size;
	const bool had_room = nt_buffer_extend(buffer, size) != NULL;
	buffer->size = before;
	if (buffer->data)
		buffer->data[before] = '\0';
	return had_room;
}

void nt_buffer_append(nt_buffer *buffer, const void *bytes, size_t size)
{
	/* JSON of a million primitives comes in pieces of a few bytes */
	if (size && size < buffer->capacity - buffer->size && !buffer->failed) {
		memcpy(buffer->data + buffer->size, bytes, size);
		buffer->size += size;
		buffer->data[buffer->size] = '\0';
		return;
	}
	void *begin = nt_buffer_extend(buffer, size);
	if (begin && size)
		memcpy(begin, bytes, size);
}

void nt_buffer_format(nt_buffer *buffer, const char *format, ...)
{
	va_list arguments, again;
	va_start(arguments, format);
	va_copy(again, arguments);
	const int length = vsnprintf(NULL, 0, format, arguments);
	va_end(arguments);
	char *begin = length < 0 ? NULL : nt_buffer_extend(buffer, (size_t)length);
	if (begin)
		vsnprintf(begin, (size_t)length + 1, format, again);
	va_end(again);
}

void nt_buffer_clean(nt_buffer *buffer, const char *text)
{
	for (size_t length; *text; text += length) {
		length = nt_utf8_length(text, SIZE_MAX);
		const bool unsafe = nt_utf8_is_unsafe(text, length);
		length = length ? length : 1;
		if (!unsafe)
			nt_buffer_append(buffer, text, length);
		for (size_t i = 0; i < length && unsafe; i++)
			nt_buffer_format(buffer, "\\x%02x", (unsigned char)text[i]);
	}
}

void nt_buffer_free_into(nt_buffer *buffer, nt_buffer *other)
{
	other->failed |= buffer->failed;
	nt_buffer_free(buffer);
}

void nt_buffer_free(nt_buffer *buffer)
{
	free(buffer->data);
	*buffer = (nt_buffer){0};
}
