/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include <stdio.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include "ext/draco.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* A grid of (SIDE + 1)^2 points over a bumpy surface, with normals, texture coordinates, tangents whose w changes
 * in the middle, and joints. One face is degenerate, one point unused. */
enum { SIDE = 12, POINTS = (SIDE + 1) * (SIDE + 1) + 1, FACES = 2 * SIDE * SIDE + 1 };

typedef struct grid {
	float positions[POINTS][3], normals[POINTS][3], texcoords[POINTS][2], tangents[POINTS][4];
	uint16_t joints[POINTS][4];
	uint32_t indices[FACES][3];
	nt_draco_attribute attributes[5];
	nt_draco_mesh mesh;
} grid;

static void add_attribute(grid *g, nt_draco_kind kind, uint32_t id, int type, int components,
	int bits, const void *data)
{
	g->attributes[g->mesh.attribute_count++] = (nt_draco_attribute){.unique_id = id, .kind = kind,
		.component_type = type, .components = components, .quantization.bits = bits, .data = data};
}

static void make_grid(grid *g, nt_draco_method method, int bits)
{
	memset(g, 0, sizeof *g);
	for (int p = 0; p < POINTS; p++) {
		const int x = p % (SIDE + 1), y = p / (SIDE + 1);
		const float angle = 0.1f * (float)(x * y);
		g->positions[p][0] = (float)x * 0.37f;
		g->positions[p][1] = (float)y * 0.21f;
		g->positions[p][2] = sinf(angle);
		g->normals[p][1] = sinf(angle);
		g->normals[p][2] = cosf(angle);
		g->texcoords[p][0] = (float)x / SIDE;
		g->texcoords[p][1] = (float)y / SIDE;
		g->tangents[p][0] = cosf(angle);
		g->tangents[p][1] = sinf(angle);
		g->tangents[p][3] = x < SIDE / 2 ? 1 : -1;
		g->joints[p][0] = (uint16_t)(1000 * x);
	}
	uint32_t(*to)[3] = g->indices;
	for (uint32_t y = 0; y < SIDE; y++)
		for (uint32_t x = 0; x < SIDE; x++) {
			const uint32_t a = y * (SIDE + 1) + x, b = a + SIDE + 1;
			const uint32_t two[2][3] = {{a, a + 1, b + 1}, {a, b + 1, b}};
			memcpy(to, two, sizeof two);
			to += 2;
		}
	(*to)[0] = (*to)[1] = 5;
	g->mesh = (nt_draco_mesh){.method = method, .point_count = POINTS, .face_count = FACES,
		.indices = &g->indices[0][0], .attributes = g->attributes};
	add_attribute(g, NT_DRACO_POSITION, 0, NT_GLTF_FLOAT, 3, bits, g->positions);
	add_attribute(g, NT_DRACO_NORMAL, 1, NT_GLTF_FLOAT, 3, bits, g->normals);
	add_attribute(g, NT_DRACO_TEXCOORD, 2, NT_GLTF_FLOAT, 2, bits, g->texcoords);
	add_attribute(g, NT_DRACO_GENERIC, 7, NT_GLTF_FLOAT, 4, bits, g->tangents);
	add_attribute(g, NT_DRACO_GENERIC, 9, NT_GLTF_USHORT, 4, 0, g->joints);
}

