/* SPDX-License-Identifier: MIT */
/*
 * Vertices on Draco's grid. A plain primitive that will be compressed is loaded with the values that a decoder will
 * have, so that all that follows (normals, morph targets, the solve, findings) is about what is drawn. The file's own
 * values go to the encoder, which lays the same grid over them: both look at the vertices that faces use, or take the
 * grid that edit/draco_plan.c has for them.
 *
 * A primitive that is compressed already needs nothing: its values lie on a grid which it keeps, and
 * quantizing them again moves none; what is beside its block stays there as it is.
 */
#include "gltf/load.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

static void flip_texcoords(nt_mesh *mesh)
{
	for (size_t v = 0; v < mesh->vertex_count; v++)
		mesh->texcoords[2 * v + 1] = -mesh->texcoords[2 * v + 1];
}

/* Corner by corner where a mesh has no indices of its own, in *own. NULL: memory is exhausted. */
static const uint32_t *indices_of(const nt_mesh *mesh, uint32_t **own)
{
	*own = NULL;
	if (mesh->indices)
		return mesh->indices;
	*own = nt_alloc(mesh->corner_count, sizeof **own);
	for (size_t c = 0; *own && c < mesh->corner_count; c++)
		(*own)[c] = (uint32_t)c;
	return *own;
}

/* Attributes with the mesh's triangles, to be quantized. values: as nt_draco_quantize() takes them. */
static nt_status quantize(const nt_mesh *mesh, const nt_draco_attribute *attributes, size_t count,
	float *const *values, nt_error *error)
{
	uint32_t *own;
	const nt_draco_mesh packed = {.method = NT_DRACO_SEQUENTIAL, .point_count = mesh->vertex_count,
		.face_count = mesh->face_count, .indices = indices_of(mesh, &own), .attributes = attributes,
		.attribute_count = count};
	const nt_status status = packed.indices ? nt_draco_quantize(&packed, values, error) :
						  nt_fail_memory(error);
	free(own);
	return status;
}

/* Whether faces use all vertices. */
static nt_status uses_all(const nt_mesh *mesh, bool *all, nt_error *error)
{
	bool *used = nt_calloc(mesh->vertex_count, sizeof *used);
	size_t count = 0;
	if (!used)
		return nt_fail_memory(error);
	for (size_t c = 0; c < mesh->corner_count; c++) {
		bool *vertex = &used[mesh->indices ? mesh->indices[c] : c];
		count += !*vertex;
		*vertex = true;
	}
	free(used);
	*all = count == mesh->vertex_count;
	return NT_OK;
}

nt_status nt_gltf_draco_takes(const nt_mesh *mesh, const nt_draco_attribute *attributes, size_t count, bool whole,
	nt_error *error)
{
	bool all = true;
	float **nothing = nt_calloc(count, sizeof *nothing);
	nt_status status = nothing ? quantize(mesh, attributes, count, nothing, error) : nt_fail_memory(error);
	free(nothing);
	if (!status && whole)
		status = uses_all(mesh, &all, error);
	return all ? status : nt_fail(error, NT_ERROR_INPUT, "faces do not use all vertices");
}

/* ---- what was loaded ---- */

static nt_status check_whole(nt_mesh *mesh, nt_error *error)
{
	bool all = true;
	const nt_status status = uses_all(mesh, &all, error);
	if (!all)
		mesh->plan.quantized = NT_QUANTIZED_NOT;
	return status;
}

/* The attributes of a mesh that are plain floats. */
typedef struct taking {
	nt_draco_attribute attributes[3];
	float *values[3];
	float **loaded[3]; /* where the mesh has them */
	size_t count;
	bool failed; /* memory is exhausted */
} taking;

static void take(taking *t, nt_scene *scene, const nt_mesh *mesh, const nt_gltf_accessor *from, nt_draco_kind kind,
	int bits, float **loaded)
{
	if (!from || from->component_type != NT_GLTF_FLOAT || t->failed)
		return;
	const size_t i = t->count++;
	t->attributes[i] = (nt_draco_attribute){.unique_id = (uint32_t)i, .kind = kind,
		.component_type = NT_GLTF_FLOAT, .components = (int)from->components,
		.quantization = nt_gltf_draco_grid(scene->source, from->index, bits), .data = *loaded};
	t->values[i] = nt_arena_alloc(&scene->arena, mesh->vertex_count, from->components * sizeof(float));
	t->failed |= !t->values[i];
	t->loaded[i] = loaded;
}

nt_status nt_gltf_quantize_vertices(nt_scene *scene, nt_mesh *mesh, const nt_gltf_accessor *positions,
	const nt_gltf_accessor *normals, const nt_gltf_accessor *texcoords, const nt_read_options *options,
	nt_error *error)
{
	const int *bits = options->draco_bits;
	taking t = {.count = 0};
	if (nt_gltf_draco_of(nt_gltf_primitive_of(scene->source, mesh)))
		return mesh->plan.quantized == NT_QUANTIZED_WHOLE ? check_whole(mesh, error) : NT_OK;
	take(&t, scene, mesh, positions, NT_DRACO_POSITION, nt_gltf_draco_bits(bits, NT_DRACO_BITS_POSITION),
		&mesh->positions);
	take(&t, scene, mesh, normals, NT_DRACO_NORMAL, nt_gltf_draco_bits(bits, NT_DRACO_BITS_NORMAL),
		&mesh->normals);
	take(&t, scene, mesh, texcoords, NT_DRACO_TEXCOORD, nt_gltf_draco_bits(bits, NT_DRACO_BITS_TEXCOORD),
		&mesh->texcoords);
	if (t.failed)
		return nt_fail_memory(error);
	/* texture coordinates lie on the grid as they are stored */
	if (mesh->texcoords)
		flip_texcoords(mesh);
	const nt_status status = t.count ? quantize(mesh, t.attributes, t.count, t.values, error) : NT_OK;
	for (size_t i = 0; !status && i < t.count; i++)
		*t.loaded[i] = t.values[i];
	if (mesh->texcoords)
		flip_texcoords(mesh);
	return status;
}

/* ---- what was made ---- */

static nt_status quantize_made(nt_scene *scene, nt_mesh *mesh, int bits, nt_error *error)
{
	const nt_draco_attribute normals = {.kind = NT_DRACO_NORMAL, .component_type = NT_GLTF_FLOAT, .components = 3,
		.quantization = {.bits = bits}, .data = mesh->normals};
	float *values = nt_arena_alloc(&scene->arena, mesh->vertex_count, 3 * sizeof *values);
	nt_error refused;
	if (!values)
		return nt_fail_memory(error);
	const nt_status status = quantize(mesh, &normals, 1, &values, &refused);
	if (!status)
		mesh->solve_normals = values;
	else if (nt_gltf_is_beside_mesh(status))
		*error = refused;
	return nt_gltf_is_beside_mesh(status) ? status : NT_OK;
}

nt_status nt_gltf_quantize_made_normals(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	const int bits = nt_gltf_draco_bits(options->draco_bits, NT_DRACO_BITS_NORMAL);
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (!mesh->plan.quantized || !mesh->normals_made)
			continue;
		if (mesh->plan.same_as)
			mesh->solve_normals = mesh->plan.same_as->solve_normals;
		else
			status = quantize_made(scene, mesh, bits, error);
	}
	return status;
}
