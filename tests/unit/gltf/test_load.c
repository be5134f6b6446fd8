/* SPDX-License-Identifier: MIT */
/*
 * Meshes that several threads load: which, and what is left for the load of one after the other.
 */
#include "hand_gltf_file.h"
#include "base/parallel.h"
#include "gltf/load.h"

/* The meshes: one with an index that is no vertex, one with an attribute and one with positions in a buffer that
 * nobody has opened, and one that is not needed. All have FACES triangles. */
enum { MESHES = 12, DAMAGED = 5, COLORED = 7, ELSEWHERE = 8, UNASKED = 9, FACES = 500 };

/* Buffer 0: positions, then indices of FACES triangles, and a 7 behind them. Buffer 1: other positions. */
static nt_buffer make_document(void)
{
	static const float positions[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 2, 0, 0, 0, 2, 0}};
	unsigned char first[sizeof positions[0] + 3 * FACES + 4] = {0};
	memcpy(first, positions[0], sizeof positions[0]);
	for (size_t i = 0; i < 3 * FACES; i++)
		first[sizeof positions[0] + i] = (unsigned char)(i % 3);
	first[sizeof positions[0] + 3 * FACES] = 7;
	nt_buffer json = {0};
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[");
	append_buffer(&json, first, sizeof first);
	nt_buffer_text(&json, ",");
	append_buffer(&json, positions[1], sizeof positions[1]);
	nt_buffer_format(&json, "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":1,\"byteLength\":36},"
		"{\"buffer\":0,\"byteOffset\":36,\"byteLength\":%d}],\"accessors\":["
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},"
		"{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},"
		"{\"bufferView\":2,\"componentType\":5121,\"type\":\"SCALAR\",\"count\":%d},"
		"{\"bufferView\":2,\"byteOffset\":1,\"componentType\":5121,\"type\":\"SCALAR\",\"count\":%d}],"
		"\"meshes\":[{\"primitives\":[", 3 * FACES + 1, 3 * FACES, 3 * FACES);
	for (int i = 0; i < MESHES; i++)
		nt_buffer_format(&json, "%s{\"attributes\":{\"POSITION\":%d%s},\"indices\":%d}", i ? "," : "",
			i == ELSEWHERE, i == COLORED ? ",\"COLOR_1\":1" : "", i == DAMAGED ? 3 : 2);
	nt_buffer_text(&json, "]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}");
	return json;
}

enum { MOST_THREADS = 4 };

typedef struct loading {
	nt_scene *scene;
	const nt_read_options *options;
	bool *needed;
	nt_arena arenas[MOST_THREADS];
} loading;

static void load_one(void *context, size_t item, unsigned slot)
{
	loading *job = context;
	nt_scene own = *job->scene;
	own.arena = job->arenas[slot];
	if (job->needed[item] && own.meshes[item].ready)
		job->needed[item] = nt_gltf_load(&own, &own.meshes[item], job->options, NULL) != NT_OK;
	job->arenas[slot] = own.arena;
}

static void check_with(unsigned threads)
{
	nt_buffer json = make_document();
	const nt_read_options options = {.texcoord_set = -1, .threads = threads, .report = true};
	bool needed[MESHES];
	nt_scene scene;
	nt_error error;
	assert_int_equal(open_bytes(&scene, json.data, json.size, &options, &error), NT_OK);
	assert_int_equal(scene.mesh_count, MESHES);
	for (size_t i = 0; i < MESHES; i++)
		needed[i] = i != UNASKED;
	assert_int_equal(nt_gltf_prepare(&scene, needed, &options, &error), NT_OK);
	loading job = {.scene = &scene, .options = &options, .needed = needed};
	nt_parallel_items(threads, MESHES, load_one, &job);
	for (unsigned i = 0; i < threads; i++)
		nt_arena_join(&scene.arena, &job.arenas[i]);
	for (size_t i = 0; i < MESHES; i++) {
		assert_int_equal(needed[i], i == DAMAGED);
		if (i == UNASKED)
			assert_null(scene.meshes[i].positions);
	}

	/* what is left is loaded as if nobody had tried, and says what is wrong */
	for (size_t i = 0; i < MESHES; i++) {
		nt_mesh *mesh = &scene.meshes[i];
		const nt_status status = needed[i] || i == UNASKED
			? nt_gltf_load(&scene, mesh, &options, &error) : NT_OK;
		assert_int_equal(status, i == DAMAGED ? NT_ERROR_INPUT : NT_OK);
		if (i == DAMAGED) {
			assert_string_equal(error.place.pointer, "/accessors/3");
			assert_string_equal(error.place.object, "mesh 0, primitive 5");
			continue;
		}
		assert_int_equal(mesh->vertex_count, 3);
		assert_int_equal(mesh->face_count, FACES);
		assert_true(mesh->positions[3] == (i == ELSEWHERE ? 2 : 1));
		for (size_t c = 0; c < 3 * FACES; c++)
			assert_int_equal(mesh->indices[c], c % 3);
		/* positions, a tangent, and the colour where there is one */
		assert_int_equal(mesh->vertex_bytes, 12 + 16 + (i == COLORED ? 12 : 0));
	}
	nt_scene_free(&scene);
	nt_buffer_free(&json);
}

TEST(meshes_are_loaded_by_several_threads)
{
	check_with(1);
	check_with(2);
	check_with(MOST_THREADS);
}
