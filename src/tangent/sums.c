/* SPDX-License-Identifier: MIT */
/*
 * The methods that are sums of frames: area, lengyel, robust.
 *
 * `area` weighs corner angle times the two edge lengths, so that a thin bevel, which has large angles
 * but little area, does not tilt the flat faces beside it. `lengyel` adds dP/du as the 2x2 system gives
 * it (E. Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001), which weighs a
 * triangle by the inverse of its texture density. `robust` is MikkTSpace's average without its rounding.
 * All keep mirrored triangles apart, so that w is the sign of the determinant: one sum for each welded
 * vertex and exact orientation.
 *
 * MikkTSpace averages over the part of those triangles that hangs together by paired edges. Where two
 * fans meet in nothing but a vertex, or in a non-manifold edge, or across a collapsed triangle, its parts
 * depend on the order of the triangles and on what is collapsed. One sum does not, and costs no pairing.
 *
 * The passes: weld; unit normals of the welded vertices; 16 triangles at a time (sums_kernel.h), added to
 * the sums of their vertices in triangle order; sums become tangents; corners are written. Threads own
 * ranges of triangles; a vertex belongs to the first range that touches it, and what later ranges have for
 * it is put aside and added afterwards in order, so that bytes do not depend on the number of threads.
 */
#include "tangent/sums.h"

#include <string.h>
#include "base/parallel.h"
#include "topology/corners.h"
#include "topology/weld.h"

/* Below that, starting a thread costs more than it saves. */
enum { TRIANGLE_GRAIN = 32768, VERTEX_GRAIN = 32768 };

/* What becomes of one sum. */
typedef struct sum_result {
	float x, y, z; /* unit tangent, or zero for repair to fill */
	uint32_t flags;
} sum_result;
enum { FLAG_POSITIVE = 1, FLAG_SUSPECT = 2 };
enum { RESULT_ILL = 1, RESULT_MET = 2 /* some triangle has weight here */ };

typedef struct deferred {
	nt_frame_sum *to;
	nt_frame_sum add;
} deferred;

typedef struct summing {
	const nt_solve *solve;
	const nmtan_mesh *mesh;
	nt_weight weight;
	void (*kernel)(nt_sum_block *block); /* NULL: all triangles are hard */
	nt_weld weld;
	nt_dvec3 *normals;         /* [weld.count] unit, or zero */
	size_t triangle_count;
	const uint32_t *corners;   /* [3 * triangle_count] of the mesh; NULL: i is i */
	int8_t *sides;             /* [triangle_count] orientation of its face */
	uint8_t *flags;            /* [triangle_count] FLAG_: what judging need not look at */
	bool know_sides;           /* filled in before the sums; else the sums fill them in */
	uint32_t *first_triangle;  /* [weld.count] that touches the vertex */
	nt_frame_sum (*sums)[2];   /* [weld.count] */
	sum_result (*results)[2];  /* [weld.count] */
	unsigned ranges;
	deferred **deferred;       /* [ranges] */
	size_t *deferred_count;    /* [ranges] */
	size_t *lost_counts;       /* [slots of the finishing pass] results that are zero against weight */
	size_t *ill_counts;        /* [slots of the writing pass] */
} summing;

static size_t corner_of(const summing *s, size_t i)
{
	return s->corners ? s->corners[i] : i;
}

/* The first triangle of a range. */
static size_t range_begin(const summing *s, unsigned range)
{
	return s->triangle_count / s->ranges * range + s->triangle_count % s->ranges * range / s->ranges;
}

/* Triangles of a mesh with quads, and the orientation of each face where it is not just that of its one
 * triangle. */
static nmtan_status make_triangles(summing *s)
{
	const nmtan_mesh *mesh = s->mesh;
	s->know_sides = mesh->face_sizes || nt_has_stored(mesh);
	s->triangle_count = mesh->face_count;
	for (size_t face = 0; mesh->face_sizes && face < mesh->face_count; face++)
		s->triangle_count += mesh->face_sizes[face] == 4;
	s->sides = nt_scratch_alloc(s->solve->scratch, s->triangle_count, 1);
	s->flags = nt_scratch_alloc(s->solve->scratch, s->triangle_count, 1);
	if (!s->sides || !s->flags)
		return NMTAN_ERROR_MEMORY;
	if (!s->know_sides)
		return NMTAN_OK;
	uint32_t *corners = nt_scratch_alloc(s->solve->scratch, s->triangle_count, 3 * sizeof *corners);
	if (!corners)
		return NMTAN_ERROR_MEMORY;
	size_t first = 0, t = 0;
	for (size_t face = 0; face < mesh->face_count; first += nt_face_size(mesh, face++)) {
		uint32_t cut[2][3];
		const unsigned count = nt_face_triangles(mesh, face, first, cut);
		const int orientation = nt_face_orientation(mesh, face, first, true, NULL);
		for (unsigned i = 0; i < count; i++, t++) {
			memcpy(corners + 3 * t, cut[i], sizeof cut[i]);
			s->sides[t] = (int8_t)orientation;
		}
	}
	s->corners = corners;
	return NMTAN_OK;
}

