/* SPDX-License-Identifier: MIT */
/*
 * Complex vertices of the fast path, complex*.c, against the definition: directions that are antiparallel or nearly so,
 * and hubs.
 */
#include "test.h"
#include <math.h>
#include "definition.h"

/* Around a vertex three triangles of a square, from (-1, -1) counterclockwise, with u = x and directions of u
 * (1 - k, 1 + k), (1, 0) and (1 - k, -1 - k), k = 1 - 2^-bits. The directions of v are (0, 1). The product of the
 * first and the last is 2^(-2 bits - 1) above -1: step 7 parts them from 12 bits on, where that is 2^-25, half the
 * distance of floats below 1, or less. `turn` exchanges axes. Returns whether the vertex has two results at least. */
static bool compare_wide_fan(int bits, int turn, bool middle_first, size_t *differences)
{
	const float k = 1.0f - ldexpf(1.0f, -bits);
	const float x[5] = {0, -1, 1, 1, -1}, y[5] = {0, -1, -1, 1, 1}, v[5] = {0, k, -1, 1, -k};
	float p[5][3] = {{0}}, n[5][3] = {{0}}, t[5][2];
	for (int i = 0; i < 5; i++) {
		p[i][turn] = x[i], p[i][(turn + 1) % 3] = y[i], n[i][(turn + 2) % 3] = 1.0f;
		t[i][0] = x[i], t[i][1] = v[i];
	}
	const unsigned in_order[9] = {0, 1, 2, 0, 2, 3, 0, 3, 4}, other[9] = {0, 2, 3, 0, 1, 2, 0, 3, 4};
	const nmtan_mesh loose = {.struct_bytes = sizeof loose, .face_count = 3, .vertex_count = 5,
		.positions = p[0], .normals = n[0],
		.texcoords = t[0], .indices = middle_first ? other : in_order};
	const nmtan_mesh mesh = nt_filled(&loose);
	nt_result expected = nt_result_define(&mesh, 9, false);
	*differences += nt_compare_variants("wide fan", &mesh, 9, &expected, false);
	const bool two = memcmp(expected.tangents + 4 * (middle_first ? 3 : 0), expected.tangents + 4 * 6, 16) != 0;
	nt_result_free(&expected);
	return two;
}

TEST(antiparallel_directions_are_byte_identical)
{
	size_t differences = 0;
	for (int bits = 1; bits <= 24; bits++)
		for (int turn = 0; turn < 3; turn++)
			for (int first = 0; first < 2; first++)
				assert_int_equal(compare_wide_fan(bits, turn, first, &differences), bits >= 12);
	assert_int_equal(differences, 0);
}

/* A fan of three triangles around a vertex, whose directions are nearly its normal: what is left in its plane is so
 * short that its square is a denormal, and a "unit" vector is up to a fifth too long or too short. */
static size_t compare_short_fan(uint32_t random)
{
	enum { RIM = 4, FACES = RIM - 1 };
	static const float normal[3] = {1, 0, 0};
	float p[RIM + 1][3] = {{0}}, n[RIM + 1][3], t[RIM + 1][2] = {{0}};
	unsigned indices[FACES][3];
	memcpy(n[0], normal, sizeof normal);
	for (int i = 1; i <= RIM; i++) {
		memcpy(n[i], normal, sizeof normal);
		p[i][0] = 1.0f;
		for (int c = 1; c < 3; c++) {
			random = random * 1664525 + 1013904223;
			p[i][c] = ((float)(random >> 8) - 0x1p23f) * 0x1p-23f * 1e-22f;
		}
		t[i][0] = (float)(RIM - i), t[i][1] = (float)i;
	}
	for (unsigned i = 0; i < FACES; i++)
		memcpy(indices[i], (unsigned[3]){0, i + 1, i + 2}, sizeof indices[i]);
	const nmtan_mesh loose = {.struct_bytes = sizeof loose, .face_count = FACES, .vertex_count = RIM + 1,
		.positions = p[0], .normals = n[0],
		.texcoords = t[0], .indices = indices[0]};
	const nmtan_mesh mesh = nt_filled(&loose);
	nt_result expected = nt_result_define(&mesh, 3 * FACES, true);
	const size_t differences = nt_compare_variants("short fan", &mesh, 3 * FACES, &expected, true);
	nt_result_free(&expected);
	return differences;
}

/* Angles of such directions do not tell whether their product is -1. These fans, eight of 70 000, would be solved
 * wrongly if they did. */
TEST(short_directions_are_byte_identical)
{
	static const uint32_t seeds[] = {2098508433, 921525665, 2118292457, 4254900097, 1290134337, 3088173105,
		3896388217, 3648777353};
	size_t differences = 0;
	for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++)
		differences += compare_short_fan(seeds[i]);
	assert_int_equal(differences, 0);
}

