/* SPDX-License-Identifier: MIT */
/*
 * published FROM COUNT: random meshes by seed, the definition and the fast path in all its ways against mikktspace.c as
 * published, which the caller brings (published.sh). Prints "meshes different matter": in how many of these meshes the
 * unfinished sort shows.
 *
 * Ordinary meshes: bumpy planes, tubes and tori, closed or not, of triangles and quads, faces in order or shuffled and
 * turned, with some of them missing, doubled, mirrored or without UV area; books and fans of many triangles; these with
 * rare positions, normals and signs of zeros (`changes`), with NaN, and with rows that no corner has; and soups
 * and nasty ones with positions that are finite and below FLT_MAX / 2. At thresholds other than the default the
 * definition alone is compared.
 */
#include "test.h"
#include <float.h>
#include <math.h>
#include <mikktspace.h>
#include <stdio.h>
#include "base/cpu.h"
#include "definition.h"
#include "nasty.h"
#include "soup.h"
#include "surfaces.h"

/* mikktspace.c */

typedef struct reference {
	const nmtan_mesh *mesh;
	size_t *first; /* [face_count] corner */
	nt_result *result;
} reference;

static const reference *of(const SMikkTSpaceContext *context)
{
	return context->m_pUserData;
}

static int face_count(const SMikkTSpaceContext *context)
{
	return (int)of(context)->mesh->face_count;
}

static int face_size(const SMikkTSpaceContext *context, const int face)
{
	const nmtan_mesh *m = of(context)->mesh;
	return m->face_sizes ? m->face_sizes[face] : 3;
}

static void get(const reference *r, const float *rows, size_t stride_bytes, size_t floats, float *to, int face,
	int vert)
{
	const size_t corner = r->first[face] + (size_t)vert;
	const size_t vertex = r->mesh->indices ? r->mesh->indices[corner] : corner;
	memcpy(to, (const char *)rows + stride_bytes * vertex, floats * sizeof *to);
}

static void get_position(const SMikkTSpaceContext *context, float to[], const int face, const int vert)
{
	get(of(context), of(context)->mesh->positions, of(context)->mesh->position_stride_bytes, 3, to, face, vert);
}

static void get_normal(const SMikkTSpaceContext *context, float to[], const int face, const int vert)
{
	get(of(context), of(context)->mesh->normals, of(context)->mesh->normal_stride_bytes, 3, to, face, vert);
}

static void get_texcoord(const SMikkTSpaceContext *context, float to[], const int face, const int vert)
{
	get(of(context), of(context)->mesh->texcoords, of(context)->mesh->texcoord_stride_bytes, 2, to, face, vert);
}

static void set_frame(const SMikkTSpaceContext *context, const float tangent[], const float bitangent[],
	const float mag_s, const float mag_t, const tbool preserving, const int face, const int vert)
{
	const nt_result *r = of(context)->result;
	const size_t c = of(context)->first[face] + (size_t)vert;
	memcpy(r->tangents + 4 * c, (float[4]){tangent[0], tangent[1], tangent[2], preserving ? 1.0f : -1.0f}, 16);
	memcpy(r->bitangents + 3 * c, bitangent, 12);
	memcpy(r->magnitudes + 2 * c, (float[2]){mag_s, mag_t}, 8);
}

static nt_result solve_reference(const nmtan_mesh *mesh, size_t corners, float degrees)
{
	SMikkTSpaceInterface calls = {.m_getNumFaces = face_count, .m_getNumVerticesOfFace = face_size,
		.m_getPosition = get_position, .m_getNormal = get_normal, .m_getTexCoord = get_texcoord,
		.m_setTSpace = set_frame};
	nt_result result = nt_result_make(corners);
	reference r = {mesh, malloc(mesh->face_count * sizeof *r.first + 1), &result};
	for (size_t face = 0, first = 0; face < mesh->face_count; face++) {
		r.first[face] = first;
		first += mesh->face_sizes ? mesh->face_sizes[face] : 3;
	}
	const SMikkTSpaceContext context = {&calls, &r};
	assert_true(degrees > 0 ? genTangSpace(&context, degrees) : genTangSpaceDefault(&context));
	free(r.first);
	return result;
}

/* Meshes */

typedef struct point {
	float position[3], normal[3], texcoord[2];
} point;

