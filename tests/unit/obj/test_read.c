/* SPDX-License-Identifier: MIT */
/*
 * The OBJ reader's results. Expected arrays are derived by hand beside each case: vertices are numbered by
 * the first use of their v/vt/vn. Files that are wrong are in test_damage.c.
 */
#include "obj/read.h"
#include "obj_file.h"

static void assert_floats(const float *floats, const float *expected, size_t count)
{
	assert_non_null(floats);
	for (size_t i = 0; i < count; i++)
		assert_true(floats[i] == expected[i]);
}

static void assert_numbers(const uint32_t *numbers, const uint32_t *expected, size_t count)
{
	assert_non_null(numbers);
	for (size_t i = 0; i < count; i++)
		assert_int_equal(numbers[i], expected[i]);
}

/* The finding of a code, NULL where there is none. */
static const nt_finding *find(const reading *r, nt_code code)
{
	for (size_t i = 0; i < r->scene.findings.count; i++)
		if (r->scene.findings.items[i].code == code)
			return &r->scene.findings.items[i];
	return NULL;
}

/* ---- what is read ---- */

TEST(one_triangle_with_everything)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		"# comment\no head\nv 0 0 0\nv 1.5 0 0\nv 0 -2e0 .25\n"
		"vt 0.5 0.25\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
	assert_string_equal(mesh->name, "head");
	nt_place place;
	nt_mesh_place(mesh, &place);
	assert_string_equal(place.file, "folder/test.obj");
	assert_int_equal(place.line, 2);
	assert_string_equal(place.object, "object \"head\"");
	assert_int_equal(mesh->vertex_count, 3);
	assert_int_equal(mesh->source_vertex_count, 3);
	assert_int_equal(mesh->face_count, 1);
	assert_int_equal(mesh->corner_count, 3);
	assert_floats(mesh->positions, (const float[]){0, 0, 0, 1.5f, 0, 0, 0, -2, 0.25f}, 9);
	assert_floats(mesh->texcoords, (const float[]){0.5f, 0.25f, 1, 0, 0, 1}, 6);
	assert_floats(mesh->normals, (const float[]){0, 0, 1, 0, 0, 1, 0, 0, 1}, 9);
	assert_numbers(mesh->indices, (const uint32_t[]){0, 1, 2}, 3);
	assert_true(mesh->triangles && mesh->reachable && !mesh->unlit);
	assert_true(mesh->has_positions && mesh->has_normals && mesh->has_texcoords);
	assert_false(mesh->has_tangents);
	assert_null(mesh->colors);
	assert_null(mesh->tangents);
	assert_null(mesh->vertex_lacks);
	assert_null(mesh->face_sizes);
	assert_null(mesh->face_polygon);
	assert_null(mesh->face_smoothing);
	assert_null(mesh->face_primitive);
	assert_int_equal(mesh->primitive_count, 1);
	assert_int_equal(mesh->primitives[0].material, NT_NONE);
	assert_int_equal(mesh->primitives[0].face_count, 1);
	assert_int_equal(mesh->gltf_mesh, NT_NONE);
	assert_int_equal(mesh->decision, NT_DECISION_OPEN);
	assert_int_equal(r.scene.instance_count, 1);
	assert_int_equal(r.scene.instances[0].mesh, 0);
	for (int k = 0; k < 16; k++)
		assert_true(r.scene.instances[0].matrix[k] == (k % 5 == 0));
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

/* Corners 1/1 2/2 3/3 then 1/1 3/3 4/2: the second face shares two; 4 is new, v 5 is not used. Then v 2
 * with another vt: a vertex of its own. */
TEST(equal_corners_share_a_vertex_in_order_of_first_use)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		TRIANGLE "v 1 1 0\nv 9 9 9\nvt 0 0\nvt 1 0\nvt 1 1\n"
		"f 3/3 1/1 2/2\nf 1/1 3/3 4/2\nf 2/1 3/3 4/2\n");
	assert_int_equal(mesh->vertex_count, 5);
	assert_numbers(mesh->indices, (const uint32_t[]){0, 1, 2, 1, 0, 3, 4, 0, 3}, 9);
	assert_floats(mesh->positions,
		(const float[]){0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0}, 15);
	assert_floats(mesh->texcoords, (const float[]){1, 1, 0, 0, 1, 0, 1, 0, 0, 0}, 10);
	assert_null(mesh->normals);
	close_reading(&r);
}

