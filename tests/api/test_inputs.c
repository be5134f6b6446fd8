/* SPDX-License-Identifier: MIT */
/*
 * The ways in which meshes come and results go: v down, short indices, attributes with numbers of their own, strides,
 * vertices that are never split, room that is too small, and threads of the caller. Each against the plain way.
 */
#include "test.h"
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>
#include "golden.h"
#include "nasty.h"
#include "nmtan.h"

/* Two quads side by side, cut into triangles; the texture of the right one is mirrored: 1 and 2 need copies. */
static const float positions[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
static const float normals[6][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const float texcoords[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {0, 1}};
static const uint32_t triangles[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};

static nmtan_mesh two_quads(void)
{
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.face_count = 4;
	mesh.vertex_count = 6;
	mesh.indices = triangles;
	mesh.positions = positions[0];
	mesh.normals = normals[0];
	mesh.texcoords = texcoords[0];
	return mesh;
}

/* Results for corners and for vertices. */
typedef struct results {
	float *corners, *vertices;
	uint32_t *indices, *sources;
	nmtan_split_output split;
	nmtan_counts counts;
} results;

static results solve(const nmtan_mesh *mesh, size_t corner_count, const nmtan_options *options)
{
	results r = {calloc(corner_count + 1, 16), calloc(mesh->vertex_count + corner_count + 1, 16),
		calloc(corner_count + 1, 4), calloc(corner_count + 1, 4), NMTAN_SPLIT_OUTPUT_INIT, NMTAN_COUNTS_INIT};
	nmtan_output output = NMTAN_OUTPUT_INIT;
	output.tangents = r.corners;
	r.split.indices = r.indices;
	r.split.sources = r.sources;
	r.split.source_capacity = corner_count;
	r.split.vertex_tangents = r.vertices;
	assert_int_equal(nmtan_tangents(mesh, options, &output, NULL), NMTAN_OK);
	assert_int_equal(nmtan_vertex_tangents(mesh, options, &r.split, &r.counts), NMTAN_OK);
	return r;
}

static void release(results *r)
{
	free(r->corners);
	free(r->vertices);
	free(r->indices);
	free(r->sources);
}

static void assert_same(const results *a, const results *b, size_t vertex_count, size_t corner_count)
{
	assert_int_equal(a->split.source_count, b->split.source_count);
	assert_memory_equal(a->corners, b->corners, 16 * corner_count);
	assert_memory_equal(a->vertices, b->vertices, 16 * (vertex_count + a->split.source_count));
	assert_memory_equal(a->indices, b->indices, 4 * corner_count);
	assert_memory_equal(a->sources, b->sources, 4 * a->split.source_count);
	assert_memory_equal(&a->counts, &b->counts, sizeof a->counts);
}

/* A golden mesh with every seventh corner at the vertex of the sixth before it. */
typedef struct indexed {
	nmtan_mesh mesh;
	uint32_t *indices;
} indexed;

static indexed index_golden(const nt_golden *golden)
{
	indexed i = {nt_golden_mesh(golden), malloc(4 * (size_t)golden->corner_count + 1)};
	for (uint32_t c = 0; c < golden->corner_count; c++)
		i.indices[c] = c % 7 == 6 ? c - 6 : c;
	i.mesh.indices = i.indices;
	return i;
}

static void compare_down(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	(void)context;
	const indexed i = index_golden(golden);
	const size_t corners = golden->corner_count;
	float *wide = calloc(corners + 1, 20), *turned = malloc(8 * corners + 1);
	for (size_t v = 0; v < corners; v++) {
		memcpy(wide + 5 * v, golden->texcoords + 2 * v, 8);
		turned[2 * v] = golden->texcoords[2 * v];
		turned[2 * v + 1] = -golden->texcoords[2 * v + 1];
	}
	nmtan_mesh up = i.mesh, down = i.mesh;
	up.texcoords = turned;
	down.texcoords = wide;
	down.texcoord_stride_bytes = 20;
	down.v_down = 1;
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		const nmtan_options options = {.struct_bytes = sizeof options, .method = (nmtan_method)method,
			.repair = method % 2 ? NMTAN_REPAIR_ON : NMTAN_REPAIR_OFF};
		results a = solve(&up, corners, &options), b = solve(&down, corners, &options);
		assert_same(&a, &b, corners, corners);
		release(&a);
		release(&b);
	}
	free(wide);
	free(turned);
	free(i.indices);
}

TEST(v_down_is_v_negated)
{
	assert_int_equal(nt_golden_each("data/golden", compare_down, NULL), 46);
	nmtan_mesh mesh = two_quads();
	results up = solve(&mesh, 12, NULL);
	mesh.v_down = 1;
	results down = solve(&mesh, 12, NULL);
	for (int c = 0; c < 12; c++) {
		assert_memory_equal(up.corners + 4 * c, down.corners + 4 * c, 12);
		assert_true(up.corners[4 * c + 3] == (c < 6 ? 1.0f : -1.0f));
		assert_true(down.corners[4 * c + 3] == -up.corners[4 * c + 3]);
	}
	release(&up);
	release(&down);
}

static void compare_short(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	(void)context;
	const indexed i = index_golden(golden);
	uint16_t *few = malloc(2 * (size_t)golden->corner_count + 1);
	for (uint32_t c = 0; c < golden->corner_count; c++)
		few[c] = (uint16_t)i.indices[c];
	nmtan_mesh mesh = i.mesh;
	mesh.indices = NULL;
	mesh.indices16 = few;
	results a = solve(&i.mesh, golden->corner_count, NULL), b = solve(&mesh, golden->corner_count, NULL);
	assert_same(&a, &b, golden->corner_count, golden->corner_count);
	release(&a);
	release(&b);
	free(few);
	free(i.indices);
}

TEST(short_indices_are_indices)
{
	assert_int_equal(nt_golden_each("data/golden", compare_short, NULL), 46);
	nmtan_mesh mesh = two_quads();
	const uint16_t beyond[12] = {0, 1, 2, 0, 2, 3, 1, 4, 6};
	float tangents[12][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	mesh.indices16 = beyond;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_ERROR_ARGUMENT); /* both */
	mesh.indices = NULL;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_ERROR_INDEX);
}

