/* SPDX-License-Identifier: MIT */
/*
 * Data URIs of a patched document, encoded while its text is written: in the text a mark stands where the data of
 * a buffer belongs. In the JSON, as it was before, a buffer took its size four times over: its bytes, their base64,
 * the string's copy, and the text.
 *
 * A string of the input may look like a mark. So the marks are counted in the text, and made anew with another
 * number where there are more of them than buffers. That number is a hash of the text: nobody can write a text with
 * many of those to come.
 */
#include "gltf/edit/data_uris.h"

#include <stdio.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/edit/relocate.h"
#include "file/uri.h"

enum { MARK_BYTES = 32 };
static const char plain_head[] = "data:application/octet-stream;base64,";

static size_t make_mark(char mark[MARK_BYTES], uint64_t number, uint32_t buffer)
{
	return (size_t)snprintf(mark, MARK_BYTES, "<%016llx %u>", (unsigned long long)number, buffer);
}

/* The length of a data URI before its data; 0: it has none that could stay. */
static size_t head_length(const char *uri, size_t length)
{
	static const char ending[] = ";base64,";
	const char *comma = uri && nt_uri_is_data(uri, length) ? memchr(uri, ',', length) : NULL;
	const size_t head = comma ? (size_t)(comma - uri) + 1 : 0;
	return head >= strlen(ending) && memcmp(uri + head - strlen(ending), ending, strlen(ending)) == 0 ? head : 0;
}

/* Puts the mark behind the head of the buffer's uri, in place of what is there. */
static nt_status set_mark(nt_gltf_container *c, uint32_t buffer)
{
	nt_json_value *json = nt_json_at(nt_gltf_root_member(c->document, "buffers"), buffer);
	char mark[MARK_BYTES];
	const size_t mark_length = make_mark(mark, c->mark_number, buffer);
	size_t length = 0;
	const char *uri = nt_json_get_string(nt_json_find(json, "uri"), &length);
	const size_t head = head_length(uri, length);
	nt_buffer text = {0};
	nt_buffer_append(&text, head ? uri : plain_head, head ? head : sizeof plain_head - 1);
	nt_buffer_append(&text, mark, mark_length);
	if (!text.failed)
		nt_json_set_string(c->json, nt_json_put(c->json, json, "uri"), text.data, text.size);
	const nt_status status = text.failed ? nt_fail_memory(c->error) : NT_OK;
	nt_buffer_free(&text);
	return status;
}

nt_status nt_gltf_embed(nt_gltf_container *c, uint32_t buffer)
{
	if (!c->embedded)
		c->embedded = nt_arena_alloc(&c->arena, c->patcher->layout.buffer_count, sizeof *c->embedded);
	if (!c->embedded)
		return nt_fail_memory(c->error);
	c->embedded[c->embedded_count++] = buffer;
	return set_mark(c, buffer);
}

/* Whether each mark stands in the text once. */
static bool marks_are_clear(const nt_gltf_container *c, const nt_buffer *text)
{
	for (size_t i = 0; i < c->embedded_count; i++) {
		char mark[MARK_BYTES];
		const size_t length = make_mark(mark, c->mark_number, c->embedded[i]);
		const char *end = text->data + text->size, *first = memmem(text->data, text->size, mark, length);
		const char *behind = first ? first + length : end;
		if (!first || memmem(behind, (size_t)(end - behind), mark, length))
			return false;
	}
	return true;
}

nt_status nt_gltf_embedding_text(nt_gltf_container *c, nt_buffer *text, uint64_t *length)
{
	nt_status status = nt_json_dump(c->json, text, c->error);
	while (!status && !marks_are_clear(c, text)) {
		c->mark_number = nt_hash_bytes(c->mark_number + 1, text->data, text->size);
		for (size_t i = 0; !status && i < c->embedded_count; i++)
			status = set_mark(c, c->embedded[i]);
		text->size = 0;
		if (!status)
			status = nt_json_dump(c->json, text, c->error);
	}
	*length = text->size;
	for (size_t i = 0; i < c->embedded_count; i++) {
		char mark[MARK_BYTES];
		*length += nt_base64_length(c->patcher->layout.buffers[c->embedded[i]].new_length);
		*length -= make_mark(mark, c->mark_number, c->embedded[i]);
	}
	return status;
}

nt_status nt_gltf_write_text(nt_gltf_container *c, const nt_buffer *text, nt_sink *sink)
{
	const char *at = text->data, *const end = text->data + text->size;
	nt_status status = NT_OK;
	/* buffers come in their order, wherever the array stands */
	for (size_t i = 0; !status && i < c->embedded_count; i++) {
		char mark[MARK_BYTES];
		const size_t mark_length = make_mark(mark, c->mark_number, c->embedded[i]);
		const char *place = memmem(at, (size_t)(end - at), mark, mark_length);
		nt_base64 base64 = {.sink = sink};
		status = nt_sink_write(sink, at, (size_t)(place - at), c->error);
		if (!status)
			status = nt_layout_encode(&c->patcher->layout, c->embedded[i], &base64, c->error);
		if (!status)
			status = nt_base64_end(&base64, c->error);
		at = place + mark_length;
	}
	return status ? status : nt_sink_write(sink, at, (size_t)(end - at), c->error);
}
