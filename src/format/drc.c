/* SPDX-License-Identifier: MIT */
/*
 * Draco files (.drc) as input: one mesh, without materials. Draco decodes and checks (ext/draco.h); here its
 * attributes become the scene's arrays. Normals and texture coordinates are the first of their kind, v points
 * up, as in the OBJ and PLY files that Draco's own tools encode. Generic attributes have no meaning that a .drc
 * tells, so they are passed over, with a finding.
 */
#include "format/format.h"

#include <math.h>
#include <string.h>
#include "ext/draco.h"
#include "gltf/quantize.h"
#include "scene/values.h"

bool nt_drc_recognise(const unsigned char *bytes, size_t size)
{
	return size >= 5 && memcmp(bytes, "DRACO", 5) == 0;
}

/* An attribute as rows of `width` floats; components that it does not have are `missing`. */
static float *read_rows(nt_scene *scene, const nt_draco_attribute *a, size_t count, int width,
	float missing)
{
	float *rows = nt_arena_alloc(&scene->arena, count, (size_t)width * sizeof *rows);
	if (!rows)
		return NULL;
	const size_t step = nt_component_size(a->component_type), size = step * (size_t)a->components;
	if (a->component_type == NT_GLTF_FLOAT && a->components == width) {
		memcpy(rows, a->data, count * size);
		return rows;
	}
	for (size_t p = 0; p < count; p++) {
		const unsigned char *value = (const unsigned char *)a->data + p * size;
		for (int k = 0; k < width; k++)
			rows[(size_t)width * p + (size_t)k] = k < a->components
				? nt_component_value(value + step * (size_t)k, a->component_type, a->normalized)
				: missing;
	}
	return rows;
}

/* As OBJ and PLY: there is no tangent at NaN, and glTF cannot store it. */
static nt_status check_finite(const float *rows, size_t count, int width, unsigned attribute, nt_error *error)
{
	for (size_t i = 0; i < count * (size_t)width; i++)
		if (!isfinite(rows[i]))
			return nt_fail(error, NT_ERROR_INPUT,
				"Draco attribute %u of point %zu is not finite, expected finite numbers", attribute,
				i / (size_t)width);
	return NT_OK;
}

/* The rows that an attribute fills in the scene, and how wide they are. */
typedef struct target {
	float **rows;
	int width, least; /* components that it needs */
} target;

static target target_of(nt_mesh *mesh, nt_draco_kind kind)
{
	switch (kind) {
	case NT_DRACO_POSITION:
		return (target){&mesh->positions, 3, 3};
	case NT_DRACO_NORMAL:
		return (target){&mesh->normals, 3, 3};
	case NT_DRACO_TEXCOORD:
		return (target){&mesh->texcoords, 2, 2};
	case NT_DRACO_COLOR:
		return (target){&mesh->colors, 4, 3};
	default:
		return (target){0};
	}
}

static nt_status take_attributes(nt_scene *scene, nt_mesh *mesh, const nt_draco_mesh *from,
	nt_error *error)
{
	for (size_t i = 0; i < from->attribute_count; i++) {
		const nt_draco_attribute *a = &from->attributes[i];
		const target to = target_of(mesh, a->kind);
		if (!to.rows || *to.rows || a->components < to.least) {
			nt_scene_leave_out(scene, 0, 1, "Draco attribute %u with %d components", a->unique_id,
				a->components);
			continue;
		}
		*to.rows = read_rows(scene, a, from->point_count, to.width, 1.0f);
		if (!*to.rows)
			return nt_fail_memory(error);
		if (a->kind == NT_DRACO_COLOR) /* those of an OBJ or PLY: draco_encoder copies them */
			nt_linearise(scene, mesh, from->point_count);
		const nt_status status = check_finite(*to.rows, from->point_count, to.width, a->unique_id, error);
		if (status)
			return status;
	}
	return mesh->positions ? NT_OK
			       : nt_fail(error, NT_ERROR_INPUT, "the Draco mesh has no positions");
}

static nt_status fill_scene(nt_scene *scene, const nt_draco_mesh *from, nt_error *error)
{
	nt_mesh *mesh = nt_arena_alloc(&scene->arena, 1, sizeof *mesh);
	nt_instance *instance = nt_arena_alloc(&scene->arena, 1, sizeof *instance);
	uint32_t *indices = nt_arena_alloc(&scene->arena, from->face_count, 3 * sizeof *indices);
	nt_primitive *primitive = nt_arena_alloc(&scene->arena, 1, sizeof *primitive);
	if (!mesh || !instance || !indices || !primitive)
		return nt_fail_memory(error);
	if (from->face_count) /* else `from` has no array */
		memcpy(indices, from->indices, from->face_count * 3 * sizeof *indices);
	*instance = (nt_instance){.matrix = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0}};
	*primitive = (nt_primitive){.material = NT_NONE, .face_count = from->face_count};
	*mesh = (nt_mesh){.name = "", .gltf_mesh = NT_NONE, .gltf_primitive = NT_NONE,
		.triangles = true, .reachable = true, .has_positions = true,
		.vertex_count = from->point_count, .source_vertex_count = from->point_count,
		.face_count = from->face_count, .corner_count = 3 * from->face_count,
		.indices = indices, .primitives = primitive, .primitive_count = 1};
	scene->meshes = mesh;
	scene->instances = instance;
	scene->mesh_count = scene->instance_count = 1;
	const nt_status status = take_attributes(scene, mesh, from, error);
	mesh->has_normals = mesh->normals != NULL;
	mesh->has_texcoords = mesh->texcoords != NULL;
	return status;
}

nt_status nt_drc_open(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	(void)options;
	nt_draco *decoded;
	scene->format = NT_FORMAT_DRC;
	nt_status status =
		nt_draco_decode(&decoded, scene->bytes, scene->byte_count, 0, error);
	if (status == NT_OK)
		status = fill_scene(scene, &decoded->mesh, error);
	nt_draco_free(decoded);
	return status;
}
