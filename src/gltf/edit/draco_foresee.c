/* SPDX-License-Identifier: MIT */
/*
 * Which primitives will be compressed by Draco, found before they are loaded. Quantization moves vertices: a triangle
 * that is small beside the grid gets another direction in space or in the texture, or is turned over, and what was
 * solved for the values of the file is wrong for those of the decoder. So these primitives are loaded as a decoder will
 * have them (gltf/draco_values.c). Of 19 public models compressed by sequential with 14, 12, 12 and 12 bits, tangents
 * of the file's values gave --check 3 480 findings; 20, 14, 18 and 12 bits left 1 266 and took 9 % more bytes.
 *
 * What stands in the way of compression is found by the function that finds it when the document is edited, without a
 * look at values. What these have against it is left for the load.
 *
 * On grids of their own the borders of primitives that are solved together (--across=mesh) would not meet any more.
 * They get one grid; where some of them will not be compressed, all stay as the file has them.
 */
#include "gltf/edit/draco_foresee.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "gltf/accessor.h"
#include "gltf/edit/draco.h"

typedef struct foreseeing {
	nt_scene *scene;
	nt_vertex_pools pools;
	nt_write_options options;
	nt_arena of_pool;
} foreseeing;

/* How many vertices the primitive has; false: it will not be loaded. */
static bool count_vertices(nt_gltf *document, const nt_vertex_pool *pool, size_t *count)
{
	const nt_json_value *attributes = nt_json_find(nt_pool_primitive(pool, 0), "attributes");
	uint64_t index;
	nt_gltf_accessor accessor;
	const bool found = nt_json_get_uint64(nt_json_find(attributes, "POSITION"), &index) &&
		nt_gltf_get_accessor(document, index, "", &accessor, NULL) == NT_OK;
	*count = found ? (size_t)accessor.count : 0;
	return found;
}

static bool gets_tangents(const nt_vertex_pool *pool)
{
	for (size_t i = 0; i < pool->user_count; i++)
		if (!nt_mesh_is_wanted(nt_pool_mesh(pool, i)))
			return false;
	return true;
}

static nt_status look_at_pool(foreseeing *f, size_t number, nt_error *error)
{
	nt_gltf *document = f->scene->source;
	nt_vertex_pool pool;
	nt_pool_vertices vertices = {.pool = &pool};
	nt_gltf_recoding recoding;
	nt_arena_clear(&f->of_pool);
	nt_status status = nt_vertex_pools_get(&f->pools, number, &f->of_pool, &pool, error);
	if (status || !gets_tangents(&pool) || !count_vertices(document, &pool, &vertices.old_count))
		return status;
	const bool compressed = nt_gltf_draco_of(nt_pool_primitive(&pool, 0)) != NULL;
	if (!compressed && f->options.draco == NT_DRACO_KEEP)
		return NT_OK;
	/* what is wrong with the file is found again when it is loaded */
	nt_error ignored;
	status = nt_gltf_draco_foresee(&recoding, document, &f->pools, &vertices, &f->options, &f->of_pool, &ignored);
	if (status == NT_ERROR_MEMORY)
		return nt_fail_memory(error);
	for (size_t i = 0; !status && !recoding.obstacle && i < pool.user_count; i++)
		f->scene->meshes[pool.users[i]].quantized = recoding.outside ? NT_QUANTIZED_WHOLE : NT_QUANTIZED;
	return NT_OK;
}

/* A mesh whose geometry serves one that will not be compressed stays as the file has it. */
static void clear_shared(nt_scene *scene)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		/* a copy in a join is none of the scene's, and is not marked */
		if (mesh->same_as >= scene->meshes && mesh->same_as < scene->meshes + scene->mesh_count && !mesh->quantized)
			scene->meshes[mesh->same_as - scene->meshes].quantized = NT_QUANTIZED_NOT;
	}
}

/* ---- what is solved together ---- */

/* The least box around values. */
typedef struct box {
	float least[3], most[3];
} box;

