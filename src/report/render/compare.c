/* SPDX-License-Identifier: MIT */
/*
 * Two versions of an asset: see render.h. Exporters renumber vertices and triangles, so triangles are found by their
 * positions, which are hashed from the least of the three corners on. Findings, meshes and triangles are paired alike:
 * by a key, each thing once.
 */
#include "report/render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/angle.h"
#include "base/hash.h"
#include "base/vec.h"
#include "report/report.h"

static const double DEGREES = 57.29577951308232;

/* ---- findings ---- */

static uint64_t finding_key(const void *report, size_t index)
{
	return ((const nt_report *)report)->findings[index].fingerprint;
}

static uint64_t finding_geometry(const void *report, size_t index)
{
	return ((const nt_report *)report)->findings[index].geometry;
}

/* A finding of another name now is known by its geometry. */
static bool match_findings(nt_report_diff *diff)
{
	const nt_report *const *reports = diff->reports;
	nt_pairs pairs = {0};
	diff->known[1] = nt_calloc(reports[1]->finding_count, sizeof(bool));
	const bool made = nt_pair(&pairs, reports[0], reports[0]->finding_count, reports[1],
		reports[1]->finding_count, (const nt_key_of[]){finding_key, finding_geometry}) && diff->known[1];
	for (size_t i = 0; made && i < reports[1]->finding_count; i++) {
		diff->known[1][i] = pairs.partners[i] != NT_NONE;
		diff->unchanged += diff->known[1][i];
	}
	diff->known[0] = pairs.taken;
	free(pairs.partners);
	for (int i = 0; made && i < 2; i++)
		for (size_t k = 0; k < reports[i]->finding_count; k++)
			diff->by_severity[i][reports[i]->findings[k].severity] += !diff->known[i][k];
	return made;
}

/* ---- meshes ---- */

static uint64_t mesh_key(const void *report, size_t index)
{
	const nt_report_mesh *mesh = &((const nt_report *)report)->meshes[index];
	return nt_hash_bytes(mesh->gltf_primitive, mesh->name, strlen(mesh->name));
}

static uint64_t mesh_digest(const void *report, size_t index)
{
	return ((const nt_report *)report)->meshes[index].digest;
}

/* Pairs the rest of both in order, if it has as many triangles. */
static void match_rest(const nt_report *old, const nt_report *new, nt_pairs *pairs)
{
	size_t next = 0;
	for (size_t i = 0; i < new->mesh_count; i++) {
		if (pairs->partners[i] != NT_NONE)
			continue;
		while (next < old->mesh_count && pairs->taken[next])
			next++;
		if (next == old->mesh_count || old->meshes[next].triangle_count != new->meshes[i].triangle_count)
			continue;
		pairs->partners[i] = (uint32_t)next;
		pairs->taken[next] = true;
	}
}

static bool match_meshes(nt_report_diff *diff)
{
	const nt_report *old = diff->reports[0], *new = diff->reports[1];
	nt_pairs pairs = {0};
	diff->meshes = nt_calloc(old->mesh_count + new->mesh_count, sizeof *diff->meshes);
	const bool made = nt_pair(&pairs, old, old->mesh_count, new, new->mesh_count,
		(const nt_key_of[]){mesh_key, mesh_digest}) && diff->meshes;
	if (made)
		match_rest(old, new, &pairs);
	for (size_t i = 0; made && i < new->mesh_count + old->mesh_count; i++) {
		const uint32_t gone = (uint32_t)(i - new->mesh_count);
		if (i < new->mesh_count)
			diff->meshes[diff->mesh_count++] =
				(nt_mesh_change){.meshes = {pairs.partners[i], (uint32_t)i}, .worst_degrees = NAN};
		else if (!pairs.taken[gone])
			diff->meshes[diff->mesh_count++] =
				(nt_mesh_change){.meshes = {gone, NT_NONE}, .worst_degrees = NAN};
	}
	nt_pairs_free(&pairs);
	return made;
}

/* ---- triangles ---- */

static const float *position_of(const nt_report_geometry *g, size_t t, unsigned k)
{
	return g->positions + 3 * (size_t)g->indices[3 * t + k];
}

/* 0 and -0 are one; NaN is as its bits are. */
static int compare_positions(const float *a, const float *b)
{
	for (int i = 0; i < 3; i++)
		if (a[i] < b[i] || a[i] > b[i])
			return a[i] < b[i] ? -1 : 1;
	return 0;
}

/* The corner to begin with, so that turned triangles are equal. */
static unsigned first_corner(const nt_report_geometry *g, size_t t)
{
	unsigned first = 0;
	for (unsigned k = 1; k < 3; k++)
		if (compare_positions(position_of(g, t, k), position_of(g, t, first)) < 0)
			first = k;
	return first;
}

static uint64_t triangle_key(const void *geometry, size_t t)
{
	const nt_report_geometry *g = geometry;
	const unsigned first = first_corner(g, t);
	float values[9];
	for (unsigned k = 0; k < 3; k++)
		for (int i = 0; i < 3; i++)
			values[3 * k + (unsigned)i] = position_of(g, t, (first + k) % 3)[i] + 0.0f;
	return nt_hash_bytes(0, values, sizeof values);
}

static bool same_place(const nt_report_geometry *a, size_t t, const nt_report_geometry *b, size_t u)
{
	const unsigned first = first_corner(a, t), other = first_corner(b, u);
	for (unsigned k = 0; k < 3; k++)
		if (compare_positions(position_of(a, t, (first + k) % 3), position_of(b, u, (other + k) % 3)) != 0)
			return false;
	return true;
}

