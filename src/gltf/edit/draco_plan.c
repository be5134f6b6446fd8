/* SPDX-License-Identifier: MIT */
/*
 * Which primitives will be compressed by Draco, found before they are loaded. Quantization moves vertices: a triangle
 * that is small beside the grid gets another direction in space or in the texture, or is turned over, and what was
 * solved for the values of the file is wrong for those of the decoder. So these primitives are loaded as a decoder will
 * have them (gltf/draco_values.c). On 19 public models compressed by sequential with 14, 12, 12 and 12 bits, tangents
 * of the file's values gave --check 3 480 findings; 20, 14, 18 and 12 bits left 1 266 and took 9 % more bytes.
 *
 * The functions that edit the document also find here what stands in the way of compression: by one check that looks
 * at no values, and by Draco's own. Whether faces use all vertices of a block is known when it is decoded: the load
 * finds that.
 *
 * On grids of their own the borders of primitives that are solved together (--across=mesh) would not meet any more.
 * Compressed ones get one grid; if some are not, all are solved for what the file has, so that tangents
 * meet at the least.
 */
#include "gltf/edit/edit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/edit/pool_edit.h"
#include "gltf/load.h"

typedef struct planning {
	nt_scene *scene;
	nt_vertex_pools *pools;
	const nt_write_options *options;
	nt_arena of_pool;
} planning;

/* The faces of a plain primitive. */
static nt_status find_faces(planning *f, const nt_gltf_recoding *r, nt_mesh *mesh, nt_error *error)
{
	uint64_t index;
	const nt_gltf_accessor *accessor = NULL;
	uint32_t *indices = NULL;
	nt_status status = NT_OK;
	if (nt_json_find_uint64(r->primitive, "indices", &index)) {
		status = nt_gltf_get_accessor(r->document, index, "", &accessor, error);
		if (!status)
			status = nt_gltf_indices(r->document, accessor, mesh->vertex_count,
				&f->of_pool, &indices, error);
	}
	mesh->indices = indices;
	mesh->face_count = (accessor ? (size_t)accessor->count : mesh->vertex_count) / 3;
	mesh->corner_count = 3 * mesh->face_count;
	return status;
}

/* Whether Draco takes the values of a plain primitive, and all of its vertices where something beside the block counts
 * them. Loading finds faults of the file again. */
static nt_status look_at_values(planning *f, const nt_gltf_recoding *r, bool *takes, nt_error *error)
{
	nt_mesh mesh = {.vertex_count = r->vertices->old_count};
	nt_draco_attribute *attributes = nt_arena_alloc(&f->of_pool, r->attribute_count, sizeof *attributes);
	size_t count = 0;
	if (!attributes)
		return nt_fail_memory(error);
	for (size_t i = 0; i < r->attribute_count; i++)
		if (strcmp(r->names[i], "TANGENT") != 0) /* ours takes its place */
			attributes[count++] = r->attributes[i];
	nt_status status = find_faces(f, r, &mesh, error);
	if (!status)
		status = nt_gltf_draco_takes(&mesh, attributes, count, r->outside, error);
	*takes = !status;
	return status == NT_ERROR_MEMORY ? status : NT_OK;
}

static nt_status look_at_pool(planning *f, size_t number, nt_error *error)
{
	nt_gltf *document = f->scene->source;
	nt_vertex_pool pool;
	nt_pool_vertices vertices = {.pool = &pool};
	nt_gltf_recoding recoding;
	nt_arena_clear(&f->of_pool);
	nt_status status = nt_vertex_pools_get(f->pools, number, &f->of_pool, &pool, error);
	for (size_t i = 0; !status && i < pool.user_count; i++)
		if (!nt_mesh_is_wanted(nt_pool_mesh(&pool, i)))
			return NT_OK;
	const nt_gltf_accessor *positions = status ? NULL : nt_gltf_named(document,
		nt_json_find(nt_pool_primitive(&pool, 0), "attributes"), "POSITION");
	if (!positions) /* it will not be loaded */
		return status;
	vertices.own_count = vertices.old_count = (size_t)positions->count;
	const bool compressed = nt_gltf_draco_of(nt_pool_primitive(&pool, 0)) != NULL;
	if (!compressed && f->options->draco == NT_DRACO_KEEP)
		return NT_OK;
	/* what is wrong with the file is found again when it is loaded */
	nt_error ignored;
	status = nt_gltf_draco_begin(&recoding, document, &vertices, f->options, &f->of_pool, &ignored);
	if (status == NT_ERROR_MEMORY)
		return nt_fail_memory(error);
	bool takes = !status && !recoding.obstacle;
	if (takes && !compressed && look_at_values(f, &recoding, &takes, &ignored))
		return nt_fail_memory(error);
	for (size_t i = 0; takes && i < pool.user_count; i++)
		f->scene->meshes[pool.users[i]].plan.quantized =
			compressed && recoding.outside ? NT_QUANTIZED_WHOLE : NT_QUANTIZED;
	return NT_OK;
}

