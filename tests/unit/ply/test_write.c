/* SPDX-License-Identifier: MIT */
/*
 * The PLY writer on scenes whose results are set by hand, so that every byte of the output is known.
 */
#include "ext/number.h"
#include "fail_alloc.h"
#include "file/input.h"
#include "folder.h"
#include "ply/ply.h"
#include "ply_file.h"

#include <math.h>

static nt_status try_write(nt_scene *scene, bool bitangents, nt_error *error)
{
	const nt_write_options options = {.format = NT_FORMAT_PLY, .path = in_folder("out.ply"),
		.bitangents = bitangents};
	nt_output *output = NULL;
	nt_error_clear(error);
	nt_status status = nt_output_create(&output, NULL, error);
	if (!status)
		status = nt_ply_write(scene, &options, output, error);
	if (!status)
		return nt_output_commit(output, error);
	nt_output_abort(output);
	return status;
}

static nt_file write_scene(nt_scene *scene, bool bitangents)
{
	nt_error error;
	nt_file file;
	assert_int_equal(try_write(scene, bitangents, &error), NT_OK);
	assert_int_equal(nt_file_open(&file, in_folder("out.ply"), &error), NT_OK);
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

TEST(nothing_solved_gives_the_same_bytes)
{
	static const char text[] = "ply\r\nformat ascii 1.0 \nelement vertex 1\n" XYZ
		"end_header\n  1.000 2e0\t+3 \n\ntrailing\n";
	reading r;
	open_text(&r, text);
	assert_written(&r, true, text);
}

TEST(text_keeps_everything_and_gets_tangents)
{
	reading r;
	open_text(&r, "ply\ncomment first\nformat ascii 1.0\nobj_info kept\nelement extra 1\n"
		"property list int int numbers\nelement vertex 3\ncomment inside\n" UV
		"property double quality\n" XYZ "property list uchar int list\ncomment behind\n"
		"element face 1\nproperty uchar flags\n" LIST "property float area\nelement edge 1\n"
		"property int vertex1\nproperty int vertex2\nend_header\n"
		"2  7 8\n\n"
		"0.50 1.0000000001 1e-300 0 0 0 0 \n1 0 2 1 0.0 0 2 5 6\n\n0 1 3 0 1 0 1 9\n"
		"7 3 0 1 2 0.125\n0 1\n\nleft over\n");
	SET_SPLIT(&r, 0, NULL, 0, 1, 2);
	assert_written(&r, false, "ply\ncomment first\nformat ascii 1.0\nobj_info kept\n"
		"element extra 1\nproperty list int int numbers\nelement vertex 3\ncomment inside\n" UV
		"property double quality\n" XYZ "property list uchar int list\n" TANGENT
		"comment behind\nelement face 1\nproperty uchar flags\n" LIST
		"property float area\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
		"end_header\n"
		"2  7 8\n"
		"0.50 1.0000000001 1e-300 0 0 0 0 0 0 0 1\n1 0 2 1 0.0 0 2 5 6 1 0 0 1\n"
		"0 1 3 0 1 0 1 9 2 0 0 1\n"
		"7 3 0 1 2 0.125\n0 1\nleft over\n");
}

TEST(split_vertices_are_appended_with_all_properties)
{
	reading r;
	open_text(&r, "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\n"
		"property float y\r\nproperty float z\r\nproperty uchar flag\r\nelement face 2\r\n"
		"property int id\r\nproperty list uchar uint vertex_index\r\nproperty float area\r\n"
		"end_header\r\n0 0 0 10\r\n1 0 0 11\r\n1 1 0 12\r\n0 1 0 13\r\n"
		"100 3  0 1 2 .5\r\n101 3 0 2 3 .25\r\n");
	SET_SPLIT(&r, 2, SOURCES(0, 2), 0, 1, 2, 4, 5, 3);
	assert_written(&r, false, "ply\r\nformat ascii 1.0\r\nelement vertex 6\r\nproperty float x\r\n"
		"property float y\r\nproperty float z\r\nproperty uchar flag\r\nproperty float tx\r\n"
		"property float ty\r\nproperty float tz\r\nproperty float tw\r\nelement face 2\r\n"
		"property int id\r\nproperty list uchar uint vertex_index\r\nproperty float area\r\n"
		"end_header\r\n0 0 0 10 0 0 0 1\r\n1 0 0 11 1 0 0 1\r\n1 1 0 12 2 0 0 1\r\n"
		"0 1 0 13 3 0 0 1\r\n0 0 0 10 4 0 0 1\r\n1 1 0 12 5 0 0 1\r\n"
		"100 3 0 1 2 .5\r\n101 3 4 5 3 .25\r\n");
}

/* Keeps their place and type. */
TEST(old_tangents_and_bitangents_are_replaced)
{
	static const char *const input = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float tx\n"
		XYZ "property float bx\nproperty float by\nproperty float bz\n"
		"property double ty\nproperty float tz\nproperty float tw\n" NORMAL "element face 1\n" LIST
		"end_header\n9 0 0 0 9 9 9 9 9 -1 0 0 1\n9 1 0 0 9 9 9 9 9 -1 0 0 1\n"
		"9 0 1 0 9 9 9 9 9 -1 0 0 1\n3 0 1 2\n";
	reading r;
	open_text(&r, input);
	assert_true(r.scene.meshes->has_tangents);
	SET_SPLIT(&r, 0, NULL, 0, 1, 2);
	/* B = (0,0,1) x (k,0,0) = (0,k,0); -0 comes from 0 * 0 - 1 * 0 in x */
	assert_written(&r, false, "ply\nformat ascii 1.0\nelement vertex 3\nproperty float tx\n" XYZ BITANGENT
		"property double ty\nproperty float tz\nproperty float tw\n" NORMAL "element face 1\n" LIST
		"end_header\n0 0 0 0 0 0 0 0 0 1 0 0 1\n1 1 0 0 0 1 0 0 0 1 0 0 1\n"
		"2 0 1 0 0 2 0 0 0 1 0 0 1\n3 0 1 2\n");
}

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

TEST(floats_in_text_read_back_as_themselves)
{
	static const float values[] = {0.1f, 1.0f / 3.0f, 1e-45f, 3.4028235e38f, -16777217.0f, 1e10f,
		0.30000001f, -0.0f};
	char text[NT_FLOAT_TEXT];
	for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
		const char *end = nt_write_float(text, values[i]);
		float back;
		assert_true(end - text <= 15);
		assert_ptr_equal(nt_read_float(text, end, &back), end);
		assert_memory_equal(&back, &values[i], sizeof back);
	}
	assert_int_equal(nt_write_float(text, 0.1f) - text, 3);
	assert_memory_equal(text, "0.1", 3);
}

