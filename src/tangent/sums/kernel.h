/* SPDX-License-Identifier: MIT */
/*
 * The passes of sums.c that need lanes, as plain loops over 16 of them that the compiler makes vectors of.
 * sums_kernel_*.c include this file once for each instruction set, with NT_SUM_KERNEL naming the table of its
 * passes. Rows are gathered and turned by tangent/fast/turn.h of the fast path.
 *
 * accumulate: 16 triangles at a time. The arithmetic is that of frames.c, operation by operation, in steps
 * that each fit the registers: directions, their second look where products cancel, lengths, corners.
 * Values that are not finite, vertices without a normal and differences that are no doubles and cancel
 * are only noticed here: such a lane is hard and is left to frames.c. On ordinary meshes none is.
 *
 * finish: 16 vertices at a time, sums become tangents.
 */
#include <math.h>
#include "base/exact.h"
#include "tangent/fast/turn.h"
#include "tangent/sums/parts.h"
#include "tangent/weigh.h"

#define LANE_INLINE static inline NT_ALWAYS_INLINE
#define LANES(i) for (int i = 0; i < NT_SUM_LANES; i++)

/* Everything finite is below; so are products of three. */
#define SUM_HUGE 1e100

/* Data that goes from one step to the next, by lane. */
typedef struct sum_lanes {
	NT_ALIGNED(64) float row[3][8][NT_SUM_LANES]; /* corner, float of its nt_weld_row */
	double uv[4][NT_SUM_LANES];    /* the texture edges bu, bv, cu, cv */
	double edge[3][3][NT_SUM_LANES];
	double u[3][NT_SUM_LANES], across[3][NT_SUM_LANES];
	double sign[NT_SUM_LANES], determinant[NT_SUM_LANES]; /* |determinant| of the texture edges */
	double squared[NT_SUM_LANES], u_length[NT_SUM_LANES], across_length[NT_SUM_LANES];
	double length[3][NT_SUM_LANES]; /* of edges */
	double normals[NT_SUM_LANES];   /* product of the normals' squares; > 0: all are there */
	double weight[NT_SUM_LANES];    /* the least sensitivity of the corners */
	/* 0 or 1: a second look is needed */
	double u_cancels[NT_SUM_LANES], across_cancels[NT_SUM_LANES], tie[NT_SUM_LANES];
	double determinant_cancels[NT_SUM_LANES];
} sum_lanes;

LANE_INLINE double lane_larger(double a, double b)
{
	return a > b ? a : b;
}

LANE_INLINE double lane_largest(double x, double y, double z)
{
	return lane_larger(fabs(x), lane_larger(fabs(y), fabs(z)));
}

/* Flags are doubles, 0 or 1: SSE2 has no comparison of 64-bit integers. */
#define FLAG(condition) ((condition) ? 1.0 : 0.0)

LANE_INLINE double lane_cancels(double most, nt_dvec3 p, nt_dvec3 q, nt_dvec3 d)
{
	return FLAG(most * lane_largest(d.x, d.y, d.z) <
		    lane_larger(lane_largest(p.x, p.y, p.z), lane_largest(q.x, q.y, q.z)));
}

LANE_INLINE nt_dvec3 lane_load(const double (*from)[NT_SUM_LANES], int i)
{
	return (nt_dvec3){from[0][i], from[1][i], from[2][i]};
}

LANE_INLINE void lane_store(double (*to)[NT_SUM_LANES], int i, nt_dvec3 v)
{
	to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z;
}

LANE_INLINE nt_dvec3 lane_floats(const float (*from)[NT_SUM_LANES], int i)
{
	return (nt_dvec3){from[0][i], from[1][i], from[2][i]};
}