/* An attribute of plain floats, and its elements. */
static bool find_floats(nt_gltf *document, const nt_mesh *mesh, const char *name, nt_gltf_accessor *accessor,
	const unsigned char **elements)
{
	const nt_json_value *attributes = nt_json_find(nt_gltf_primitive_of(document, mesh), "attributes");
	uint64_t index;
	nt_error ignored;
	return nt_json_get_uint64(nt_json_find(attributes, name), &index) &&
		nt_gltf_get_accessor(document, index, "", accessor, &ignored) == NT_OK &&
		accessor->component_type == NT_GLTF_FLOAT && accessor->components <= 3 &&
		nt_gltf_elements(document, accessor, elements, &ignored) == NT_OK && *elements;
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

/* One grid for the positions, or the texture coordinates, of all parts; false: there is none. */
static bool lay_grid(const foreseeing *f, const nt_join *join, bool texcoords)
{
	nt_gltf *document = f->scene->source;
	const uint32_t components = texcoords ? 2 : 3;
	char name[32];
	nt_gltf_accessor accessor;
	const unsigned char *elements;
	box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
	for (size_t i = 0; i < join->part_count; i++) {
		if (!find_floats(document, join->parts[i], name_of(join->parts[i], texcoords, &name), &accessor, &elements) ||
			accessor.components != components)
			return false;
		grow_box(&b, &accessor, elements);
	}
	nt_draco_quantization grid = {.bits = nt_gltf_draco_bits(f->options.draco_bits,
		texcoords ? NT_DRACO_BITS_TEXCOORD : NT_DRACO_BITS_POSITION), .explicit_box = true};
	for (uint32_t k = 0; k < components; k++) {
		grid.origin[k] = b.least[k];
		grid.range = fmaxf(grid.range, b.most[k] - b.least[k]);
	}
	if (grid.range == 0) /* as Draco has it */
		grid.range = 1;
	for (size_t i = 0; isfinite(grid.range) && i < join->part_count; i++)
		if (find_floats(document, join->parts[i], name_of(join->parts[i], texcoords, &name), &accessor, &elements))
			document->grids[accessor.index] = grid;
	return isfinite(grid.range);
}

/* Whether all parts are plain and will be compressed. */
static bool is_quantized(const foreseeing *f, const nt_join *join)
{
	for (size_t i = 0; i < join->part_count; i++)
		if (!join->parts[i]->quantized || nt_gltf_draco_of(nt_gltf_primitive_of(f->scene->source, join->parts[i])))
			return false;
	return true;
}

static void look_at_join(const foreseeing *f, const nt_join *join)
{
	if (is_quantized(f, join) && lay_grid(f, join, false) && lay_grid(f, join, true))
		return;
	for (size_t i = 0; i < join->part_count; i++)
		if (!nt_gltf_draco_of(nt_gltf_primitive_of(f->scene->source, join->parts[i])))
			join->parts[i]->quantized = NT_QUANTIZED_NOT;
}

static nt_status look_at_joins(const foreseeing *f, nt_error *error)
{
	nt_gltf *document = f->scene->source;
	for (size_t i = 0; i < f->scene->join_count; i++) {
		const nt_join *join = &f->scene->joins[i];
		if (join->parts[0]->join != join) /* only compared */
			continue;
		if (!document->grids)
			document->grids = nt_calloc(f->pools.accessor_count, sizeof *document->grids);
		if (!document->grids)
			return nt_fail_memory(error);
		look_at_join(f, join);
	}
	return NT_OK;
}

/* ---- all ---- */

nt_status nt_gltf_find_quantized(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	nt_arena arena = {0};
	foreseeing f = {.scene = scene, .options = {.draco = options->draco}};
	for (size_t i = 0; i < NT_DRACO_BITS_COUNT; i++)
		f.options.draco_bits[i] = options->draco_bits[i];
	nt_status status = nt_vertex_pools_find(&f.pools, scene, &arena, error);
	for (size_t i = 0; !status && i < f.pools.count; i++)
		status = look_at_pool(&f, i, error);
	clear_shared(scene);
	if (!status && f.pools.count)
		status = look_at_joins(&f, error);
	nt_arena_free(&f.of_pool);
	nt_arena_free(&arena);
	return status;
}