/* Rows of each attribute that occur once, as a file that numbers them apart has them; positions and what is left of
 * texture coordinates with strides, normals one for each corner. */
static void compare_apart(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	const int down = *(const int *)context;
	const size_t corners = golden->corner_count;
	nmtan_mesh plain = nt_golden_mesh(golden), apart = plain;
	uint32_t *p = malloc(4 * corners + 1), *t = malloc(4 * corners + 1);
	float *points = calloc(corners + 1, 16), *uvs = malloc(8 * corners + 1);
	size_t point_count = 0, uv_count = 0;
	for (size_t c = 0; c < corners; c++) {
		const float uv[2] = {golden->texcoords[2 * c], down ? -golden->texcoords[2 * c + 1]
								    : golden->texcoords[2 * c + 1]};
		for (p[c] = 0; p[c] < point_count && memcmp(points + 4 * p[c], golden->positions + 3 * c, 12); p[c]++)
			;
		for (t[c] = 0; t[c] < uv_count && memcmp(uvs + 2 * t[c], uv, 8); t[c]++)
			;
		memcpy(points + 4 * p[c], golden->positions + 3 * c, 12);
		memcpy(uvs + 2 * t[c], uv, 8);
		point_count += p[c] == point_count;
		uv_count += t[c] == uv_count;
	}
	apart.positions = points;
	apart.position_stride_bytes = 16;
	apart.vertex_count = point_count;
	apart.indices = p;
	apart.normal_count = corners;
	apart.texcoords = uvs;
	apart.texcoord_stride_bytes = 0;
	apart.texcoord_indices = t;
	apart.texcoord_count = uv_count;
	apart.v_down = (size_t)down;
	results a = solve(&plain, corners, NULL), b = solve(&apart, corners, NULL);
	assert_memory_equal(a.corners, b.corners, 16 * corners);
	/* each corner is a vertex, since its normal is; and stands for itself */
	assert_int_equal(b.split.source_count, corners);
	assert_memory_equal(b.vertices, b.corners, 16 * corners);
	for (uint32_t c = 0; c < corners; c++)
		assert_true(b.indices[c] == c && b.sources[c] == c);
	release(&a);
	release(&b);
	free(p);
	free(t);
	free(points);
	free(uvs);
}