/* Directions and signs. */
static void NT_NOINLINE sum_frames(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block,
	double offset, double slack)
{
	LANES(i) {
		const nt_dvec3 p0 = lane_floats(l->row[0], i), p1 = lane_floats(l->row[1], i),
			       p2 = lane_floats(l->row[2], i);
		const double u0 = l->row[0][6][i], v0 = l->row[0][7][i];
		const double u1 = l->row[1][6][i], v1 = l->row[1][7][i];
		const double u2 = l->row[2][6][i], v2 = l->row[2][7][i];
		const nt_dvec3 e0 = nt_dvec3_sub(p1, p0), e1 = nt_dvec3_sub(p2, p1), e2 = nt_dvec3_sub(p0, p2);
		const nt_dvec3 d2 = nt_dvec3_scale(-1.0, e2);
		const double bu = u1 - u0, bv = v1 - v0, cu = u2 - u0, cv = v2 - v0;
		const double inexact_uv = nt_difference_error(bu, u0, u1) + nt_difference_error(bv, v0, v1) +
					  nt_difference_error(cu, u0, u2) + nt_difference_error(cv, v0, v2);
		const double inexact = inexact_uv +
			nt_difference_error(e0.x, p0.x, p1.x) + nt_difference_error(e0.y, p0.y, p1.y) +
			nt_difference_error(e0.z, p0.z, p1.z) + nt_difference_error(d2.x, p0.x, p2.x) +
			nt_difference_error(d2.y, p0.y, p2.y) + nt_difference_error(d2.z, p0.z, p2.z);
		const double exact_uv = FLAG(inexact_uv == 0.0), exact = FLAG(inexact == 0.0);
		const double sum = fabs(e0.x) + fabs(e0.y) + fabs(e0.z) + fabs(d2.x) + fabs(d2.y) + fabs(d2.z) +
				   fabs(bu) + fabs(bv) + fabs(cu) + fabs(cv);

		const double left = bu * cv, right = bv * cu, difference = fabs(left - right);
		const double larger = lane_larger(fabs(left), fabs(right));
		const double some = FLAG(larger > 0.0), uneven = FLAG(difference > 0.0);
		const double tie = exact_uv * some * (1.0 - uneven);
		const double apart = FLAG(NT_CANCELLATION_INEXACT * difference >= larger);

		const nt_dvec3 up = nt_dvec3_scale(cv, e0), uq = nt_dvec3_scale(bv, d2), u = nt_dvec3_sub(up, uq);
		const nt_dvec3 ap = {e0.y * d2.z, e0.z * d2.x, e0.x * d2.y};
		const nt_dvec3 aq = {e0.z * d2.y, e0.x * d2.z, e0.y * d2.x};
		const nt_dvec3 across = nt_dvec3_sub(ap, aq);
		const double most = inexact == 0.0 ? NT_CANCELLATION : NT_CANCELLATION_INEXACT;
		const double u_cancels = lane_cancels(most, up, uq, u);
		const double across_cancels = lane_cancels(most, ap, aq, across);

		l->tie[i] = tie;
		l->determinant[i] = difference;
		l->determinant_cancels[i] = exact_uv * FLAG(NT_CANCELLATION * difference < larger);
		l->u_cancels[i] = u_cancels * exact;
		l->across_cancels[i] = across_cancels * exact;
		/* not finite; a sign in doubt; inexact and cancelling */
		block->hard[i] = FLAG(!(sum < SUM_HUGE)) + (1.0 - exact_uv) * (1.0 - apart) +
				 some * (1.0 - exact) * (u_cancels + across_cancels);
		l->sign[i] = left > right ? 1.0 : left < right ? -1.0 : 0.0;
		/* storing moves each v by u |v + offset| at most, u = 2^-24, an edge by twice that */
		block->certain[i] = FLAG(slack * ((fabs(v0) + fabs(v1) + fabs(v2) + offset) * (fabs(bu) + fabs(cu))) <=
					 difference);
		l->uv[0][i] = bu, l->uv[1][i] = bv, l->uv[2][i] = cu, l->uv[3][i] = cv;
		lane_store(l->edge[0], i, e0);
		lane_store(l->edge[1], i, e1);
		lane_store(l->edge[2], i, e2);
		lane_store(l->u, i, u);
		lane_store(l->across, i, across);
	}
}

#if defined(__FMA__) || defined(NT_SET_AVX2) || defined(__ARM_FEATURE_FMA)
LANE_INLINE double lane_product_difference(double a, double b, double c, double d)
{
	const double product = c * d;
	return fma(a, b, -product) + fma(-c, d, product);
}