/* A point of a bumpy plane, tube or torus, with parameters in [0, 1]. */
static point point_at(uint32_t kind, double a, double b, double bump)
{
	const double u = 2 * M_PI * a, v = 2 * M_PI * b, r = 1 + bump;
	point p = {.texcoord = {(float)a, (float)b}};
	if (kind == 0) {
		memcpy(p.position, (float[3]){(float)a, (float)b, (float)(bump / 4)}, sizeof p.position);
		memcpy(p.normal, (float[3]){0, 0, 1}, sizeof p.normal);
	} else if (kind == 1) {
		memcpy(p.position, (float[3]){(float)(r * cos(u)), (float)(r * sin(u)), (float)(3 * b)},
			sizeof p.position);
		memcpy(p.normal, (float[3]){(float)cos(u), (float)sin(u), 0}, sizeof p.normal);
	} else {
		const double w = 3 + r * cos(v);
		memcpy(p.position, (float[3]){(float)(w * cos(u)), (float)(w * sin(u)), (float)(r * sin(v))},
			sizeof p.position);
		memcpy(p.normal, (float[3]){(float)(cos(u) * cos(v)), (float)(sin(u) * cos(v)), (float)sin(v)},
			sizeof p.normal);
	}
	return p;
}

typedef struct grid {
	uint32_t columns, rows, kind;
	bool closed[2]; /* the last column, or row, is the first one, texture coordinates too */
	point *points;
} grid;

static point grid_point(const grid *g, uint32_t x, uint32_t y)
{
	return g->points[(g->closed[1] ? y % g->rows : y) * (g->columns + 1) + (g->closed[0] ? x % g->columns : x)];
}

static void put_corner(soup *s, const point *p)
{
	memcpy(s->positions[s->corner_count], p->position, sizeof p->position);
	memcpy(s->normals[s->corner_count], p->normal, sizeof p->normal);
	memcpy(s->texcoords[s->corner_count++], p->texcoord, sizeof p->texcoord);
}

static void put_face(soup *s, const point *corners, uint8_t size, uint32_t turn, bool reversed)
{
	for (uint32_t k = 0; k < size; k++) {
		const uint32_t at = (k + turn) % size;
		put_corner(s, &corners[reversed ? size - 1u - at : at]);
	}
	s->sizes[s->face_count++] = size;
}

static void put_cell(soup *s, const grid *g, uint32_t x, uint32_t y, nt_random *random, uint32_t quads, bool turned)
{
	const point c[4] = {grid_point(g, x, y), grid_point(g, x + 1, y), grid_point(g, x + 1, y + 1),
		grid_point(g, x, y + 1)};
	const uint32_t turn = turned ? nt_random_below(random, 12) : 0;
	const bool reversed = turned && nt_random_below(random, 60) == 0;
	if (nt_random_below(random, 4) < quads) {
		put_face(s, c, 4, turn, reversed);
	} else if (nt_random_below(random, turned ? 2 : 1)) {
		put_face(s, (point[3]){c[0], c[1], c[3]}, 3, turn, reversed);
		put_face(s, (point[3]){c[1], c[2], c[3]}, 3, turn / 2, reversed);
	} else {
		put_face(s, (point[3]){c[0], c[1], c[2]}, 3, turn, reversed);
		put_face(s, (point[3]){c[0], c[2], c[3]}, 3, turn / 2, reversed);
	}
}

static soup make_grid(nt_random *random, uint32_t columns, uint32_t rows)
{
	grid g = {columns, rows, nt_random_below(random, 3), {false, false}, NULL};
	g.closed[0] = g.kind > 0 && nt_random_below(random, 2);
	g.closed[1] = g.kind > 1 && nt_random_below(random, 2);
	const uint32_t cells = g.columns * g.rows, points = (g.columns + 1) * (g.rows + 1);
	const double bump = nt_random_below(random, 4) * 0.1;
	const uint32_t quads = nt_random_below(random, 2) * nt_random_below(random, 5);
	const uint32_t odd = nt_random_below(random, 3);
	const bool shuffled = nt_random_below(random, 2);
	g.points = malloc(points * sizeof *g.points);
	uint32_t *order = malloc(cells * sizeof *order);
	for (uint32_t i = 0; i < points; i++) {
		const double a = (double)(i % (g.columns + 1)) / g.columns, b = (double)(i / (g.columns + 1)) / g.rows;
		g.points[i] = point_at(g.kind, a, b, bump * nt_random_real(random));
		if (odd == 1 && nt_random_below(random, 20) == 0)
			g.points[i].texcoord[0] = 0;
		if (odd == 2 && i % (g.columns + 1) > g.columns / 2)
			g.points[i].texcoord[0] = 1 - g.points[i].texcoord[0];
	}
	for (uint32_t i = 0; i < cells; i++) {
		const uint32_t other = shuffled ? nt_random_below(random, i + 1) : i;
		order[i] = order[other];
		order[other] = i;
	}
	soup s = soup_make(4 * (size_t)cells, 12 * (size_t)cells);
	s.face_count = s.corner_count = 0;
	for (uint32_t i = 0; i < cells; i++) {
		const uint32_t times = odd == 1 ? (uint32_t[]){0, 1, 1, 1, 1, 1, 1, 2}[nt_random_below(random, 8)] : 1;
		for (uint32_t k = 0; k < times; k++)
			put_cell(&s, &g, order[i] % g.columns, order[i] / g.columns, random, quads, shuffled);
	}
	free(g.points);
	free(order);
	return s;
}