static nt_draco_block encoded(const nt_draco_mesh *mesh)
{
	nt_draco_block block;
	nt_error error;
	const nt_status status = nt_draco_encode(mesh, &block, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
	return block;
}

static nt_draco *decoded(const nt_draco_block *block)
{
	nt_draco *result;
	nt_error error;
	const nt_status status = nt_draco_decode(&result, block->bytes, block->size, 0, &error);
	if (status != NT_OK)
		fail_msg("%s", error.message);
	return result;
}

/* A grid with a -0 that was encoded and decoded. */
typedef struct coded {
	grid g;
	nt_draco_block block;
	nt_draco *result;
	const nt_draco_mesh *mesh;
} coded;

static void code_grid(coded *c, nt_draco_method method, int bits)
{
	make_grid(&c->g, method, bits);
	c->g.positions[SIDE / 2][2] = -0.0f;
	c->block = encoded(&c->g.mesh);
	c->result = decoded(&c->block);
	c->mesh = &c->result->mesh;
}

static void end_coded(coded *c)
{
	nt_draco_free(c->result);
	nt_draco_block_free(&c->block);
}

TEST(sequential_without_quantization_is_exact)
{
	coded c;
	code_grid(&c, NT_DRACO_SEQUENTIAL, 0);
	assert_int_equal(c.block.point_count, POINTS - 1); /* the last one is not used */
	assert_int_equal(c.block.face_count, FACES);       /* the degenerate one stays */
	assert_int_equal(c.block.sources[POINTS - 2], POINTS - 2);
	assert_int_equal(c.mesh->method, NT_DRACO_SEQUENTIAL);
	assert_memory_equal(c.mesh->indices, c.g.indices, sizeof c.g.indices);
	for (size_t i = 0; i < 5; i++) {
		const nt_draco_attribute *a = &c.g.attributes[i];
		const size_t width = nt_component_size(a->component_type) * (size_t)a->components;
		assert_memory_equal(nt_draco_find(c.mesh, a->unique_id)->data, a->data, width * (POINTS - 1));
	}
	assert_int_equal(nt_draco_find(c.mesh, 9)->component_type, NT_GLTF_USHORT);
	assert_int_equal(nt_draco_find(c.mesh, 9)->components, 4);
	assert_null(nt_draco_find(c.mesh, 3));
	end_coded(&c);
}

/* Largest angle between tangents, in degrees; w must be exact. */
static double tangent_error(const float (*tangents)[4], const float *back, size_t count)
{
	double worst = 0;
	for (size_t p = 0; p < count; p++) {
		const float *a = tangents[p], *b = back + 4 * p;
		assert_true(b[3] == a[3]);
		const double cross[3] = {(double)a[1] * b[2] - (double)a[2] * b[1],
			(double)a[2] * b[0] - (double)a[0] * b[2], (double)a[0] * b[1] - (double)a[1] * b[0]};
		const double sine = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
		worst = fmax(worst, asin(fmin(sine, 1)) * 180 / 3.14159265358979);
	}
	return worst;
}

TEST(twelve_bits_keep_tangents_and_their_sign)
{
	coded c;
	code_grid(&c, NT_DRACO_SEQUENTIAL, 12);
	const nt_draco_attribute *tangents = nt_draco_find(c.mesh, 7);
	assert_int_equal(tangents->quantization.bits, 12);
	/* the box is [-1, 1]: half a step is 1/4095 in each of three coordinates, 0.0242 degrees */
	assert_true(tangent_error(c.g.tangents, tangents->data, POINTS - 1) < 0.0243);
	const nt_draco_attribute *normals = nt_draco_find(c.mesh, 1);
	assert_true(normals->quantization.octahedral);
	assert_int_equal(normals->quantization.bits, 12);
	assert_int_equal(normals->component_type, NT_GLTF_FLOAT);
	assert_int_equal(normals->components, 3);
	end_coded(&c);
}

/* The value of an integer n: n * step, rounded, plus the box's origin, rounded, on every machine. */
TEST(floats_are_multiplied_then_added)
{
	static const uint32_t ids[] = {0, 2, 7};
	size_t differ = 0; /* from what one rounding gives */
	for (int bits = 12; bits <= 16; bits++) {
		coded c;
		code_grid(&c, NT_DRACO_SEQUENTIAL, bits);
		for (size_t i = 0; i < COUNT(ids); i++) {
			const nt_draco_attribute *a = nt_draco_find(c.mesh, ids[i]);
			const float step = a->quantization.range / (float)((1 << bits) - 1);
			const float *values = a->data;
			for (size_t k = 0; k < (POINTS - 1) * (size_t)a->components; k++) {
				const float origin = a->quantization.origin[k % (size_t)a->components];
				const float n = (float)round(((double)values[k] - origin) / step);
				assert_true(values[k] == n * step + origin);
				differ += values[k] != fmaf(n, step, origin);
			}
		}
		end_coded(&c);
	}
	assert_true(differ > 100);
}

TEST(second_encoding_in_the_same_box_moves_nothing)
{
	grid g;
	make_grid(&g, NT_DRACO_SEQUENTIAL, 11);
	nt_draco_block first = encoded(&g.mesh);
	nt_draco *once = decoded(&first);
	const nt_draco_mesh *mesh = &once->mesh;
	/* origin and range came with the data: the box of the positions */
	const nt_draco_quantization *box = &nt_draco_find(mesh, 0)->quantization;
	assert_true(box->explicit_box);
	assert_true(box->origin[0] == 0 && box->origin[1] == 0);
	assert_true(box->range == g.positions[SIDE][0]);

	/* half of the faces: their own box is another one */
	nt_draco_mesh half = *mesh;
	half.face_count /= 2;
	nt_draco_block second = encoded(&half);
	nt_draco *twice = decoded(&second);
	for (uint32_t id = 0; id <= 7; id++) {
		const nt_draco_attribute *a = nt_draco_find(mesh, id);
		const nt_draco_attribute *b = nt_draco_find(&twice->mesh, id);
		if (!a || a->quantization.octahedral)
			continue;
		const size_t width = 4 * (size_t)a->components;
		for (size_t p = 0; p < second.point_count; p++)
			assert_memory_equal((const char *)b->data + p * width,
				(const char *)a->data + second.sources[p] * width, width);
	}
	nt_draco_free(once);
	nt_draco_free(twice);
	nt_draco_block_free(&first);
	nt_draco_block_free(&second);
}

TEST(edgebreaker_keeps_every_sound_face)
{
	for (int bits = 0; bits <= 14; bits += 7) {
		coded c;
		code_grid(&c, NT_DRACO_EDGEBREAKER, bits); /* which compares the set of faces */
		assert_int_equal(c.block.face_count, FACES - 1);
		assert_null(c.block.sources);
		assert_int_equal(c.mesh->method, NT_DRACO_EDGEBREAKER);
		assert_int_equal(c.mesh->point_count, POINTS - 1);
		end_coded(&c);
	}
}

TEST(non_manifold_meshes_survive_edgebreaker)
{
	static const float positions[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {9, 9, 9},
		{9, 8, 9}, {8, 9, 9}};
	/* three faces on one edge, one of them twice, and one apart */
	static const uint32_t indices[] = {0, 1, 2, 0, 1, 3, 1, 0, 4, 0, 1, 2, 5, 6, 7};
	const nt_draco_attribute position = {.component_type = NT_GLTF_FLOAT, .components = 3, .data = positions};
	const nt_draco_mesh mesh = {.method = NT_DRACO_EDGEBREAKER, .point_count = 8, .face_count = 5,
		.indices = indices, .attributes = &position, .attribute_count = 1};
	nt_draco_block block = encoded(&mesh);
	assert_int_equal(block.face_count, 5);
	nt_draco_block_free(&block);
}

/* The grid's last points told as copies: the block is that of points which have the same values of their own. */
TEST(copied_points_have_the_values_of_others)
{
	for (int method = NT_DRACO_SEQUENTIAL; method <= NT_DRACO_EDGEBREAKER; method++) {
		enum { OWN = POINTS - 20 };
		uint32_t copied[POINTS - OWN];
		grid g, told;
		make_grid(&g, (nt_draco_method)method, 11);
		for (size_t i = 0; i < 3 * FACES; i++) /* no face has point 20: those behind it get other numbers */
			(&g.indices[0][0])[i] += (&g.indices[0][0])[i] == 20;
		for (uint32_t p = OWN; p < POINTS; p++) {
			const uint32_t from = copied[p - OWN] = p % 7 * 10;
			memcpy(g.normals[p], g.normals[from], sizeof *g.normals);
			memcpy(g.texcoords[p], g.texcoords[from], sizeof *g.texcoords);
			memcpy(g.joints[p], g.joints[from], sizeof *g.joints);
		}
		told = g;
		told.mesh.attributes = told.attributes;
		memset(told.normals[OWN], 0x7F, 20 * sizeof *told.normals);
		memset(told.texcoords[OWN], 0x7F, 20 * sizeof *told.texcoords);
		memset(told.joints[OWN], 0x7F, 20 * sizeof *told.joints);
		told.attributes[1].data = told.normals;
		told.attributes[2].data = told.texcoords;
		told.attributes[4].data = told.joints;
		for (int i = 1; i < 5; i++)
			if (i != 3) { /* positions and tangents are all their own */
				told.attributes[i].copied = copied;
				told.attributes[i].own_count = OWN;
			}
		nt_draco_block block = encoded(&g.mesh), same = encoded(&told.mesh);
		assert_int_equal(block.size, same.size);
		assert_memory_equal(block.bytes, same.bytes, block.size);
		nt_draco_block_free(&block);
		nt_draco_block_free(&same);
	}
}

/* Three points for each face: equal ones become one again. */
TEST(equal_points_are_joined_by_edgebreaker)
{
	enum { SOUP = 3 * (FACES - 1) };
	grid g;
	make_grid(&g, NT_DRACO_EDGEBREAKER, 0);
	static float positions[SOUP][3], texcoords[SOUP][2];
	static uint32_t indices[SOUP];
	for (uint32_t c = 0; c < SOUP; c++) {
		const uint32_t p = g.indices[c / 3][c % 3];
		memcpy(positions[c], g.positions[p], sizeof *positions);
		memcpy(texcoords[c], g.texcoords[p], sizeof *texcoords);
		texcoords[c][0] = fabsf(texcoords[c][0] - 0.5f); /* neither kind of value is a point's alone */
		positions[c][0] = 0.37f * (float)(p % (SIDE + 1) % 7);
		positions[c][1] = (float)(p / (SIDE + 1));
		indices[c] = c;
	}
	const nt_draco_attribute attributes[] = {
		{.kind = NT_DRACO_POSITION, .component_type = NT_GLTF_FLOAT, .components = 3, .data = positions},
		{.unique_id = 1, .kind = NT_DRACO_TEXCOORD, .component_type = NT_GLTF_FLOAT, .components = 2,
			.data = texcoords}};
	const nt_draco_mesh mesh = {.method = NT_DRACO_EDGEBREAKER, .point_count = SOUP, .face_count = FACES - 1,
		.indices = indices, .attributes = attributes, .attribute_count = 2};
	size_t distinct = 0;
	for (size_t c = 0; c < SOUP; c++) {
		size_t first = 0;
		while (memcmp(positions[first], positions[c], sizeof *positions) != 0 ||
			memcmp(texcoords[first], texcoords[c], sizeof *texcoords) != 0)
			first++;
		distinct += first == c;
	}
	nt_draco_block block = encoded(&mesh);
	assert_true(distinct < SOUP / 2);
	assert_int_equal(block.point_count, distinct);
	nt_draco_block_free(&block);
}

/* The extremes of what a decoder gives back. */
TEST(bounds_are_those_of_the_decoded_values)
{
	coded c;
	code_grid(&c, NT_DRACO_EDGEBREAKER, 9);
	for (size_t i = 0; i < 4; i++) {
		const nt_draco_attribute *a = nt_draco_find(c.mesh, c.g.attributes[i].unique_id);
		for (int k = 0; k < a->components; k++) {
			float least = INFINITY, most = -INFINITY;
			for (size_t p = 0; p < c.block.point_count; p++) {
				const float value = ((const float *)a->data)[p * (size_t)a->components + (size_t)k];
				least = fminf(least, value);
				most = fmaxf(most, value);
			}
			assert_true(c.block.bounds[i][0][k] == least && c.block.bounds[i][1][k] == most);
		}
	}
	end_coded(&c);
}

/* The attributes 0 to 2 of a mesh; values: room for each. */
static nt_status quantize_grid(const grid *g, float (*values)[3 * POINTS])
{
	nt_draco_mesh three = g->mesh;
	three.attribute_count = 3;
	float *const to[] = {values[0], values[1], values[2]};
	nt_error error;
	return nt_draco_quantize(&three, to, &error);
}

TEST(quantized_values_are_those_that_are_decoded)
{
	for (int bits = 4; bits <= 14; bits += 5) {
		grid g;
		make_grid(&g, NT_DRACO_SEQUENTIAL, bits);
		/* the last point is the unused one */
		g.positions[POINTS - 1][0] = 1000;
		static float values[3][3 * POINTS];
		assert_int_equal(quantize_grid(&g, values), NT_OK);
		assert_true(values[0][3 * (POINTS - 1)] == 1000);
		/* nowhere further than half a cell */
		const float cell = g.positions[SIDE][0] / (float)((1 << bits) - 1);
		for (int i = 0; i < 3 * (POINTS - 1); i++)
			assert_true(fabsf(values[0][i] - g.positions[i / 3][i % 3]) <= 0.5001f * cell);

		/* with all attributes, and by another function of the library */
		nt_draco_block block = encoded(&g.mesh);
		nt_draco *result = decoded(&block);
		for (uint32_t i = 0; i < 3; i++) {
			const nt_draco_attribute *a = nt_draco_find(&result->mesh, i);
			const size_t width = (size_t)a->components;
			for (size_t p = 0; p < block.point_count; p++)
				assert_memory_equal((const float *)a->data + width * p,
					values[i] + width * block.sources[p], width * sizeof(float));
		}
		nt_draco_free(result);
		nt_draco_block_free(&block);

		/* in place, and what is refused */
		float *const own[] = {g.positions[0], g.normals[0], g.texcoords[0]};
		nt_draco_mesh three = g.mesh;
		three.attribute_count = 3;
		nt_error error;
		assert_int_equal(nt_draco_quantize(&three, own, &error), NT_OK);
		assert_memory_equal(g.positions, values[0], sizeof g.positions);
		assert_memory_equal(g.texcoords, values[2], sizeof g.texcoords);
		g.texcoords[3][0] = INFINITY;
		assert_int_equal(quantize_grid(&g, values), NT_ERROR_ARGUMENT);
		g.texcoords[3][0] = 0;
		g.indices[3][0] = POINTS;
		assert_int_equal(quantize_grid(&g, values), NT_ERROR_INDEX);
	}
}

/* message: what an error says, among other words. */
static void encoding_ends(const grid *g, nt_status expected, const char *message)
{
	nt_draco_block block;
	nt_error error;
	assert_int_equal(nt_draco_encode(&g->mesh, &block, &error), expected);
	assert_true((expected == NT_OK) == (block.bytes != NULL));
	assert_true(expected == NT_OK || strstr(error.message, message));
	nt_draco_block_free(&block);
}

TEST(what_cannot_be_encoded_is_refused)
{
	grid g;
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	g.tangents[3][2] = NAN;
	encoding_ends(&g, NT_ERROR_ARGUMENT, "point 3 in attribute 7");
	g.attributes[3].quantization.bits = 0; /* as it is, it may be anything */
	encoding_ends(&g, NT_OK, "");

	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	g.indices[7][1] = POINTS;
	encoding_ends(&g, NT_ERROR_INDEX, "");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 25);
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	g.positions[2][0] = 3e38f;
	encoding_ends(&g, NT_OK, "");
	g.positions[3][0] = -3e38f; /* the range is infinite */
	encoding_ends(&g, NT_ERROR_ARGUMENT, "attribute 0");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	for (int p = 0; p < POINTS; p++)
		memset(g.texcoords[p], 0, sizeof g.texcoords[p]);
	encoding_ends(&g, NT_OK, "");
	g.texcoords[7][1] = 1e-40f; /* cells in one unit: more than a float holds */
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	/* the coder's table would have 2^32 rows, and has none */
	uint32_t large[4 * POINTS] = {0};
	g.attributes[4].component_type = NT_GLTF_UINT;
	g.attributes[4].data = large;
	large[5] = 1u << 24;
	encoding_ends(&g, NT_OK, "");
	large[5]++;
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	large[5] = UINT32_MAX;
	encoding_ends(&g, NT_ERROR_ARGUMENT, "24 bits");
	g.attributes[4].component_type = NT_GLTF_INT; /* -1 */
	encoding_ends(&g, NT_OK, "");
	large[5] = (uint32_t)-(1 << 24) - 1;
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	g.attributes[4].quantization.bits = 8; /* integers */
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	make_grid(&g, NT_DRACO_SEQUENTIAL, 12);
	g.attributes[0].quantization.explicit_box = true;
	g.attributes[0].quantization.range = 1; /* positions reach 4.4 */
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	g.mesh.face_count = 0;
	encoding_ends(&g, NT_ERROR_INPUT, "");
	make_grid(&g, NT_DRACO_EDGEBREAKER, 12);
	g.attributes[1].kind = NT_DRACO_POSITION; /* a second one */
	encoding_ends(&g, NT_ERROR_ARGUMENT, "2 attributes of positions");
	g.attributes[0].kind = g.attributes[1].kind = NT_DRACO_GENERIC;
	encoding_ends(&g, NT_ERROR_ARGUMENT, "");
	make_grid(&g, NT_DRACO_EDGEBREAKER, 12);
	memset(g.indices, 0, sizeof g.indices); /* nothing but degenerate faces */
	encoding_ends(&g, NT_ERROR_INPUT, "");
}

