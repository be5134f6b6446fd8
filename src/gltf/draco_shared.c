/* SPDX-License-Identifier: MIT */
/*
 * An accessor without a buffer view says of a compressed attribute how many elements it has, and of which type. Files
 * exist in which primitives with different blocks name the same accessor, since those words are the same. Written
 * plain, it could hold the elements of one of them only. So before anything is read, each further content (a block,
 * and an attribute in it or its indices) gets a copy of the accessor, which says the same.
 */

#include <stdlib.h>
#include "gltf/draco.h"
#include "gltf/vertex_pools.h"

#define INDICES UINT64_MAX /* in place of the id of an attribute */

typedef struct separating {
	nt_gltf *document;
	nt_json_value *accessors;
	size_t named_count;      /* accessors of the file */
	bool *given;             /* [named_count] has a content already */
	nt_key_table contents;   /* an accessor as the file names it, the view of the block, the id */
	uint32_t *accessor_of;   /* [capacity] by content: the accessor that a content has now */
	size_t capacity;
} separating;

/* The accessor for a content that is met for the first time. */
static uint32_t accessor_for(separating *s, uint64_t named)
{
	nt_json *json = s->document->json;
	if (!s->given[named]) {
		s->given[named] = true;
		return (uint32_t)named;
	}
	nt_gltf_find_dangling(s->document);
	nt_json_value *copy = nt_json_append(json, s->accessors);
	nt_json_set_copy(json, copy, nt_json_at(s->accessors, (size_t)named));
	return (uint32_t)nt_json_count(s->accessors) - 1;
}

/* Points object[key] to the accessor of its content. False: out of memory. */
static bool separate(separating *s, nt_json_value *object, const char *key, uint64_t view, uint64_t id)
{
	uint64_t named;
	if (!nt_json_find_uint64(object, key, &named) || named >= s->named_count ||
		nt_json_find(nt_json_at(s->accessors, (size_t)named), "bufferView"))
		return true;
	const size_t known = s->contents.names.count;
	nt_key_put(&s->contents, named);
	nt_key_put(&s->contents, view);
	nt_key_put(&s->contents, id);
	const uint32_t number = nt_key_number(&s->contents);
	if (number == NT_NONE ||
		!nt_grow((void **)&s->accessor_of, &s->capacity, (size_t)number + 1, sizeof *s->accessor_of))
		return false;
	if (number == known)
		s->accessor_of[number] = accessor_for(s, named);
	if (s->accessor_of[number] != named)
		nt_json_set_uint64(s->document->json, nt_json_find(object, key), s->accessor_of[number]);
	return !nt_json_failed(s->document->json);
}

static bool separate_primitive(separating *s, nt_json_value *primitive)
{
	const nt_json_value *extension = nt_gltf_draco_of(primitive);
	const nt_json_value *ids = nt_json_find(extension, "attributes");
	uint64_t view, id;
	if (!nt_json_find_uint64(extension, "bufferView", &view))
		return true;
	for (size_t i = 0; i < nt_json_count(ids); i++) {
		const char *name = nt_json_key(ids, i, NULL);
		if (name && nt_json_get_uint64(nt_json_at(ids, i), &id) &&
			!separate(s, nt_json_find(primitive, "attributes"), name, view, id))
			return false;
	}
	return separate(s, primitive, "indices", view, INDICES);
}

nt_status nt_gltf_separate_draco(nt_gltf *document, nt_error *error)
{
	separating s = {.document = document, .accessors = nt_gltf_root_member(document, "accessors")};
	s.named_count = nt_json_count(s.accessors);
	s.given = nt_calloc(s.named_count, sizeof *s.given);
	bool room = s.given != NULL;
	const nt_json_value *meshes = nt_gltf_root_member(document, "meshes");
	for (size_t i = 0; room && i < nt_json_count(meshes); i++) {
		const nt_json_value *primitives = nt_json_find(nt_json_at(meshes, i), "primitives");
		for (size_t k = 0; room && k < nt_json_count(primitives); k++)
			room = separate_primitive(&s, nt_json_at(primitives, k));
	}
	nt_key_table_free(&s.contents);
	free(s.accessor_of);
	free(s.given);
	return room ? nt_gltf_check_dangling(document, error) : nt_fail_memory(error);
}