/* One row of the binary file: x, y, z, flag, and the tangent (k, 0, 0, 1). */
static void put_row(unsigned char *to, float x, unsigned char flag, float k, bool big)
{
	const float values[7] = {x, 2, 3, k, 0, 0, 1};
	for (size_t i = 0; i < 7; i++) {
		uint32_t bits;
		memcpy(&bits, &values[i], 4);
		unsigned char *at = to + 4 * i + (i > 2);
		for (size_t b = 0; b < 4; b++)
			at[b] = (unsigned char)(bits >> 8 * (big ? 3 - b : b));
	}
	to[12] = flag;
}

TEST(binary_files_keep_their_byte_order)
{
	for (int big = 0; big < 2; big++) {
		const char *order = big ? "big" : "little";
		char input[512], expected[512];
		int in = snprintf(input, sizeof input, "ply\nformat binary_%s_endian 1.0\nelement vertex 2\n"
			XYZ "property uchar flag\nelement face 1\nproperty list uchar ushort vertex_index\n"
			"end_header\n", order);
		int out = snprintf(expected, sizeof expected, "ply\nformat binary_%s_endian 1.0\n"
			"element vertex 3\n" XYZ "property uchar flag\n" TANGENT
			"element face 1\nproperty list uchar ushort vertex_index\nend_header\n", order);
		for (int row = 0; row < 3; row++) {
			unsigned char bytes[29];
			put_row(bytes, row == 1 ? 7 : 5, row == 1 ? 201 : 200, (float)row, big);
			if (row < 2)
				memcpy(input + in, bytes, 13);
			memcpy(expected + out, bytes, 29);
			in += row < 2 ? 13 : 0;
			out += 29;
		}
		memcpy(input + in, big ? "\3\0\0\0\1\0\0" : "\3\0\0\1\0\0\0", 7);
		memcpy(expected + out, big ? "\3\0\0\0\1\0\2" : "\3\0\0\1\0\2\0", 7);
		reading r;
		open_sound(&r, input, (size_t)in + 7);
		SET_SPLIT(&r, 1, SOURCES(0), 0, 1, 2);
		nt_file file = write_scene(&r.scene, false);
		assert_int_equal(file.size, out + 7);
		assert_memory_equal(file.data, expected, file.size);
		nt_file_close(&file);
		close_reading(&r);
	}
}

