/* SPDX-License-Identifier: MIT */
/*
 * The PLY writer on meshes that are set by hand; tests/cli/texts.tsv and test_convert.sh have what it keeps of a PLY.
 */
#include "file/input.h"
#include "folder.h"
#include "ply/ply.h"
#include "ply_file.h"

#include <math.h>

static nt_file write_scene(nt_scene *scene, bool bitangents)
{
	const nt_write_options options = {.format = NT_FORMAT_PLY, .path = in_folder("out.ply"),
		.bitangents = bitangents};
	nt_output *output;
	nt_error error;
	nt_file file;
	assert_int_equal(nt_output_create(&output, NULL, &error), NT_OK);
	assert_int_equal(nt_ply_write(scene, &options, output, &error), NT_OK);
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	assert_int_equal(nt_file_open(&file, in_folder("out.ply"), NT_NAMED_BY_USER, &error), NT_OK);
	return file;
}

/* The same, read again. */
static void write_and_read(nt_scene *scene, bool bitangents, reading *back)
{
	nt_file file = write_scene(scene, bitangents);
	open_sound(back, file.data, file.size);
	nt_file_close(&file);
}

#define NORMAL "property float nx\nproperty float ny\nproperty float nz\n"
#define TANGENT "property float tx\nproperty float ty\nproperty float tz\nproperty float tw\n"
#define BITANGENT "property float bx\nproperty float by\nproperty float bz\n"
#define LIST "property list uchar int vertex_indices\n"

/* A mesh by hand, as a reader of glTF leaves it: v is -v, w for v up. */
typedef struct hand_made {
	nt_mesh mesh;
	nt_instance instances[2];
	nt_scene scene;
} hand_made;

static void make_gltf(hand_made *h)
{
	static float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
	static float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
	static float texcoords[] = {0, -1, 1, -1, 0, -0.25f};
	static float colors[] = {0, 1, 0, 1, 0, 0, 0, 1, 1, 1, 1, 1};
	colors[2] = (float)pow((51 / 255.0f + 0.055) / 1.055, 2.4); /* the linear light of a byte of 51 */
	static float tangents[] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
	static uint32_t indices[] = {0, 1, 2};
	*h = (hand_made){.mesh = {.name = "", .triangles = true, .vertex_count = 3, .face_count = 1,
		.corner_count = 3, .positions = positions, .normals = normals, .texcoords = texcoords,
		.colors = colors, .indices = indices}};
	h->mesh.split.vertex_tangents = tangents;
	h->mesh.split.indices = indices;
	h->instances[0].matrix[0] = h->instances[0].matrix[5] = 1;
	h->instances[0].matrix[10] = h->instances[0].matrix[15] = 1;
	/* x mirrored and doubled, y tripled, moved by 10 in x */
	h->instances[1].matrix[0] = -2;
	h->instances[1].matrix[5] = 3;
	h->instances[1].matrix[10] = 1;
	h->instances[1].matrix[12] = 10;
	h->instances[1].matrix[15] = 1;
	h->scene = (nt_scene){.format = NT_FORMAT_GLB, .path = "hand.glb", .meshes = &h->mesh, .mesh_count = 1,
		.instances = h->instances, .instance_count = 2};
}