static void compare_tangents(nt_mesh_change *change, const float *before, const float *after, const float *position)
{
	nt_dvec3 a = nt_dvec3_load(before), b = nt_dvec3_load(after);
	if (!nt_dvec3_normalise(&a) || !nt_dvec3_normalise(&b))
		return;
	const nt_dvec3 cross = nt_dvec3_cross(a, b);
	const double degrees = nt_angle(nt_dvec3_length(cross), nt_dvec3_dot(a, b)) * DEGREES;
	int bin = 0;
	while (bin + 1 < NT_ANGLE_BINS && degrees > nt_angle_bins[bin])
		bin++;
	change->histogram[bin]++;
	change->compared++;
	change->turned += degrees > NT_TURNED_DEGREES;
	change->reversed += before[3] != after[3];
	if (!(degrees <= change->worst_degrees)) {
		change->worst_degrees = degrees;
		memcpy(change->worst_position, position, sizeof change->worst_position);
	}
}

/* Notes the other version's tangent of a vertex, if it turned more than what was noted before. Both have a length. */
static void note_other(float *noted, const float *own, const float *other)
{
	nt_dvec3 t = nt_dvec3_load(own), before = nt_dvec3_load(noted), now = nt_dvec3_load(other);
	if (!nt_dvec3_normalise(&t) || !nt_dvec3_normalise(&now))
		return;
	const bool any = nt_dvec3_normalise(&before);
	const double turned = own[3] != other[3] ? -2.0 : nt_dvec3_dot(t, now);
	if (!any || turned < (own[3] != noted[3] ? -2.0 : nt_dvec3_dot(t, before)))
		memcpy(noted, other, 4 * sizeof *noted);
}

static void compare_triangles(nt_mesh_change *change, const nt_report_geometry *a, size_t t,
	const nt_report_geometry *b, size_t u, bool exchange)
{
	const unsigned first = first_corner(a, t), other = first_corner(b, u);
	change->matched++;
	for (unsigned k = 0; k < 3; k++) {
		const size_t v = a->indices[3 * t + (first + k) % 3], w = b->indices[3 * u + (other + k) % 3];
		if (a->texcoords && b->texcoords)
			change->moved_texcoords += a->texcoords[2 * v] != b->texcoords[2 * w] ||
				a->texcoords[2 * v + 1] != b->texcoords[2 * w + 1];
		if (!a->tangents || !b->tangents)
			continue;
		const float *before = a->tangents + 4 * v, *after = b->tangents + 4 * w;
		compare_tangents(change, before, after, b->positions + 3 * w);
		if (exchange) {
			note_other(a->computed + 4 * v, before, after);
			note_other(b->computed + 4 * w, after, before);
		}
	}
}

static bool compare_geometry(nt_mesh_change *change, const nt_report_geometry *a, const nt_report_geometry *b,
	bool exchange)
{
	nt_pairs pairs = {0};
	const bool made = nt_pair(&pairs, a, a->triangle_count, b, b->triangle_count,
		(const nt_key_of[]){triangle_key, NULL});
	for (size_t u = 0; made && u < b->triangle_count; u++)
		if (pairs.partners[u] != NT_NONE && same_place(a, pairs.partners[u], b, u))
			compare_triangles(change, a, pairs.partners[u], b, u, exchange);
	nt_pairs_free(&pairs);
	return made;
}

/* Meshes of one geometry have it at the first of them. */
static const nt_report_geometry *geometry_of(const nt_report *report, uint32_t mesh)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	return m->same_as == NT_NONE ? m->geometry : report->meshes[m->same_as].geometry;
}

static bool begin_exchange(nt_report *report)
{
	for (size_t i = 0; i < report->mesh_count; i++) {
		nt_report_geometry *g = report->meshes[i].geometry;
		if (!g || !g->tangents || report->meshes[i].same_as != NT_NONE)
			continue;
		g->authored = g->tangents;
		g->computed = nt_arena_alloc(&report->arena, g->vertex_count, 4 * sizeof *g->computed);
		if (!g->computed)
			return false;
		memset(g->computed, 0, 4 * g->vertex_count * sizeof *g->computed);
	}
	return true;
}

nt_status nt_report_compare(nt_report_diff *diff, nt_report *before, nt_report *after, bool exchange)
{
	*diff = (nt_report_diff){.reports = {before, after}};
	bool made = match_findings(diff) && match_meshes(diff) &&
		(!exchange || (begin_exchange(before) && begin_exchange(after)));
	for (size_t i = 0; i < diff->mesh_count && made; i++) {
		nt_mesh_change *change = &diff->meshes[i];
		if (change->meshes[0] == NT_NONE || change->meshes[1] == NT_NONE)
			continue;
		const nt_report_geometry *a = geometry_of(before, change->meshes[0]);
		const nt_report_geometry *b = geometry_of(after, change->meshes[1]);
		made = !a || !b || compare_geometry(change, a, b, exchange);
	}
	if (!made)
		nt_report_diff_free(diff);
	return made ? NT_OK : NT_ERROR_MEMORY;
}

void nt_report_diff_free(nt_report_diff *diff)
{
	free(diff->meshes);
	free(diff->known[0]);
	free(diff->known[1]);
	*diff = (nt_report_diff){0};
}