static nt_status decode_status(const unsigned char *bytes, size_t size, size_t max_faces,
	nt_error *error)
{
	nt_draco *result;
	const nt_status status = nt_draco_decode(&result, bytes, size, max_faces, error);
	assert_true((status == NT_OK) == (result != NULL));
	nt_draco_free(result);
	return status;
}

TEST(damaged_streams_are_refused)
{
	nt_error error;
	static const struct {
		const char *bytes;
		size_t size;
		nt_status status;
	} rows[] = {{"", 0, NT_ERROR_INPUT}, {"DRACO\2\2\1\1\0\0", 11, NT_ERROR_INPUT},
		{"DRACO\2\3\0\1\0\0", 11, NT_ERROR_UNSUPPORTED}, /* a point cloud */
		{"DRACO\2\2\1\0\0\0\xff\xff\xff\xff\xff\1\3\1", 19, NT_ERROR_INPUT}, /* 36 bits */
		/* 2^31 faces in a few bytes: sequential, faces and points as variable numbers */
		{"DRACO\2\2\1\0\0\0\x80\x80\x80\x80\x08\x03\1", 18, NT_ERROR_TOO_LARGE}};
	for (size_t i = 0; i < COUNT(rows); i++)
		assert_int_equal(decode_status((const unsigned char *)rows[i].bytes, rows[i].size, 0, &error),
			rows[i].status);
	assert_non_null(strstr(error.message, "2147483648 faces"));

	grid g;
	make_grid(&g, NT_DRACO_EDGEBREAKER, 12);
	nt_draco_block block = encoded(&g.mesh);
	assert_int_equal(decode_status(block.bytes, block.size, FACES - 1, &error), NT_OK);
	assert_int_equal(decode_status(block.bytes, block.size, FACES - 2, &error),
		NT_ERROR_TOO_LARGE);
	for (size_t size = 0; size < block.size; size += 7) {
		assert_int_equal(decode_status(block.bytes, size, 0, &error), NT_ERROR_INPUT);
		assert_true(error.place.offset <= size); /* how far the decoder came */
	}
	nt_draco_block_free(&block);
}

