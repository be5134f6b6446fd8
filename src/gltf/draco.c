/* SPDX-License-Identifier: MIT */
/*
 * KHR_draco_mesh_compression: a primitive whose indices and some of whose attributes are one block. The
 * block is decoded when the primitive is loaded, and the accessors that it fills get their elements from
 * it: their own count gives way to what was decoded, as the extension says.
 */
#include "gltf/draco.h"

#include <stdio.h>
#include <stdlib.h>
#include "gltf/accessor.h"
#include "gltf/view.h"

typedef struct nt_gltf_draco {
	struct nt_gltf_draco *next;
	uint64_t view; /* that holds the block */
	nt_draco *mesh;
} nt_gltf_draco;

nt_json_value *nt_gltf_draco_of(const nt_json_value *primitive)
{
	return nt_json_find(nt_json_find(primitive, "extensions"), "KHR_draco_mesh_compression");
}

static void free_blocks(nt_gltf_draco *block)
{
	while (block) {
		nt_gltf_draco *next = block->next;
		nt_draco_free(block->mesh);
		free(block);
		block = next;
	}
}

const nt_draco_mesh *nt_gltf_draco_block(const nt_gltf *document, uint64_t view)
{
	for (const nt_gltf_draco *block = document->draco_blocks; block; block = block->next)
		if (block->view == view)
			return nt_draco_get(block->mesh);
	return NULL;
}

static nt_status decode_block(nt_gltf *document, uint64_t index, const char *pointer,
	nt_error *error)
{
	nt_gltf_view view;
	const unsigned char *bytes = NULL;
	nt_status status = nt_gltf_get_view(document, index, pointer, &view, error);
	if (!status)
		status = nt_gltf_view_bytes(document, (uint32_t)index, 0, view.length, pointer, &bytes,
			error);
	if (status)
		return status;
	nt_gltf_draco *block = nt_calloc(1, sizeof *block);
	if (!block)
		return nt_fail_memory(error);
	block->view = index;
	status = nt_draco_decode(&block->mesh, bytes, (size_t)view.length, 0, true, error);
	if (status) {
		free(block);
		if (error && status != NT_ERROR_MEMORY) {
			snprintf(error->place.pointer, sizeof error->place.pointer, "/bufferViews/%llu",
				(unsigned long long)index);
			error->place.offset = NT_NO_OFFSET;
		}
		return status;
	}
	block->next = document->draco_blocks;
	document->draco_blocks = block;
	document->free_blocks = free_blocks;
	return NT_OK;
}

/* An accessor gets elements, if its type is that of the decoded attribute. */
static nt_status give_attribute(nt_gltf *document, uint64_t index, const char *name,
	const nt_draco_mesh *mesh, const nt_draco_attribute *from, const char *pointer, nt_error *error)
{
	nt_gltf_accessor accessor;
	nt_status status = nt_gltf_get_accessor(document, index, pointer, &accessor, error);
	if (status)
		return status;
	if (accessor.component_type != (uint32_t)from->component_type ||
		accessor.components != (uint32_t)from->components)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%.40s: accessor %llu has %u components of type %u, the compressed attribute %d of "
			"type %d", name, (unsigned long long)index, accessor.components,
			accessor.component_type, from->components, from->component_type);
	document->decoded[index] = (nt_gltf_decoded){from->data, mesh->point_count,
		(uint32_t)from->component_type};
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
				"%.40s has the id %llu, which the compressed data does not", name,
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
	snprintf(pointer, sizeof pointer, "%.80s/extensions/KHR_draco_mesh_compression",
		primitive_pointer);
	uint64_t view, mode = 4, index;
	nt_status status = nt_gltf_uint(extension, pointer, "bufferView", UINT32_MAX - 1,
		NT_GLTF_REQUIRED, &view, error);
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	if (!status && mode != 4)
		status = nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, pointer,
			"compressed primitive of mode %llu, expected 4", (unsigned long long)mode);
	if (!status && !document->decoded) {
		document->accessor_count = nt_json_count(nt_gltf_root_member(document, "accessors"));
		document->decoded = nt_calloc(document->accessor_count, sizeof *document->decoded);
		if (!document->decoded)
			status = nt_fail_memory(error);
	}
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
	if (!status && index < document->accessor_count)
		document->decoded[index] = (nt_gltf_decoded){(const unsigned char *)mesh->indices,
			mesh->face_count * 3, NT_GLTF_UINT};
	return status;
}