static void unit_normals(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const summing *s = context;
	for (size_t v = begin; v < end; v++) {
		nt_dvec3 n = nt_dvec3_load(s->weld.rows[v].normal);
		s->normals[v] = nt_dvec3_normalise(&n) ? n : (nt_dvec3){0, 0, 0};
	}
}

static void find_first_triangles(summing *s)
{
	memset(s->first_triangle, 0xff, s->weld.count * sizeof *s->first_triangle);
	for (size_t i = 3 * s->triangle_count; i-- > 0;)
		s->first_triangle[s->weld.ids[corner_of(s, i)]] = (uint32_t)(i / 3);
}

static nmtan_status make_deferred(summing *s)
{
	s->deferred = nt_scratch_alloc(s->solve->scratch, s->ranges, sizeof *s->deferred);
	s->deferred_count = nt_scratch_alloc(s->solve->scratch, s->ranges, sizeof *s->deferred_count);
	if (!s->deferred || !s->deferred_count)
		return NMTAN_ERROR_MEMORY;
	for (unsigned r = 0; r < s->ranges; r++) {
		const size_t begin = range_begin(s, r), end = range_begin(s, r + 1);
		size_t count = 0;
		for (size_t i = 3 * begin; r > 0 && i < 3 * end; i++)
			count += s->first_triangle[s->weld.ids[corner_of(s, i)]] < begin;
		s->deferred_count[r] = 0;
		s->deferred[r] = nt_scratch_alloc(s->solve->scratch, count, sizeof **s->deferred);
		if (!s->deferred[r])
			return NMTAN_ERROR_MEMORY;
	}
	return NMTAN_OK;
}

/* Adding */

static void load_lane(const summing *s, size_t t, int lane, nt_sum_block *block)
{
	for (size_t k = 0; k < 3; k++) {
		const uint32_t id = s->weld.ids[corner_of(s, 3 * t + k)];
		const nt_weld_row *row = &s->weld.rows[id];
		const nt_dvec3 n = s->normals[id];
		const double values[8] = {row->position[0], row->position[1], row->position[2], n.x, n.y, n.z,
			row->texcoord[0], row->texcoord[1]};
		for (int i = 0; i < 8; i++)
			block->row[k][i][lane] = values[i];
	}
}

static void add_sum(nt_frame_sum *to, const nt_frame_sum *add)
{
	to->u = nt_dvec3_add(to->u, add->u);
	to->weights += add->weights;
	to->sensitivity += add->sensitivity;
}

/* A corner's contribution goes to its vertex, or aside when the vertex belongs to an earlier range. */
static void add_corner(summing *s, unsigned range, size_t range_first, uint32_t id, int side,
	const nt_frame_sum *add)
{
	nt_frame_sum *to = &s->sums[id][side];
	if (s->ranges > 1 && s->first_triangle[id] < range_first)
		s->deferred[range][s->deferred_count[range]++] = (deferred){to, *add};
	else
		add_sum(to, add);
}

static void add_hard(summing *s, unsigned range, size_t range_first, size_t t)
{
	uint32_t corners[3];
	for (size_t k = 0; k < 3; k++)
		corners[k] = (uint32_t)corner_of(s, 3 * t + k);
	if (!s->know_sides)
		s->sides[t] = (int8_t)nt_triangle_orientation(s->mesh, corners, false);
	s->flags[t] = FLAG_SUSPECT;
	nt_frame_sum parts[3] = {{{0, 0, 0}, 0, 0}, {{0, 0, 0}, 0, 0}, {{0, 0, 0}, 0, 0}};
	nt_frame_sum *const to[3] = {&parts[0], &parts[1], &parts[2]};
	nt_add_triangle(s->mesh, s->weight, corners, to);
	for (int k = 0; k < 3; k++)
		add_corner(s, range, range_first, s->weld.ids[corners[k]], s->sides[t] > 0, &parts[k]);
}

static void add_block(summing *s, unsigned range, size_t range_first, size_t t, const nt_sum_block *block,
	int lane)
{
	if (!s->know_sides)
		s->sides[t] = (int8_t)block->sign[lane];
	s->flags[t] = (block->plain[lane] ? 0 : FLAG_SUSPECT) | (block->sign[lane] > 0 ? FLAG_POSITIVE : 0);
	for (size_t k = 0; k < 3; k++) {
		const double (*a)[NT_SUM_LANES] = block->add[k];
		const nt_frame_sum add = {{a[0][lane], a[1][lane], a[2][lane]}, a[3][lane], a[4][lane]};
		add_corner(s, range, range_first, s->weld.ids[corner_of(s, 3 * t + k)], s->sides[t] > 0, &add);
	}
}

