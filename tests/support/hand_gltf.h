/* SPDX-License-Identifier: MIT */
/*
 * A scene of two faces made by hand, written as glTF into the folder of the test and read back with tinygltf.
 */
#ifndef NT_TEST_HAND_GLTF_H
#define NT_TEST_HAND_GLTF_H

#include "test.h"
#include "folder.h"
#include "ext/tinygltf.h"
#include "file/input.h"
#include "gltf/create/create.h"

#include <unistd.h>

/* ---- the scene ---- */

/* A quad and a triangle in the plane z = 0; vertex 2 is split for the triangle, which has tangents the other
 * way. v is not a float of few bits on purpose: 1 - v rounds.
 *
 *   3---2---4
 *   |   | /
 *   0---1     quad 0 1 2 3, triangle 1 4 2 */
typedef struct hand_scene {
	nt_scene scene;
	nt_mesh mesh;
	nt_primitive primitives[2];
	nt_instance instance;
	nt_material material;
	float tangents[24];
} hand_scene;

/* Fills a scene in place, since it points into itself. */
static inline nt_scene *make_scene(hand_scene *hand)
{
	static float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 1, 0};
	static float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0, 0};
	static float texcoords[] = {0, 0, 1, 0.1f, 1, 1, 0, 0.7f, 2, 1};
	static uint32_t corners[] = {0, 1, 2, 3, 1, 4, 2}, split_corners[] = {0, 1, 2, 3, 1, 4, 5};
	static uint32_t split_sources[] = {2};
	static uint8_t sizes[] = {4, 3}, diagonals[] = {1, 0};
	*hand = (hand_scene){
		.mesh = {.name = "hand", .vertex_count = 5, .positions = positions, .normals = normals,
			.texcoords = texcoords, .face_count = 2, .corner_count = 7, .face_sizes = sizes,
			.face_diagonals = diagonals, .indices = corners, .primitive_count = 1,
			.split = {split_corners, split_sources, 1, hand->tangents}},
		.primitives = {{.material = NT_NONE, .face_count = 1}, {.material = NT_NONE, .face_count = 1}},
		.instance = {.matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
		.material = {.name = "m", .base_color = {1, 1, 1, 1}, .roughness = 1, .normal_scale = 1},
		.tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, -1, 0, 0, -1},
	};
	static char path[512];
	snprintf(path, sizeof path, "%s", in_folder("hand.obj"));
	nt_scene_init(&hand->scene, path);
	hand->mesh.primitives = hand->primitives;
	hand->scene.meshes = &hand->mesh;
	hand->scene.mesh_count = 1;
	hand->scene.instances = &hand->instance;
	hand->scene.instance_count = 1;
	hand->scene.materials = &hand->material;
	hand->scene.material_count = 1;
	return &hand->scene;
}

/* Two primitives, the triangle first. */
static inline void divide(hand_scene *hand)
{
	static uint32_t face_primitive[] = {1, 0};
	hand->mesh.primitive_count = 2;
	hand->mesh.face_primitive = face_primitive;
}

/* ---- composing and reading back ---- */

static inline bool exists(const char *name)
{
	return access(in_folder(name), F_OK) == 0;
}

/* The text of a file, for strstr(). */
static inline char *text_of(const char *name)
{
	nt_file file;
	nt_error error;
	assert_int_equal(nt_file_open(&file, in_folder(name), &error), NT_OK);
	char *text = calloc(file.size + 1, 1);
	memcpy(text, file.data, file.size);
	nt_file_close(&file);
	return text;
}

static inline nt_status compose(nt_scene *scene, nt_write_options options, const char *name,
	nt_error *error)
{
	nt_output *output;
	options.path = in_folder(name);
	options.format = strstr(name, ".glb") ? NT_FORMAT_GLB : NT_FORMAT_GLTF;
	assert_int_equal(nt_output_create(&output, NULL, error), NT_OK);
	const nt_status status = nt_gltf_compose(scene, &options, output, error);
	if (status == NT_OK)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

static inline void compose_well(nt_scene *scene, nt_write_options options, const char *name)
{
	nt_error error;
	const nt_status status = compose(scene, options, name, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
}

static inline void assert_file_says(const char *name, const char *const *parts)
{
	char *text = text_of(name);
	assert_says(text, parts);
	free(text);
}

typedef struct opened {
	nt_file main, sidecar;
	nt_reread *reread;
} opened;

static inline bool find_sidecar(void *user, const char *uri, const unsigned char **bytes, size_t *size)
{
	opened *file = user;
	nt_error error;
	if (strstr(uri, ".bin") == NULL ||
		nt_file_open(&file->sidecar, in_folder(uri), &error) != NT_OK)
		return false;
	*bytes = file->sidecar.data;
	*size = file->sidecar.size;
	return true;
}

static inline opened open_back(const char *name)
{
	opened file = {.sidecar = {.fd = -1}};
	nt_error error;
	assert_int_equal(nt_file_open(&file.main, in_folder(name), &error), NT_OK);
	const nt_status status = nt_reread_open(&file.reread, file.main.data, file.main.size,
		find_sidecar, &file, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
	return file;
}

static inline void close_back(opened *file)
{
	nt_reread_free(file->reread);
	nt_file_close(&file->main);
	if (file->sidecar.data)
		nt_file_close(&file->sidecar);
}

static inline nt_reread_array array_of(const opened *file, size_t mesh, size_t primitive, const char *name)
{
	nt_reread_array array;
	nt_error error;
	const nt_status status =
		nt_reread_attribute(file->reread, mesh, primitive, name, &array, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
	return array;
}

static inline void assert_floats(const opened *file, size_t primitive, const char *name,
	const float *expected, size_t count, int width)
{
	const nt_reread_array array = array_of(file, 0, primitive, name);
	assert_int_equal(array.count, count);
	assert_int_equal(array.components, width);
	assert_int_equal(array.component_type, NT_GLTF_FLOAT);
	assert_memory_equal(array.data, expected, count * (size_t)width * sizeof(float));
}

static inline void assert_indices(const opened *file, size_t primitive, const uint16_t *expected,
	size_t count)
{
	const nt_reread_array array = array_of(file, 0, primitive, NULL);
	assert_int_equal(array.count, count);
	assert_int_equal(array.component_type, NT_GLTF_USHORT);
	assert_memory_equal(array.data, expected, count * sizeof *expected);
}

/* The whole mesh as the file should have it: the copy of vertex 2 at the end, v turned round, normals of
 * unit length, the zero one along z. */
static inline void assert_whole(const opened *file, const float *tangents)
{
	static const float out_positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 1, 0, 1, 1, 0};
	static const float out_normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
	static const float out_texcoords[] = {0, 1, 1, 1 - 0.1f, 1, 0, 0, 1 - 0.7f, 2, 0, 1, 0};
	static const uint16_t out_indices[] = {0, 1, 3, 1, 2, 3, 1, 4, 5};
	assert_floats(file, 0, "POSITION", out_positions, 6, 3);
	assert_floats(file, 0, "NORMAL", out_normals, 6, 3);
	assert_floats(file, 0, "TEXCOORD_0", out_texcoords, 6, 2);
	assert_floats(file, 0, "TANGENT", tangents, 6, 4);
	assert_indices(file, 0, out_indices, 9);
}

#endif
