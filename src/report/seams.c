/* SPDX-License-Identifier: MIT */
/*
 * Mirror seams: the edges on whose two sides texture coordinates are wound differently, in walking
 * order, with what a technical artist asks of a seam: where it is, how long, whether it closes, how sharp
 * the surface bends there, how far the tangents of its sides are apart, and in which plane it lies.
 * Boundary loops are counted here too, since they are traced alike.
 *
 * Sides of one edge may share their vertices or have vertices of their own; both count.
 */
#include "report/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/angle.h"
#include "base/vec.h"
#include "scene/values.h"

/* A seam lies in a plane when its points keep within this part of the mesh's extent. */
static const double PLANE_TOLERANCE = 1e-4;

/* ---- one edge ---- */

static nt_dvec3 face_normal(const nt_surface *s, uint32_t t)
{
	const nt_dvec3 a = nt_dvec3_load(nt_side_position(s, 3 * t));
	const nt_dvec3 b = nt_dvec3_load(nt_side_position(s, 3 * t + 1));
	const nt_dvec3 c = nt_dvec3_load(nt_side_position(s, 3 * t + 2));
	return nt_dvec3_cross(nt_dvec3_sub(b, a), nt_dvec3_sub(c, a));
}

/* dP/du of a triangle, but for its length. */
static nt_dvec3 face_tangent(const nt_surface *s, uint32_t t)
{
	const float *ta = nt_side_texcoord(s, 3 * t);
	const float *tb = nt_side_texcoord(s, 3 * t + 1), *tc = nt_side_texcoord(s, 3 * t + 2);
	const nt_dvec3 a = nt_dvec3_load(nt_side_position(s, 3 * t));
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, 3 * t + 1)), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, 3 * t + 2)), a);
	const double sign = s->orientation[t];
	return nt_dvec3_sub(nt_dvec3_scale(sign * ((double)tc[1] - ta[1]), d1),
		nt_dvec3_scale(sign * ((double)tb[1] - ta[1]), d2));
}

/* Degrees between two vectors, NaN where one has no direction. */
static double angle_between(nt_dvec3 a, nt_dvec3 b)
{
	if (!nt_dvec3_normalise(&a) || !nt_dvec3_normalise(&b))
		return NAN;
	const nt_dvec3 cross = nt_dvec3_cross(a, b);
	return nt_angle(sqrt(nt_dvec3_dot(cross, cross)), nt_dvec3_dot(a, b)) * NT_DEGREES;
}

static void widen(double range[2], double value)
{
	range[0] = fmin(range[0], value); /* fmin and fmax pass NaN over */
	range[1] = fmax(range[1], value);
}

/* ---- what a normal map can hide ---- */

/*
 * A baker writes the difference of two frames into the texels of each side. If both sides look up the same texels, it
 * cannot: the seam shows if the frames differ by more than one step of an 8-bit map, 1 / 127, unless the map is flat
 * across it.
 */
static const double HIDDEN_DEGREES = 0.45;

/* Coordinates at one place of the texture, as the sampler wraps them; a whole tile away floats are rounded. */
static bool same_texel(const nt_check *check, const float *a, const float *b)
{
	for (int axis = 0; axis < 2; axis++) {
		const nt_mesh *mesh = check->mesh;
		double d = fabs(nt_wrap_coordinate(mesh, axis, a[axis]) - nt_wrap_coordinate(mesh, axis, b[axis]));
		if (mesh->wrap[axis] == NT_WRAP_REPEAT && d > 0.5) /* 0 and 1 are neighbours */
			d = 1.0 - d;
		if (!(d <= 1e-6 * fmax(1.0, fmax(fabs(a[axis]), fabs(b[axis])))))
			return false;
	}
	return true;
}

/* The tangent of a corner: as it is stored, else as it was computed; NULL: there is none. */
static const float *corner_tangent(const nt_check *check, uint32_t side)
{
	const uint32_t corner = nt_side_corner(&check->surface, side);
	if (check->stored != NT_STORED_NONE)
		return nt_stored_tangent(check, corner);
	const nt_mesh *mesh = check->mesh;
	if (mesh->corner_tangents)
		return mesh->corner_tangents + 4 * (size_t)corner;
	if (!mesh->split.vertex_tangents)
		return NULL;
	return mesh->split.vertex_tangents +
		4 * (size_t)(mesh->split.indices ? mesh->split.indices[corner] : nt_side_vertex(&check->surface, side));
}