/* xorshift32: the same mutations everywhere. */
static uint32_t random_bits(uint32_t *state)
{
	*state ^= *state << 13;
	*state ^= *state >> 17;
	return *state ^= *state << 5;
}

/* A block that decodes must have sound indices and values, which a sum over everything touches. */
static void touch(const nt_draco_mesh *mesh)
{
	unsigned sum = 0;
	for (size_t i = 0; i < 3 * mesh->face_count; i++)
		assert_true(mesh->indices[i] < mesh->point_count);
	for (size_t i = 0; i < mesh->attribute_count; i++) {
		const nt_draco_attribute *a = &mesh->attributes[i];
		const size_t size = nt_component_size(a->component_type) * (size_t)a->components;
		const unsigned char *bytes = a->data;
		for (size_t k = 0; k < size * mesh->point_count; k++)
			sum += bytes[k];
	}
	assert_true(sum < UINT32_MAX);
}

static size_t mutate(const unsigned char *bytes, size_t size, unsigned count, uint32_t *seed,
	size_t max_faces)
{
	unsigned char *copy = malloc(size);
	size_t good = 0;
	for (unsigned i = 0; i < count; i++) {
		memcpy(copy, bytes, size);
		for (uint32_t k = random_bits(seed) % 3; k < 3; k++)
			copy[11 + random_bits(seed) % (size - 11)] ^= (unsigned char)(1 << random_bits(seed) % 8);
		nt_draco *result;
		nt_error error;
		if (nt_draco_decode(&result, copy, size, max_faces, &error) == NT_OK) {
			touch(&result->mesh);
			good++;
		}
		nt_draco_free(result);
	}
	free(copy);
	return good;
}