/* -1 is the last one before the face, wherever it stands in the file. */
TEST(negative_indices_count_back_from_the_face)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		TRIANGLE "vt 0 0\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n"
		"v 5 5 5\nvt 7 7\nvn 1 0 0\nf -2//-2 1/-1 -1/1/1\n");
	assert_int_equal(mesh->vertex_count, 6);
	assert_numbers(mesh->indices, (const uint32_t[]){0, 1, 2, 3, 4, 5}, 6);
	assert_floats(mesh->positions + 9, (const float[]){0, 1, 0, 0, 0, 0, 5, 5, 5}, 9);
	assert_floats(mesh->texcoords + 6, (const float[]){0, 0, 7, 7, 0, 0}, 6);
	assert_floats(mesh->normals + 9, (const float[]){0, 0, 1, 0, 0, 0, 0, 0, 1}, 9);
	/* vertex 3 is -2//-2, 4 is 1/-1, 5 has everything */
	const uint8_t lacks[6] = {0, 0, 0, NT_LACKS_TEXCOORD, NT_LACKS_NORMAL, 0};
	assert_memory_equal(mesh->vertex_lacks, lacks, 6);
	close_reading(&r);
}

TEST(faces_may_come_before_their_vertices)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, "f 1/1 2/1 3/1\n" TRIANGLE "vt 0.5 0.5\n");
	assert_int_equal(mesh->vertex_count, 3);
	assert_floats(mesh->positions, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9);
	close_reading(&r);
}

/* If no vertex has a normal, none lacks one. */
TEST(lacks_are_told_only_where_others_have)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, TRIANGLE "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3\n");
	const uint8_t lacks[3] = {0, 0, NT_LACKS_TEXCOORD};
	assert_null(mesh->normals);
	assert_false(mesh->has_normals);
	assert_memory_equal(mesh->vertex_lacks, lacks, 3);
	close_reading(&r);
	mesh = only_mesh(&r, TRIANGLE "vt 0 0\nvn 0 0 1\nf 1 2/ 3//\n");
	assert_null(mesh->normals);
	assert_null(mesh->texcoords);
	assert_null(mesh->vertex_lacks);
	close_reading(&r);
}

TEST(quads_stay_and_larger_polygons_become_triangles)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\n"
		"f 1 2 3 4\nf 1 2 3\n");
	assert_int_equal(mesh->corner_count, 7);
	assert_memory_equal(mesh->face_sizes, ((const uint8_t[]){4, 3}), 2);
	assert_null(mesh->face_polygon);
	close_reading(&r);

	/* the pentagon is convex: a fan from its first corner */
	mesh = only_mesh(&r,
		"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\n"
		"f 1 2 3\nf 1 2 3 4 5\nf 4 3 2 1\n");
	assert_int_equal(mesh->face_count, 5);
	assert_int_equal(mesh->corner_count, 16);
	assert_memory_equal(mesh->face_sizes, ((const uint8_t[]){3, 3, 3, 3, 4}), 5);
	assert_numbers(mesh->face_polygon, (const uint32_t[]){0, 1, 1, 1, 2}, 5);
	assert_numbers(mesh->indices,
		(const uint32_t[]){0, 1, 2, 0, 1, 2, 0, 2, 3, 0, 3, 4, 3, 2, 1, 0}, 16);
	assert_null(find(&r, NT_CODE_POLYGON_DEGENERATE));
	close_reading(&r);
}

/* A polygon of 300 corners does not fit a byte; 254, 255 and 256 are around the border. */
TEST(polygons_of_many_corners)
{
	const size_t sizes[4] = {254, 255, 256, 300};
	char *text = malloc(100000), *p = text;
	for (int i = 0; i < 300; i++) /* on a parabola: convex */
		p += sprintf(p, "v %d %d 0\n", i, i * i);
	for (int k = 0; k < 4; k++) {
		p += sprintf(p, "f");
		for (size_t i = 1; i <= sizes[k]; i++)
			p += sprintf(p, " %zu", i);
		p += sprintf(p, "\nf 1 2 3\n");
	}
	reading r;
	const nt_mesh *mesh = only_mesh(&r, text);
	assert_int_equal(mesh->face_count, 254 + 255 + 256 + 300 - 8 + 4);
	assert_int_equal(mesh->corner_count, 3 * mesh->face_count);
	size_t f = 0;
	for (uint32_t k = 0; k < 4; k++) {
		for (size_t i = 0; i < sizes[k] - 2; i++, f++) {
			assert_int_equal(mesh->face_polygon[f], 2 * k);
			assert_numbers(mesh->indices + 3 * f,
				(const uint32_t[]){0, (uint32_t)i + 1, (uint32_t)i + 2}, 3);
		}
		assert_int_equal(mesh->face_polygon[f], 2 * k + 1);
		assert_numbers(mesh->indices + 3 * f++, (const uint32_t[]){0, 1, 2}, 3);
	}
	close_reading(&r);
	free(text);
}