/* The end of an edge's side (0 or 1), as it is seen from a point at one of them on: the side that begins there. */
static uint32_t end_from(const nt_surface *s, uint32_t side, uint32_t from, int end)
{
	return (nt_side_point(s, side) == from) == !end ? side : nt_side_next(side);
}

/* Adds an edge to frame_angle, same_texel_count and unhidden_count. */
static void compare_frames(const nt_check *check, const nt_edge *edge, uint32_t from, nt_seam *seam)
{
	const nt_surface *s = &check->surface;
	bool same = true;
	double greatest = 0.0;
	for (int end = 0; end < 2; end++) {
		const uint32_t one = end_from(s, edge->sides[0], from, end);
		const uint32_t two = end_from(s, edge->sides[1], from, end);
		const float *a = corner_tangent(check, one), *b = corner_tangent(check, two);
		same = same && same_texel(check, nt_side_texcoord(s, one), nt_side_texcoord(s, two));
		const double angle = a && b ? angle_between(nt_dvec3_load(a), nt_dvec3_load(b)) : NAN;
		widen(seam->frame_angle, angle);
		greatest = fmax(greatest, angle);
	}
	seam->same_texel_count += same;
	seam->unhidden_count += same && greatest > HIDDEN_DEGREES;
}

/* ---- the edge's other numbers ---- */

/* The vertex that stands for a corner in the output, as the mesh by itself numbers it: copies come behind the vertices
 * of the source. */
static uint32_t output_vertex(const nt_check *check, uint32_t side)
{
	const nt_mesh *mesh = check->mesh;
	const uint32_t vertex = nt_is_written(check) && mesh->split.indices
		? mesh->split.indices[nt_side_corner(&check->surface, side)] : nt_side_vertex(&check->surface, side);
	return vertex < mesh->source_vertex_count ? nt_mesh_pool_vertex(mesh, vertex)
						  : vertex + (uint32_t)mesh->unused_vertices;
}

nt_seam_edge nt_describe_edge(const nt_check *check, const nt_edge *edge, uint32_t from)
{
	const nt_surface *s = &check->surface;
	nt_seam_edge result = {.triangles = {edge->sides[0] / 3, edge->sides[1] / 3}};
	for (int i = 0; i < 2; i++)
		for (int end = 0; end < 2; end++) {
			const uint32_t side = end_from(s, edge->sides[i], from, end), vertex = nt_side_vertex(s, side);
			result.vertices[i][end] = nt_source_vertex(check->mesh, vertex);
			result.output[i][end] = output_vertex(check, side);
			nt_source_texcoord(check->scene, check->mesh->texcoords + 2 * (size_t)vertex,
				result.texcoords[i][end]);
			memcpy(result.positions[end], nt_side_position(s, side), sizeof result.positions[end]);
		}
	/* the dihedral angle is 0 on a flat surface; sides that run the same way face each other's back */
	nt_dvec3 other = face_normal(s, result.triangles[1]);
	if (nt_side_point(s, edge->sides[0]) == nt_side_point(s, edge->sides[1]))
		other = nt_dvec3_scale(-1.0, other);
	result.dihedral = (float)angle_between(face_normal(s, result.triangles[0]), other);
	result.tangent_angle = (float)angle_between(face_tangent(s, result.triangles[0]),
		face_tangent(s, result.triangles[1]));
	return result;
}

/* ---- the plane ---- */

/* Sums over a seam's edges for fitting a plane. */
typedef struct plane_sums {
	nt_dvec3 across; /* from the mirrored triangles' third points to the unmirrored ones' */
	nt_dvec3 points;
	size_t count;
} plane_sums;

static nt_dvec3 third_point(const nt_surface *s, uint32_t side)
{
	return nt_dvec3_load(nt_side_position(s, nt_side_next(nt_side_next(side))));
}