static soup make_ordinary(nt_random *random)
{
	const uint32_t most = nt_random_below(random, 50) == 0 ? 60 : 10;
	const uint32_t columns = 2 + nt_random_below(random, most), rows = 2 + nt_random_below(random, most);
	return make_grid(random, columns, rows);
}

static point random_point(nt_random *random)
{
	point p = {.normal = {0, 0, 1}};
	for (int i = 0; i < 3; i++)
		p.position[i] = (float)nt_random_real(random);
	for (int i = 0; i < 2; i++)
		p.texcoord[i] = (float)nt_random_real(random);
	return p;
}

/* Up to 500 triangles around a vertex, or with one edge in common: behind triangles of the other vertices, so that
 * those have the smaller numbers and the many edges are the last of the sort; or before them. */
static soup make_hub(nt_random *random)
{
	const uint32_t pages = 3 + nt_random_below(random, nt_random_below(random, 10) ? 40 : 497);
	const bool fan = nt_random_below(random, 2), late = nt_random_below(random, 3);
	const point hub[3] = {random_point(random), random_point(random), random_point(random)};
	point *rim = malloc((pages + 2) * sizeof *rim);
	for (uint32_t i = 0; i < pages + 2; i++)
		rim[i] = random_point(random);
	soup s = soup_make(2 * (size_t)pages, 6 * (size_t)pages);
	s.face_count = s.corner_count = 0;
	for (uint32_t i = 0; late && i < pages; i++)
		put_face(&s, (point[3]){rim[i], rim[i + 1], rim[i + 2]}, 3, nt_random_below(random, 3), false);
	for (uint32_t i = 0; i < pages; i++) {
		const uint32_t at = nt_random_below(random, 4) ? i : nt_random_below(random, pages);
		const point other = fan ? rim[at + 1] : hub[nt_random_below(random, 8) ? 1 : 2];
		put_face(&s, (point[3]){hub[0], other, rim[at]}, 3, nt_random_below(random, 3),
			nt_random_below(random, 3) == 0);
	}
	free(rim);
	return s;
}

static void flatten_faces(soup *s, nt_random *random)
{
	const uint32_t kept = (const uint32_t[]){2, 4, 20, UINT32_MAX}[nt_random_below(random, 4)];
	for (size_t f = 0, first = 0; f < s->face_count; first += s->sizes[f++])
		if (nt_random_below(random, kept))
			memcpy(s->positions[first], s->positions[first + 1 + nt_random_below(random, 2)],
				sizeof *s->positions);
}

static void flatten_quads(soup *s, nt_random *random)
{
	for (size_t f = 0, first = 0; f < s->face_count; first += s->sizes[f++]) {
		const uint32_t k = nt_random_below(random, 4);
		if (s->sizes[f] == 4 && nt_random_below(random, 2))
			memcpy(s->positions[first + k], s->positions[first + (k + 1) % 4], sizeof *s->positions);
	}
}

/* Few positions have many vertices. */
static void vary_normals(soup *s, nt_random *random)
{
	const uint32_t count = 2 + nt_random_below(random, nt_random_below(random, 2) ? 3 : 40);
	for (size_t c = 0; c < s->corner_count; c++) {
		const double a = 6.2831853 * nt_random_below(random, count) / count;
		memcpy(s->normals[c], (float[3]){(float)cos(a), (float)sin(a), 0.5f}, sizeof *s->normals);
	}
}

/* Up to the largest coordinates that are welded, or down to denormal ones, which coincide; or around the roots of both
 * ends of floats, beyond which squares are no floats; in one direction, or all. Texture coordinates, too. */
