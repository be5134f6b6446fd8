/* SPDX-License-Identifier: MIT */
/*
 * Frames and weights of 16 triangles in double, as one plain loop that the compiler makes vectors of.
 * kernel_*.c include this file once for each instruction set, with NT_SUM_KERNEL giving the name.
 *
 * The arithmetic is that of frames.c, operation by operation. What it does with branches (differences
 * that are no doubles, products that cancel, values that are not finite) is only noticed here: such a lane
 * is hard and is left to frames.c. On ordinary meshes few are.
 */
#include <math.h>
#include "base/angle.h"
#include "tangent/sums.h"

#define LANE_INLINE static inline __attribute__((always_inline))

LANE_INLINE double lane_larger(double a, double b)
{
	return a > b ? a : b;
}

LANE_INLINE double lane_largest(double x, double y, double z)
{
	return lane_larger(fabs(x), lane_larger(fabs(y), fabs(z)));
}

/* nt_is_difference() without a branch. */
LANE_INLINE int64_t lane_is_difference(double d, double a, double b)
{
	return (int64_t)(d + a == b) & (int64_t)(b - d == a);
}

LANE_INLINE int64_t lane_cancels(nt_dvec3 p, nt_dvec3 q, nt_dvec3 d)
{
	return NT_CANCELLATION * lane_largest(d.x, d.y, d.z) <
	       lane_larger(lane_largest(p.x, p.y, p.z), lane_largest(q.x, q.y, q.z));
}

LANE_INLINE nt_dvec3 lane_load(const nt_sum_block *block, int corner, int from, int lane)
{
	return (nt_dvec3){block->row[corner][from][lane], block->row[corner][from + 1][lane],
		block->row[corner][from + 2][lane]};
}

/* One corner with edges e to the next and g from the previous vertex; u is the unit direction. */
LANE_INLINE void lane_corner(nt_sum_block *block, int corner, int lane, nt_dvec3 u, nt_dvec3 e, nt_dvec3 g,
	nt_dvec3 across, double across_length, int by_area)
{
	const nt_dvec3 n = lane_load(block, corner, 3, lane);
	const nt_dvec3 direction = nt_dvec3_reject(n, u);
	const double length = nt_dvec3_length(direction);
	const nt_dvec3 pe = nt_dvec3_reject(n, e), pg = nt_dvec3_reject(n, g);
	const double c = -nt_dvec3_dot(pe, pg);
	const double along = fabs(nt_dvec3_dot(n, across));
	const double s = lane_largest(n.x, n.y, n.z) > 0.0 ? along : across_length;
	const double squared = s * s + c * c;
	/* divisors that may be zero are replaced, not branched around: what is divided is zero then, or dropped */
	const double condition = (fabs(c) * across_length + s * sqrt(nt_dvec3_dot(e, e) * nt_dvec3_dot(g, g))) /
				 (squared > 0.0 ? squared : 1.0);
	const double angle = nt_angle_finite(s, c);
	const double factor = by_area ? nt_dvec3_length(e) * nt_dvec3_length(g) : 1.0;
	const double usable = length > NT_PARALLEL ? 1.0 : 0.0;
	const double divisor = length > NT_PARALLEL ? length : 1.0;
	const double scale = usable * (factor * angle / divisor);
	block->add[corner][0][lane] = scale * direction.x;
	block->add[corner][1][lane] = scale * direction.y;
	block->add[corner][2][lane] = scale * direction.z;
	block->add[corner][3][lane] = usable * (factor * angle);
	block->add[corner][4][lane] = usable * (factor * (angle / divisor + condition));
}

LANE_INLINE void lane_triangle(nt_sum_block *block, int lane, int by_area)
{
	const nt_dvec3 p0 = lane_load(block, 0, 0, lane), p1 = lane_load(block, 1, 0, lane),
		       p2 = lane_load(block, 2, 0, lane);
	const double u0 = block->row[0][6][lane], v0 = block->row[0][7][lane];
	const double u1 = block->row[1][6][lane], v1 = block->row[1][7][lane];
	const double u2 = block->row[2][6][lane], v2 = block->row[2][7][lane];
	const nt_dvec3 e0 = nt_dvec3_sub(p1, p0), e1 = nt_dvec3_sub(p2, p1), e2 = nt_dvec3_sub(p0, p2);
	const nt_dvec3 d2 = nt_dvec3_scale(-1.0, e2);
	const double bu = u1 - u0, bv = v1 - v0, cu = u2 - u0, cv = v2 - v0;
	int64_t exact = lane_is_difference(e0.x, p0.x, p1.x) & lane_is_difference(e0.y, p0.y, p1.y) &
			lane_is_difference(e0.z, p0.z, p1.z) & lane_is_difference(d2.x, p0.x, p2.x) &
			lane_is_difference(d2.y, p0.y, p2.y) & lane_is_difference(d2.z, p0.z, p2.z);
	exact &= lane_is_difference(bu, u0, u1) & lane_is_difference(bv, v0, v1) &
		 lane_is_difference(cu, u0, u2) & lane_is_difference(cv, v0, v2);
	const double left = bu * cv, right = bv * cu;
	const double sign = left > right ? 1.0 : -1.0;

	const nt_dvec3 up = nt_dvec3_scale(cv, e0), uq = nt_dvec3_scale(bv, d2);
	const nt_dvec3 ud = nt_dvec3_sub(up, uq), su = nt_dvec3_scale(sign, ud);
	const nt_dvec3 ap = {e0.y * d2.z, e0.z * d2.x, e0.x * d2.y};
	const nt_dvec3 aq = {e0.z * d2.y, e0.x * d2.z, e0.y * d2.x};
	const nt_dvec3 across = nt_dvec3_sub(ap, aq);
	const double across_length = nt_dvec3_length(across);

	/* unit u, as nt_dvec3_normalise() */
	const double largest = lane_largest(su.x, su.y, su.z);
	const nt_dvec3 scaled = {su.x / largest, su.y / largest, su.z / largest};
	const nt_dvec3 u = nt_dvec3_scale(1.0 / sqrt(nt_dvec3_dot(scaled, scaled)), scaled);

	const int64_t easy = exact & (int64_t)(left != right) & (int64_t)(largest > 0.0);
	block->hard[lane] = (easy ^ 1) | lane_cancels(up, uq, ud) | lane_cancels(ap, aq, across);
	block->sign[lane] = left > right ? 1 : -1;
	lane_corner(block, 0, lane, u, e0, e2, across, across_length, by_area);
	lane_corner(block, 1, lane, u, e1, e0, across, across_length, by_area);
	lane_corner(block, 2, lane, u, e2, e1, across, across_length, by_area);
	block->plain[lane] = (block->hard[lane] ^ 1) & (int64_t)(across_length > 0.0) &
			     (int64_t)(block->add[0][3][lane] > 0.0) & (int64_t)(block->add[1][3][lane] > 0.0) &
			     (int64_t)(block->add[2][3][lane] > 0.0);
}

static void sum_by_angle(nt_sum_block *block)
{
	for (int lane = 0; lane < NT_SUM_LANES; lane++)
		lane_triangle(block, lane, 0);
}

static void sum_by_area(nt_sum_block *block)
{
	for (int lane = 0; lane < NT_SUM_LANES; lane++)
		lane_triangle(block, lane, 1);
}

const nt_sum_kernels NT_SUM_KERNEL = {sum_by_angle, sum_by_area};
