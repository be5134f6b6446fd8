/* SPDX-License-Identifier: MIT */
/*
 * New accessors: see new_accessors.c.
 */
#ifndef NT_GLTF_EDIT_NEW_ACCESSORS_H
#define NT_GLTF_EDIT_NEW_ACCESSORS_H

#include "gltf/edit/editor.h"

/* Appends the JSON of an accessor; view NT_NONE: without one. Returns its number. */
uint32_t nt_gltf_new_accessor(nt_gltf_patcher *patcher, uint32_t view, uint32_t component_type,
	const char *type, size_t count, bool normalized);

/* An attribute's accessor over a new view. */
nt_status nt_gltf_add_attribute(nt_gltf_patcher *patcher, uint32_t buffer, const void *rows, size_t count,
	size_t row_bytes, uint32_t component_type, const char *type, uint32_t *accessor);

/* A VEC3 or VEC4 of floats. */
nt_status nt_gltf_add_floats(nt_gltf_patcher *patcher, uint32_t buffer, const float *rows, size_t count,
	uint32_t width, uint32_t *accessor);

/* Every primitive of a group gets the attribute. */
void nt_gltf_set_attribute(nt_gltf_patcher *patcher, const nt_gltf_cluster *component, uint32_t group,
	const char *name, uint32_t accessor);

/* The first mesh of a group. */
const nt_mesh *nt_gltf_first_of_group(const nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	uint32_t group);

/* cross(N, T) w of every row of a group, glTF's own definition of the bitangent. */
nt_status nt_gltf_bitangents(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	uint32_t group, float **rows);

/* TANGENT of the morph targets of a group's meshes: what to add to the base's. */
nt_status nt_gltf_add_morphs(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	uint32_t group);

#endif
