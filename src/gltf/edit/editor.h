/* SPDX-License-Identifier: MIT */
/*
 * What the parts of the glTF patch share: the document, the edits of its new bytes, and who shares
 * accessors.
 */
#ifndef NT_GLTF_EDIT_EDITOR_H
#define NT_GLTF_EDIT_EDITOR_H

#include "gltf/edit/buffer_edits.h"
#include "gltf/edit/vertex_pools.h"

typedef struct nt_gltf_patcher {
	nt_scene *scene;
	nt_gltf *document;
	nt_json *json;
	const nt_write_options *options;
	nt_buffer_edits edits;
	nt_gltf_sharing sharing;
	uint32_t *own;      /* [accessor_count] by canonical accessor: 1 + component that grows it */
	nt_arena *arena;    /* the edits's */
	bool quantized;     /* TANGENT was written as integers */
	nt_error *error;
} nt_gltf_patcher;

/* The meshes of one component. */
typedef struct nt_gltf_cluster {
	uint32_t number;
	const uint32_t *members; /* mesh numbers */
	size_t member_count;
	nt_gltf_rows rows;
	uint32_t buffer;         /* of new views */
} nt_gltf_cluster;

#endif