static void add_to_sums(const nt_surface *s, const nt_edge *edge, plane_sums *sums)
{
	nt_dvec3 d = nt_dvec3_sub(third_point(s, edge->sides[0]), third_point(s, edge->sides[1]));
	if (nt_dvec3_dot(d, sums->across) < 0.0)
		d = nt_dvec3_scale(-1.0, d);
	sums->across = nt_dvec3_add(sums->across, d);
	sums->points = nt_dvec3_add(sums->points, nt_dvec3_load(nt_side_position(s, edge->sides[0])));
	sums->points = nt_dvec3_add(sums->points,
		nt_dvec3_load(nt_side_position(s, nt_side_next(edge->sides[0]))));
	sums->count += 2;
}

/* Whether all points of the seam lie in the plane n p = d. */
static bool plane_holds(const nt_check *check, const nt_chains *chains, size_t chain, nt_dvec3 n,
	double d, double tolerance)
{
	for (size_t i = chains->first[chain]; i < chains->first[chain + 1]; i++) {
		const uint32_t side = check->mirrors.items[chains->edges[i]].sides[0];
		for (uint32_t end = 0; end < 2; end++) {
			const float *p = nt_side_position(&check->surface, end ? nt_side_next(side) : side);
			if (!(fabs(nt_dvec3_dot(n, nt_dvec3_load(p)) - d) <= tolerance))
				return false;
		}
	}
	return true;
}

/*
 * The plane across which the triangles beside the seam are each other's image, if the seam lies in it: its
 * normal is the mean direction from one side to the other. A plane along two axes is tried first, since
 * that is how symmetric models are made.
 */
static void fit_plane(const nt_check *check, const nt_chains *chains, size_t chain, nt_seam *seam,
	const plane_sums *sums)
{
	const double tolerance = PLANE_TOLERANCE * nt_box_extent(&check->facts->box);
	const nt_dvec3 centre = nt_dvec3_scale(1.0 / (double)sums->count, sums->points);
	const double at[3] = {centre.x, centre.y, centre.z};
	const nt_dvec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
	nt_dvec3 across = sums->across;
	if (!nt_dvec3_normalise(&across))
		return;
	int axis = fabs(across.x) >= fabs(across.y) ? 0 : 1;
	if (fabs(across.z) > fabs(axis ? across.y : across.x))
		axis = 2;
	if (plane_holds(check, chains, chain, axes[axis], at[axis], tolerance)) {
		const double d = fabs(at[axis]) <= tolerance ? 0.0 : at[axis];
		seam->has_plane = true;
		memcpy(seam->plane, (double[4]){axes[axis].x, axes[axis].y, axes[axis].z, d},
			sizeof seam->plane);
		snprintf(seam->plane_text, sizeof seam->plane_text, "%c = %.6g", "xyz"[axis], d);
		return;
	}
	const double d = nt_dvec3_dot(across, centre);
	if (!plane_holds(check, chains, chain, across, d, tolerance))
		return;
	seam->has_plane = true;
	memcpy(seam->plane, (double[4]){across.x, across.y, across.z, d}, sizeof seam->plane);
	snprintf(seam->plane_text, sizeof seam->plane_text, "%.3gx %+.3gy %+.3gz = %.4g", across.x,
		across.y, across.z, d);
}

/* The same plane in the world, of a mesh that is scaled: its normal goes by cofactors. large: coordinates are. */
static void move_plane(const nt_report_mesh *facts, bool large, nt_seam *seam)
{
	const double *m = facts->world, *p = seam->plane;
	const float on[3] = {(float)(p[0] * p[3]), (float)(p[1] * p[3]), (float)(p[2] * p[3])};
	double at[3], n[3];
	if (!seam->has_plane || !facts->is_scaled)
		return;
	nt_world_point(facts, on, at);
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		n[i] = p[0] * (m[4 + j] * m[8 + k] - m[4 + k] * m[8 + j]) +
			p[1] * (m[8 + j] * m[k] - m[8 + k] * m[j]) + p[2] * (m[j] * m[4 + k] - m[k] * m[4 + j]);
	}
	nt_dvec3 normal = {n[0], n[1], n[2]};
	if (!nt_dvec3_normalise(&normal))
		return;
	const double d = normal.x * at[0] + normal.y * at[1] + normal.z * at[2];
	const double parts[3] = {normal.x, normal.y, normal.z};
	memcpy(seam->plane, (double[4]){normal.x, normal.y, normal.z, d}, sizeof seam->plane);
	snprintf(seam->plane_text, sizeof seam->plane_text, "%.3gx %+.3gy %+.3gz = %.*g", normal.x, normal.y, normal.z,
		large ? 10 : 4, d);
	for (int i = 0; i < 3; i++)
		if (fabs(parts[i]) > 1.0 - 1e-9)
			snprintf(seam->plane_text, sizeof seam->plane_text, "%c = %.*g", "xyz"[i], large ? 10 : 6,
				d * parts[i]);
}

