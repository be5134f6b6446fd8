/* SPDX-License-Identifier: MIT */
/*
 * Who shares what with whom, and the vertices that come out of it.
 *
 * Primitives that share an attribute accessor share its rows, so their vertices can only be split
 * together: they form a component. Primitives of a component with the same positions, normals and texture
 * coordinates (as texture transforms turn them) form a group and share one TANGENT accessor.
 */
#ifndef NT_GLTF_EDIT_VERTEX_POOLS_H
#define NT_GLTF_EDIT_VERTEX_POOLS_H

#include "gltf/document.h"

typedef struct nt_gltf_sharing {
	size_t accessor_count;
	uint32_t *canonical;      /* [accessor_count] the first accessor over the same bytes */
	bool *foreign;            /* [accessor_count] used by something else than attributes */
	uint32_t *attribute_users; /* [accessor_count] uses as attribute, of morph targets too; by canonical accessor */
	uint32_t *index_users;    /* [accessor_count] primitives that have it as indices */
	uint32_t *block_users;    /* [view_count] primitives that are compressed in it */
	uint32_t *order;          /* [mesh count] meshes, those of one component together */
	uint32_t *component;      /* [mesh count] by mesh: number of the component */
	size_t component_count;
	uint32_t *first;          /* [component_count + 1] where each begins in order */
} nt_gltf_sharing;

nt_status nt_gltf_find_sharing(nt_gltf_sharing *sharing, nt_gltf *document, const nt_scene *scene,
	nt_arena *arena, nt_error *error);

/* Rows of one component after splitting. */
typedef struct nt_gltf_rows {
	size_t old_count;     /* rows of the source */
	size_t new_count;
	uint32_t *sources;    /* [new_count - old_count] rows of the source */
	size_t group_count;
	float **tangents;     /* [group_count][new_count][4] */
	float **normals;      /* [group_count][new_count][3]: NULL where normals were not made */
	float ***morphs;      /* [group_count][morph count of its meshes][new_count][3] */
	uint32_t *group_of;   /* [member count] NT_NONE: not solved */
	uint32_t *group_first; /* [group_count] first member of each; what belongs to one is found without the others */
	uint32_t *next_of;    /* [member count] the next member of the same group, NT_NONE: none */
	uint32_t **indices;   /* [member count][corner count]; NULL: not solved */
	bool *changed;        /* [member count] indices differ from the source's triangles */
	bool borrowed;        /* sources, tangents and indices are the scene's: do not write to them */
} nt_gltf_rows;

/* Fills group_count, group_of, group_first and next_of, which have room for all members. False: out of memory. */
bool nt_gltf_find_groups(nt_gltf_rows *rows, const nt_gltf *document, const nt_scene *scene,
	const nt_gltf_sharing *sharing, const uint32_t *members, size_t member_count);

#endif
