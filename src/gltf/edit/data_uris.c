/* SPDX-License-Identifier: MIT */
/*
 * The text of a document. Data URIs are encoded while it is written: the JSON has their heads alone, as strings that
 * are left open, and a new document has open arrays, whose elements are text already. In the JSON a buffer would take
 * its size four times over: its bytes, their base64, the string's copy, and the text.
 */
#include "gltf/edit/images.h"

#include <string.h>
#include "file/uri.h"

static const char plain_head[] = "data:application/octet-stream;base64,";

/* The length of a data URI before its data; 0: it has none that could stay. */
static size_t head_length(const char *uri, size_t length)
{
	static const char ending[] = ";base64,";
	const char *comma = uri && nt_uri_is_data(uri, length) ? memchr(uri, ',', length) : NULL;
	const size_t head = comma ? (size_t)(comma - uri) + 1 : 0;
	return head >= strlen(ending) && memcmp(uri + head - strlen(ending), ending, strlen(ending)) == 0 ? head : 0;
}

nt_status nt_data_uris_add(nt_data_uris *uris, uint32_t buffer, nt_error *error)
{
	nt_gltf *document = uris->edits->document;
	nt_json *json = document->json;
	nt_json_value *object = nt_json_at(nt_gltf_root_member(document, "buffers"), buffer);
	if (!nt_grow((void **)&uris->buffers, &uris->capacity, uris->count + 1, sizeof *uris->buffers))
		return nt_fail_memory(error);
	uris->buffers[uris->count++] = buffer;
	size_t length = 0;
	const char *uri = nt_json_find_string(object, "uri", &length);
	const size_t head = head_length(uri, length);
	nt_json_set_open(json, nt_json_put(json, object, "uri"), head ? uri : plain_head,
		head ? head : sizeof plain_head - 1);
	return NT_OK;
}

nt_status nt_data_uris_measure(const nt_data_uris *uris, uint64_t *length, nt_error *error)
{
	const nt_status status = nt_json_measure(uris->edits->document->json, length, error);
	for (size_t i = 0; !status && i < uris->edits->list_count; i++)
		*length += uris->edits->lists[i].size;
	for (size_t i = 0; !status && i < uris->count; i++)
		*length += nt_base64_length(uris->edits->buffers[uris->buffers[i]].length);
	return status;
}

typedef struct text_sink {
	const nt_data_uris *uris;
	nt_sink *sink;
	size_t next, list; /* buffers come in their order, wherever the array stands; lists before them */
	nt_error *error;
} text_sink;

static nt_status put_text(void *user, const char *text, size_t size)
{
	text_sink *to = user;
	nt_buffer_edits *edits = to->uris->edits;
	while (!size && to->list < edits->list_count) {
		const nt_buffer *list = &edits->lists[to->list++];
		text = list->data;
		size = list->size;
	}
	if (size)
		return nt_sink_write(to->sink, text, size, to->error);
	nt_base64 base64 = {.sink = to->sink};
	const nt_status status = nt_edits_encode(edits, to->uris->buffers[to->next++], &base64,
		to->error);
	return status ? status : nt_base64_end(&base64, to->error);
}

nt_status nt_data_uris_write(const nt_data_uris *uris, nt_sink *sink, nt_error *error)
{
	return nt_json_write(uris->edits->document->json, put_text, &(text_sink){uris, sink, 0, 0, error}, error);
}