static void sum_range(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	summing *s = context;
	nt_sum_block block;
	for (size_t range = begin; range < end; range++) {
		const size_t first = range_begin(s, (unsigned)range), last = range_begin(s, (unsigned)range + 1);
		for (size_t t = first; t < last; t += NT_SUM_LANES) {
			const int lanes = last - t < NT_SUM_LANES ? (int)(last - t) : NT_SUM_LANES;
			for (int lane = 0; s->kernel && lane < NT_SUM_LANES; lane++)
				load_lane(s, t + (size_t)(lane < lanes ? lane : 0), lane, &block);
			if (s->kernel)
				s->kernel(&block);
			for (int lane = 0; lane < lanes; lane++) {
				if (!s->kernel || block.hard[lane])
					add_hard(s, (unsigned)range, first, t + (size_t)lane);
				else
					add_block(s, (unsigned)range, first, t + (size_t)lane, &block, lane);
			}
		}
	}
}

static void add_deferred(summing *s)
{
	for (unsigned r = 1; r < s->ranges; r++)
		for (size_t i = 0; i < s->deferred_count[r]; i++)
			add_sum(s->deferred[r][i].to, &s->deferred[r][i].add);
}

/* Results */

static void finish_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const summing *s = context;
	size_t lost = 0;
	for (size_t v = begin; v < end; v++) {
		for (int side = 0; side < 2; side++) {
			const nt_frame_sum *sum = &s->sums[v][side];
			sum_result *result = &s->results[v][side];
			nt_dvec3 t;
			if (!nt_sum_tangent(sum, s->normals[v], &t)) {
				t = (nt_dvec3){0, 0, 0};
				lost += sum->weights > 0.0;
			}
			/* no -0, whose sign would tell the path that was taken */
			*result = (sum_result){(float)t.x + 0.0f, (float)t.y + 0.0f, (float)t.z + 0.0f, 0};
			result->flags = (nt_sum_is_ill_conditioned(sum) ? RESULT_ILL : 0) |
					(sum->weights > 0.0 ? RESULT_MET : 0);
		}
	}
	s->lost_counts[slot] = lost;
}

/* A plain triangle has weight at its corners, so its results are unit vectors perpendicular to N unless one
 * was lost. Quads and rounded v are left to judging. */
static void vouch(const summing *s, unsigned slots)
{
	size_t lost = 0;
	for (unsigned slot = 0; slot < slots; slot++)
		lost += s->lost_counts[slot];
	if (s->solve->vouched && lost == 0 && !s->know_sides)
		*s->solve->vouched = (nt_vouched){.flags = s->flags, .positive = FLAG_POSITIVE,
			.suspect = FLAG_SUSPECT};
}

/* A face without orientation takes the orientation that has a sum at its corners. */
static void write_corner(const summing *s, size_t corner, int orientation, size_t *ill)
{
	const nt_solve *solve = s->solve;
	const uint32_t id = s->weld.ids[corner];
	const sum_result *results = s->results[id];
	const int side = orientation ? orientation > 0 : (results[1].flags & RESULT_MET) != 0;
	const sum_result *r = &results[side];
	const float w = side ? 1.0f : -1.0f;
	const float tangent[4] = {r->x, r->y, r->z, w};
	*ill += r->flags & RESULT_ILL;
	memcpy(solve->tangents + 4 * corner, tangent, sizeof tangent);
	if (solve->bitangents) {
		const nt_dvec3 t = {r->x, r->y, r->z};
		const nt_dvec3 b = nt_dvec3_scale(w, nt_dvec3_cross(s->normals[id], t));
		const float bitangent[3] = {(float)b.x, (float)b.y, (float)b.z};
		memcpy(solve->bitangents + 3 * corner, bitangent, sizeof bitangent);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * corner] = solve->magnitudes[2 * corner + 1] = 1.0f;
}

/* By faces. Before face f lie 3 f + q corners and f + q triangles, where q is the number of quads. */
static void write_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const summing *s = context;
	size_t ill = 0, first = nt_first_corner(s->mesh, begin), t = first - 2 * begin;
	for (size_t face = begin; face < end; face++) {
		const unsigned size = nt_face_size(s->mesh, face);
		for (size_t c = first; c < first + size; c++)
			write_corner(s, c, s->sides[t], &ill);
		first += size;
		t += size - 2;
	}
	s->ill_counts[slot] = ill;
}

