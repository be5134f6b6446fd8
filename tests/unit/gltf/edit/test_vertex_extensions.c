/* SPDX-License-Identifier: MIT */
/*
 * FB_ngon_encoding, by which triangles that follow each other with one first index are one polygon, where vertices are
 * copied: it stays where that still holds.
 *
 *   3---2---4    the quad (0 1 2 3) as (0 1 2)(0 2 3), and the triangle (4 2 1)
 *   | / | /
 *   0---1        texture coordinates are positions, but for one vertex over which a side is folded
 */
#include "hand_gltf_file.h"
#include "gltf/document.h"

#define EXTENSION "\"extensions\":{\"FB_ngon_encoding\":{}}"

enum { SPLITS_FIRST = 3, SPLITS_OTHERS = 4 };

/* A primitive in which that vertex lies on the other side: of 3 copies the first corner of the quad, 4 leaves it. */
static void put_primitive(hand_file *f, nt_buffer *primitives, int folded, const char *members)
{
	static const float positions[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}};
	static const float normals[5][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	static const uint16_t indices[] = {0, 1, 2, 0, 2, 3, 4, 2, 1};
	float texcoords[5][2];
	for (size_t v = 0; v < 5; v++)
		memcpy(texcoords[v], positions[v], sizeof *texcoords);
	/* 3 falls on 1, its mirror image over the diagonal; 4 comes to lie left of the side 1 2 */
	texcoords[folded][0] = folded == SPLITS_FIRST ? 1 : 0;
	texcoords[folded][1] = folded == SPLITS_FIRST ? 0 : 1;
	const size_t p = put_accessor(f, positions, 5, NT_GLTF_FLOAT, "VEC3");
	const size_t n = put_accessor(f, normals, 5, NT_GLTF_FLOAT, "VEC3");
	const size_t t = put_accessor(f, texcoords, 5, NT_GLTF_FLOAT, "VEC2");
	const size_t i = put_accessor(f, indices, 9, NT_GLTF_USHORT, "SCALAR");
	nt_buffer_format(primitives, "%s{\"attributes\":{\"POSITION\":%zu,\"NORMAL\":%zu,\"TEXCOORD_0\":%zu},"
		"\"indices\":%zu,\"material\":0,%s}", primitives->size ? "," : "", p, n, t, i, members);
}

/* in.glb, of primitives whose vertex `folded` lies elsewhere, all marked. */
static void put_file_of(const int *folded, size_t count, const char *members)
{
	hand_file f = {0};
	nt_buffer primitives = {0}, document = {0};
	for (size_t i = 0; i < count; i++)
		put_primitive(&f, &primitives, folded[i], members);
	nt_buffer_format(&document, "\"extensionsUsed\":[\"FB_ngon_encoding\"]," NORMAL_MAP
		"\"meshes\":[{\"primitives\":[%s]}],", primitives.data);
	put_glb("in.glb", &f, document.data);
	nt_buffer_free(&primitives);
	nt_buffer_free(&document);
}

/* Converts it; expects so many findings, marks and names in extensionsUsed. */
static void expect(nt_settings settings, size_t dropped, size_t marks, size_t used)
{
	nt_summary summary = convert_file("in.glb", "out.glb", settings);
	assert_int_equal(count_findings(&summary, NT_CODE_POLYGONS_DROPPED), dropped);
	assert_int_equal(count_findings(&summary, NT_CODE_EXTENSION_STALE), 0);
	nt_summary_free(&summary);
	nt_scene scene;
	nt_file file;
	open_file(&scene, &file, "out.glb", &(nt_read_options){.texcoord_set = -1});
	size_t found = 0, listed = 0;
	for (size_t i = 0; i < scene.mesh_count; i++)
		found += nt_json_find(nt_json_find(nt_gltf_primitive_of(scene.source, &scene.meshes[i]), "extensions"),
			"FB_ngon_encoding") != NULL;
	const nt_json_value *names = nt_gltf_root_member(scene.source, "extensionsUsed");
	for (size_t i = 0; i < nt_json_count(names); i++)
		listed += !strcmp(nt_json_get_string(nt_json_at(names, i), NULL), "FB_ngon_encoding");
	assert_int_equal(found, marks);
	assert_int_equal(listed, used);
	nt_scene_free(&scene);
	nt_file_close(&file);
}

/* Solved as triangles: on quads a folded half keeps the quad's sign, and no corner is copied. */
TEST(polygon_whose_first_corner_is_copied_loses_its_mark)
{
	put_file_of((int[]){SPLITS_FIRST}, 1, EXTENSION);
	expect((nt_settings){.io.threads = 1, .quads = NT_QUADS_OFF}, 1, 0, 0);
	nt_file out = file_in_folder("out.glb");
	assert_null(memmem(out.data, out.size, "xtensions", 9)); /* nor an empty object or list */
	nt_file_close(&out);
}

TEST(polygon_whose_other_corners_are_copied_keeps_it)
{
	put_file_of((int[]){SPLITS_OTHERS}, 1, EXTENSION);
	expect((nt_settings){.io.threads = 1}, 0, 1, 1);
}

TEST(list_names_it_while_another_primitive_has_it)
{
	put_file_of((int[]){SPLITS_FIRST, SPLITS_OTHERS, SPLITS_FIRST}, 3, EXTENSION);
	expect((nt_settings){.io.threads = 1, .quads = NT_QUADS_OFF}, 2, 1, 1);
}

/* Draco's edgebreaker gives triangles another order. */
TEST(compressed_triangles_lose_it)
{
	put_file_of((int[]){SPLITS_OTHERS}, 1, EXTENSION);
	expect((nt_settings){.io.threads = 1, .io.draco = NT_DRACO_AS_EDGEBREAKER}, 1, 0, 0);
}

/* An extension that is listed without need is not ours to take away. */
TEST(nothing_goes_where_nothing_was)
{
	put_file_of((int[]){SPLITS_FIRST}, 1, "\"extras\":1");
	expect((nt_settings){.io.threads = 1}, 0, 0, 1);
}

/* The polygons' halves and quads are allocated too. */
TEST(exhausted_memory_is_told)
{
	put_file_of((int[]){SPLITS_FIRST, SPLITS_OTHERS}, 2, EXTENSION);
	assert_true(exhaust_memory(in_folder("in.glb"), (nt_settings){.io.threads = 1}) > 30);
}

AROUND_EACH(make_folder, remove_folder)