/* ---- one seam ---- */

static nt_status describe_seam(nt_check *check, const nt_chains *chains, size_t chain, nt_seam *seam)
{
	const nt_surface *s = &check->surface;
	const size_t first = chains->first[chain];
	*seam = (nt_seam){.closed = chains->closed[chain],
		.edge_count = chains->first[chain + 1] - first,
		.dihedral = {NAN, NAN}, .tangent_angle = {NAN, NAN}, .frame_angle = {NAN, NAN},
		.box = nt_box_empty()};
	const size_t kept = seam->edge_count < NT_SEAM_EDGES ? seam->edge_count : NT_SEAM_EDGES;
	seam->edges = nt_arena_alloc(&check->report->arena, kept, sizeof *seam->edges);
	if (!seam->edges)
		return NT_ERROR_MEMORY;
	plane_sums sums = {0};
	for (size_t i = 0; i < seam->edge_count; i++) {
		const nt_edge *mirror = &check->mirrors.items[chains->edges[first + i]];
		const uint32_t side = mirror->sides[0];
		const uint32_t from = nt_side_point(s, chains->reversed[first + i] ? nt_side_next(side) : side);
		const nt_seam_edge edge = nt_describe_edge(check, mirror, from);
		if (i < kept)
			seam->edges[i] = edge;
		seam->length += nt_world_length(check->facts, edge.positions[0], edge.positions[1]);
		widen(seam->dihedral, edge.dihedral);
		widen(seam->tangent_angle, edge.tangent_angle);
		compare_frames(check, mirror, from, seam);
		seam->shared_count += edge.vertices[0][0] == edge.vertices[1][0] &&
			edge.vertices[0][1] == edge.vertices[1][1];
		seam->non_manifold_count += mirror->non_manifold;
		nt_box_add(&seam->box, edge.positions[0]);
		nt_box_add(&seam->box, edge.positions[1]);
		add_to_sums(s, mirror, &sums);
		if (i == 0) {
			seam->islands[0] = check->islands[edge.triangles[0]];
			seam->islands[1] = check->islands[edge.triangles[1]];
		}
	}
	fit_plane(check, chains, chain, seam, &sums);
	move_plane(check->facts, nt_scene_has_origin(check->scene), seam);
	return NT_OK;
}

static double widest_angle(const nt_seam *seam)
{
	return isfinite(seam->frame_angle[1]) ? seam->frame_angle[1] : 0.0;
}

/* Seams that show come first. */
static double rank_of(const nt_seam *seam)
{
	return 1000.0 * (double)seam->unhidden_count + widest_angle(seam);
}

/* A seam and its chain, while seams are put in order. */
typedef struct numbered_seam {
	nt_seam seam;
	size_t chain;
} numbered_seam;

/* As findings are listed: by rank, then by edges. */
static int compare_seams(const void *a, const void *b)
{
	const numbered_seam *x = a, *y = b;
	const double ranks[2] = {rank_of(&x->seam), rank_of(&y->seam)};
	if (ranks[0] != ranks[1])
		return ranks[0] > ranks[1] ? -1 : 1;
	if (x->seam.edge_count != y->seam.edge_count)
		return x->seam.edge_count > y->seam.edge_count ? -1 : 1;
	return x->chain < y->chain ? -1 : x->chain > y->chain;
}

static void tally_seam(const nt_check *check, const nt_chains *chains, size_t chain, nt_tally *tally)
{
	for (size_t i = chains->first[chain]; i < chains->first[chain + 1]; i++)
		nt_tally_side(check, tally, check->mirrors.items[chains->edges[i]].sides[0], NAN);
}

