/* SPDX-License-Identifier: MIT */
/*
 * The weighted u direction of one corner in each of 16 lanes (spec page, step 8), and the bits of its record's state.
 * Steps of a loop each: lanes.h has them in order. The arithmetic is that of the scalar definition wherever a value
 * reaches the output. Included by lanes.h.
 */
#ifndef NT_TANGENT_FAST_CORNER_LANES_H
#define NT_TANGENT_FAST_CORNER_LANES_H

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "tangent/acos.h"
#include "tangent/fast/frame_lanes.h"

/* A component is beyond 2^-7 or -2^-7 if this, added to its upper half, sets the bit below the sign's; so it does up to
 * 2^121. Two unit vectors that both are, along one axis and on one side, have a dot product of at least
 * 2 * 2^-14 - 1 = -0.99988, well away from the -1 at which step 7 parts them: rounding moves it by 1e-6. The smaller
 * the distance is, the fewer vertices fail the test.
 *
 * Lengths in here are normalised without loss: their squares neither overflow nor lose bits. Across a normal of unit
 * length a unit vector becomes shorter. So v need not be divided by its length before the test; across long
 * normals, where its components are below 2 and its length is below 3.5, the product is still above 1.0e-5 - 1. */
#define BEYOND 0x0400u

/* The same for whole floats from 2^-100 up to 2^28. */
#define WELL_INSIDE 0x32800000u

/* Below the sign of a float: it is 2 or more, infinite, or NaN. */
#define TWO 0x40000000u

static inline NT_ALWAYS_INLINE uint32_t bits_of(float x)
{
	uint32_t bits;
	memcpy(&bits, &x, sizeof bits);
	return bits;
}

/* The upper halves of two floats. */
static inline NT_ALWAYS_INLINE uint32_t halves_of(float low, float high)
{
	return bits_of(low) >> 16 | (bits_of(high) & 0xffff0000u);
}

/* The bits of a state that vectors u and v have, and NT_STATE_SOUND where v is beyond somewhere and `sound` has the bit
 * of TWO. Comparisons would take the ports that multiply, which are the busiest here. */
static inline NT_ALWAYS_INLINE uint32_t state_of(const float u[3], const float v[3], uint32_t sound)
{
	const uint32_t both = BEYOND << 16 | BEYOND;
	const uint32_t a = halves_of(u[0], u[1]) + both, b = halves_of(u[2], v[0]) + both,
		c = halves_of(v[1], v[2]) + both;
	/* sign and beyond, six times two bits */
	const uint32_t all = (a & 0xc000c000u) | (b >> 2 & 0x30003000u) | (c >> 4 & 0x0c000c00u);
	const uint32_t beyond = all & 0x54005400u, sides = beyond + (all >> 1 & beyond);
	return NT_STATE_BASE | NT_STATE_NO_ANY | NT_STATE_LOCAL | (sides & 0xfc00u) | (sides >> 22 & 0x03ffu) |
	       ((sound & (b | c | c << 16)) >> 30 & NT_STATE_SOUND);
}

/* Corners in lanes, by component. */
typedef struct corner_lanes {
	const float (*n)[NT_TRIANGLES];                 /* normal */
	const float (*u)[NT_TRIANGLES], (*v)[NT_TRIANGLES]; /* directions of the triangle's frame */
	const float (*e)[NT_TRIANGLES], (*f)[NT_TRIANGLES]; /* edges at the corner */
	float turned;                               /* -1 where one of them runs towards it, or 1 */
	float (*sum)[NT_TRIANGLES], (*extra)[NT_TRIANGLES]; /* as in lanes_out */
} corner_lanes;

/* Each corner's unit directions, the bits of what holds for it, and the cosine of its angle as seen along n, at most 1.
 * NaN may become a number: of a corner that is not sound nothing is used. */
static inline NT_ALWAYS_INLINE void find_directions(corner_lanes a, float *NT_RESTRICT cosines, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float e[3] = {a.e[0][i], a.e[1][i], a.e[2][i]};
	const float f[3] = {a.f[0][i], a.f[1][i], a.f[2][i]};
	const float os[3] = {a.u[0][i], a.u[1][i], a.u[2][i]};
	const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
	/* across the normal */
	const float ne = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
	const float nf = n[0] * f[0] + n[1] * f[1] + n[2] * f[2];
	const float nu = n[0] * os[0] + n[1] * os[1] + n[2] * os[2];
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	const float ex = e[0] - ne * n[0], ey = e[1] - ne * n[1], ez = e[2] - ne * n[2];
	const float fx = f[0] - nf * n[0], fy = f[1] - nf * n[1], fz = f[2] - nf * n[2];
	const float ux = os[0] - nu * n[0], uy = os[1] - nu * n[1], uz = os[2] - nu * n[2];
	const float v[3] = {ot[0] - nv * n[0], ot[1] - nv * n[1], ot[2] - nv * n[2]};

	const float er = a.turned / sqrtf(ex * ex + ey * ey + ez * ez);
	const float fr = 1.0f / sqrtf(fx * fx + fy * fy + fz * fz);
	const float cosine = (er * ex) * (fr * fx) + (er * ey) * (fr * fy) + (er * ez) * (fr * fz);
	cosines[i] = copysignf(fabsf(cosine) < 1.0f ? fabsf(cosine) : 1.0f, cosine);
	const float uu = ux * ux + uy * uy + uz * uz, ur = 1.0f / sqrtf(uu);
	const float u[3] = {ur * ux, ur * uy, ur * uz};
	/* with this square of u the definition normalises as well; the product of an edge without length is NaN; v is
	 * as long as it is: see BEYOND */
	const uint32_t sound =
		(bits_of(uu) + WELL_INSIDE) & ~(bits_of(v[0]) | bits_of(v[1]) | bits_of(v[2]) | bits_of(cosine));
	const uint32_t state = state_of(u, v, sound);
	a.sum[0][i] = u[0];
	a.sum[1][i] = u[1];
	a.sum[2][i] = u[2];
	memcpy(&a.sum[3][i], &state, sizeof state);
}

/* Directions are weighted by the angle, which replaces its cosine. */
static inline NT_ALWAYS_INLINE void weigh_corner(corner_lanes a, float *NT_RESTRICT angles, int i)
{
	const float w = nt_acos(angles[i]);
	a.sum[0][i] *= w;
	a.sum[1][i] *= w;
	a.sum[2][i] *= w;
	angles[i] = w;
}

/* The directions of v and the magnitudes, weighted, and the weight. */
static inline NT_ALWAYS_INLINE void weigh_more(corner_lanes a, const float *NT_RESTRICT angles,
	const lanes_out *out, int i)
{
	const float n[3] = {a.n[0][i], a.n[1][i], a.n[2][i]};
	const float ot[3] = {a.v[0][i], a.v[1][i], a.v[2][i]};
	const float nv = n[0] * ot[0] + n[1] * ot[1] + n[2] * ot[2];
	const float x = ot[0] - nv * n[0], y = ot[1] - nv * n[1], z = ot[2] - nv * n[2];
	const float r = 1.0f / sqrtf(x * x + y * y + z * z), w = angles[i], size = fabsf(out->area[i]);
	a.extra[0][i] = r * x * w;
	a.extra[1][i] = r * y * w;
	a.extra[2][i] = r * z * w;
	a.extra[3][i] = w;
	a.extra[4][i] = w * (out->length_u[i] / size);
	a.extra[5][i] = w * (out->length_v[i] / size);
	a.extra[6][i] = 0.0f;
	a.extra[7][i] = 0.0f;
}

#endif
