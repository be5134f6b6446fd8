/* SPDX-License-Identifier: MIT */
/*
 * Vertices on Draco's grid. A plain primitive that will be compressed is loaded with the values that a decoder will
 * have, so that all that follows (normals, morph targets, the solve, findings) is about what is drawn. The file's own
 * values go to the encoder, which lays the same grid over them: both look at the vertices that faces use, or take the
 * grid that edit/draco_foresee.c has for them.
 *
 * Of a primitive that is compressed already nothing has to be done: its values lie on a grid which it keeps, and
 * quantizing them again moves none; what is beside its block stays there as it is.
 */
#include "gltf/draco_values.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/draco.h"
#include "gltf/primitive.h"

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

/* ---- what was loaded ---- */

/* The attributes of a mesh that are plain floats, and others that Draco may refuse. */
typedef struct taking {
	nt_draco_attribute *attributes;
	float **values; /* NULL: it is only looked at */
	float **loaded[3];
	size_t count;
	bool failed; /* memory is exhausted */
} taking;

/* loaded: where the mesh has the values, which stay as they are. */
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

/* Attributes that a load does not read: a value in them with which Draco refuses the mesh. */
static nt_status look_at_others(taking *t, nt_gltf *document, const nt_json_value *attributes,
	const nt_gltf_sources *sources, int bits, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(attributes); i++) {
		const char *name = nt_json_key(attributes, i, NULL);
		const bool is_texcoord = strncmp(name, "TEXCOORD_", 9) == 0;
		uint64_t index;
		nt_gltf_accessor a;
		const unsigned char *elements = NULL;
		if (!nt_json_get_uint64(nt_json_at(attributes, i), &index) ||
			nt_gltf_get_accessor(document, index, "", &a, NULL) != NT_OK || a.components > 4 ||
			(sources->texcoords && sources->texcoords->index == a.index))
			continue;
		if (a.component_type == NT_GLTF_FLOAT ? !is_texcoord : a.component_type != NT_GLTF_UINT)
			continue;
		status = nt_gltf_elements(document, &a, &elements, error);
		t->attributes[t->count] = (nt_draco_attribute){.unique_id = (uint32_t)t->count,
			.kind = is_texcoord ? NT_DRACO_TEXCOORD : NT_DRACO_GENERIC, .component_type = (int)a.component_type,
			.components = (int)a.components, .stride_bytes = a.stride, .data = elements,
			.quantization = nt_gltf_draco_grid(document, a.index, a.component_type == NT_GLTF_FLOAT ? bits : 0)};
		t->count++;
	}
	return status;
}

/* Quantizes what was taken; a mesh that is refused loses ->quantized. */
static nt_status quantize_taken(const taking *t, nt_mesh *mesh, nt_error *error)
{
	/* texture coordinates lie on the grid as they are stored */
	if (mesh->texcoords)
		flip_texcoords(mesh);
	nt_error refused;
	const nt_status status = t->count ? quantize(mesh, t->attributes, t->count, t->values, &refused) : NT_OK;
	if (nt_gltf_is_beside_mesh(status)) {
		*error = refused;
		return status;
	}
	if (status)
		mesh->quantized = NT_QUANTIZED_NOT;
	for (size_t i = 0; !status && i < t->count; i++)
		if (t->values[i])
			*t->loaded[i] = t->values[i];
	if (mesh->texcoords)
		flip_texcoords(mesh);
	return NT_OK;
}

/* arena: of what is not needed afterwards. */
static nt_status quantize_plain(nt_scene *scene, nt_mesh *mesh, const nt_json_value *attributes,
	const nt_gltf_sources *sources, const int *bits, nt_arena *arena, nt_error *error)
{
	const size_t most = 3 + nt_json_count(attributes);
	taking t = {.attributes = nt_arena_alloc(arena, most, sizeof *t.attributes),
		.values = nt_arena_alloc(arena, most, sizeof *t.values)};
	if (!t.attributes || !t.values)
		return nt_fail_memory(error);
	memset(t.values, 0, most * sizeof *t.values);
	take(&t, scene, mesh, sources->positions, NT_DRACO_POSITION,
		nt_gltf_draco_bits(bits, NT_DRACO_BITS_POSITION), &mesh->positions);
	take(&t, scene, mesh, sources->normals, NT_DRACO_NORMAL, nt_gltf_draco_bits(bits, NT_DRACO_BITS_NORMAL),
		&mesh->normals);
	take(&t, scene, mesh, sources->texcoords, NT_DRACO_TEXCOORD,
		nt_gltf_draco_bits(bits, NT_DRACO_BITS_TEXCOORD), &mesh->texcoords);
	if (t.failed)
		return nt_fail_memory(error);
	const nt_status status = look_at_others(&t, scene->source, attributes, sources,
		nt_gltf_draco_bits(bits, NT_DRACO_BITS_TEXCOORD), error);
	return status ? status : quantize_taken(&t, mesh, error);
}

nt_status nt_gltf_quantize_vertices(nt_scene *scene, nt_mesh *mesh, const nt_gltf_sources *sources,
	const nt_read_options *options, nt_error *error)
{
	bool all = true;
	nt_status status = mesh->quantized == NT_QUANTIZED_WHOLE ? uses_all(mesh, &all, error) : NT_OK;
	if (!all)
		mesh->quantized = NT_QUANTIZED_NOT;
	const nt_json_value *primitive = nt_gltf_primitive_of(scene->source, mesh);
	if (status || !mesh->quantized || nt_gltf_draco_of(primitive))
		return status;
	nt_arena arena = {0};
	status = quantize_plain(scene, mesh, nt_json_find(primitive, "attributes"), sources, options->draco_bits,
		&arena, error);
	nt_arena_free(&arena);
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
		if (!mesh->quantized || !mesh->normals_made)
			continue;
		if (mesh->same_as)
			mesh->solve_normals = mesh->same_as->solve_normals;
		else
			status = quantize_made(scene, mesh, bits, error);
	}
	return status;
}
