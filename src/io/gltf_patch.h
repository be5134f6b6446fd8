/* SPDX-License-Identifier: MIT */
/*
 * What the parts of the glTF patch share: the document, the layout of its new bytes, and who shares
 * accessors.
 */
#ifndef NT_IO_GLTF_PATCH_H
#define NT_IO_GLTF_PATCH_H

#include "io/gltf_buffer_edits.h"
#include "io/gltf_vertex_pools.h"

typedef struct nt_gltf_patcher {
	nt_scene *scene;
	nt_gltf *document;
	nt_json *json;
	const nt_write_options *options;
	nt_gltf_layout layout;
	nt_gltf_sharing sharing;
	uint32_t *own;      /* [accessor_count] by canonical accessor: 1 + component that grows it */
	nt_arena *arena;    /* the layout's */
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

/* TANGENT accessors that a group's meshes have and nobody else uses. */
typedef struct nt_gltf_old_tangents {
	uint32_t *accessors; /* [count]; none: a new one is appended */
	size_t count;
	bool in_place;       /* the new rows go where the old ones are */
} nt_gltf_old_tangents;

/* ---- gltf_tangent.c ---- */

/* The TANGENT accessor of a member; NT_NONE: none. */
uint32_t nt_gltf_tangent_of(const nt_gltf_patcher *patcher, const nt_gltf_cluster *component, size_t member);

nt_status nt_gltf_find_tangents(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	uint32_t group, nt_gltf_old_tangents *old);

/* Takes their bytes out of the buffers, where nobody else refers to them. */
nt_status nt_gltf_vacate_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old);

/* Gives them the type that is stored. */
void nt_gltf_retype_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old);

/* Lets them refer to `count` rows in a new view. */
void nt_gltf_move_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old, uint32_t view,
	size_t count);

/* ---- the other parts ---- */

/* Whether a solved member of the component is compressed by Draco. */
bool nt_gltf_has_draco(const nt_gltf_patcher *patcher, const nt_gltf_cluster *component);

/* Writes a component with compressed members: compressed again where that is possible, else plain.
 * *done false: plain, and what plain components need is still to be done. */
nt_status nt_gltf_patch_draco(nt_gltf_patcher *patcher, nt_gltf_cluster *component, bool *done);

/* Takes KHR_draco_mesh_compression off the lists where no primitive has it any more. */
void nt_gltf_drop_draco(nt_gltf_patcher *patcher);

/* Writes the indices of the component's solved meshes where they changed. */
nt_status nt_gltf_patch_indices(nt_gltf_patcher *patcher, const nt_gltf_cluster *component);

/* Writes the document with its buffers and images: gltf_container.c. */
nt_status nt_gltf_write_container(nt_gltf_patcher *patcher, nt_output *output);

/* Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

#endif