/* A second look, with residuals, at what cancels. */
static void NT_NOINLINE sum_cancelled(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block)
{
	(void)block;
	LANES(i) {
		const nt_dvec3 d1 = lane_load(l->edge[0], i), e2 = lane_load(l->edge[2], i);
		const nt_dvec3 d2 = nt_dvec3_scale(-1.0, e2);
		const double bu = l->uv[0][i], bv = l->uv[1][i], cu = l->uv[2][i], cv = l->uv[3][i];
		const nt_dvec3 u = {lane_product_difference(cv, d1.x, bv, d2.x),
			lane_product_difference(cv, d1.y, bv, d2.y), lane_product_difference(cv, d1.z, bv, d2.z)};
		const nt_dvec3 across = {lane_product_difference(d1.y, d2.z, d1.z, d2.y),
			lane_product_difference(d1.z, d2.x, d1.x, d2.z),
			lane_product_difference(d1.x, d2.y, d1.y, d2.x)};
		for (int c = 0; c < 3; c++) {
			const double uc = c == 0 ? u.x : c == 1 ? u.y : u.z;
			const double ac = c == 0 ? across.x : c == 1 ? across.y : across.z;
			l->u[c][i] = l->u_cancels[i] != 0.0 ? uc : l->u[c][i];
			l->across[c][i] = l->across_cancels[i] != 0.0 ? ac : l->across[c][i];
		}
		const double determinant = fabs(lane_product_difference(bu, cv, bv, cu));
		l->determinant[i] = l->determinant_cancels[i] != 0.0 ? determinant : l->determinant[i];
		const double rest = fma(bu, cv, -(bu * cv)) - fma(bv, cu, -(bv * cu));
		const double sign = rest > 0.0 ? 1.0 : rest < 0.0 ? -1.0 : 0.0;
		l->sign[i] = l->tie[i] != 0.0 ? sign : l->sign[i];
	}
}
#else
/* Without fused operations these lanes are hard. */
static void sum_cancelled(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block)
{
	LANES(i)
		block->hard[i] += l->u_cancels[i] + l->across_cancels[i] + l->tie[i] + l->determinant_cancels[i];
}
#endif

LANE_INLINE void sum_lengths(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block, int by_area)
{
	LANES(i) {
		const nt_dvec3 u = nt_dvec3_scale(l->sign[i], lane_load(l->u, i));
		const nt_measured m = nt_measure(u, lane_load(l->across, i));
		lane_store(l->u, i, u);
		l->squared[i] = m.squared;
		l->u_length[i] = m.u_length;
		l->across_length[i] = m.across_length;
		for (int k = 0; k < 3; k++)
			l->length[k][i] = nt_measure_edge(lane_load(l->edge[k], i), by_area);
		l->normals[i] = 1.0;
		l->weight[i] = INFINITY;
		block->sign[i] = l->sign[i];
	}
}

LANE_INLINE void sum_corner(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block, int k, nt_weight weight)
{
	const int before = (k + 2) % 3, by_area = weight == NT_WEIGHT_AREA;
	LANES(i) {
		const nt_dvec3 raw = lane_floats(l->row[k] + 3, i), n = nt_weigh_normal(raw.x, raw.y, raw.z);
		const double squared = nt_dvec3_dot(raw, raw);
		const nt_measured m = {lane_load(l->u, i), lane_load(l->across, i), l->squared[i], l->u_length[i],
			l->across_length[i]};
		const double sine = fabs(nt_dvec3_dot(n, m.across));
		const double inverse = l->sign[i] != 0.0 ? 1.0 / l->determinant[i] : 0.0;
		const nt_weighed w = weight == NT_WEIGHT_NONE
			? nt_weigh_nothing(&m, n, inverse)
			: nt_weigh_corner(&m, n, lane_load(l->edge[k], i), lane_load(l->edge[before], i),
				  l->length[k][i], l->length[before][i], sine, by_area);
		lane_store(block->add[k], i, w.u);
		block->add[k][3][i] = w.sensitivity;
		l->normals[i] = squared > 0.0 && squared < SUM_HUGE ? l->normals[i] : 0.0;
		l->weight[i] = w.sensitivity < l->weight[i] ? w.sensitivity : l->weight[i];
	}
}

