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
 * MikkTSpace averages over the part of those triangles that hangs together by paired edges. If two fans meet in
 * nothing but a vertex, or in a non-manifold edge, or across a collapsed triangle, its parts depend on the order of
 * the triangles and on what is collapsed. One sum does not, and costs no pairing: what that saves pays for double
 * precision.
 *
 * The passes: weld; 16 triangles at a time, added to the sums of their vertices in triangle order; 16 sums
 * at a time become tangents (both kernel.h); corners are written, but for those that a caller would
 * rather look up (nt_known.rows). Threads own ranges of triangles; a vertex belongs to the first range
 * that touches it, and what later ranges have for it is put aside and added afterwards in order, so
 * that bytes do not depend on the number of threads.
 *
 * Scratch lives in the output until it is written, where it fits.
 */
#include "tangent/sums/sums.h"

#include <string.h>
#include "base/cpu.h"
#include "base/deadline.h"
#include "base/parallel.h"
#include "tangent/fast/bins.h"
#include "tangent/sums/parts.h"
#include "topology/corners.h"

/* Below that, starting a thread costs more than it saves. */
enum { TRIANGLE_GRAIN = 32768, WELD_GRAIN = 3 * 65536, BLOCK_GRAIN = 2048, MOST_RANGES = UINT16_MAX };

/* Triangles by which the results of a scattered mesh are prefetched before they are read. */
enum { WRITE_AHEAD = 16 };

/* The first range that touches each vertex, and room for what later ones have for it. */
static nmtan_status make_owners(nt_sums *s)
{
	nt_scratch *scratch = s->solve->scratch;
	s->owners = nt_scratch_alloc(scratch, s->weld.count, sizeof *s->owners);
	s->later = nt_scratch_alloc(scratch, s->ranges.count, sizeof *s->later);
	s->later_counts = nt_scratch_alloc(scratch, s->ranges.count, sizeof *s->later_counts);
	if (!s->owners || !s->later || !s->later_counts)
		return NMTAN_ERROR_MEMORY;
	memset(s->owners, 0xff, s->weld.count * sizeof *s->owners);
	const size_t *bounds = s->ranges.bounds;
	for (unsigned r = s->ranges.count; r-- > 0;)
		for (size_t i = 3 * bounds[r]; i < 3 * bounds[r + 1]; i++)
			s->owners[nt_sums_vertex(s, i)] = (uint16_t)r;
	for (unsigned r = 0; r < s->ranges.count; r++) {
		size_t count = 0;
		for (size_t i = 3 * bounds[r]; r > 0 && i < 3 * bounds[r + 1]; i++)
			count += s->owners[nt_sums_vertex(s, i)] != r;
		s->later_counts[r] = 0;
		s->later[r] = nt_scratch_alloc(scratch, count, sizeof **s->later);
		if (!s->later[r])
			return NMTAN_ERROR_MEMORY;
	}
	return NMTAN_OK;
}

/* nt_weld_mesh() but for its limit. */
static nmtan_status weld_any_size(nt_sums *s, nt_borrowed *memory)
{
	const nt_solve *solve = s->solve;
	if (solve->corner_count < NT_WELD_LIMIT && solve->mesh->vertex_count < NT_WELD_LIMIT)
		return nt_weld_mesh(solve->mesh, solve->corner_count,
			nt_parallel_slots(solve->threads, solve->corner_count, WELD_GRAIN), memory, memory, &s->weld);
	uint32_t *ids = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *ids);
	nt_weld_row *rows = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *rows);
	if (!ids || !rows)
		return NMTAN_ERROR_MEMORY;
	const nmtan_status status = nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, ids,
		&s->weld.count);
	for (size_t c = 0; !status && c < solve->corner_count; c++)
		nt_weld_load(solve->mesh, nt_vertex_of(solve->mesh, c), &rows[ids[c]]);
	s->weld.ids = ids;
	s->weld.rows = rows;
	return status;
}

