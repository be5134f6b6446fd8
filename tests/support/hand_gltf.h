/* SPDX-License-Identifier: MIT */
/*
 * A scene of two faces made by hand.
 */
#ifndef NT_TEST_HAND_GLTF_H
#define NT_TEST_HAND_GLTF_H

#include "test.h"
#include "folder.h"
#include "gltf/create/create.h"

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

#endif