LANE_INLINE void sum_corners(sum_lanes *NT_RESTRICT l, nt_sum_block *NT_RESTRICT block, nt_weight weight)
{
	sum_lengths(l, block, weight == NT_WEIGHT_AREA);
	sum_corner(l, block, 0, weight);
	sum_corner(l, block, 1, weight);
	sum_corner(l, block, 2, weight);
	LANES(i) {
		block->hard[i] += FLAG(!(l->normals[i] > 0.0));
		block->plain[i] = FLAG(block->hard[i] == 0.0) * FLAG(l->sign[i] != 0.0) *
				  FLAG(l->across_length[i] > 0.0) * FLAG(l->weight[i] > 0.0);
	}
}

static void NT_NOINLINE sum_corners_by_angle(sum_lanes *l, nt_sum_block *block)
{
	sum_corners(l, block, NT_WEIGHT_ANGLE);
}

static void NT_NOINLINE sum_corners_by_area(sum_lanes *l, nt_sum_block *block)
{
	sum_corners(l, block, NT_WEIGHT_AREA);
}

static void NT_NOINLINE sum_corners_unweighted(sum_lanes *l, nt_sum_block *block)
{
	sum_corners(l, block, NT_WEIGHT_NONE);
}

static void sum_solve(const nt_sums *s, const uint32_t *ids, size_t count, sum_lanes *l, nt_sum_block *block)
{
	const double offset = nt_stored_v_offset(s->solve->mesh);
	gather_lanes(s->weld.rows, ids, count, NT_SUM_LANES, l->row[0][0], NT_SUM_LANES);
	sum_frames(l, block, fabs(offset), offset != 0.0 ? 3 * 0x1p-24 : 0.0);
	const double asked = FLAG(s->weight == NT_WEIGHT_NONE);
	double cancelled = 0.0;
	LANES(i) {
		l->determinant_cancels[i] *= asked;
		cancelled += l->u_cancels[i] + l->across_cancels[i] + l->tie[i] + l->determinant_cancels[i];
	}
	if (cancelled != 0.0)
		sum_cancelled(l, block);
	if (s->weight == NT_WEIGHT_AREA)
		sum_corners_by_area(l, block);
	else if (s->weight == NT_WEIGHT_NONE)
		sum_corners_unweighted(l, block);
	else
		sum_corners_by_angle(l, block);
}

LANE_INLINE uint8_t sum_flags(const nt_sum_block *block, size_t i)
{
	return (uint8_t)((block->sign[i] > 0.0 ? NT_SUM_POSITIVE : 0) | (block->sign[i] == 0.0 ? NT_SUM_NONE : 0) |
			 (block->plain[i] != 0.0 ? 0 : NT_SUM_SUSPECT));
}

/* Flags of the lanes, after hard ones have been done. */
static void sum_classify(const nt_sums *s, size_t first, size_t count, nt_sum_block *block)
{
	uint8_t *flags = s->flags + first;
	const bool ask = nt_has_stored_texcoords(s->solve->mesh);
	double odd = s->one_by_one;
	LANES(i)
		odd += block->hard[i] + (1.0 - block->certain[i]);
	if (odd == 0.0 && !s->triangles.cuts && !ask) {
		for (size_t i = 0; i < count; i++)
			flags[i] = sum_flags(block, i);
		return;
	}
	for (size_t i = 0; i < count; i++) {
		if (block->hard[i] != 0.0 || s->one_by_one)
			nt_sums_do_hard(s, first + i, (int)i, block);
		flags[i] = (flags[i] & NT_SUM_SECOND) | sum_flags(block, i);
	}
	for (size_t i = 0; i < count; i++) {
		const bool quad = i + 1 < count && (flags[i + 1] & NT_SUM_SECOND);
		const bool differ = quad && ((flags[i] ^ flags[i + 1]) & (NT_SUM_POSITIVE | NT_SUM_NONE));
		const bool doubtful = ask || block->certain[i] == 0.0 || (quad && block->certain[i + 1] == 0.0);
		if (differ || doubtful)
			nt_sums_orient(s, first + i);
		i += quad;
	}
}

