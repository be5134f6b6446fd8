/* SPDX-License-Identifier: MIT */
/*
 * KHR_draco_mesh_compression: a primitive whose indices and some of whose attributes are one block. The
 * block is decoded when the primitive is loaded, or before that on several threads, and the accessors that it fills get
 * their elements from it: their own count gives way to what was decoded, as the extension says.
 */
#include "gltf/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/parallel.h"
#include "gltf/document.h"

nt_json_value *nt_gltf_draco_of(const nt_json_value *primitive)
{
	return nt_json_find(nt_json_find(primitive, "extensions"), "KHR_draco_mesh_compression");
}

int nt_gltf_draco_bits(const int *draco_bits, nt_draco_bits which)
{
	static const int defaults[NT_DRACO_BITS_COUNT] = {14, 12, 12, 12};
	return draco_bits[which] ? draco_bits[which] : defaults[which];
}

nt_draco_quantization nt_gltf_draco_grid(const nt_gltf *document, uint32_t accessor, int bits)
{
	return document->grids && document->grids[accessor].bits ? document->grids[accessor] :
		(nt_draco_quantization){.bits = bits};
}

const nt_draco_quantization *nt_gltf_draco_tangents_of(const nt_gltf *document, const nt_json_value *primitive)
{
	const nt_gltf_accessor *a = nt_gltf_named(document, nt_json_find(primitive, "attributes"), "TANGENT");
	return a && a->packed ? &a->packed->quantization : NULL;
}

nt_draco_kind nt_gltf_draco_kind(const char *name)
{
	return strcmp(name, "POSITION") == 0 ? NT_DRACO_POSITION :
	       strcmp(name, "NORMAL") == 0 ? NT_DRACO_NORMAL :
	       strncmp(name, "COLOR_", 6) == 0 ? NT_DRACO_COLOR :
	       strncmp(name, "TEXCOORD_", 9) == 0 ? NT_DRACO_TEXCOORD : NT_DRACO_GENERIC;
}

int nt_gltf_draco_bits_of(const int *draco_bits, const char *name)
{
	switch (nt_gltf_draco_kind(name)) {
	case NT_DRACO_POSITION:
		return nt_gltf_draco_bits(draco_bits, NT_DRACO_BITS_POSITION);
	case NT_DRACO_NORMAL:
		return nt_gltf_draco_bits(draco_bits, NT_DRACO_BITS_NORMAL);
	case NT_DRACO_TEXCOORD:
		return nt_gltf_draco_bits(draco_bits, NT_DRACO_BITS_TEXCOORD);
	default:
		return strcmp(name, "TANGENT") == 0 ? nt_gltf_draco_bits(draco_bits, NT_DRACO_BITS_TANGENT) : 0;
	}
}

/* A value as a decoder will have it, in Draco's arithmetic. */
static float decoded_value(const nt_draco_quantization *q, size_t component, float value)
{
	const float most = (float)((1u << q->bits) - 1), step = q->range / most;
	const float number = floorf((value - q->origin[component]) * (most / q->range) + 0.5f);
	return number < 0 || number > most ? NAN : number * step + q->origin[component];
}

nt_draco_quantization nt_gltf_draco_tangent_grid(const nt_draco_quantization *source, const int *draco_bits)
{
	enum { MOST = 23 }; /* the number of the last cell is rounded up from 24 bits on */
	nt_draco_quantization grid = {.bits = nt_gltf_draco_bits(draco_bits, NT_DRACO_BITS_TANGENT),
		.explicit_box = true, .origin = {-1, -1, -1, -1}, .range = 2};
	bool is_exact = source && source->bits > 0 && !source->octahedral;
	for (size_t k = 0; is_exact && k < 4; k++)
		is_exact = decoded_value(source, k, -1) == -1 && decoded_value(source, k, 1) == 1;
	if (is_exact) {
		grid = *source;
		grid.explicit_box = true;
	} else if (source && source->bits > grid.bits) {
		grid.bits = source->bits;
	}
	grid.bits = grid.bits > MOST && !is_exact ? MOST : grid.bits;
	return grid;
}

static void free_blocks(nt_gltf *document)
{
	for (size_t i = 0; i < document->view_count; i++)
		nt_draco_free(document->draco_blocks[i]);
	free(document->draco_blocks);
}

static nt_status make_room(nt_gltf *document, nt_error *error)
{
	if (document->draco_blocks)
		return NT_OK;
	document->draco_blocks = nt_calloc(document->view_count, sizeof *document->draco_blocks);
	if (!document->draco_blocks)
		return nt_fail_memory(error);
	document->free_blocks = free_blocks;
	return NT_OK;
}

