/* SPDX-License-Identifier: MIT */
/*
 * Other meshes of a scene that may share the texels of one.
 */
#ifndef NT_REPORT_SURFACE_OTHERS_H
#define NT_REPORT_SURFACE_OTHERS_H

#include <math.h>
#include "scene/scene.h"

/* Meshes by what a sampler takes alike. */
typedef struct nt_other nt_other;
typedef struct nt_others {
	size_t faces;    /* of other meshes that checks of a mesh may still look at */
	nt_other *all;   /* [count] by sampler; NULL: nobody asked */
	uint32_t *built; /* of a sampler's first one: how many are in its tree; NT_NONE: nobody asked */
	size_t count;
} nt_others;

/* The unmirrored triangles of a mesh that is no surface, quads cut anyhow: those of `face` come next. */
typedef struct nt_mesh_triangles {
	const nt_mesh *mesh;
	size_t face, first, turn;
} nt_mesh_triangles;

/* The place that a sampler looks up along an axis, for a coordinate of the surface: repeated modulo 1, mirrored
 * folded, clamped (inside the texture) or in tiles as it stands. Offsets that move all alike are left out. */
static inline double nt_wrap_coordinate(const nt_mesh *mesh, int axis, double coordinate)
{
	const nt_wrap wrap = mesh->wrap[axis];
	const double x = coordinate + mesh->wrap_offset[axis];
	if (wrap == NT_WRAP_CLAMP || wrap == NT_WRAP_TILES)
		return x;
	const double tile = floor(x), within = x - tile;
	return wrap == NT_WRAP_MIRRORED && fmod(tile, 2.0) != 0.0 ? 1.0 - within : within;
}

/* Goes to the next one; false: there is none. */
bool nt_next_unmirrored(nt_mesh_triangles *at, const float *texcoords[3]);

/* Calls visit for the meshes whose unmirrored triangles, as a sampler takes them, may reach into a box of UV space of
 * a mesh that the sampler takes alike, which may be among them, until it returns false. */
nt_status nt_others_ask(nt_others *others, const nt_scene *scene, const nt_mesh *mesh, const double minimum[2],
	const double maximum[2], bool (*visit)(void *context, const nt_mesh *other), void *context);
void nt_others_free(nt_others *others);

#endif
