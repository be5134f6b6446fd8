/* SPDX-License-Identifier: MIT */
/*
 * Demands of materials on the primitives they cover: see materials.c.
 */
#ifndef NT_GLTF_MATERIALS_H
#define NT_GLTF_MATERIALS_H

#include "gltf/document.h"
#include "scene/transform.h"

/* A KHR_texture_transform, as it is for v up. */
typedef struct nt_gltf_transform {
	nt_uv_transform uv;
	bool turns;    /* it does something to directions: more than an offset */
	bool animated;
} nt_gltf_transform;

/* Demands of a primitive's materials. */
typedef struct nt_gltf_shading {
	unsigned slots; /* enum nt_slot */
	bool unlit;     /* all of its materials are */
	bool has_set;
	uint32_t set;   /* texture coordinates of the first slot in the order of enum nt_slot */
	bool conflict;  /* another slot wants other_set */
	uint32_t other_set;
	uint32_t material; /* the primitive's own; NT_NONE: none */
	nt_gltf_transform transform; /* of the texture that gives the set */
	nt_wrap wrap[2];             /* and its sampler's */
	bool transforms_differ;      /* another material or slot transforms that set otherwise */
} nt_gltf_shading;

/* Whether the transform turns or scales texture coordinates of this set. */
static inline bool nt_gltf_turns(const nt_gltf_shading *shading, uint32_t set)
{
	return shading->has_set && shading->set == set && shading->transform.turns;
}

/* Demands of a primitive's materials, variants included: slots, texture coordinates, transform. */
nt_status nt_gltf_find_slots(nt_gltf *document, const nt_json_value *primitive,
	const char *pointer, nt_gltf_shading *shading, nt_error *error);

#endif