const nt_draco_mesh *nt_gltf_draco_block(const nt_gltf *document, uint64_t view)
{
	const nt_draco *block = document->draco_blocks && view < document->view_count ?
		document->draco_blocks[view] : NULL;
	return block ? &block->mesh : NULL;
}

static nt_status find_bytes(nt_gltf *document, uint64_t index, const char *pointer, const unsigned char **bytes,
	size_t *size, nt_error *error)
{
	const nt_gltf_view *view;
	const nt_status status = nt_gltf_get_view(document, index, pointer, &view, error);
	if (status)
		return status;
	*size = (size_t)view->length;
	return nt_gltf_view_bytes(document, (uint32_t)index, 0, view->length, pointer, bytes, error);
}

static nt_status decode_block(nt_gltf *document, uint64_t index, const char *pointer, nt_error *error)
{
	const unsigned char *bytes = NULL;
	size_t size;
	nt_status status = find_bytes(document, index, pointer, &bytes, &size, error);
	if (!status)
		status = make_room(document, error);
	if (status)
		return status;
	status = nt_draco_decode(&document->draco_blocks[index], bytes, size, 0, error);
	if (status && error && status != NT_ERROR_MEMORY) {
		snprintf(error->place.pointer, sizeof error->place.pointer, "/bufferViews/%llu",
			(unsigned long long)index);
		error->place.offset = NT_NO_OFFSET;
	}
	return status;
}

/* ---- several at a time ---- */

typedef struct packed {
	const unsigned char *bytes; /* NULL: not wanted */
	size_t size;
} packed;

typedef struct decoding {
	nt_gltf *document;
	packed *blocks; /* [view_count] */
} decoding;

static void decode_wanted(void *context, size_t view, unsigned thread)
{
	const decoding *d = context;
	(void)thread;
	if (d->blocks[view].bytes)
		nt_draco_decode(&d->document->draco_blocks[view], d->blocks[view].bytes, d->blocks[view].size, 0,
			NULL);
}

/* How many blocks the meshes have that are not decoded. */
static size_t find_wanted(const decoding *d, const nt_scene *scene, const bool *needed)
{
	nt_gltf *document = d->document;
	size_t count = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		uint64_t view;
		if (!needed[i] || mesh->plan.same_as ||
			!nt_json_find_uint64(nt_gltf_draco_of(nt_gltf_primitive_of(document, mesh)), "bufferView",
				&view) ||
			view >= document->view_count || nt_gltf_draco_block(document, view) || d->blocks[view].bytes)
			continue;
		packed *block = &d->blocks[view];
		nt_error ignored;
		if (find_bytes(document, view, "", &block->bytes, &block->size, &ignored) != NT_OK)
			block->bytes = NULL;
		count += block->bytes != NULL;
	}
	return count;
}

nt_status nt_gltf_decode_ahead(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error)
{
	nt_gltf *document = scene->source;
	const unsigned threads = nt_thread_count(options->threads);
	if (threads == 1)
		return NT_OK;
	const decoding d = {document, nt_calloc(document->view_count, sizeof *d.blocks)};
	if (!d.blocks)
		return nt_fail_memory(error);
	const size_t count = find_wanted(&d, scene, needed);
	/* room for blocks says that there are some */
	const nt_status status = count > 1 ? make_room(document, error) : NT_OK;
	if (!status && count > 1)
		nt_parallel_items(count < threads ? (unsigned)count : threads, document->view_count, decode_wanted,
			(void *)&d);
	free(d.blocks);
	return status;
}

/* ---- a primitive's ---- */

/* The accessor of a compressed primitive is what the decoder gave, tightly packed. */
static void use_decoded(nt_gltf_accessor *accessor, const unsigned char *elements, size_t count,
	uint32_t component_type)
{
	accessor->decoded = elements;
	accessor->count = count;
	accessor->component_type = component_type;
	accessor->component_bytes = (uint8_t)nt_gltf_component_bytes(component_type);
	accessor->element_bytes = (uint8_t)(accessor->component_bytes * accessor->components);
	accessor->stride = accessor->element_bytes;
	accessor->view = NT_NONE;
	accessor->offset = 0;
	accessor->sparse = NULL;
}