TEST(degenerate_polygon_is_a_finding_with_its_line)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, "o line\n" TRIANGLE "f 1 2 3\nf 1 1 2 2 3\nf 1 1 1 1 1\n");
	assert_int_equal(mesh->face_count, 7);
	const nt_finding *finding = find(&r, NT_CODE_POLYGON_DEGENERATE);
	assert_non_null(finding);
	assert_int_equal(finding->count, 2);
	assert_int_equal(finding->place.line, 6);
	assert_string_equal(finding->place.object, "object \"line\"");
	close_reading(&r);
}

/* ---- objects, materials, smoothing ---- */

/* Groups are primitives of one mesh, brought together by name; faces before the first have none. */
TEST(groups_are_parts_of_one_mesh_where_there_is_no_object)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, TRIANGLE "f 1 2 3\ng leg\nusemtl a\nf 2 3 1\ng arm one\nf 3 1 2\nusemtl b\n"
		"g leg\nf 1 2 3\nf 2 3 1\nusemtl a\nf 3 1 2\ng\nf 1 2 3\n");
	static const struct {
		const char *group;
		uint32_t material, faces;
	} expected[] = {{"", NT_NONE, 1}, {"", 0, 1}, {"leg", 0, 2}, {"leg", 1, 2}, {"arm one", 0, 1}};
	assert_int_equal(mesh->primitive_count, 5);
	for (size_t i = 0; i < 5; i++) {
		assert_string_equal(mesh->groups[mesh->primitives[i].group], expected[i].group);
		assert_int_equal(mesh->primitives[i].material, expected[i].material);
		assert_int_equal(mesh->primitives[i].face_count, expected[i].faces);
	}
	assert_numbers(mesh->face_primitive, (const uint32_t[]){0, 2, 4, 3, 3, 2, 1}, 7);
	assert_int_equal(mesh->vertex_count, 3);
	assert_string_equal(mesh->name, "");
	close_reading(&r);
	/* one name for all is the mesh's */
	mesh = only_mesh(&r, "g default\n" TRIANGLE "g pCube1\nf 1 2 3\n");
	assert_string_equal(mesh->name, "pCube1");
	close_reading(&r);
}