TEST(attributes_with_numbers_of_their_own_give_the_corners_their_tangents)
{
	assert_int_equal(nt_golden_each("data/golden", compare_apart, &(int){0}), 46);
	assert_int_equal(nt_golden_each("data/golden", compare_apart, &(int){1}), 46);
}

/* The two quads, with one normal for all, and v and u of the seam twice: 6 combinations of rows, of which two need two
 * tangents. Sources are corners. */
TEST(combinations_of_rows_are_vertices)
{
	static const uint32_t all_one[12] = {0};
	nmtan_mesh mesh = two_quads();
	mesh.normals = normals[0];
	mesh.normal_indices = all_one;
	mesh.normal_count = 1;
	mesh.texcoord_indices = triangles;
	mesh.texcoord_count = 6;
	uint32_t indices[12], sources[8];
	float tangents[8][5];
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
		.vertex_tangents = tangents[0], .vertex_tangent_stride_bytes = sizeof *tangents};
	for (split.source_capacity = 0; split.source_capacity < 8; split.source_capacity++) {
		assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_ERROR_CAPACITY);
		assert_int_equal(split.source_count, 8);
	}
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_OK);
	static const uint32_t expected[12] = {0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7},
		expected_sources[8] = {0, 1, 2, 5, 7, 8, 1, 2};
	assert_memory_equal(indices, expected, sizeof expected);
	assert_memory_equal(sources, expected_sources, sizeof expected_sources);
	assert_int_equal(split.split_count, 2);
	for (int v = 0; v < 8; v++)
		assert_true(tangents[v][0] == (v < 4 ? 1.0f : -1.0f) && tangents[v][3] == tangents[v][0]);
	/* the same from the tangents of corners */
	float corners[12][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = corners[0]};
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_OK);
	memset(indices, 0, sizeof indices);
	memset(sources, 0, sizeof sources);
	mesh.positions = mesh.texcoords = NULL;
	assert_int_equal(nmtan_split(&mesh, corners[0], NULL, &split), NMTAN_OK);
	assert_memory_equal(indices, expected, sizeof expected);
	assert_memory_equal(sources, expected_sources, sizeof expected_sources);
	split.copy_counts = sources;
	assert_int_equal(nmtan_split(&mesh, corners[0], NULL, &split), NMTAN_ERROR_ARGUMENT);
	split.copy_counts = NULL;
	mesh.normal_count = 0;
	assert_int_equal(nmtan_split(&mesh, corners[0], NULL, &split), NMTAN_ERROR_INDEX);
	mesh.normal_indices = NULL;
	mesh.texcoord_count = 5;
	assert_int_equal(nmtan_split(&mesh, corners[0], NULL, &split), NMTAN_ERROR_INDEX);
}

TEST(rows_of_tangents_may_lie_apart)
{
	const nmtan_mesh mesh = two_quads();
	float corners[12][4], wide[12][7], vertices[8][9];
	uint32_t indices[12], sources[2];
	nmtan_output output = {.struct_bytes = sizeof output, .tangents = corners[0]};
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_OK);
	memset(wide, 0x5a, sizeof wide);
	memset(vertices, 0x5a, sizeof vertices);
	float untouched;
	memcpy(&untouched, &wide[0][6], 4);
	output = (nmtan_output){.struct_bytes = sizeof output, .tangents = wide[0], .tangent_stride_bytes = 28};
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_OK);
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = indices, .sources = sources,
		.source_capacity = 2, .vertex_tangents = vertices[0], .vertex_tangent_stride_bytes = 36};
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_OK);
	for (int c = 0; c < 12; c++) {
		assert_memory_equal(wide[c], corners[c], 16);
		assert_memory_equal(vertices[indices[c]], corners[c], 16);
		assert_true(wide[c][4] == untouched && wide[c][6] == untouched);
	}
	assert_true(vertices[7][4] == untouched && vertices[0][8] == untouched);
	output.tangent_stride_bytes = 12;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_ERROR_ARGUMENT);
	split.vertex_tangent_stride_bytes = 18;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
}