/* Which sums these triangles need that do not exist; -1: none. */
static int sum_missing(const nt_sums *s, size_t first, size_t count)
{
	unsigned seen = 0;
	if (s->sums[0] && s->sums[1])
		return -1;
	for (size_t i = 0; i < count; i++)
		seen |= s->flags[first + i] & NT_SUM_NONE ? 0 : 1u << (s->flags[first + i] & NT_SUM_POSITIVE);
	return (seen & 1) && !s->sums[0] ? 0 : (seen & 2) && !s->sums[1] ? 1 : -1;
}

#if WIDTH > 1
/* Four rows of four doubles, turned, in each 32-byte part of the vectors: see turn(). */
#if WIDTH == 16
enum { SUM_PARTS = 2 };
#define IN_DOUBLES(a, b, c, d) DOUBLES(0, a, b, c, d), DOUBLES(4, a, b, c, d)
#else
enum { SUM_PARTS = 1 };
#define IN_DOUBLES(a, b, c, d) DOUBLES(0, a, b, c, d)
#endif
#define DOUBLES(part, a, b, c, d) DOUBLE(part, a), DOUBLE(part, b), DOUBLE(part, c), DOUBLE(part, d)
#define DOUBLE(part, i) ((part) + (i) % 4 + (i) / 4 * 4 * SUM_PARTS)
typedef double double_lanes __attribute__((vector_size(32 * SUM_PARTS)));

LANE_INLINE void turn_doubles(double_lanes rows[4])
{
	const double_lanes ab02 = __builtin_shufflevector(rows[0], rows[1], IN_DOUBLES(0, 4, 2, 6));
	const double_lanes ab13 = __builtin_shufflevector(rows[0], rows[1], IN_DOUBLES(1, 5, 3, 7));
	const double_lanes cd02 = __builtin_shufflevector(rows[2], rows[3], IN_DOUBLES(0, 4, 2, 6));
	const double_lanes cd13 = __builtin_shufflevector(rows[2], rows[3], IN_DOUBLES(1, 5, 3, 7));
	rows[0] = __builtin_shufflevector(ab02, cd02, IN_DOUBLES(0, 1, 4, 5));
	rows[1] = __builtin_shufflevector(ab13, cd13, IN_DOUBLES(0, 1, 4, 5));
	rows[2] = __builtin_shufflevector(ab02, cd02, IN_DOUBLES(2, 3, 6, 7));
	rows[3] = __builtin_shufflevector(ab13, cd13, IN_DOUBLES(2, 3, 6, 7));
}

LANE_INLINE size_t turned_double_place(size_t lane)
{
	const size_t in_vectors = lane % (4 * SUM_PARTS);
	return lane - in_vectors + in_vectors % 4 * SUM_PARTS + in_vectors / 4;
}

LANE_INLINE void sum_add_one(nt_vertex_sum *to, const nt_vertex_sum *add)
{
	typedef double four_doubles __attribute__((vector_size(32)));
	four_doubles sum, more;
	memcpy(&sum, to, sizeof sum);
	memcpy(&more, add, sizeof more);
	sum += more;
	memcpy(to, &sum, sizeof sum);
}
#else
LANE_INLINE size_t turned_double_place(size_t lane)
{
	return lane;
}

LANE_INLINE void sum_add_one(nt_vertex_sum *to, const nt_vertex_sum *add)
{
	to->x += add->x, to->y += add->y, to->z += add->z;
	to->sensitivity += add->sensitivity;
}
#endif