static nmtan_status prepare(nt_sums *s, nt_borrowed *memory)
{
	const double begin = nt_seconds();
	nmtan_status status = weld_any_size(s, memory);
	if (s->solve->timing)
		s->solve->timing->weld += nt_seconds() - begin;
	const nmtan_mesh *mesh = s->solve->mesh;
	s->triangle_count = nt_triangle_count(mesh, s->solve->corner_count);
	s->triangles.ids = s->weld.ids;
	if (!status)
		status = nt_cut_faces(mesh, s->triangle_count, s->solve->scratch, &s->flags, &s->triangles);
	if (status)
		return status;
	s->scattered = nt_is_scattered(s->weld.ids, s->solve->corner_count, s->weld.count);
	const unsigned ranges = nt_parallel_slots(s->solve->threads, s->triangle_count, TRIANGLE_GRAIN);
	status = nt_cut_ranges(s->flags, s->triangle_count, ranges < MOST_RANGES ? ranges : MOST_RANGES,
		s->solve->scratch, &s->ranges);
	return !status && s->ranges.count > 1 ? make_owners(s) : status;
}

/* Summing */

static bool make_sums(nt_sums *s, int side, nt_borrowed *memory)
{
	s->sums[side] = nt_borrowed_alloc(memory, s->weld.count, sizeof **s->sums);
	s->results[side] = nt_scratch_alloc(s->solve->scratch, s->weld.count, sizeof **s->results);
	if (!s->sums[side] || !s->results[side])
		return false;
	memset(s->sums[side], 0, s->weld.count * sizeof **s->sums);
	return true;
}

typedef struct run {
	nt_sums *s;
	const nt_sum_kernels *kernels;
	nt_sums_finished *finished; /* [used_threads] */
	size_t *ill;                /* [ranges] corners */
} run;

static void sum_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const run *r = context;
	const size_t *bounds = r->s->ranges.bounds;
	for (size_t range = begin; range < end; range++) {
		int side;
		r->kernels->accumulate(r->s, bounds[range], bounds[range + 1], (unsigned)range, &side);
	}
}

static void add_later(const nt_sums *s)
{
	for (unsigned r = 1; r < s->ranges.count; r++) {
		for (size_t i = 0; i < s->later_counts[r]; i++) {
			const nt_later *later = &s->later[r][i];
			later->to->x += later->add.x;
			later->to->y += later->add.y;
			later->to->z += later->add.z;
			later->to->sensitivity += later->add.sensitivity;
		}
	}
}

static nmtan_status sum_up(const run *r, nt_borrowed *memory)
{
	nt_sums *s = r->s;
	if (s->ranges.count > 1) {
		if (!make_sums(s, 0, memory) || !make_sums(s, 1, memory))
			return NMTAN_ERROR_MEMORY;
		nt_parallel_ranges(s->ranges.count, s->ranges.count, 1, sum_ranges, (void *)r);
		add_later(s);
		return NMTAN_OK;
	}
	/* sums of an orientation exist from the first triangle that has it */
	int side = 0;
	for (size_t t = 0;;) {
		t = r->kernels->accumulate(s, t, s->triangle_count, 0, &side);
		if (t == s->triangle_count)
			return NMTAN_OK;
		if (!make_sums(s, side, memory))
			return NMTAN_ERROR_MEMORY;
	}
}

/* Results */

static void finish_blocks(void *context, size_t begin, size_t end, unsigned thread)
{
	const run *r = context;
	nt_sums_finished finished = {0};
	r->kernels->finish(r->s, begin, end, &finished);
	r->finished[thread] = finished;
}

static nmtan_status finish(const run *given, nt_sums_finished *sum)
{
	run r = *given;
	nt_sums *s = r.s;
	const unsigned threads = s->solve->threads;
	const size_t blocks = (s->weld.count + NT_SUM_LANES - 1) / NT_SUM_LANES;
	const unsigned used_threads = nt_parallel_slots(threads, blocks, BLOCK_GRAIN);
	s->vertex_flags = nt_scratch_alloc(s->solve->scratch, s->weld.count, 1);
	r.finished = nt_scratch_alloc(s->solve->scratch, used_threads, sizeof *r.finished);
	if (!s->vertex_flags || !r.finished)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(threads, blocks, BLOCK_GRAIN, finish_blocks, &r);
	for (unsigned i = 0; i < used_threads; i++) {
		sum->lost += r.finished[i].lost;
		sum->ill += r.finished[i].ill;
	}
	return NMTAN_OK;
}