TEST(room_that_is_too_small_says_what_is_needed)
{
	for (uint64_t seed = 0; seed < 500; seed++) {
		nt_nasty nasty;
		nt_nasty_make(seed, &nasty);
		results r = solve(&nasty.mesh, nasty.corner_count, NULL);
		const size_t needed = r.split.source_count, rows = nasty.mesh.vertex_count + needed;
		float *few = malloc(16 * rows + 1);
		r.split.vertex_tangents = few;
		for (r.split.source_capacity = 0; r.split.source_capacity < needed;
			r.split.source_capacity = r.split.source_capacity * 2 + 1) {
			r.split.source_count = 0;
			assert_int_equal(nmtan_vertex_tangents(&nasty.mesh, NULL, &r.split, NULL),
				NMTAN_ERROR_CAPACITY);
			assert_int_equal(r.split.source_count, needed);
			r.split.source_count = 0;
			assert_int_equal(nmtan_split(&nasty.mesh, r.corners, NULL, &r.split), NMTAN_ERROR_CAPACITY);
			assert_int_equal(r.split.source_count, needed);
		}
		r.split.source_capacity = needed;
		assert_int_equal(nmtan_vertex_tangents(&nasty.mesh, NULL, &r.split, NULL), NMTAN_OK);
		assert_memory_equal(few, r.vertices, 16 * rows);
		free(few);
		release(&r);
		nt_nasty_free(&nasty);
	}
}

TEST(vertices_are_not_split_where_there_are_no_indices)
{
	const nmtan_mesh mesh = two_quads();
	float tangents[6][4];
	uint32_t copies[6];
	nmtan_split_output split = {.struct_bytes = sizeof split, .vertex_tangents = tangents[0],
		.copy_counts = copies};
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_OK);
	assert_int_equal(split.source_count, 2);
	assert_int_equal(split.split_count, 2);
	for (int v = 0; v < 6; v++) {
		assert_true(tangents[v][0] == (v < 4 ? 1.0f : -1.0f));
		assert_int_equal(copies[v], v == 1 || v == 2);
	}
	split.source_capacity = 2;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
	/* a vertex with three tangents is one that would be split */
	float corners[12][4] = {{0}};
	for (int c = 0; c < 12; c++)
		corners[c][0] = (float)c;
	split.source_capacity = 0;
	assert_int_equal(nmtan_split(&mesh, corners[0], NULL, &split), NMTAN_OK);
	assert_int_equal(split.source_count, 6);
	assert_int_equal(split.split_count, 4);
}

TEST(normals_that_are_not_unit_are_counted)
{
	float odd[6][3];
	memcpy(odd, normals, sizeof odd);
	odd[1][2] = 1.0002f; /* |n|^2 is 1.0004: within 2^-11 */
	odd[2][2] = 1.0003f;
	odd[4][0] = NAN;
	odd[5][2] = 127;
	nmtan_mesh mesh = two_quads();
	mesh.normals = odd[0];
	results r = solve(&mesh, 12, NULL);
	assert_int_equal(r.counts.normals_not_unit, 3);
	release(&r);
}

/* Threads of the caller that take jobs from the end. */
typedef struct crew {
	void (*job)(void *context, unsigned i);
	void *context;
	atomic_int left;
	atomic_uint done;
	unsigned calls, most;
} crew;

static void *work(void *context)
{
	crew *c = context;
	for (int i; (i = atomic_fetch_sub(&c->left, 1)) > 0; c->done++)
		c->job(c->context, (unsigned)i - 1);
	return NULL;
}

static void run_crew(void *user, unsigned count, void (*job)(void *context, unsigned i), void *context)
{
	crew *c = user;
	pthread_t threads[2];
	c->job = job;
	c->context = context;
	c->left = (int)count;
	c->calls++;
	c->most = count > c->most ? count : c->most;
	for (int i = 0; i < 2; i++)
		pthread_create(&threads[i], NULL, work, c);
	for (int i = 0; i < 2; i++)
		pthread_join(threads[i], NULL);
}

static void run_in_turn(void *user, unsigned count, void (*job)(void *context, unsigned i), void *context)
{
	for (unsigned i = 0; i < count; i++)
		job(context, i);
	++*(unsigned *)user;
}

/* A bumpy grid of 2 * 200 * 200 triangles, mirrored in the middle. */
enum { SIDE = 200, ROW = SIDE + 1, GRID_CORNERS = 6 * SIDE * SIDE };