/* Adds the lanes to their vertices, in order; or aside, where the vertex belongs to an earlier range. */
static void NT_NOINLINE sum_add(nt_sums *s, size_t first, const uint32_t *ids, size_t count, unsigned range,
	const nt_sum_block *block)
{
	NT_ALIGNED(64) nt_vertex_sum rows[3][NT_SUM_LANES]; /* in turned places */
#if WIDTH > 1
	for (size_t k = 0; k < 3; k++)
		for (size_t i = 0; i < NT_SUM_LANES; i += 4 * SUM_PARTS) {
			double_lanes four[4];
			for (size_t c = 0; c < 4; c++) {
				double_lanes one; /* copied to an element it would go by halves (gcc 12, AVX2) */
				memcpy(&one, block->add[k][c] + i, sizeof one);
				four[c] = one;
			}
			turn_doubles(four);
			for (size_t c = 0; c < 4; c++)
				memcpy(rows[k] + i + SUM_PARTS * c, &four[c], sizeof four[c]);
		}
#else
	for (size_t k = 0; k < 3; k++)
		for (size_t i = 0; i < NT_SUM_LANES; i++)
			rows[k][i] = (nt_vertex_sum){block->add[k][0][i], block->add[k][1][i], block->add[k][2][i],
				block->add[k][3][i]};
#endif
	const bool alone = s->ranges.count == 1;
	for (size_t i = 0; i < count; i++, ids += 3) {
		const uint8_t flags = s->flags[first + i];
		const size_t place = turned_double_place(i);
		if (flags & NT_SUM_NONE)
			continue;
		nt_vertex_sum *to = s->sums[flags & NT_SUM_POSITIVE];
		for (size_t k = 0; k < 3; k++) {
			if (alone || s->owners[ids[k]] == range) {
				sum_add_one(to + ids[k], &rows[k][place]);
				continue;
			}
			nt_later *later = &s->later[range][s->later_counts[range]++];
			later->to = to + ids[k];
			later->add = rows[k][place];
		}
	}
}

/* Scattered vertices: what the batch after the next needs. */
LANE_INLINE void sum_prefetch(const nt_sums *s, size_t first, size_t end)
{
	const nt_vertex_sum *sums = s->sums[1] ? s->sums[1] : s->sums[0];
	const size_t far = first + 2 * NT_SUM_LANES < end ? first + 2 * NT_SUM_LANES : end;
	const size_t count = end - far < NT_SUM_LANES ? end - far : NT_SUM_LANES;
	uint32_t copy[3 * NT_SUM_LANES];
	const uint32_t *ids = nt_triangle_vertices(&s->triangles, far, count, copy);
	for (size_t i = 0; i < 3 * count; i++) {
		NT_PREFETCH(&s->weld.rows[ids[i]]);
		if (sums)
			NT_PREFETCH_TO_WRITE(&sums[ids[i]]);
	}
}

static size_t sum_accumulate(nt_sums *s, size_t begin, size_t end, unsigned range, int *side)
{
	sum_lanes l;
	nt_sum_block block = {.hard = {0}};
	for (size_t first = begin, count; first < end; first += count) {
		count = end - first < NT_SUM_LANES ? end - first : NT_SUM_LANES;
		if (first + count < end && (s->flags[first + count] & NT_SUM_SECOND))
			count--; /* halves of a quad stay together */
		if (s->scattered)
			sum_prefetch(s, first, end);
		uint32_t copy[3 * NT_SUM_LANES];
		const uint32_t *ids = nt_triangle_vertices(&s->triangles, first, count, copy);
		if (!s->one_by_one)
			sum_solve(s, ids, count, &l, &block);
		sum_classify(s, first, count, &block);
		const int missing = sum_missing(s, first, count);
		if (missing >= 0) {
			*side = missing;
			return first;
		}
		sum_add(s, first, ids, count, range, &block);
	}
	return end;
}

/* Finishing */

typedef struct finish_lanes {
	double sum[4][NT_SUM_LANES];
	float row[8][NT_SUM_LANES];
	double normal[3][NT_SUM_LANES];
	float tangent[4][NT_SUM_LANES];
	double flags[NT_SUM_LANES]; /* of NT_VERTEX_MET and its like, which are small numbers */
} finish_lanes;

/* Unit normals of `count` vertices; zero where they are not finite. */
static void NT_NOINLINE finish_normals(const nt_weld_row *rows, size_t count, finish_lanes *NT_RESTRICT l)
{
	uint32_t ids[3 * NT_SUM_LANES];
	for (uint32_t i = 0; i < NT_SUM_LANES; i++)
		ids[3 * i] = i < count ? i : 0;
	for (size_t lane = 0; lane < NT_SUM_LANES; lane += WIDTH)
		gather_corner(rows, ids + 3 * lane, l->row[0] + lane, NT_SUM_LANES);
	LANES(i) {
		const nt_dvec3 raw = lane_floats(l->row + 3, i), unit = nt_weigh_normal(raw.x, raw.y, raw.z);
		const double finite = nt_dvec3_dot(raw, raw) < SUM_HUGE ? 1.0 : 0.0;
		l->normal[0][i] = finite != 0.0 ? unit.x : 0.0;
		l->normal[1][i] = finite != 0.0 ? unit.y : 0.0;
		l->normal[2][i] = finite != 0.0 ? unit.z : 0.0;
	}
}