/* The sign at a corner whose vertex does not tell it: repair looks at the whole face. */
enum { NO_SIDE = -1 };

/* The orientation whose sum a corner gets. */
static int side_of(const nt_sums *s, uint8_t flags, uint8_t vertex)
{
	if (!(flags & NT_SUM_NONE))
		return flags & NT_SUM_POSITIVE;
	const bool negative = vertex & NT_VERTEX_MET, positive = vertex & NT_VERTEX_MET << 1;
	return s->solve->repair && negative == positive ? NO_SIDE : positive;
}

static void write_corner(const nt_sums *s, size_t corner, uint32_t id, int side)
{
	const nt_solve *solve = s->solve;
	nt_vertex_tangent r = {0, 0, 0, 0};
	if (side != NO_SIDE && s->results[side])
		r = s->results[side][id];
	if (r.w == 0.0f && !solve->repair)
		r.w = side ? 1.0f : -1.0f;
	memcpy(solve->tangents + 4 * corner, &r, sizeof r);
	if (solve->bitangents) {
		const nt_dvec3 t = {r.x, r.y, r.z};
		const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, corner));
		const nt_dvec3 b = nt_dvec3_scale(r.w, nt_dvec3_cross(n, t));
		const float bitangent[3] = {(float)b.x + 0.0f, (float)b.y + 0.0f, (float)b.z + 0.0f};
		memcpy(solve->bitangents + 3 * corner, bitangent, sizeof bitangent);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * corner] = solve->magnitudes[2 * corner + 1] = 1.0f;
}

/* Whether a triangle's corner is one of the first half of its quad, too. */
static bool is_counted(const nt_sums *s, size_t t, size_t corner)
{
	for (unsigned k = 0; k < 3 && s->flags[t] & NT_SUM_SECOND; k++)
		if (nt_triangle_corner(&s->triangles, t - 1, k) == corner)
			return true;
	return false;
}

/* Writes any triangle, and returns how many of its corners are ill-conditioned. A face without orientation
 * takes that of the sums at its corners. Triangles that the check has to see become suspect. */
static size_t write_triangle(const nt_sums *s, size_t t)
{
	size_t ill = 0;
	for (unsigned k = 0; k < 3; k++) {
		const size_t corner = nt_triangle_corner(&s->triangles, t, k);
		const uint32_t id = s->weld.ids[corner];
		const uint8_t flags = s->flags[t], vertex = s->vertex_flags[id];
		const int side = side_of(s, flags, vertex);
		const bool none = side == NO_SIDE || !s->results[side];
		if (!none && (vertex & NT_VERTEX_LOST << side))
			s->flags[t] |= NT_SUM_SUSPECT;
		const bool is_ill = none || (vertex & NT_VERTEX_ILL << side);
		ill += is_ill && !is_counted(s, t, corner);
		if (is_ill && s->solve->faults && s->weight == NT_WEIGHT_ANGLE)
			s->solve->faults[corner] |= NMTAN_FAULT_ILL_CONDITIONED;
		write_corner(s, corner, id, side);
	}
	return ill;
}

/* Triangles without anything special, and tangents only. */
static void write_plain(const nt_sums *s, size_t t, const nt_vertex_tangent *results)
{
	const uint32_t *ids = s->weld.ids + 3 * t;
	const nt_vertex_tangent a = results[ids[0]], b = results[ids[1]], c = results[ids[2]];
	float *out = s->solve->tangents + 12 * t;
	memcpy(out, &a, sizeof a);
	memcpy(out + 4, &b, sizeof b);
	memcpy(out + 8, &c, sizeof c);
}

