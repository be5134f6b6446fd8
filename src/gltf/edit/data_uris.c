/* SPDX-License-Identifier: MIT */
/*
 * Data URIs of an edited document, encoded while its text is written: the JSON has their heads alone. In the
 * JSON, as it was before, a buffer took its size four times over: its bytes, their base64, the string's
 * copy, and the text.
 *
 * To find the place of a buffer's data, the text is made twice, once with a character in its place: there the texts
 * differ. Without data URIs the text is never in memory as a whole.
 */
#include "gltf/edit/data_uris.h"

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

/* Sets the data of the buffer's uri, and its head, where it has none. */
static nt_status set_data(nt_gltf *document, uint32_t buffer, const char *data, nt_error *error)
{
	nt_json *json = document->json;
	nt_json_value *object = nt_json_at(nt_gltf_root_member(document, "buffers"), buffer);
	size_t length = 0;
	const char *uri = nt_json_get_string(nt_json_find(object, "uri"), &length);
	const size_t head = head_length(uri, length);
	nt_buffer text = {0};
	nt_buffer_append(&text, head ? uri : plain_head, head ? head : sizeof plain_head - 1);
	nt_buffer_text(&text, data);
	if (!text.failed)
		nt_json_set_string(json, nt_json_put(json, object, "uri"), text.data, text.size);
	const nt_status status = text.failed ? nt_fail_memory(error) : NT_OK;
	nt_buffer_free(&text);
	return status;
}

nt_status nt_data_uris_add(nt_data_uris *uris, uint32_t buffer, nt_error *error)
{
	if (!nt_grow((void **)&uris->buffers, &uris->capacity, uris->count + 1, sizeof *uris->buffers))
		return nt_fail_memory(error);
	uris->buffers[uris->count++] = (nt_data_uri){.buffer = buffer};
	return set_data(uris->relocated->document, buffer, "", error);
}

nt_status nt_data_uris_text(nt_data_uris *uris, nt_buffer *text, uint64_t *length, nt_error *error)
{
	nt_gltf *document = uris->relocated->document;
	nt_buffer marked = {0};
	if (!uris->count)
		return nt_json_measure(document->json, length, error);
	nt_status status = nt_json_dump(document->json, text, error);
	for (size_t i = 0; !status && i < uris->count; i++)
		status = set_data(document, uris->buffers[i].buffer, "A", error);
	if (!status)
		status = nt_json_dump(document->json, &marked, error);
	*length = text->size;
	/* buffers come in their order, wherever the array stands */
	for (size_t i = 0, at = 0; !status && i < uris->count; i++) {
		while (text->data[at] == marked.data[at + i])
			at++;
		uris->buffers[i].at = at;
		*length += nt_base64_length(uris->relocated->buffers[uris->buffers[i].buffer].length);
	}
	for (size_t i = 0; !status && i < uris->count; i++)
		status = set_data(document, uris->buffers[i].buffer, "", error);
	nt_buffer_free(&marked);
	return status;
}

typedef struct text_sink {
	nt_sink *sink;
	nt_error *error;
} text_sink;

static nt_status put_text(void *user, const char *text, size_t size)
{
	const text_sink *to = user;
	return nt_sink_write(to->sink, text, size, to->error);
}

nt_status nt_data_uris_write(const nt_data_uris *uris, const nt_buffer *text, nt_sink *sink, nt_error *error)
{
	size_t written = 0;
	nt_status status = NT_OK;
	if (!uris->count)
		return nt_json_write(uris->relocated->document->json, put_text, &(text_sink){sink, error}, error);
	for (size_t i = 0; !status && i < uris->count; i++) {
		const nt_data_uri *uri = &uris->buffers[i];
		nt_base64 base64 = {.sink = sink};
		status = nt_sink_write(sink, text->data + written, uri->at - written, error);
		if (!status)
			status = nt_relocated_encode(uris->relocated, uri->buffer, &base64, error);
		if (!status)
			status = nt_base64_end(&base64, error);
		written = uri->at;
	}
	return status ? status : nt_sink_write(sink, text->data + written, text->size - written, error);
}