/* Metadata of an attribute, which has a child, and of the mesh stand between the head and the connectivity. */
TEST(metadata_is_read_over)
{
	static const unsigned char notes[] = {1, 7, 1, 1, 'a', 2, 'x', 'y', 1, 1, 'b', 0, 0, 1, 1, 'c', 1, 'z', 0};
	enum { HEAD = 11, DEPTH = 120 };
	grid g;
	make_grid(&g, NT_DRACO_EDGEBREAKER, 0);
	nt_draco_block plain = encoded(&g.mesh);
	unsigned char *bytes = malloc(plain.size + 3 * DEPTH + 3 + sizeof notes);
	memcpy(bytes, plain.bytes, HEAD);
	bytes[HEAD - 1] |= 0x80;
	nt_error error;
	nt_draco *made;
	memcpy(bytes + HEAD, notes, sizeof notes);
	for (size_t cut = 0; cut <= sizeof notes; cut++)
		assert_int_equal(nt_draco_decode(&made, bytes, HEAD + cut, 0, &error), NT_ERROR_INPUT);
	memcpy(bytes + HEAD + sizeof notes, plain.bytes + HEAD, plain.size - HEAD);
	assert_int_equal(nt_draco_decode(&made, bytes, plain.size + sizeof notes, 0, &error), NT_OK);
	assert_int_equal(made->mesh.face_count, FACES - 1);
	nt_draco_free(made);
	/* children of children, each with a name of no letters */
	size_t size = HEAD;
	bytes[size++] = 0;
	for (int i = 0; i < DEPTH; i++)
		memcpy(bytes + size + 3 * i, "\0\1", 3);
	size += 3 * DEPTH;
	memcpy(bytes + size, "\0\0", 2);
	memcpy(bytes + size + 2, plain.bytes + HEAD, plain.size - HEAD);
	size += 2 + plain.size - HEAD;
	assert_int_equal(nt_draco_decode(&made, bytes, size, 0, &error), NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "its head is cut off"));
	free(bytes);
	nt_draco_block_free(&plain);
}