static void prefetch_results(const nt_sums *s, size_t t, size_t end)
{
	if (t >= end)
		return;
	const nt_vertex_tangent *results = s->results[s->flags[t] & NT_SUM_POSITIVE];
	for (size_t i = 3 * t; results && i < 3 * t + 3; i++)
		NT_PREFETCH(&results[nt_sums_vertex(s, i)]);
}

typedef struct writing {
	const run *r;
	bool careful; /* some result is lost or ill-conditioned, or more than triangles' tangents are wanted */
	bool sparse;  /* rows of triangles that are not suspect are not wanted */
} writing;

static size_t write_range(const writing *w, size_t begin, size_t end)
{
	const nt_sums *s = w->r->s;
	size_t ill = 0;
	for (size_t t = begin; t < end; t++) {
		if (s->scattered)
			prefetch_results(s, t + WRITE_AHEAD, end);
		const uint8_t flags = s->flags[t];
		if (w->careful || (flags & NT_SUM_SUSPECT))
			ill += write_triangle(s, t);
		else if (!w->sparse)
			write_plain(s, t, s->results[flags & NT_SUM_POSITIVE]);
	}
	return ill;
}

static void write_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const writing *w = context;
	const nt_sums *s = w->r->s;
	for (size_t range = begin; range < end; range++)
		w->r->ill[range] = write_range(w, s->ranges.bounds[range], s->ranges.bounds[range + 1]);
}

/* Tells the check for unusable tangents what it need not look at: a plain triangle has weight at its corners, so
 * that its results are unit vectors perpendicular to N unless one was lost, and its sign is exact. */
static void tell_known(const nt_sums *s, bool sparse)
{
	nt_known *known = s->solve->known;
	if (!known)
		return;
	*known = (nt_known){.flags = s->flags, .suspect = NT_SUM_SUSPECT, .positive = NT_SUM_POSITIVE,
		.doubtful = NT_SUM_SUSPECT, .welded = s->weld.ids, .welded_count = s->weld.count};
	if (!sparse)
		return;
	known->ids = s->weld.ids;
	known->row_step = 4;
	for (int side = 0; side < 2; side++)
		known->rows[side] = s->results[side] ? &s->results[side]->x : NULL;
}

static nmtan_status write_results(run *r, const nt_sums_finished *finished, size_t *ill_conditioned)
{
	nt_sums *s = r->s;
	const nt_solve *solve = s->solve;
	const writing w = {.r = r,
		.careful = finished->lost || finished->ill || s->triangles.cuts || solve->bitangents ||
			   solve->magnitudes,
		.sparse = solve->sparse && solve->known && !s->triangles.cuts};
	r->ill = nt_scratch_alloc(solve->scratch, s->ranges.count, sizeof *r->ill);
	if (!r->ill)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(s->ranges.count, s->ranges.count, 1, write_ranges, (void *)&w);
	tell_known(s, w.sparse);
	*ill_conditioned = 0;
	for (unsigned range = 0; range < s->ranges.count; range++)
		*ill_conditioned += r->ill[range];
	return NMTAN_OK;
}

static nmtan_status solve_by_sums(const nt_solve *solve, nt_weight weight, size_t *ill_conditioned)
{
	nt_sums s = {.solve = solve, .weight = weight, .one_by_one = solve->one_by_one};
	run r = {.s = &s, .kernels = NT_CPU_TABLE(solve->isa, nt_sum_kernels)};
	/* a sparse output is not filled, so that its pages need not exist */
	nt_borrowed memory = nt_borrow(solve->tangents, solve->sparse ? 0 : solve->corner_count * 4 * sizeof(float),
		solve->scratch);
	nt_sums_finished finished = {0};
	nmtan_status status = prepare(&s, &memory);
	if (!status)
		status = sum_up(&r, &memory);
	if (!status)
		status = finish(&r, &finished);
	if (!status && finished.ill && weight == NT_WEIGHT_ANGLE)
		nt_sums_judge_ill(&s);
	return status ? status : write_results(&r, &finished, ill_conditioned);
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
