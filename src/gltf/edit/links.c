/* SPDX-License-Identifier: MIT */
/*
 * External files of a document, named from another folder.
 */
#include "gltf/edit/edit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "file/path.h"

const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length)
{
	const char *uri = nt_json_find_string(object, "uri", length);
	return uri && !nt_uri_is_data(uri, *length) ? uri : NULL;
}

nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error)
{
	nt_buffer from_folder = {0}, to_folder = {0}, way = {0};
	nt_error failure;
	nt_status status = nt_link_folder(&from_folder, from, &failure);
	if (!status)
		status = nt_link_folder(&to_folder, to, &failure);
	if (!status) {
		if (to_folder.size != 1) /* the root's path ends in a slash already */
			nt_buffer_text(&to_folder, "/");
		if (!to_folder.failed)
			nt_link_uri(&way, from_folder.data, to_folder.data);
	}
	*prefix = nt_arena_text(arena, way.data ? way.data : "", way.size);
	const bool failed = to_folder.failed || way.failed || !*prefix;
	nt_buffer_free(&from_folder);
	nt_buffer_free(&to_folder);
	nt_buffer_free(&way);
	if (failed)
		return nt_fail_memory(error);
	if (status == NT_OK || status == NT_ERROR_MISSING)
		return NT_OK;
	*error = failure;
	return status;
}

/* Whether a URI is taken from the document's folder: not "/x", nor anything with a colon in its first
 * segment, which is a scheme, a drive, or no URI at all (":"), and means the same from everywhere. */
static bool is_relative(const char *uri, size_t length)
{
	size_t first = 0;
	while (first < length && !strchr("/?#", uri[first]))
		first++;
	return length > 0 && uri[0] != '/' && !memchr(uri, ':', first);
}

/* Whether the steps of a path lead out of the folder where they begin. */
static bool leads_out(const char *path)
{
	size_t depth = 0;
	for (const char *step = path; *step;) {
		const size_t length = strcspn(step, "/\\");
		const bool up = length == 2 && memcmp(step, "..", 2) == 0;
		if (up && depth == 0)
			return true;
		if (up)
			depth--;
		else if (length > 1 || (length == 1 && *step != '.'))
			depth++;
		step += length + (step[length] != '\0');
	}
	return false;
}

bool nt_gltf_link_leaves(const nt_json_value *object, const char *prefix)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(object, &length);
	if (!uri || !*prefix || !is_relative(uri, length))
		return false;
	nt_buffer path = {0};
	nt_uri_append_decoded(&path, prefix, strlen(prefix));
	nt_uri_append_decoded(&path, uri, length);
	const bool leaves = path.failed || leads_out(path.data);
	nt_buffer_free(&path);
	return leaves;
}

void nt_gltf_tell_leaving(nt_scene *scene, const char *array, size_t index, const char *why)
{
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.pointer, sizeof place.pointer, "/%s/%zu", array, index);
	nt_finding_add(&scene->findings, NT_CODE_LINK_LEAVES, &place, 1, "%s", why);
}

nt_status nt_gltf_link(nt_json *json, nt_json_value *object, const char *prefix, nt_error *error)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(object, &length);
	if (!uri || !*prefix || !is_relative(uri, length))
		return NT_OK;
	nt_buffer text = {0};
	nt_buffer_text(&text, prefix);
	nt_buffer_append(&text, uri, length);
	if (!text.failed)
		nt_json_set_string(json, nt_json_put(json, object, "uri"), text.data, text.size);
	const bool failed = text.failed;
	nt_buffer_free(&text);
	return failed ? nt_fail_memory(error) : NT_OK;
}