static void report_seam(nt_check *check, const nt_chains *chains, size_t chain, size_t index)
{
	const nt_seam *seam = &check->facts->seams[index];
	nt_tally tally = {.code = NT_CODE_UV_MIRROR_SEAM, .seam = (uint32_t)index + 1};
	tally_seam(check, chains, chain, &tally);
	nt_tally_number(&tally, "length", seam->length);
	nt_tally_number(&tally, "dihedral_min_degrees", seam->dihedral[0]);
	nt_tally_number(&tally, "dihedral_max_degrees", seam->dihedral[1]);
	nt_tally_number(&tally, "tangent_angle_min_degrees", seam->tangent_angle[0]);
	nt_tally_number(&tally, "tangent_angle_max_degrees", seam->tangent_angle[1]);
	nt_tally_number(&tally, "frame_angle_max_degrees", seam->frame_angle[1]);
	nt_tally_number(&tally, "edges_sharing_vertices", (double)seam->shared_count);
	tally.rank = rank_of(seam);
	const double angle = widest_angle(seam);
	char frames[80] = "";
	if (seam->unhidden_count)
		snprintf(frames, sizeof frames, ", visible on %zu edge%s: tangents up to %.3g degrees apart",
			seam->unhidden_count, seam->unhidden_count == 1 ? "" : "s", angle);
	else if (angle >= 0.05)
		snprintf(frames, sizeof frames, ", tangents up to %.3g degrees apart", angle);
	nt_check_report(check, &tally, "seam %zu, %s, length %.4g%s%s%s", index,
		seam->closed ? "a closed loop" : "an open chain", seam->length, frames,
		seam->has_plane ? ", plane " : "", seam->plane_text);
}

static void report_seams(nt_check *check, const nt_chains *chains, const numbered_seam *seams)
{
	nt_tally rest = {.code = NT_CODE_UV_MIRROR_SEAM};
	for (size_t i = 0; i < chains->count; i++) {
		if (i < NT_SINGLE_FINDINGS)
			report_seam(check, chains, seams[i].chain, i);
		else
			tally_seam(check, chains, seams[i].chain, &rest);
	}
	if (chains->count > NT_SINGLE_FINDINGS)
		nt_check_report(check, &rest, "%zu further seams, one finding together beyond the first %d",
			chains->count - NT_SINGLE_FINDINGS, NT_SINGLE_FINDINGS);
}

/* ---- entry ---- */

static bool any_conflict(const nt_check *check)
{
	return check->facts->non_manifold_edges || check->facts->inconsistent_edges;
}

static nt_status trace_boundary(nt_check *check)
{
	nt_chains chains;
	const nt_status status = nt_chains_trace(&check->surface, &check->boundary, any_conflict(check),
		check->scratch, &chains, check->error);
	if (status)
		return status;
	for (size_t i = 0; i < chains.count; i++)
		++*(chains.closed[i] ? &check->facts->boundary_loops : &check->facts->boundary_chains);
	check->facts->left_out = chains.left_out;
	return NT_OK;
}

static nt_status trace_seams(nt_check *check)
{
	nt_report_mesh *facts = check->facts;
	nt_chains chains;
	nt_status status = nt_chains_trace(&check->surface, &check->mirrors, any_conflict(check), check->scratch,
		&chains, check->error);
	if (status)
		return status;
	facts->seams = nt_arena_alloc(&check->report->arena, chains.count, sizeof *facts->seams);
	numbered_seam *seams = nt_scratch_alloc(check->scratch, chains.count, sizeof *seams);
	if (!facts->seams || !seams)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < chains.count; i++) {
		status = describe_seam(check, &chains, i, &seams[i].seam);
		if (status)
			return status;
		seams[i].chain = i;
	}
	qsort(seams, chains.count, sizeof *seams, compare_seams);
	for (size_t i = 0; i < chains.count; i++) {
		facts->seams[i] = seams[i].seam;
		facts->seam_edges += facts->seams[i].edge_count;
		facts->seam_length += facts->seams[i].length;
		facts->seam_count++;
	}
	if (chains.left_out > facts->left_out)
		facts->left_out = chains.left_out;
	report_seams(check, &chains, seams);
	return NT_OK;
}

nt_status nt_check_seams(nt_check *check)
{
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	nt_status status = check->facts->boundary_edges ? trace_boundary(check) : NT_OK;
	nt_scratch_back(check->scratch, mark);
	if (!status && check->mirrors.count)
		status = trace_seams(check);
	nt_surface_free_sides(&check->surface); /* nobody asks for edges after this */
	nt_scratch_back(check->scratch, mark);
	return status;
}
