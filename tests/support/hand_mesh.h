/* SPDX-License-Identifier: MIT */
/*
 * Small scenes made by hand, for the tests of the report: vertices of position and UV (v up), triangles of
 * indices, normals and tangents where a test wants them.
 */
#ifndef NT_HAND_MESH_H
#define NT_HAND_MESH_H

#include "test.h"
#include "base/hash.h"
#include "report/report.h"

enum { HAND_VERTICES = 512, HAND_TRIANGLES = 512 };

typedef struct hand_mesh {
	nt_scene scene;
	nt_mesh mesh;
	nt_primitive primitive;
	float positions[HAND_VERTICES][3], normals[HAND_VERTICES][3], texcoords[HAND_VERTICES][2];
	float tangents[HAND_VERTICES][4];
	uint32_t indices[3 * HAND_TRIANGLES];
} hand_mesh;

static inline hand_mesh *hand_new(void)
{
	hand_mesh *h = calloc(1, sizeof *h);
	nt_scene_init(&h->scene, "hand.ply");
	h->scene.format = NT_FORMAT_PLY;
	h->mesh.name = "hand";
	h->mesh.triangles = h->mesh.reachable = h->mesh.has_positions = true;
	h->mesh.gltf_mesh = h->mesh.gltf_primitive = NT_NONE;
	h->mesh.positions = h->positions[0];
	h->mesh.texcoords = h->texcoords[0];
	h->mesh.indices = h->indices;
	h->primitive.material = NT_NONE;
	h->mesh.primitives = &h->primitive;
	h->mesh.primitive_count = 1;
	h->scene.meshes = &h->mesh;
	h->scene.mesh_count = 1;
	return h;
}

static inline uint32_t hand_vertex(hand_mesh *h, float x, float y, float z, float u, float v)
{
	const size_t i = h->mesh.vertex_count++;
	assert_true(i < HAND_VERTICES);
	h->positions[i][0] = x;
	h->positions[i][1] = y;
	h->positions[i][2] = z;
	h->texcoords[i][0] = u;
	h->texcoords[i][1] = v;
	h->normals[i][2] = 1.0f; /* (0, 0, 1) */
	h->tangents[i][0] = h->tangents[i][3] = 1.0f;
	h->mesh.source_vertex_count = h->mesh.vertex_count;
	return (uint32_t)i;
}

static inline void hand_triangle(hand_mesh *h, uint32_t a, uint32_t b, uint32_t c)
{
	const size_t i = h->mesh.face_count++;
	assert_true(i < HAND_TRIANGLES);
	h->indices[3 * i] = a;
	h->indices[3 * i + 1] = b;
	h->indices[3 * i + 2] = c;
	h->mesh.corner_count += 3;
}

/* A quad a b c d as two triangles. */
static inline void hand_quad(hand_mesh *h, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
	hand_triangle(h, a, b, c);
	hand_triangle(h, a, c, d);
}

static inline void hand_give_normals(hand_mesh *h)
{
	h->mesh.normals = h->normals[0];
	h->mesh.has_normals = true;
}

static inline nt_report *hand_report(const hand_mesh *h, const nt_report_options *options)
{
	nt_report *report = NULL;
	nt_error error;
	assert_int_equal(nt_report_build(&h->scene, options, &report, &error), NT_OK);
	return report;
}

/* The same under a key with which hashes are products of what is hashed, so that many are equal. */
static inline nt_report *hand_report_by_equal_hashes(const hand_mesh *h)
{
	nt_hash_key_words[1] = 1;
	nt_hash_key_words[0] = 0;
	assert_true(nt_hash_words(0, 5) == nt_hash_words(0, 7) && nt_hash_words(2, 3) == nt_hash_words(1, 5));
	nt_report *report = hand_report(h, NULL);
	nt_hash_key_words[1] = 0; /* another key is made */
	return report;
}

/* How many findings have this code. */
static inline size_t hand_findings(const nt_report *report, nt_code code)
{
	size_t count = 0;
	for (size_t i = 0; i < report->finding_count; i++)
		count += report->findings[i].code == code;
	return count;
}

/* The only finding of this code. */
static inline const nt_report_finding *hand_finding(const nt_report *report, nt_code code)
{
	const nt_report_finding *found = NULL;
	for (size_t i = 0; i < report->finding_count; i++) {
		if (report->findings[i].code != code)
			continue;
		if (found)
			fail_msg("%s is there twice", nt_code_info(code)->name);
		found = &report->findings[i];
	}
	if (!found)
		fail_msg("%s is missing", nt_code_info(code)->name);
	return found;
}

static inline void hand_free(hand_mesh *h, nt_report *report)
{
	nt_report_free(report);
	nt_scene_free(&h->scene);
	free(h);
}

#endif