static nmtan_mesh make_grid(void)
{
	static float rows[ROW * ROW][8];
	static uint32_t corners[GRID_CORNERS];
	for (uint32_t v = 0, c = 0; v < ROW * ROW; v++) {
		const float x = (float)(v % ROW), y = (float)(v / ROW);
		memcpy(rows[v], (float[8]){x, y, sinf(x * y / 99), 0, 0, 1, x < 100 ? x : 200 - x, y}, 32);
		if (v % ROW < SIDE && v / ROW < SIDE) {
			memcpy(corners + c, (uint32_t[6]){v, v + 1, v + ROW + 1, v, v + ROW + 1, v + ROW}, 24);
			c += 6;
		}
	}
	nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2 * SIDE * SIDE, .vertex_count = ROW * ROW,
		.indices = corners, .positions = rows[0], .normals = rows[0] + 3, .texcoords = rows[0] + 6};
	mesh.position_stride_bytes = mesh.normal_stride_bytes = mesh.texcoord_stride_bytes = sizeof *rows;
	return mesh;
}

TEST(threads_of_the_caller_give_the_same_bytes)
{
	const nmtan_mesh mesh = make_grid();
	crew c = {.calls = 0};
	unsigned turns = 0;
	const nmtan_jobs jobs = {run_crew, &c}, in_turn = {run_in_turn, &turns}, none = {NULL, NULL};
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		nmtan_options options = {.struct_bytes = sizeof options, .method = (nmtan_method)method, .threads = 1};
		results one = solve(&mesh, GRID_CORNERS, &options);
		options.threads = 3;
		options.jobs = &jobs;
		results crewed = solve(&mesh, GRID_CORNERS, &options);
		options.jobs = &in_turn;
		results turned = solve(&mesh, GRID_CORNERS, &options);
		options.jobs = NULL;
		results pooled = solve(&mesh, GRID_CORNERS, &options);
		assert_same(&one, &crewed, mesh.vertex_count, GRID_CORNERS);
		assert_same(&one, &turned, mesh.vertex_count, GRID_CORNERS);
		assert_same(&one, &pooled, mesh.vertex_count, GRID_CORNERS);
		release(&one);
		release(&crewed);
		release(&turned);
		release(&pooled);
	}
	assert_true(c.calls > 5 && c.most > 1 && c.most <= 3 && turns == c.calls);
	nmtan_options options = {.struct_bytes = sizeof options, .jobs = &none};
	float tangents[12][4];
	const nmtan_mesh small = two_quads();
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	assert_int_equal(nmtan_tangents(&small, &options, &output, NULL), NMTAN_ERROR_ARGUMENT);
}

static unsigned threads_at_first;

static unsigned count_threads(void)
{
	unsigned threads = 0;
	char line[128];
	FILE *file = fopen("/proc/self/status", "r");
	while (file && fgets(line, sizeof line, file))
		sscanf(line, "Threads: %u", &threads);
	if (file)
		fclose(file);
	return threads;
}

/* Waits until no more than `most` threads are left, and returns how many there are. A thread that was joined still
 * stands in /proc until the kernel has run its last steps. */
static unsigned settle_threads(unsigned most, unsigned patience_milliseconds)
{
	unsigned threads = count_threads();
	for (; threads > most && patience_milliseconds > 0; patience_milliseconds--) {
		nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
		threads = count_threads();
	}
	return threads;
}

TEST(threads_end_and_begin_again)
{
	enum { PATIENCE = 60000 };
	const nmtan_mesh mesh = make_grid();
	const nmtan_options options = {.struct_bytes = sizeof options, .threads = 4};
	for (int i = 0; i < 20; i++) {
		nmtan_end_threads();
		assert_int_equal(settle_threads(threads_at_first, PATIENCE), threads_at_first);
		results r = solve(&mesh, GRID_CORNERS, &options);
		release(&r);
		assert_true(threads_at_first == 0 || count_threads() > threads_at_first);
	}
	nmtan_end_threads();
}

/* Before the pool has made any: one, or two if a sanitizer has one. */
static int note_threads(void **state)
{
	(void)state;
	threads_at_first = count_threads();
	return 0;
}

AROUND_ALL(note_threads, NULL)