#define PENTAGON "0 0 0\n2 0 0\n2 2 0\n1 3 0\n0 2 0\n"

/* Which triangles the pentagon was cut into is taken from the mesh itself. */
TEST(polygons_stay_where_their_triangles_agree)
{
	reading r;
	open_text(&r, HEAD("5") "element face 3\n" LIST
		"property int id\nend_header\n" PENTAGON "2 0 1 7\n5 0 1 2 3 4 8\n4 0 1 2 4 9\n");
	uint32_t indices[13];
	memcpy(indices, r.scene.meshes->indices, sizeof indices);
	for (size_t c = 0; c < 9; c++) /* corner 3 of the pentagon gets the copy, in every triangle */
		indices[c] = indices[c] == 3 ? 5 : indices[c];
	set_split(&r, indices, SOURCES(3), 1);
	assert_ends(&r, NULL, "1 3 0 5 0 0 1\n2 0 1 7\n5 0 1 2 5 4 8\n4 0 1 2 4 9\n");
	assert_int_equal(count_findings(&r.scene, NT_CODE_POLYGON_CUT), 0);
	close_reading(&r);
}

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

/* Vertex 1 has two pairs of coordinates, so two vertices in the mesh; their tangents are equal. Vertex
 * 2 has two as well, and two tangents. */
TEST(wedges_stay_and_do_not_split_without_need)
{
	static const char *const head = "ply\nformat ascii 1.0\nelement vertex %d\n" XYZ "%selement face 2\n"
		LIST "property list uchar float texcoord\nend_header\n";
	char input[1024], expected[1024];
	int size = snprintf(input, sizeof input, head, 4, "");
	strcpy(input + size, "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2 6 0 0 1 0 0 1\n"
		"3 2 1 3 6 .5 .5 .7 .5 .9 .9\n");
	size = snprintf(expected, sizeof expected, head, 5, TANGENT);
	strcpy(expected + size, "0 0 0 0 0 0 1\n1 0 0 1 0 0 1\n0 1 0 2 0 0 1\n1 1 0 3 0 0 1\n"
		"0 1 0 4 0 0 1\n3 0 1 2 6 0 0 1 0 0 1\n3 4 1 3 6 .5 .5 .7 .5 .9 .9\n");
	reading r;
	open_text(&r, input);
	assert_int_equal(r.scene.meshes->vertex_count, 6);
	SET_SPLIT(&r, 0, NULL, 0, 1, 2, 4, 5, 3);
	plain_tangents[5][0] = 1.0f;
	assert_written(&r, false, expected);
}