TEST(objects_become_meshes_and_groups_do_not)
{
	reading r;
	open_text(&r,
		TRIANGLE "f 1 2 3\no empty\no first\ng a b\nf 1 2 3\ng c\nf 3 2 1\no second one\nf 2 1 3\n");
	assert_int_equal(r.status, NT_OK);
	assert_int_equal(r.scene.mesh_count, 3);
	assert_int_equal(r.scene.instance_count, 3);
	const nt_mesh *mesh = r.scene.meshes;
	assert_string_equal(mesh[0].name, "");
	nt_place place;
	assert_string_equal(nt_mesh_place(&mesh[0], &place)->object, "");
	assert_string_equal(mesh[1].name, "first");
	assert_int_equal(mesh[1].line, 6);
	assert_string_equal(mesh[2].name, "second one");
	assert_int_equal(mesh[0].face_count, 1);
	assert_int_equal(mesh[1].face_count, 2);
	assert_int_equal(mesh[2].face_count, 1);
	for (int m = 0; m < 3; m++)
		assert_int_equal(mesh[m].vertex_count, 3);
	assert_numbers(mesh[1].indices, (const uint32_t[]){0, 1, 2, 2, 1, 0}, 6);
	assert_numbers(mesh[2].indices, (const uint32_t[]){0, 1, 2}, 3);
	assert_floats(mesh[2].positions, (const float[]){1, 0, 0, 0, 0, 0, 0, 1, 0}, 9);
	assert_int_equal(r.scene.instances[2].mesh, 2);
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

/* b is used first, but its first face comes in the second mesh. */
TEST(materials_become_primitives_in_order_of_first_use)
{
	reading r;
	open_text(&r,
		TRIANGLE "f 1 2 3\nusemtl b\nusemtl  a name \nf 1 2 3\nf 1 2 3\nusemtl\nf 3 2 1\n"
			 "usemtl a name\nf 1 2 3\no two\nf 1 2 3\nusemtl b\nf 1 2 3 1 2\nf 1 2 3\n");
	assert_int_equal(r.status, NT_OK);
	assert_int_equal(r.scene.material_count, 2);
	assert_string_equal(r.scene.materials[0].name, "a name");
	assert_string_equal(r.scene.materials[1].name, "b");
	assert_null(r.scene.materials[0].library);
	const nt_mesh *mesh = &r.scene.meshes[0];
	assert_int_equal(mesh->primitive_count, 2);
	assert_int_equal(mesh->primitives[0].material, NT_NONE);
	assert_int_equal(mesh->primitives[0].face_count, 2);
	assert_int_equal(mesh->primitives[1].material, 0);
	assert_int_equal(mesh->primitives[1].face_count, 3);
	assert_numbers(mesh->face_primitive, (const uint32_t[]){0, 1, 1, 0, 1}, 5);
	mesh = &r.scene.meshes[1];
	assert_int_equal(mesh->primitive_count, 2);
	assert_int_equal(mesh->primitives[0].material, 0);
	assert_int_equal(mesh->primitives[0].face_count, 1);
	assert_int_equal(mesh->primitives[1].material, 1);
	assert_int_equal(mesh->primitives[1].face_count, 4); /* three triangles of the pentagon, and one */
	assert_numbers(mesh->face_primitive, (const uint32_t[]){0, 1, 1, 1, 1}, 5);
	const nt_finding *unknown = find(&r, NT_CODE_MATERIAL_UNKNOWN);
	assert_non_null(unknown);
	assert_string_equal(unknown->detail, "a name");
	assert_int_equal(unknown->place.line, 6);
	close_reading(&r);
}

TEST(smoothing_groups_are_kept_where_normals_lack)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		TRIANGLE "f 1 2 3\ns 1\nf 1 2 3\ns off\nf 1 2 3\ns 17\nf 1 2 3 1 2\ns on\nf 1 2 3\ns 0\nf 1 2 3\n");
	assert_numbers(mesh->face_smoothing, (const uint32_t[]){0, 1, 0, 17, 17, 17, 1, 0}, 8);
	close_reading(&r);
	/* 3ds Max has 32 groups, which are bits; ZBrush writes no number; null stands for off in some files */
	mesh = only_mesh(&r, TRIANGLE "s 16777216\nf 1 2 3\ns 2147483648\nf 1 2 3\ns 4294967295\nf 1 2 3\ns\nf 1 2 3\n"
				      "s null\nf 1 2 3\ns # none\nf 1 2 3\n");
	assert_numbers(mesh->face_smoothing, (const uint32_t[]){16777216, 2147483648, 4294967295, 1, 0, 1}, 6);
	close_reading(&r);
	mesh = only_mesh(&r, TRIANGLE "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\n");
	assert_null(mesh->face_smoothing);
	close_reading(&r);
	mesh = only_mesh(&r, TRIANGLE "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\nf 1 2 3\n");
	assert_numbers(mesh->face_smoothing, (const uint32_t[]){1, 1}, 2);
	close_reading(&r);
	mesh = only_mesh(&r, TRIANGLE "f 1 2 3\n");
	assert_null(mesh->face_smoothing);
	close_reading(&r);
}

TEST(missing_library_is_a_finding)
{
	reading r;
	only_mesh(&r, "usemtl stone\nmtllib no such file.mtl\nmtllib no such file.mtl\n" TRIANGLE "f 1 2 3\n");
	const nt_finding *missing = find(&r, NT_CODE_MTL_MISSING);
	assert_non_null(missing);
	assert_int_equal(missing->count, 1);
	assert_int_equal(missing->place.line, 2);
	assert_string_equal(missing->detail, "no such file.mtl: no such file");
	/* that the material is unknown follows from it */
	assert_null(find(&r, NT_CODE_MATERIAL_UNKNOWN));
	assert_string_equal(r.scene.materials[0].name, "stone");
	close_reading(&r);
}

/* ---- spellings ---- */

TEST(line_ends_blanks_and_continuations)
{
	static const char *const texts[] = {
		"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
		"v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
		"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
		"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\r",
		"\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
		"\tv\t0  0\t0\t\n  v +1 0 0  \nv 0.0 1. -0\n \t f\t1 2\t3 \t\n",
		"v 0 \\\n0 0\nv 1\\\r\n 0 0\nv \\\n\\\n0 1 0\nf 1 2 \\\n3\n",
		"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\",
		"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\\\n",
	};
	for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
		reading r;
		const nt_mesh *mesh = only_mesh(&r, texts[i]);
		assert_int_equal(mesh->face_count, 1);
		assert_floats(mesh->positions, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9);
		close_reading(&r);
	}
}

