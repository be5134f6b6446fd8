/* SPDX-License-Identifier: MIT */
/*
 * Which primitives will be compressed by Draco, found before they are loaded. Quantization moves vertices: a triangle
 * that is small beside the grid gets another direction in space or in the texture, or is turned over, and what was
 * solved for the values of the file is wrong for those of the decoder. So these primitives are loaded as a decoder will
 * have them (gltf/draco_values.c). Of 19 public models compressed by sequential with 14, 12, 12 and 12 bits, tangents
 * of the file's values gave --check 3 480 findings; 20, 14, 18 and 12 bits left 1 266 and took 9 % more bytes.
 *
 * What stands in the way of compression is found by the function that finds it when the document is edited, from the
 * JSON alone. What values have against it is left for the load.
 *
 * Primitives that are solved together (--across=mesh) are not among them: each has a grid of its own, and on these
 * their borders would not meet.
 */
#include "gltf/edit/draco_foresee.h"

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
		if (!nt_mesh_is_wanted(nt_pool_mesh(pool, i)) || nt_pool_mesh(pool, i)->join)
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
		if (mesh->same_as && !mesh->quantized)
			scene->meshes[mesh->same_as - scene->meshes].quantized = NT_QUANTIZED_NOT;
	}
}

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
	nt_arena_free(&f.of_pool);
	nt_arena_free(&arena);
	return status;
}