/* Sanitizers need memory of their own. */
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/* The peak of a process of its own that encodes so many faces and attributes of a mesh. */
static size_t peak_of(nt_draco_mesh mesh, size_t face_count, size_t attribute_count)
{
	int status;
	struct rusage usage;
	const pid_t child = fork();
	assert_true(child >= 0);
	if (child == 0) {
		prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
		mesh.face_count = face_count;
		mesh.attribute_count = attribute_count;
		encoded(&mesh);
		_exit(0);
	}
	assert_int_equal(wait4(child, &status, 0, &usage), child);
	assert_int_equal(status, 0);
	return (size_t)usage.ru_maxrss * 1024;
}

/* As few attributes as glTF wants, or as many as it has names for, over a grid: its vertices are shared, or all corners
 * differ. */
TEST(the_bound_of_the_memory_for_encoding_holds)
{
	enum { ROW = 64, CORNERS = 6 * (ROW - 1) * (ROW - 1), MOST = 30, VALUES = 4 * CORNERS + MOST };
	static float values[VALUES];
	static uint32_t integers[VALUES], indices[2][CORNERS];
	static const struct {
		nt_draco_attribute others;
		size_t count;
	} rows[] = {{{.components = 1}, 1}, {{.component_type = NT_GLTF_FLOAT, .components = 4}, 4},
		{{.component_type = NT_GLTF_FLOAT, .components = 4, .quantization.bits = 12}, MOST},
		{{.component_type = NT_GLTF_UBYTE, .components = 1}, MOST},
		{{.component_type = NT_GLTF_UINT, .components = 2}, 2}};
	for (uint32_t i = 0, seed = 1; i < VALUES; i++) {
		integers[i] = (seed = seed * 1664525 + 1013904223) >> 8; /* 24 bits are the most that are encoded */
		values[i] = (float)integers[i];
	}
	for (uint32_t c = 0; c < CORNERS; c++) {
		static const uint32_t quad[] = {0, 1, ROW, 1, ROW + 1, ROW};
		indices[0][c] = c / 6 / (ROW - 1) * ROW + c / 6 % (ROW - 1) + quad[c % 6];
		indices[1][c] = c;
	}
	for (size_t i = 0; i < 4 * COUNT(rows); i++) {
		nt_draco_attribute attributes[MOST];
		const size_t own = i / 2 % 2, count = rows[i / 4].count;
		for (size_t k = 0; k < count; k++) {
			attributes[k] = rows[i / 4].others;
			attributes[k].unique_id = (uint32_t)k;
			attributes[k].kind = NT_DRACO_GENERIC;
			attributes[k].data = attributes[k].component_type == NT_GLTF_FLOAT ? (const void *)(values + k)
				: integers + k;
		}
		attributes[0] = (nt_draco_attribute){.component_type = NT_GLTF_FLOAT, .components = 3,
			.quantization.bits = 14, .data = values};
		const nt_draco_mesh mesh = {.method = (nt_draco_method)(i % 2), .face_count = CORNERS / 3, .speed = 5,
			.point_count = own ? CORNERS : ROW * ROW, .indices = indices[own],
			.attributes = attributes, .attribute_count = count};
		const uint64_t bound = nt_draco_encoding_bytes(&mesh);
		size_t peak = SIZE_MAX;
		/* Linux adds pages up in batches for each processor: one run may seem to take more, or less */
		for (int try = 0; try < 4 && (bound < peak || bound > 2 * peak + (1 << 20)); try++)
			peak = peak_of(mesh, mesh.face_count, count) - peak_of(mesh, 2, 1);
		print_message("%zu: %zu bytes, the bound is %.2f of it\n", i, peak, (double)bound / (double)peak);
		assert_in_range(bound, peak, 2 * peak + (1 << 20));
	}
}

#endif

TEST(mutated_streams_do_no_harm)
{
	uint32_t seed = 2463534242u;
	size_t good = 0;
	for (int method = 0; method < 2; method++)
		for (int bits = 0; bits <= 12; bits += 12) {
			grid g;
			make_grid(&g, (nt_draco_method)method, bits);
			nt_draco_block block = encoded(&g.mesh);
			good += mutate(block.bytes, block.size, 150, &seed, 4 * FACES);
			nt_draco_block_free(&block);
		}
	assert_true(good > 20); /* else the mutations never come as far as the geometry */
}