TEST(comments_and_names_keep_their_backslash)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r,
		"# C:\\models\\\nv 0 0 0 1\nv 1 0 0 0.5 # c \\\nv 0 1 0 2\no a\\\nfo 1 2 3 #\n#\\");
	assert_string_equal(mesh->name, "a\\");
	assert_floats(mesh->positions, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9);
	close_reading(&r);
}

TEST(texture_coordinates_of_one_and_three_numbers)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, TRIANGLE "vt 0.5\nvt 0.25 0.75 9\nvt 1 2\nf 1/1 2/2 3/3\n");
	assert_floats(mesh->texcoords, (const float[]){0.5f, 0, 0.25f, 0.75f, 1, 2}, 6);
	close_reading(&r);
}

/* sRGB to linear: 0.5 -> ((0.5 + 0.055) / 1.055)^2.4 = 0.21404114, 0.04 -> 0.04 / 12.92 = 0.0030959752;
 * a vertex without a colour is white. */
TEST(colors_are_srgb_and_become_linear)
{
	reading r;
	const nt_mesh *mesh =
		only_mesh(&r, "v 9 9 9\nv 0 0 0\nv 1 0 0 0.5 0.04 1\nv 0 1 0 0 2 -1 0.5\nf 2 3 4\n");
	assert_floats(mesh->positions, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9);
	assert_floats(mesh->colors,
		(const float[]){1, 1, 1, 1, 0.21404114f, 0.0030959752f, 1, 1, 0, 1, 0, 0.5f}, 12);
	close_reading(&r);
}

TEST(names_that_are_not_utf8_are_taken_as_latin1)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, "o K\xF6rper\n" TRIANGLE "f 1 2 3\n");
	assert_string_equal(mesh->name, "K\xC3\xB6rper");
	close_reading(&r);
	mesh = only_mesh(&r, "o K\xC3\xB6rper\n" TRIANGLE "f 1 2 3\n");
	assert_string_equal(mesh->name, "K\xC3\xB6rper");
	close_reading(&r);
}

TEST(unused_statements_are_counted)
{
	reading r;
	only_mesh(&r,
		TRIANGLE "l 1 2 3\np 1\nl 1 \\\n2\nf 1 2\nf 1\nf\nvp 0 0\nwhatever 1 2 3\nother\nf 1 2 3\n");
	const struct {
		const char *detail;
		size_t count, line;
	} expected[] = {
		{"OBJ: vp", 1, 11},
		{"OBJ: unknown statement, the first is whatever", 2, 12},
	};
	assert_string_equal(r.scene.left_out.data, "faces of fewer than three corners (3), lines (2), points (1)");
	assert_int_equal(r.scene.left_out_count, 6);
	assert_int_equal(r.scene.left_out_line, 4);
	assert_int_equal(r.scene.findings.count, 2);
	for (size_t i = 0; i < 2; i++) {
		const nt_finding *finding = &r.scene.findings.items[i];
		assert_int_equal(finding->code, NT_CODE_STATEMENT_IGNORED);
		assert_string_equal(finding->detail, expected[i].detail);
		assert_int_equal(finding->count, expected[i].count);
		assert_int_equal(finding->place.line, expected[i].line);
	}
	close_reading(&r);
}

TEST(content_is_recognised)
{
	static const char *const yes[] = {"v 0 0 0\n", "# x\n\n  o a\n", "\xEF\xBB\xBF# x\r\nmtllib a.mtl\r\n",
		"f 1 2 3\n", "g\n", "s off\n"};
	static const char *const no[] = {"", "# only comments\n", "ply\nformat ascii 1.0\n", "{\"asset\": 1}",
		"newmtl a\n", "glTF", "v", "vertex 1 2 3\n", "\177ELF", "v\x01 0\n"};
	for (size_t i = 0; i < sizeof yes / sizeof yes[0]; i++)
		assert_true(nt_obj_recognise((const unsigned char *)yes[i], strlen(yes[i])));
	for (size_t i = 0; i < sizeof no / sizeof no[0]; i++)
		assert_false(nt_obj_recognise((const unsigned char *)no[i], strlen(no[i])));
	assert_false(nt_obj_recognise((const unsigned char *)"\0v 1 2 3\n", 9));
}