static void scale_rows(soup *s, nt_random *random)
{
	float largest = 0, scale;
	const uint32_t axes = nt_random_below(random, 7) + 1, kind = nt_random_below(random, 12);
	const bool texcoords = kind > 3 && nt_random_below(random, 2);
	const size_t step = texcoords ? 2 : 3;
	float *const rows = texcoords ? s->texcoords[0] : s->positions[0];
	for (size_t i = 0; i < 3 * s->corner_count; i++)
		largest = fmaxf(largest, fabsf(s->positions[0][i]));
	scale = (const float[]){FLT_MAX / 2 / largest * 0.999999f, 1e-44f, 1e-38f, 3e-42f, 1e-38f, 1e-23f, 4e-23f,
		1e-19f, 1e-10f, 1e9f, 1e18f, 1e19f}[kind];
	for (size_t i = 0; i < step * s->corner_count; i++)
		if (axes >> i % step & 1)
			rows[i] *= scale;
}

static void sign_zeros(soup *s, nt_random *random)
{
	float *const rows[3] = {s->positions[0], s->normals[0], s->texcoords[0]};
	const uint32_t often = 1 + nt_random_below(random, 6);
	for (int a = 0; a < 3; a++)
		for (size_t i = 0; i < (a < 2 ? 3 : 2) * s->corner_count; i++) {
			if (a == 0 && fabsf(rows[a][i]) < 0.15f * (float)often)
				rows[a][i] = 0;
			if (rows[a][i] == 0 && nt_random_below(random, 2))
				rows[a][i] = -0.0f;
		}
}

/* All on one plane, line or lattice of few points. */
static void round_positions(soup *s, nt_random *random)
{
	const float steps = (float)(1 << nt_random_below(random, 5));
	const uint32_t flat = nt_random_below(random, 8);
	for (size_t i = 0; i < 3 * s->corner_count; i++)
		s->positions[0][i] = flat >> i % 3 & 1 ? 0.5f : roundf(s->positions[0][i] * steps) / steps;
}

static const struct {
	const char *name;
	void (*apply)(soup *s, nt_random *random);
} changes[] = {{"grid", NULL}, {"flat faces", flatten_faces}, {"half-flat quads", flatten_quads},
	{"many normals", vary_normals}, {"scaled", scale_rows}, {"zeros", sign_zeros},
	{"rounded", round_positions}};
enum { CHANGES = sizeof changes / sizeof *changes };

/* Some normals and texture coordinates that are no numbers: such a corner is no vertex with any other, nor with those
 * that have its row. */
static void spoil_rows(float (*normals)[3], float (*texcoords)[2], size_t count, nt_random *random)
{
	const uint32_t often = 2 + nt_random_below(random, 60), kinds = 1 + nt_random_below(random, 3);
	for (size_t v = 0; v < count; v++) {
		if (kinds & 1 && nt_random_below(random, often) == 0)
			normals[v][nt_random_below(random, 3)] = NAN;
		if (kinds & 2 && nt_random_below(random, often) == 0)
			texcoords[v][nt_random_below(random, 2)] = NAN;
	}
}

/* Rows behind the corners' that no corner has: far away, or of no number. */
static void add_unused(soup *s, nt_random *random)
{
	enum { MORE = 3 };
	const uint32_t kinds = nt_random_below(random, 2) ? 5 : 2;
	soup more = soup_make(s->face_count, s->corner_count + MORE);
	memcpy(more.sizes, s->sizes, s->face_count);
	memcpy(more.positions, s->positions, s->corner_count * sizeof *s->positions);
	memcpy(more.normals, s->normals, s->corner_count * sizeof *s->normals);
	memcpy(more.texcoords, s->texcoords, s->corner_count * sizeof *s->texcoords);
	for (size_t i = s->corner_count; i < s->corner_count + MORE; i++)
		for (int k = 0; k < 3; k++)
			more.positions[i][k] =
				more.normals[i][k] = more.texcoords[i][k % 2] =
					(const float[]){-7, 3, NAN, 1e30f, INFINITY}[nt_random_below(random, kinds)];
	more.corner_count = s->corner_count;
	soup_free(s);
	*s = more;
	s->corner_count += MORE;
}

static bool is_usual(const nmtan_mesh *m, size_t corners)
{
	for (size_t c = 0; c < corners; c++) {
		const size_t v = m->indices ? m->indices[c] : c;
		const float *p = (const float *)((const char *)m->positions + m->position_stride_bytes * v);
		for (int i = 0; i < 3; i++)
			if (!(fabsf(p[i]) < FLT_MAX / 2))
				return false;
	}
	return m->face_count > 0;
}