/* Long enough for the tight loops of the reader, which stop elsewhere. */
TEST(many_faces_are_copied_as_they_are)
{
	char *text = malloc(20000), *p = text;
	p += sprintf(p, HEAD("3") "element face 100\n" LIST
		"element end 30\nproperty int last\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
	const char *const faces = p;
	uint32_t indices[300];
	for (int i = 0; i < 100; i++) {
		p += sprintf(p, "3 0 1 2\n");
		for (uint32_t k = 0; k < 3; k++)
			indices[3 * i + (int)k] = k;
	}
	for (int i = 0; i < 30; i++)
		p += sprintf(p, "12345\n");
	reading r;
	open_text(&r, text);
	set_split(&r, indices, NULL, 0);
	assert_ends(&r, NULL, faces);
	close_reading(&r);
	free(text);
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

TEST(faces_before_vertices_stay_there)
{
	reading r;
	open_text(&r, "ply\nformat ascii 1.0\nelement face 1\n" LIST "element vertex 3\n" XYZ
		"end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
	SET_SPLIT(&r, 1, SOURCES(0), 3, 1, 2);
	assert_written(&r, false, "ply\nformat ascii 1.0\nelement face 1\n" LIST "element vertex 4\n"
		XYZ TANGENT "end_header\n3 3 1 2\n0 0 0 0 0 0 1\n1 0 0 1 0 0 1\n0 1 0 2 0 0 1\n"
		"0 0 0 3 0 0 1\n");
}

TEST(elements_without_rows_stay_empty)
{
	reading r;
	open_text(&r, HEAD("3") "element none 0\nproperty int a\nelement face 1\n" LIST "element edge 0\n"
		"property int b\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
	SET_SPLIT(&r, 0, NULL, 0, 1, 2);
	assert_written(&r, false, HEAD("3") TANGENT "element none 0\nproperty int a\nelement face 1\n" LIST
		"element edge 0\nproperty int b\nend_header\n0 0 0 0 0 0 1\n1 0 0 1 0 0 1\n0 1 0 2 0 0 1\n3 0 1 2\n");
}

/* More than 64 copies of one row, whose tangents repeat: each tangent is one vertex. */
TEST(equal_copies_of_a_row_are_one_vertex)
{
	enum { COUNT = 200 };
	char *text = malloc(20000), *p = text;
	p += sprintf(p, HEAD("3") "element face %d\nproperty list uchar int vertex_indices\n"
		"property list uchar float texcoord\nend_header\n" POINTS, COUNT);
	for (int i = 0; i < COUNT; i++)
		p += sprintf(p, "3 0 1 2 6 %d 0 1 0 0 1\n", i);
	reading r;
	open_text(&r, text);
	assert_int_equal(r.mesh->vertex_count, 3 + COUNT - 1);
	uint32_t indices[3 * COUNT];
	memcpy(indices, r.mesh->indices, sizeof indices);
	set_split(&r, indices, NULL, 0);
	for (int i = 3; i < 3 + COUNT - 1; i++)
		plain_tangents[i][0] = (float)(100 + i % 100);
	reading back;
	write_and_read(&r.scene, false, &back);
	/* 3 rows and 100 tangents of copies */
	assert_non_null(memmem(back.bytes, back.scene.byte_count, "element vertex 103\n", 19));
	close_reading(&back);
	close_reading(&r);
	free(text);
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
	h->scene = (nt_scene){.format = NT_FORMAT_GLB, .meshes = &h->mesh, .mesh_count = 1,
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

TEST(quads_and_float_colors_are_kept)
{
	float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
	float colors[] = {0.3f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 1};
	uint8_t sizes[] = {4};
	nt_mesh mesh = {.name = "", .triangles = true, .vertex_count = 4, .positions = positions,
		.colors = colors, .face_count = 1, .corner_count = 4, .face_sizes = sizes};
	nt_instance instance = {.matrix = {[0] = -1, [5] = 1, [10] = 1, [15] = 1}};
	nt_scene scene = {.format = NT_FORMAT_OBJ, .meshes = &mesh, .mesh_count = 1,
		.instances = &instance, .instance_count = 1};
	reading back;
	write_and_read(&scene, true, &back);
	const uint32_t indices[] = {0, 3, 2, 1};
	assert_int_equal(back.mesh->face_sizes[0], 4);
	assert_memory_equal(back.mesh->indices, indices, sizeof indices);
	/* in between they are sRGB */
	for (size_t i = 0; i < sizeof colors / sizeof *colors; i++)
		assert_true(fabsf(back.mesh->colors[i] - colors[i]) <= 2e-7f * colors[i]);
	assert_false(back.mesh->has_normals || back.mesh->has_texcoords || back.mesh->has_tangents);
	close_reading(&back);
}

TEST(a_scene_without_faces_is_an_empty_mesh)
{
	nt_scene scene = {.format = NT_FORMAT_GLB};
	reading back;
	write_and_read(&scene, false, &back);
	assert_int_equal(back.mesh->vertex_count, 0);
	close_reading(&back);
}

TEST(every_allocation_may_fail)
{
	size_t n = 0;
	for (bool failed = true; failed; n++) {
		reading r;
		nt_error error;
		open_text(&r, cut_pentagon);
		uint32_t indices[12];
		memcpy(indices, r.scene.meshes->indices, sizeof indices);
		uint32_t source = indices[6];
		indices[6] = 8;
		set_split(&r, indices, &source, 1);
		fail_allocations_from(n);
		const nt_status status = try_write(&r.scene, false, &error);
		failed = stop_failing_allocations();
		assert_true(failed ? status == NT_ERROR_MEMORY || r.scene.findings.failed : !status);
		close_reading(&r);
	}
	assert_true(n > 10);
}

AROUND_EACH(make_folder, remove_folder)
