/* SPDX-License-Identifier: MIT */
/*
 * Tangents may be wrong by 180 degrees while their w is right: then the bitangent is wrong by 180 degrees too, and
 * bumps look like dents. So it is where a file's tangents were made for texture coordinates that were turned since,
 * or are those of a triangle that rounding has turned over.
 */
#include "topology/corners.h"

#include "base/vec.h"

/* At most cos 120 degrees between a tangent and where u grows, and a bitangent and where v does: reversed beyond what
 * averaging does. One of them alone says little: it may be far off where u and v grow almost the same way. */
static const double REVERSED_COSINE = -0.5;

/* dP/du (of v, `which` 1) or -dP/dv (of u, 0) of a triangle, but for its length. */
static nt_dvec3 direction(const nt_tangent_triangle *t, int which, nt_dvec3 d1, nt_dvec3 d2)
{
	const double a = t->texcoords[0][which], sign = t->orientation;
	return nt_dvec3_sub(nt_dvec3_scale(sign * (t->texcoords[2][which] - a), d1),
		nt_dvec3_scale(sign * (t->texcoords[1][which] - a), d2));
}

bool nt_is_reversed(const nt_tangent_triangle *t)
{
	const nt_dvec3 a = nt_dvec3_load(t->positions[0]);
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(t->positions[1]), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(t->positions[2]), a);
	nt_dvec3 u = direction(t, 1, d1, d2);
	/* nearly all triangles end here, without a root */
	if (nt_dvec3_dot(nt_dvec3_load(t->tangents[0]), u) > 0.0 || !nt_dvec3_normalise(&u))
		return false;
	nt_dvec3 v = nt_dvec3_scale(-1.0, direction(t, 0, d1, d2));
	if (!nt_dvec3_normalise(&v))
		return false;
	const nt_dvec3 face = nt_dvec3_cross(d1, d2);
	for (size_t k = 0; k < 3; k++) {
		const nt_dvec3 normal = nt_dvec3_load(t->normals[k]);
		nt_dvec3 tangent = nt_dvec3_load(t->tangents[k]);
		const double w = t->other_w ? -t->tangents[k][3] : t->tangents[k][3];
		nt_dvec3 bitangent = nt_dvec3_scale(w, nt_dvec3_cross(normal, tangent));
		if (!(nt_dvec3_dot(face, normal) > 0.0) || !nt_dvec3_normalise(&bitangent) ||
			nt_dvec3_dot(bitangent, v) > REVERSED_COSINE || !nt_dvec3_normalise(&tangent) ||
			nt_dvec3_dot(tangent, u) > REVERSED_COSINE)
			return false;
	}
	return true;
}