static void NT_NOINLINE finish_solve(finish_lanes *NT_RESTRICT l, float sign)
{
	LANES(i) {
		const nt_dvec3 sum = lane_load(l->sum, i), n = lane_load(l->normal, i);
		const double sensitivity = l->sum[3][i];
		const double squared = nt_dvec3_dot(sum, sum), bound = sensitivity * sensitivity;
		const nt_dvec3 t = nt_dvec3_reject(n, sum);
		const double length = nt_dvec3_dot(t, t);
		const double sound = FLAG(squared > NT_CANCELLED * NT_CANCELLED * bound) * FLAG(length > 0.0) *
				     FLAG(length < SUM_HUGE * SUM_HUGE);
		const double well = FLAG(bound <= NT_WELL_CONDITIONED * NT_WELL_CONDITIONED * squared) * sound;
		const double met = FLAG(sensitivity > 0.0);
		const double scale = nt_rsqrt(length);
		/* no -0, whose sign would tell the path that was taken */
		l->tangent[0][i] = (float)(sound != 0.0 ? scale * t.x : 0.0) + 0.0f;
		l->tangent[1][i] = (float)(sound != 0.0 ? scale * t.y : 0.0) + 0.0f;
		l->tangent[2][i] = (float)(sound != 0.0 ? scale * t.z : 0.0) + 0.0f;
		l->tangent[3][i] = sensitivity > 0.0 ? sign : 0.0f;
		l->flags[i] = (double)NT_VERTEX_MET * met + (double)NT_VERTEX_LOST * met * (1.0 - sound) +
			(double)NT_VERTEX_ILL * (1.0 - well);
	}
}

static void finish_load(const nt_sums *s, int side, size_t first, size_t count, finish_lanes *NT_RESTRICT l)
{
	const nt_vertex_sum *sums = s->sums[side] + first;
	nt_vertex_sum copy[NT_SUM_LANES];
	if (count < NT_SUM_LANES) {
		memset(copy, 0, sizeof copy);
		memcpy(copy, sums, count * sizeof *copy);
		sums = copy;
	}
	for (size_t i = 0; i < NT_SUM_LANES; i += 4) {
		nt_vertex_sum four[4];
		memcpy(four, sums + i, sizeof four);
		for (size_t j = 0; j < 4; j++) {
			l->sum[0][i + j] = four[j].x, l->sum[1][i + j] = four[j].y;
			l->sum[2][i + j] = four[j].z, l->sum[3][i + j] = four[j].sensitivity;
		}
	}
}

static void sum_finish(const nt_sums *s, size_t begin, size_t end, nt_sums_finished *finished)
{
	finish_lanes l;
	for (size_t first = begin * NT_SUM_LANES; first < end * NT_SUM_LANES; first += NT_SUM_LANES) {
		const size_t left = s->weld.count - first, count = left < NT_SUM_LANES ? left : NT_SUM_LANES;
		uint8_t *flags = s->vertex_flags + first;
		memset(flags, 0, count);
		finish_normals(s->weld.rows + first, count, &l);
		for (int side = 0; side < 2; side++) {
			if (!s->sums[side])
				continue;
			finish_load(s, side, first, count, &l);
			finish_solve(&l, side ? 1.0f : -1.0f);
			float tangents[4 * NT_SUM_LANES];
			interleave(l.tangent[0], NT_SUM_LANES, NT_SUM_LANES, tangents);
			for (size_t i = 0; i < count; i++) {
				const unsigned found = (unsigned)l.flags[i];
				memcpy(&s->results[side][first + i], tangents + 4 * turned_place(i), 4 * sizeof(float));
				flags[i] |= (uint8_t)(found << side);
				finished->lost += (found & NT_VERTEX_LOST) != 0;
				finished->ill += (found & NT_VERTEX_MET) && (found & NT_VERTEX_ILL);
			}
		}
	}
}

const nt_sum_kernels NT_SUM_KERNEL = {sum_accumulate, sum_finish};
