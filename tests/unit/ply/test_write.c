/* SPDX-License-Identifier: MIT */
/*
 * The PLY writer on scenes whose results are set by hand, so that every byte of the output is known.
 * tests/cli/test_convert.sh has what it keeps of a file.
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

static void assert_written(reading *r, bool bitangents, const char *expected)
{
	nt_file file = write_scene(&r->scene, bitangents);
	if (file.size != strlen(expected) || memcmp(file.data, expected, file.size) != 0)
		print_message("written:\n%.*s\nexpected:\n%s\n", (int)file.size, (const char *)file.data,
			expected);
	assert_int_equal(file.size, strlen(expected));
	assert_memory_equal(file.data, expected, file.size);
	nt_file_close(&file);
	close_reading(r);
}

/* The output has this line, if it is not NULL, and this end. */
static void assert_ends(reading *r, const char *line, const char *tail)
{
	nt_file file = write_scene(&r->scene, false);
	assert_true(!line || memmem(file.data, file.size, line, strlen(line)));
	assert_memory_equal(file.data + file.size - strlen(tail), tail, strlen(tail));
	nt_file_close(&file);
}

static size_t count_findings(const nt_scene *scene, nt_code code)
{
	size_t count = 0;
	for (size_t i = 0; i < scene->findings.count; i++)
		count += scene->findings.items[i].code == code ? scene->findings.items[i].count : 0;
	return count;
}

/* Tangents (k, 0, 0, 1) for vertex k: small, different and short as text. */
static float plain_tangents[300][4];

static void fill_tangents(void)
{
	for (int i = 0; i < 300; i++) {
		plain_tangents[i][0] = (float)i;
		plain_tangents[i][3] = 1.0f;
	}
}

static void set_split(reading *r, uint32_t *indices, uint32_t *sources, size_t source_count)
{
	fill_tangents();
	r->scene.meshes->split = (nt_split){.indices = indices, .sources = sources,
		.source_count = source_count, .vertex_tangents = plain_tangents[0]};
}

#define SET_SPLIT(r, source_count, sources, ...) \
	set_split(r, (uint32_t[]){__VA_ARGS__}, sources, source_count)
#define SOURCES(...) (uint32_t[]){__VA_ARGS__}

#define UV "property float s\nproperty float t\n"
#define NORMAL "property float nx\nproperty float ny\nproperty float nz\n"
#define TANGENT "property float tx\nproperty float ty\nproperty float tz\nproperty float tw\n"
#define BITANGENT "property float bx\nproperty float by\nproperty float bz\n"
#define LIST "property list uchar int vertex_indices\n"

/* Normals that are made take the type of those that are there: of char 1 is 127. Properties that stay keep their
 * bytes, and integers are no tangents. */
TEST(new_values_keep_place_and_type)
{
	static const char *const input = "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
		"property char nx\nproperty short ny\nproperty double nz\nproperty char tx\nproperty char ty\n"
		"property char tz\nproperty char tw\nelement face 1\n" LIST
		"end_header\n0 0 0 0 0 0 1 2 3 4\n1 0 0 0 0 1.50 1 2 3 4\n0 1 0 0 0 0 1 2 3 4\n3 0 1 2\n";
	reading r;
	open_text(&r, input);
	nt_mesh *mesh = r.scene.meshes;
	mesh->normals = (float[]){1, 0, 0, 0, 0, 1.5f, 0.6f, -0.8f, 0};
	mesh->normals_made = true;
	SET_SPLIT(&r, 0, NULL, 0, 1, 2);
	assert_written(&r, false, "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
		"property char nx\nproperty short ny\nproperty double nz\n" TANGENT "element face 1\n" LIST
		"end_header\n0 0 0 127 0 0 0 0 0 1\n1 0 0 0 0 1.50 1 0 0 1\n0 1 0 76 -26214 0 2 0 0 1\n3 0 1 2\n");
}