typedef struct tally {
	size_t meshes, different, matter;
} tally;

static void compare(uint64_t seed, const char *kind, const nmtan_mesh *loose, size_t corners, tally *t)
{
	const nmtan_mesh mesh = nt_filled(loose);
	if (!is_usual(&mesh, corners))
		return;
	char name[64];
	snprintf(name, sizeof name, "%s %llu", kind, (unsigned long long)seed);
	nt_result published = solve_reference(&mesh, corners, 0), defined = nt_result_define(&mesh, corners, true);
	nt_result sorted = nt_result_make(corners);
	sorted.sorted = true;
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	const nt_solve solve = nt_result_solve(&mesh, corners, &scratch, &sorted, true);
	assert_int_equal(nt_mikktspace_scalar(&solve), NMTAN_OK);
	nt_scratch_free(&scratch);
	size_t differences = nt_result_differences(&published, &defined, corners, true);
	if (differences)
		print_error("%s: %zu floats differ from mikktspace.c\n", name, differences);
	differences += nt_compare_variants(name, &mesh, corners, &published, seed % 2);
	differences += nt_compare_run(name, &mesh, corners, &sorted, true, nt_cpu_best(), 1, &nt_usual_plan);
	t->meshes++;
	t->different += differences > 0;
	t->matter += nt_result_differences(&published, &sorted, corners, true) > 0;
	nt_result_free(&published);
	nt_result_free(&defined);
	nt_result_free(&sorted);
}

/* The definition at a threshold that the fast path does not know. */
static void compare_threshold(uint64_t seed, const nmtan_mesh *loose, size_t corners, tally *t)
{
	const nmtan_mesh mesh = nt_filled(loose);
	const float degrees = (const float[]){1, 30, 45, 90, 120, 179}[seed % 6];
	nt_result published = solve_reference(&mesh, corners, degrees), found = nt_result_make(corners);
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF,
		.angular_threshold_degrees = degrees, .threads = 1};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = found.tangents,
		.bitangents = found.bitangents, .magnitudes = found.magnitudes};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	const size_t differences = nt_result_differences(&published, &found, corners, true);
	if (differences)
		print_error("%llu at %g degrees: %zu floats differ from mikktspace.c\n", (unsigned long long)seed,
			degrees, differences);
	t->different += differences > 0;
	nt_result_free(&published);
	nt_result_free(&found);
}

static void compare_nasty(uint64_t seed, tally *t)
{
	nt_nasty nasty;
	nt_nasty_make(seed, &nasty);
	compare(seed, "nasty", &nasty.mesh, nasty.corner_count, t);
	nt_nasty_free(&nasty);
}

static void compare_soup(uint64_t seed, tally *t)
{
	nt_random random = nt_random_seed(seed);
	const uint32_t kind = seed % 8 < 4 ? 0 : nt_random_below(&random, CHANGES);
	soup s = seed % 8 == 0    ? soup_random(seed)
		 : seed % 8 == 4   ? make_hub(&random)
		 : seed % 800 == 2 ? make_grid(&random, 1000, 2)
				   : make_ordinary(&random);
	if (changes[kind].apply)
		changes[kind].apply(&s, &random);
	const size_t corners = s.corner_count;
	if (seed % 5 == 0)
		add_unused(&s, &random);
	nmtan_mesh mesh = soup_mesh(&s);
	soup_indexed indexed = soup_index(&s);
	if (seed % 3 == 0)
		mesh = indexed.mesh;
	if (seed % 21 == 0)
		spoil_rows(indexed.normals, indexed.texcoords, mesh.vertex_count, &random);
	else if (seed % 7 == 0)
		spoil_rows(s.normals, s.texcoords, corners, &random);
	if (corners == 3 * mesh.face_count)
		mesh.face_sizes = NULL;
	compare(seed, changes[kind].name, &mesh, corners, t);
	if (seed % 16 == 7 && is_usual(&mesh, corners))
		compare_threshold(seed, &mesh, corners, t);
	soup_indexed_free(&indexed);
	soup_free(&s);
}

int main(int count, char **arguments)
{
	if (count != 3)
		return 64;
	const uint64_t from = strtoull(arguments[1], NULL, 10), end = from + strtoull(arguments[2], NULL, 10);
	tally t = {0};
	for (uint64_t seed = from; seed < end && t.different < 20; seed++)
		(seed % 8 == 1 ? compare_nasty : compare_soup)(seed, &t);
	printf("%zu %zu %zu\n", t.meshes, t.different, t.matter);
	return t.different > 0;
}