/* nt_weld_mesh() but for its limit. */
static nmtan_status weld_any_size(summing *s)
{
	nt_scratch *scratch = s->solve->scratch;
	const size_t corner_count = s->solve->corner_count;
	nt_room none = nt_room_over(NULL, 0, scratch);
	if (corner_count < NT_WELD_LIMIT && s->mesh->vertex_count < NT_WELD_LIMIT)
		return nt_weld_mesh(s->mesh, corner_count, &none, &s->weld);
	uint32_t *ids = nt_scratch_alloc(scratch, corner_count, sizeof *ids);
	nt_weld_row *rows = nt_scratch_alloc(scratch, corner_count, sizeof *rows);
	if (!ids || !rows)
		return NMTAN_ERROR_MEMORY;
	const nmtan_status status = nt_weld_corners(s->mesh, corner_count, scratch, ids, &s->weld.count);
	for (size_t c = 0; !status && c < corner_count; c++) {
		const size_t v = nt_vertex_of(s->mesh, c);
		memcpy(rows[ids[c]].position, nt_position(s->mesh, v), sizeof rows->position);
		memcpy(rows[ids[c]].normal, nt_normal(s->mesh, v), sizeof rows->normal);
		memcpy(rows[ids[c]].texcoord, nt_texcoord(s->mesh, v), sizeof rows->texcoord);
	}
	s->weld.ids = ids;
	s->weld.rows = rows;
	return status;
}

static nmtan_status prepare(summing *s)
{
	nt_scratch *scratch = s->solve->scratch;
	nmtan_status status = weld_any_size(s);
	if (status || (status = make_triangles(s)))
		return status;
	s->normals = nt_scratch_alloc(scratch, s->weld.count, sizeof *s->normals);
	s->sums = nt_scratch_alloc(scratch, s->weld.count, sizeof *s->sums);
	s->results = nt_scratch_alloc(scratch, s->weld.count, sizeof *s->results);
	s->first_triangle = nt_scratch_alloc(scratch, s->weld.count, sizeof *s->first_triangle);
	if (!s->normals || !s->sums || !s->results || !s->first_triangle)
		return NMTAN_ERROR_MEMORY;
	memset(s->sums, 0, s->weld.count * sizeof *s->sums);
	s->ranges = nt_parallel_slots(s->solve->threads, s->triangle_count, TRIANGLE_GRAIN);
	if (s->ranges > 1)
		find_first_triangles(s);
	return make_deferred(s);
}

static nmtan_status solve_by_sums(const nt_solve *solve, nt_weight weight, size_t *ill_conditioned)
{
	const nt_sum_kernels *kernels = &nt_sum_kernels_baseline;
#if defined(__x86_64__)
	kernels = solve->isa == NMTAN_ISA_AVX512 ? &nt_sum_kernels_avx512
		  : solve->isa == NMTAN_ISA_AVX2 ? &nt_sum_kernels_avx2
						 : kernels;
#endif
	summing s = {.solve = solve, .mesh = solve->mesh, .weight = weight};
	if (!solve->one_by_one && weight != NT_WEIGHT_NONE)
		s.kernel = weight == NT_WEIGHT_AREA ? kernels->area : kernels->angle;
	const nmtan_status status = prepare(&s);
	if (status)
		return status;
	nt_parallel_ranges(solve->threads, s.weld.count, VERTEX_GRAIN, unit_normals, &s);
	nt_parallel_ranges(s.ranges, s.ranges, 1, sum_range, &s);
	add_deferred(&s);
	unsigned slots = nt_parallel_slots(solve->threads, s.weld.count, VERTEX_GRAIN);
	s.lost_counts = nt_scratch_alloc(solve->scratch, slots, sizeof *s.lost_counts);
	if (!s.lost_counts)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(solve->threads, s.weld.count, VERTEX_GRAIN, finish_range, &s);
	vouch(&s, slots);

	const size_t faces = solve->mesh->face_count;
	slots = nt_parallel_slots(solve->threads, faces, TRIANGLE_GRAIN);
	s.ill_counts = nt_scratch_alloc(solve->scratch, slots, sizeof *s.ill_counts);
	if (!s.ill_counts)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(solve->threads, faces, TRIANGLE_GRAIN, write_range, &s);
	*ill_conditioned = 0;
	for (unsigned slot = 0; slot < slots; slot++)
		*ill_conditioned += s.ill_counts[slot];
	return NMTAN_OK;
}

nmtan_status nt_area(const nt_solve *solve)
{
	size_t ignored;
	return solve_by_sums(solve, NT_WEIGHT_AREA, &ignored);
}

nmtan_status nt_lengyel(const nt_solve *solve)
{
	size_t ignored;
	return solve_by_sums(solve, NT_WEIGHT_NONE, &ignored);
}

nmtan_status nt_robust(const nt_solve *solve, size_t *ill_conditioned)
{
	return solve_by_sums(solve, NT_WEIGHT_ANGLE, ill_conditioned);
}