/* A mesh whose geometry serves one that will not be compressed stays as the file has it. */
static void clear_shared(nt_scene *scene)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		/* a copy in a join is none of the scene's, and is not marked */
		if (mesh->plan.same_as >= scene->meshes && mesh->plan.same_as < scene->meshes + scene->mesh_count &&
			!mesh->plan.quantized)
			scene->meshes[mesh->plan.same_as - scene->meshes].plan.quantized = NT_QUANTIZED_NOT;
	}
}

/* ---- what is solved together ---- */

/* The least box around values. */
typedef struct box {
	float least[3], most[3];
} box;

/* An attribute of plain floats, and its elements. */
static bool find_floats(nt_gltf *document, const nt_mesh *mesh, const char *name, uint32_t components,
	nt_gltf_accessor *accessor, const unsigned char **elements)
{
	const nt_gltf_accessor *found = nt_gltf_named(document, nt_json_find(nt_gltf_primitive_of(document, mesh),
		"attributes"), name);
	nt_error ignored;
	if (!found || found->component_type != NT_GLTF_FLOAT || found->components != components)
		return false;
	*accessor = *found;
	return nt_gltf_elements(document, found, elements, &ignored) == NT_OK && *elements;
}

static void grow_box(box *b, const nt_gltf_accessor *accessor, const unsigned char *elements)
{
	for (uint64_t i = 0; i < accessor->count; i++) {
		float value[3];
		memcpy(value, elements + i * accessor->stride, accessor->components * sizeof *value);
		for (uint32_t k = 0; k < accessor->components; k++) {
			b->least[k] = fminf(b->least[k], value[k]);
			b->most[k] = fmaxf(b->most[k], value[k]);
		}
	}
}

static const char *name_of(const nt_mesh *mesh, bool texcoords, char (*name)[32])
{
	if (!texcoords)
		return "POSITION";
	snprintf(*name, sizeof *name, "TEXCOORD_%u", mesh->texcoord_set);
	return *name;
}

/* Whether a part is plain and will be compressed. */
static bool is_new(const planning *f, const nt_mesh *part)
{
	return part->plan.quantized && !nt_gltf_draco_of(nt_gltf_primitive_of(f->scene->source, part));
}

/* One grid for the positions, or the texture coordinates, of the parts that will be compressed; integers need none, as
 * they stay what they are. Whether equal values of these parts remain equal. */
static bool lay_grid(const planning *f, const nt_join *join, bool texcoords)
{
	nt_gltf *document = f->scene->source;
	const uint32_t components = texcoords ? 2 : 3;
	char name[32];
	nt_gltf_accessor accessor;
	const unsigned char *elements;
	box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
	size_t others = 0, floats = 0;
	for (size_t i = 0; i < join->part_count; i++) {
		const nt_mesh *part = join->parts[i];
		if (!is_new(f, part))
			continue;
		if (!find_floats(document, part, name_of(part, texcoords, &name), components, &accessor, &elements)) {
			others++;
			continue;
		}
		grow_box(&b, &accessor, elements);
		floats++;
	}
	if (floats == 0)
		return true;
	nt_draco_quantization grid = {.bits = nt_gltf_draco_bits(f->options->draco_bits,
		texcoords ? NT_DRACO_BITS_TEXCOORD : NT_DRACO_BITS_POSITION), .explicit_box = true};
	for (uint32_t k = 0; k < components; k++) {
		grid.origin[k] = b.least[k];
		grid.range = fmaxf(grid.range, b.most[k] - b.least[k]);
	}
	if (grid.range == 0) /* as Draco has it */
		grid.range = 1;
	/* what Draco has to say of its cells */
	if (!isfinite(grid.range) || !isfinite((float)(1u << grid.bits) / grid.range))
		return false;
	for (size_t i = 0; i < join->part_count; i++) {
		const nt_mesh *part = join->parts[i];
		if (is_new(f, part) &&
			find_floats(document, part, name_of(part, texcoords, &name), components, &accessor, &elements))
			document->grids[accessor.index] = grid;
	}
	return others == 0;
}

static void look_at_join(const planning *f, const nt_join *join)
{
	bool all = true;
	for (size_t i = 0; i < join->part_count; i++)
		all &= is_new(f, join->parts[i]);
	all &= lay_grid(f, join, false);
	all &= lay_grid(f, join, true);
	for (size_t i = 0; !all && i < join->part_count; i++)
		if (is_new(f, join->parts[i]))
			join->parts[i]->plan.quantized = NT_QUANTIZED_NOT;
}

static nt_status look_at_joins(const planning *f, nt_error *error)
{
	nt_gltf *document = f->scene->source;
	for (size_t i = 0; i < f->scene->join_count; i++) {
		const nt_join *join = &f->scene->joins[i];
		if (join->parts[0]->plan.join != join) /* only compared */
			continue;
		if (!document->grids)
			document->grids = nt_calloc(document->accessor_count, sizeof *document->grids);
		if (!document->grids)
			return nt_fail_memory(error);
		look_at_join(f, join);
	}
	return NT_OK;
}

/* ---- all ---- */

nt_status nt_gltf_find_quantized(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	nt_gltf *document = scene->source;
	planning f = {.scene = scene, .pools = document->pools, .options = options};
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < f.pools->count; i++)
		status = look_at_pool(&f, i, error);
	clear_shared(scene);
	if (!status)
		status = look_at_joins(&f, error);
	nt_arena_free(&f.of_pool);
	return status;
}
