/* SPDX-License-Identifier: MIT */
/*
 * Records of sidecars: see document.h. A previous document is somebody's text: a record counts only for a
 * plain name in the document's folder, and output sets compare the digest with the file's bytes.
 */
#include "gltf/document.h"

#include <string.h>
#include "base/memory.h"
#include "file/path.h"

static const char key_digest[] = "nmtan:xxh128", key_before[] = "nmtan:replaces";

/* ---- reading ---- */

/* A recorded digest; NULL: none, or none that we write. */
static const char *digest_at(const nt_json_value *buffer, const char *key)
{
	size_t length;
	const char *text = nt_json_find_string(nt_json_find(buffer, "extras"), key, &length);
	return text && length == 32 && strspn(text, "0123456789abcdef") == 32 ? text : NULL;
}

static nt_status add_ownership_of(nt_output *output, const nt_json_value *buffer, nt_error *error)
{
	size_t length;
	const char *uri = nt_json_find_string(buffer, "uri", &length);
	const char *digest = digest_at(buffer, key_digest);
	if (!uri || !digest || nt_uri_is_data(uri, length))
		return NT_OK;
	nt_buffer name = {0};
	nt_status status = NT_OK;
	if (nt_uri_append_name(&name, uri, length))
		status = nt_output_add_ownership(output, name.data, digest, digest_at(buffer, key_before), error);
	else if (name.failed)
		status = nt_fail_memory(error);
	nt_buffer_free(&name);
	return status;
}

/* The document's text, whichever container it is in. */
static nt_status parse(const nt_file *file, nt_json **json, nt_error *error)
{
	if (!nt_glb_has_magic(file->data, file->size))
		return nt_json_parse(json, (const char *)file->data, file->size, "extras", error);
	nt_arena arena = {0};
	nt_glb glb;
	nt_status status = nt_glb_parse(&glb, &arena, file->data, file->size, error);
	if (!status)
		status = nt_json_parse(json, (const char *)file->data + glb.json.offset, glb.json.size,
			"extras", error);
	nt_arena_free(&arena);
	return status;
}

nt_status nt_gltf_find_ownership(nt_output *output, const char *path, nt_error *error)
{
	nt_file file;
	nt_json *json = NULL;
	nt_error ignored;
	nt_status status = nt_file_open(&file, path, NT_NAMED_BY_US, &ignored);
	if (!status) {
		status = parse(&file, &json, &ignored);
		nt_file_close(&file);
	}
	if (status)
		return status == NT_ERROR_MEMORY ? nt_fail_memory(error) : NT_OK;
	const nt_json_value *buffers = nt_json_find(nt_json_root(json), "buffers");
	for (size_t i = 0; !status && i < nt_json_count(buffers); i++)
		status = add_ownership_of(output, nt_json_at(buffers, i), error);
	nt_json_free(json);
	return status;
}

/* ---- writing ---- */

static void set_digest(nt_json *json, nt_json_value *extras, const char *key, const char *digest)
{
	if (digest)
		nt_json_set_string(json, nt_json_put(json, extras, key), digest, strlen(digest));
	else
		nt_json_remove(json, extras, key);
}

nt_status nt_gltf_record(nt_json *json, nt_json_value *buffer, const nt_sink *sidecar, bool staging,
	nt_error *error)
{
	nt_buffer uri = {0};
	nt_uri_append_path(&uri, nt_sink_name(sidecar, staging));
	if (!uri.failed)
		nt_json_set_string(json, nt_json_put(json, buffer, "uri"), uri.data, uri.size);
	const bool failed = uri.failed;
	nt_buffer_free(&uri);
	if (failed)
		return nt_fail_memory(error);
	const char *digest = nt_sink_digest(sidecar);
	if (!digest) {
		nt_gltf_forget_record(json, buffer);
		return NT_OK;
	}
	const nt_json_type type = nt_json_type_of(nt_json_find(buffer, "extras"));
	if (type != NT_JSON_NONE && type != NT_JSON_OBJECT)
		return NT_OK;
	nt_json_value *extras = nt_json_put(json, buffer, "extras");
	if (type == NT_JSON_NONE)
		nt_json_set_object(json, extras);
	set_digest(json, extras, key_digest, digest);
	set_digest(json, extras, key_before, staging ? nt_sink_digest_before(sidecar) : NULL);
	return NT_OK;
}

void nt_gltf_forget_record(nt_json *json, nt_json_value *buffer)
{
	nt_json_value *extras = nt_json_find(buffer, "extras");
	if (!nt_json_find(extras, key_digest) && !nt_json_find(extras, key_before))
		return;
	nt_json_remove(json, extras, key_digest);
	nt_json_remove(json, extras, key_before);
	if (nt_json_count(extras) == 0)
		nt_json_remove(json, buffer, "extras");
}