/* An accessor gets elements, if its type is that of the decoded attribute. */
static nt_status give_attribute(nt_gltf *document, uint64_t index, const char *name,
	const nt_draco_mesh *mesh, const nt_draco_attribute *from, const char *pointer, nt_error *error)
{
	const nt_gltf_accessor *accessor;
	nt_status status = nt_gltf_get_accessor(document, index, pointer, &accessor, error);
	if (status)
		return status;
	if (accessor->component_type != (uint32_t)from->component_type ||
		accessor->components != (uint32_t)from->components)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%.*s: accessor %llu has %u components of type %u, the compressed attribute %d of "
			"type %d", NT_CUT(40, name), (unsigned long long)index, accessor->components,
			accessor->component_type, from->components, from->component_type);
	use_decoded(&document->accessors[index], from->data, mesh->point_count, (uint32_t)from->component_type);
	document->accessors[index].packed = from;
	return NT_OK;
}

static nt_status give_attributes(nt_gltf *document, const nt_json_value *primitive,
	const nt_json_value *extension, const nt_draco_mesh *mesh, const char *pointer, nt_error *error)
{
	const nt_json_value *ids = nt_json_find(extension, "attributes");
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(ids); i++) {
		const char *name = nt_json_key(ids, i, NULL);
		uint64_t id, index;
		if (!name || !nt_json_find(attributes, name))
			continue; /* compressed, but nobody uses it */
		status = nt_gltf_uint(ids, pointer, name, UINT32_MAX, NT_GLTF_REQUIRED, &id, error);
		if (!status)
			status = nt_gltf_uint(attributes, pointer, name, document->accessor_count - 1,
				NT_GLTF_REQUIRED, &index, error);
		if (status)
			return status;
		const nt_draco_attribute *found = nt_draco_find(mesh, (uint32_t)id);
		if (!found)
			return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
				"%.*s has the id %llu, which the compressed data does not", NT_CUT(40, name),
				(unsigned long long)id);
		status = give_attribute(document, index, name, mesh, found, pointer, error);
	}
	return status;
}

nt_status nt_gltf_decode_draco(nt_gltf *document, const nt_json_value *primitive,
	const char *primitive_pointer, nt_error *error)
{
	const nt_json_value *extension = nt_gltf_draco_of(primitive);
	if (!extension)
		return NT_OK;
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "%.*s/extensions/KHR_draco_mesh_compression",
		NT_CUT(80, primitive_pointer));
	uint64_t view, index;
	const uint64_t mode = nt_gltf_mode(primitive);
	nt_status status = nt_gltf_uint(extension, pointer, "bufferView", UINT32_MAX - 1,
		NT_GLTF_REQUIRED, &view, error);
	if (!status && mode != NT_GLTF_TRIANGLES)
		status = nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, pointer,
			"compressed primitive of mode %llu, expected 4", (unsigned long long)mode);
	if (!status && !nt_gltf_draco_block(document, view))
		status = decode_block(document, view, pointer, error);
	if (status)
		return status;
	const nt_draco_mesh *mesh = nt_gltf_draco_block(document, view);
	status = give_attributes(document, primitive, extension, mesh, pointer, error);
	if (status)
		return status;
	status = nt_gltf_uint(primitive, primitive_pointer, "indices", document->accessor_count,
		NT_NONE, &index, error);
	/* a faulty one is told by the load */
	if (!status && nt_gltf_sound_accessor(document, index))
		use_decoded(&document->accessors[index], (const unsigned char *)mesh->indices, mesh->face_count * 3,
			NT_GLTF_UINT);
	return status;
}

/* ---- accessors of several blocks ---- */

/*
 * An accessor without a buffer view says of a compressed attribute how many elements it has, and of which type. Files
 * exist in which primitives with different blocks name the same accessor, since those words are the same. Written
 * plain, it could hold the elements of one of them only. So before anything is read, each further content (a block,
 * and an attribute in it or its indices) gets a copy of the accessor, which says the same.
 */

#define INDICES UINT64_MAX /* in place of the id of an attribute */

typedef struct separating {
	nt_gltf *document;
	nt_json_value *accessors;
	size_t named_count;      /* accessors of the file */
	bool *given;             /* [named_count] has a content already */
	nt_key_set contents;     /* an accessor as the file names it, the view of the block, the id */
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
	const size_t known = s->contents.count;
	const uint64_t content[] = {named, view, id};
	const uint32_t number = nt_key_add(&s->contents, content, sizeof content);
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
	document->accessor_count = nt_json_count(s.accessors);
	nt_key_set_free(&s.contents);
	free(s.accessor_of);
	free(s.given);
	return room ? nt_gltf_check_dangling(document, error) : nt_fail_memory(error);
}