TEST(other_scenes_are_written_in_world_space)
{
	hand_made h;
	make_gltf(&h);
	reading back;
	write_and_read(&h.scene, true, &back);
	nt_finding_list_free(&h.scene.findings);
	static const char head[] = "ply\nformat binary_little_endian 1.0\ncomment nmtan "
		NMTAN_VERSION_STRING "\nelement vertex 6\n" XYZ NORMAL "property uchar red\n"
		"property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\n"
		"property float t\n" TANGENT BITANGENT "element face 2\n" LIST "end_header\n";
	assert_true(back.scene.byte_count > strlen(head));
	assert_memory_equal(back.bytes, head, strlen(head));
	const nt_mesh *mesh = back.mesh;
	const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 10, 0, 0, 8, 0, 0, 10, 3, 0};
	const float texcoords[] = {0, 0, 1, 0, 0, 0.75f, 0, 0, 1, 0, 0, 0.75f};
	const uint32_t indices[] = {0, 1, 2, 3, 5, 4}; /* turned round */
	assert_memory_equal(mesh->positions, positions, sizeof positions);
	assert_memory_equal(mesh->texcoords, texcoords, sizeof texcoords);
	assert_memory_equal(mesh->indices, indices, sizeof indices);
	for (size_t v = 0; v < 6; v++) {
		assert_true(mesh->normals[3 * v + 2] == 1.0f);
		assert_true(mesh->tangents[4 * v] == (v < 3 ? 1.0f : -1.0f));
		assert_true(mesh->tangents[4 * v + 3] == (v < 3 ? 1.0f : -1.0f));
	}
	/* the mirrored bitangent, cross((0,0,1), (-1,0,0)) * -1 = (0,1,0), still runs along growing v */
	float b;
	memcpy(&b, back.bytes + strlen(head) + 3 * 64 + 56, 4);
	assert_true(b == 1.0f);
	assert_memory_equal(mesh->colors, h.mesh.colors, 3 * sizeof *mesh->colors);
	assert_memory_equal(back.bytes + strlen(head) + 6 * 4, "\x00\xff\x33\xff", 4);
	close_reading(&back);
}

/* A shear: the inverse transpose of (x + y, y, z) takes (1,0,0) to (1,-1,0) / sqrt 2, and the tangent
 * (0,1,0) to (1,1,0) / sqrt 2. */
TEST(normals_go_by_the_inverse_transpose)
{
	hand_made h;
	make_gltf(&h);
	float normals[] = {1, 0, 0, 1, 0, 0, 1, 0, 0}, tangents[] = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
	h.mesh.normals = normals;
	h.mesh.split.vertex_tangents = tangents;
	h.mesh.colors = NULL;
	h.instances[0].matrix[4] = 1;
	h.scene.instance_count = 1;
	reading back;
	write_and_read(&h.scene, false, &back);
	const float half = (float)sqrt(0.5);
	assert_true(back.mesh->normals[0] == half && back.mesh->normals[1] == -half);
	assert_true(fabsf(back.mesh->tangents[0] - half) < 1e-7f);
	assert_true(fabsf(back.mesh->tangents[1] - half) < 1e-7f);
	assert_true(back.mesh->tangents[3] == 1.0f);
	close_reading(&back);
}

/* Positions that float cannot hold come from the source, those of vertices behind its own too; and one colour that is
 * no byte makes all of them floats. */
TEST(doubles_and_colors_are_written_as_they_need)
{
	hand_made h;
	make_gltf(&h);
	float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0}, normals[12] = {0}, texcoords[8] = {0};
	float colors[16] = {0}, tangents[16] = {0};
	double exact[9] = {5e6 + 0.01, 0, 0, 5e6 + 1.02, 0, 0, 5e6, 1, 0};
	uint32_t sources[] = {1};
	colors[15] = 0.3f;
	h.mesh.positions = positions;
	h.mesh.normals = normals;
	h.mesh.texcoords = texcoords;
	h.mesh.colors = colors;
	h.mesh.split.vertex_tangents = tangents;
	h.mesh.vertex_count = 4;
	h.mesh.source_vertex_count = 3;
	h.mesh.vertex_sources = sources;
	h.mesh.exact_positions = exact;
	h.scene.origin[0] = 5e6;
	h.scene.instance_count = 1;
	nt_file file = write_scene(&h.scene, false);
	static const char types[] = "element vertex 4\nproperty double x\n";
	assert_non_null(memmem(file.data, file.size, types, strlen(types)));
	assert_non_null(memmem(file.data, file.size, "property float alpha\n", 21));
	const unsigned char *body = memmem(file.data, file.size, "end_header\n", 11);
	assert_non_null(body);
	/* doubles of 3 coordinates, then floats: 3 of a normal, 4 of a colour, 2 of u and v, 4 of a tangent */
	double x[4];
	for (size_t v = 0; v < 4; v++)
		memcpy(&x[v], body + 11 + v * (3 * 8 + 13 * 4), sizeof x[v]);
	assert_true(x[0] == exact[0] && x[1] == exact[3] && x[2] == exact[6] && x[3] == exact[3]);
	nt_file_close(&file);
	nt_finding_list_free(&h.scene.findings);
}

AROUND_EACH(make_folder, remove_folder)
