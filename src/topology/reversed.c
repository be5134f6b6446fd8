/* SPDX-License-Identifier: MIT */
/*
 * Tangents may be wrong by 180 degrees while their w is right: then the bitangent is wrong by 180 degrees too, and
 * bumps look like dents. So it is where a file's tangents were made for texture coordinates that were turned since,
 * or are those of a triangle that rounding has turned over.
 */
#include "topology/reversed.h"

#include "base/dvec.h"

/* At most cos 120 degrees between a tangent and where u grows, and a bitangent and where v does: reversed beyond what
 * averaging does. One of them alone says little: it may be far off where u and v grow almost the same way. */
static const double REVERSED_COSINE = -0.5;

/* dP/du and dP/dv of a triangle, but for their lengths. */
static void directions_of_uv(const nt_tangent_triangle *t, nt_dvec3 d1, nt_dvec3 d2, nt_dvec3 *u, nt_dvec3 *v)
{
	const float *ta = t->texcoords[0], *tb = t->texcoords[1], *tc = t->texcoords[2];
	const double sign = t->orientation;
	*v = nt_dvec3_sub(nt_dvec3_scale(sign * ((double)tb[0] - ta[0]), d2),
		nt_dvec3_scale(sign * ((double)tc[0] - ta[0]), d1));
	*u = nt_dvec3_sub(nt_dvec3_scale(sign * ((double)tc[1] - ta[1]), d1),
		nt_dvec3_scale(sign * ((double)tb[1] - ta[1]), d2));
}

bool nt_is_reversed(const nt_tangent_triangle *t)
{
	const nt_dvec3 a = nt_dvec3_load(t->positions[0]);
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(t->positions[1]), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(t->positions[2]), a), face = nt_dvec3_cross(d1, d2);
	nt_dvec3 u, v;
	directions_of_uv(t, d1, d2, &u, &v);
	/* nearly all triangles end here, without a root */
	if (nt_dvec3_dot(nt_dvec3_load(t->tangents[0]), u) > 0.0 || !nt_dvec3_normalise(&u) || !nt_dvec3_normalise(&v))
		return false;
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