TEST(normals_that_were_made_are_written)
{
	reading r;
	open_text(&r, HEAD("3") "element face 1\n" LIST
		"end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
	/* vertex 1 was split by its normal: 3 is its copy; the tangent splits that again */
	nt_mesh *mesh = r.scene.meshes;
	mesh->vertex_count = 4;
	mesh->vertex_sources = SOURCES(1);
	mesh->normals = (float[]){0, 0, 1, 0, 1, 0, 0, 0, 1, 1, 0, 0};
	mesh->normals_made = true;
	SET_SPLIT(&r, 1, SOURCES(3), 0, 4, 2);
	assert_written(&r, true, HEAD("5") NORMAL TANGENT
		BITANGENT "element face 1\n" LIST "end_header\n"
		"0 0 0 0 0 1 0 0 0 1 0 0 0\n1 0 0 0 1 0 1 0 0 1 0 0 -1\n0 1 0 0 0 1 2 0 0 1 0 2 0\n"
		"1 0 0 1 0 0 3 0 0 1 0 0 0\n1 0 0 1 0 0 4 0 0 1 0 0 0\n3 0 4 2\n");
}

/* Two of the old ones are no normals; the reader would take them for the new ones. */
TEST(properties_of_a_name_that_is_written_all_go)
{
	reading r;
	open_text(&r, HEAD("3") UV "property float nx\nproperty float ny\n"
		"property float nx\nelement face 1\n" LIST "end_header\n"
		"0 0 0 0 0 nan 5 6\n1 0 0 1 0 nan 5 6\n1 1 0 1 1 nan 5 6\n3 0 1 2\n");
	nt_mesh *mesh = r.scene.meshes;
	assert_null(mesh->normals);
	mesh->normals = (float[]){0, 0, 1, 0, 0, 1, 0, 0, 1};
	mesh->normals_made = true;
	SET_SPLIT(&r, 0, NULL, 0, 1, 2);
	assert_written(&r, false, HEAD("3") UV NORMAL TANGENT
		"element face 1\n" LIST "end_header\n"
		"0 0 0 0 0 0 0 1 0 0 0 1\n1 0 0 1 0 0 0 1 1 0 0 1\n1 1 0 1 1 0 0 1 2 0 0 1\n3 0 1 2\n");
}

#define PENTAGON "0 0 0\n2 0 0\n2 2 0\n1 3 0\n0 2 0\n"

static const char cut_pentagon[] = HEAD("5") "element face 2\n"
	"property list uchar float texcoord\n" LIST "property int id\nend_header\n" PENTAGON
	"10 0 .0 1 .1 2 .2 3 .3 4 .4 5 0 1 2 3 4 8\n0 3 0 1 2 9\n";

TEST(polygons_whose_triangles_disagree_become_triangles)
{
	reading r;
	open_text(&r, cut_pentagon);
	const nt_mesh *mesh = r.scene.meshes;
	assert_int_equal(mesh->face_count, 4);
	/* the last face lacks coordinates: its vertices are copies 5, 6 and 7; and one more copy, 8, of
	 * the first corner of the pentagon's last triangle */
	uint32_t indices[12];
	memcpy(indices, mesh->indices, sizeof indices);
	const uint32_t shared = indices[6];
	indices[6] = 8;
	set_split(&r, indices, &(uint32_t){shared}, 1);
	reading back;
	write_and_read(&r.scene, false, &back);
	assert_int_equal(count_findings(&r.scene, NT_CODE_POLYGON_CUT), 1);
	const nt_mesh *written = back.mesh;
	assert_int_equal(written->face_count, 4);
	assert_null(written->face_polygon);
	assert_int_equal(written->corner_count, 12);
	for (size_t c = 0; c < 9; c++) {
		const float *position = written->positions + 3 * written->indices[c];
		const float *uv = written->texcoords + 2 * written->indices[c];
		const uint32_t row = c == 6 ? shared : indices[c];
		assert_memory_equal(position, mesh->positions + 3 * row, 3 * sizeof(float));
		assert_true(uv[0] == (float)row && uv[1] == (float)row / 10.0f);
		assert_true(written->tangents[4 * written->indices[c]] == (float)indices[c]);
	}
	assert_memory_equal(back.bytes + back.scene.byte_count - 15, " 8\n0 3 5 6 7 9\n", 15);
	close_reading(&back);
	close_reading(&r);
}

TEST(index_types_grow_with_the_vertices)
{
	char *text = malloc(100000), *p = text;
	p += sprintf(p, "ply\nformat ascii 1.0\nelement vertex 256\n" XYZ
		"element face 2\nproperty list uchar uchar vertex_index\nend_header\n");
	for (int i = 0; i < 256; i++)
		p += sprintf(p, "%d 0 0\n", i);
	strcpy(p, "3 0 1 255\n1 7\n");
	reading r;
	open_text(&r, text);
	SET_SPLIT(&r, 1, SOURCES(255), 0, 1, 256);
	assert_ends(&r, "\nproperty list uchar int vertex_index\n", "255 0 0 256 0 0 1\n3 0 1 256\n1 7\n");
	close_reading(&r);
	/* without the copy they fit */
	open_text(&r, text);
	SET_SPLIT(&r, 0, NULL, 0, 1, 255);
	assert_ends(&r, "\nproperty list uchar uchar vertex_index\n", "3 0 1 255\n1 7\n");
	close_reading(&r);
	free(text);
}

TEST(strips_stay_unless_vertices_split)
{
	static const char *const text = HEAD("4")
		"element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
		"0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n";
	reading r;
	open_text(&r, text);
	SET_SPLIT(&r, 0, NULL, 0, 1, 2, 2, 1, 3);
	assert_written(&r, false, HEAD("4") TANGENT
		"element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
		"0 0 0 0 0 0 1\n1 0 0 1 0 0 1\n0 1 0 2 0 0 1\n1 1 0 3 0 0 1\n4 0 1 2 3\n");
	open_text(&r, text);
	SET_SPLIT(&r, 1, SOURCES(2), 0, 1, 2, 4, 1, 3);
	assert_written(&r, false, HEAD("5") TANGENT
		"element face 2\n" LIST "end_header\n"
		"0 0 0 0 0 0 1\n1 0 0 1 0 0 1\n0 1 0 2 0 0 1\n1 1 0 3 0 0 1\n0 1 0 4 0 0 1\n"
		"3 0 1 2\n3 4 1 3\n");
}

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