/* Corners around a vertex whose edges are of a few kinds in space and, always counterclockwise, in texture coordinates.
 * So they have few directions, each often, of which many are opposite in u or in v alone, as those of a quad's halves
 * may be; some triangles have no frame, and some, whose lengths overflow, one of NaN. */
enum { RIM_MOST = 700 };
typedef struct hub {
	float p[RIM_MOST + 1][3], n[RIM_MOST + 1][3], t[RIM_MOST + 1][2];
	unsigned indices[4 * RIM_MOST];
	unsigned char face_sizes[RIM_MOST];
	nmtan_mesh mesh;
	size_t corners;
} hub;

static void make_hub(uint32_t random, size_t rim, bool quads, bool large, hub *h)
{
	static const float compass[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
	*h = (hub){.n[0] = {0, 0, 1}};
	uint32_t place = 0, angle = 0;
	for (size_t i = 1; i <= rim; i++) {
		random = random * 1664525 + 1013904223;
		/* never that of the vertex before, so that the fan does not end */
		place += 1 + (random >> 29) % 7;
		const float *p = compass[place % 8], scale = large && (random >> 20) % 8 == 0 ? 3e38f : 1.0f;
		angle += (random >> 26) % 8 ? 1 + (random >> 26) % 3 : 0;
		memcpy(h->p[i], (float[3]){scale * p[0], scale * p[1], 0}, sizeof h->p[i]);
		memcpy(h->t[i], compass[angle % 8], sizeof h->t[i]);
		/* no two vertices of the rim are one */
		memcpy(h->n[i], (float[3]){(float)i, 1, 0}, sizeof h->n[i]);
	}
	unsigned *to = h->indices;
	size_t faces = 0;
	for (unsigned i = 1, step; i < rim; i += step) {
		step = quads && i + 1 < rim && i % 3 ? 2 : 1;
		*to++ = 0;
		for (unsigned j = 0; j <= step; j++)
			*to++ = i + j;
		h->face_sizes[faces++] = (unsigned char)(step + 2);
	}
	h->corners = (size_t)(to - h->indices);
	h->mesh = nt_filled(&(nmtan_mesh){.struct_bytes = sizeof h->mesh, .face_count = faces, .vertex_count = rim + 1,
		.positions = h->p[0], .normals = h->n[0], .texcoords = h->t[0], .indices = h->indices,
		.face_sizes = quads ? h->face_sizes : NULL});
}

static size_t compare_hub(const hub *h, bool more)
{
	nt_result expected = nt_result_define(&h->mesh, h->corners, more);
	const size_t differences = nt_compare_variants("hub", &h->mesh, h->corners, &expected, more);
	nt_result_free(&expected);
	return differences;
}

TEST(hubs_are_byte_identical)
{
	static const size_t rims[] = {8, 13, 100, 300, RIM_MOST};
	hub *h = malloc(sizeof *h);
	size_t differences = 0;
	for (unsigned i = 0; i < 8 * sizeof rims / sizeof *rims; i++) {
		make_hub(i + 1, rims[i / 8], i & 1, i & 2, h);
		differences += compare_hub(h, i & 4);
	}
	assert_int_equal(differences, 0);
	free(h);
}

/* Several hubs in one mesh, each with its own position and the rim of its own. */
static const size_t rims_of_many[] = {13, RIM_MOST, 40, 600, 14, 20, 300};
enum { HUBS = sizeof rims_of_many / sizeof *rims_of_many, VERTICES_OF_MANY = HUBS * (RIM_MOST + 1) };

static size_t compare_many_hubs(hub *h, bool quads, bool large, bool more)
{
	float (*p)[3] = malloc(VERTICES_OF_MANY * sizeof *p), (*n)[3] = malloc(VERTICES_OF_MANY * sizeof *n);
	float (*t)[2] = malloc(VERTICES_OF_MANY * sizeof *t);
	unsigned *indices = malloc(HUBS * sizeof h->indices);
	unsigned char *sizes = malloc(HUBS * sizeof h->face_sizes);
	size_t vertices = 0, corners = 0, faces = 0;
	for (unsigned i = 0; i < HUBS; i++) {
		make_hub(100 + i, rims_of_many[i], quads, large, h);
		for (size_t v = 0; v < h->mesh.vertex_count; v++) {
			memcpy(p[vertices + v], (float[3]){h->p[v][0], h->p[v][1], (float)i}, sizeof *p);
			memcpy(n[vertices + v], h->n[v], sizeof *n);
			memcpy(t[vertices + v], h->t[v], sizeof *t);
		}
		for (size_t c = 0; c < h->corners; c++)
			indices[corners + c] = (unsigned)vertices + h->indices[c];
		memcpy(sizes + faces, h->face_sizes, h->mesh.face_count);
		vertices += h->mesh.vertex_count;
		corners += h->corners;
		faces += h->mesh.face_count;
	}
	const nmtan_mesh mesh = nt_filled(&(nmtan_mesh){.struct_bytes = sizeof mesh, .face_count = faces,
		.vertex_count = vertices, .positions = p[0], .normals = n[0], .texcoords = t[0], .indices = indices,
		.face_sizes = quads ? sizes : NULL});
	nt_result expected = nt_result_define(&mesh, corners, more);
	const size_t differences = nt_compare_variants("hubs", &mesh, corners, &expected, more);
	nt_result_free(&expected);
	free(p);
	free(n);
	free(t);
	free(indices);
	free(sizes);
	return differences;
}

/* They come in windows: some together, some alone. */
TEST(many_hubs_are_byte_identical)
{
	hub *h = malloc(sizeof *h);
	size_t differences = 0;
	for (unsigned i = 0; i < 8; i++)
		differences += compare_many_hubs(h, i & 1, i & 2, i & 4);
	assert_int_equal(differences, 0);
	free(h);
}

/* Scratch that a hub takes whose directions turn by so much in all, or, `once`, at one place and back again. */
static size_t solve_turning_hub(float turn, bool once)
{
	enum { SPOKES = 3000 }; /* fewer may fit in the block of scratch that there is */
	float (*p)[3] = calloc(SPOKES + 2, sizeof *p), (*n)[3] = calloc(SPOKES + 2, sizeof *n);
	float (*t)[2] = calloc(SPOKES + 2, sizeof *t);
	unsigned (*indices)[3] = malloc(SPOKES * sizeof *indices);
	float turned = 0;
	n[0][2] = 1;
	for (unsigned i = 1; i <= SPOKES + 1; i++) {
		/* at once backwards, then forwards by less than a spoke: texture coordinates stay counterclockwise */
		turned = !once ? turn * (float)i / SPOKES : i == 6 ? -turn : fminf(turned + 0.2f, 0);
		const float angle = 0.3f * (float)i, direction = turned + 0.1f * sinf((float)i / 1000) - angle;
		memcpy(p[i], (float[3]){cosf(angle), sinf(angle), 0}, sizeof *p);
		memcpy(t[i], (float[2]){cosf(direction), -sinf(direction)}, sizeof *t);
		memcpy(n[i], (float[3]){(float)i, 1, 0}, sizeof *n);
		if (i <= SPOKES)
			memcpy(indices[i - 1], (unsigned[3]){0, i, i + 1}, sizeof *indices);
	}
	const nmtan_mesh mesh = nt_filled(&(nmtan_mesh){.struct_bytes = sizeof mesh, .face_count = SPOKES,
		.vertex_count = SPOKES + 2, .positions = p[0], .normals = n[0], .texcoords = t[0],
		.indices = indices[0]});
	nt_result expected = nt_result_make(3 * SPOKES), got = nt_result_make(3 * SPOKES);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_solve solve = nt_result_solve(&mesh, 3 * SPOKES, &scratch, &expected, true);
	assert_int_equal(nt_mikktspace_scalar(&solve), NMTAN_OK);
	nt_scratch_free(&scratch);
	nt_scratch_init(&scratch, NULL);
	solve = nt_result_solve(&mesh, 3 * SPOKES, &scratch, &got, true);
	assert_int_equal(nt_mikktspace_fast_as(&solve, &nt_usual_plan), NMTAN_OK);
	const size_t bytes = nt_scratch_bytes(&scratch);
	nt_scratch_free(&scratch);
	assert_int_equal(nt_result_differences(&expected, &got, 3 * SPOKES, true), 0);
	nt_result_free(&expected);
	nt_result_free(&got);
	free(p);
	free(n);
	free(t);
	free(indices);
	return bytes;
}

/* Sums for each direction, which take quadratic time, take memory, too. */
TEST(few_directions_aside_do_not_split_a_hub)
{
	const size_t bytes = solve_turning_hub(0, false);
	assert_int_equal(solve_turning_hub(1.9f, true), bytes);
	assert_true(solve_turning_hub(6, false) > bytes);
}

TEST(every_failed_allocation_of_a_hub_is_told)
{
	hub *h = malloc(sizeof *h);
	make_hub(1, RIM_MOST, false, false, h);
	nt_result r = nt_result_make(h->corners);
	size_t allowed = 0;
	while (nt_solve_within(&h->mesh, h->corners, &r, true, allowed, 1, &nt_usual_plan) == NMTAN_ERROR_MEMORY)
		allowed++;
	assert_int_equal(nt_solve_within(&h->mesh, h->corners, &r, true, allowed, 1, &nt_usual_plan), NMTAN_OK);
	assert_in_range(allowed, 2, 100);
	nt_result_free(&r);
	free(h);
}
