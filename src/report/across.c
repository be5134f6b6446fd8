/* SPDX-License-Identifier: MIT */
/*
 * Mirror seams between the objects of one OBJ: two halves that are objects of their own have positions and texture
 * coordinates that meet, and are one surface to whoever looks at it, as they would be as groups. Each mesh leaves the
 * sides at its rim; sorted by positions and texture coordinates, those that may be a seam follow each other. There is
 * one finding for each two objects, which names both; of copies of an object the first has it.
 */
#include "report/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/text.h"

static const float *position_of(const nt_check *check, const nt_rim_side *side, int end)
{
	return check->scene->meshes[side->mesh].positions + 3 * (size_t)side->ends[end];
}

/* 0 and -0 are one. */
static int compare_positions(const float *a, const float *b)
{
	for (int i = 0; i < 3; i++)
		if (a[i] != b[i])
			return a[i] < b[i] ? -1 : 1;
	return 0;
}

static uint64_t hash_end(const nt_check *check, const nt_rim_side *side, int end)
{
	const float *p = position_of(check, side, end);
	const float *uv = check->mesh->texcoords + 2 * (size_t)side->ends[end];
	return nt_hash_words(nt_hash_words(nt_hash_floats(p[0], p[1]), nt_hash_floats(p[2], 0)),
		nt_hash_floats(uv[0], uv[1]));
}

nt_status nt_check_rims(nt_check *check)
{
	const nt_surface *s = &check->surface;
	nt_rims *rims = check->rims;
	if (check->scene->format != NT_FORMAT_OBJ || check->scene->mesh_count < 2 || !check->mesh->texcoords)
		return NT_OK;
	for (size_t i = 0; i < check->boundary.count; i++) {
		const uint32_t side = check->boundary.items[i].sides[0], t = side / 3;
		nt_rim_side rim = {.mesh = check->mesh_index, .side = side,
			.face = nt_triangle_face(s, t), .orientation = nt_settled_orientation(check, t),
			.ends = {nt_side_vertex(s, side), nt_side_vertex(s, nt_side_next(side))}};
		if (!rim.orientation)
			continue;
		if (compare_positions(position_of(check, &rim, 0), position_of(check, &rim, 1)) > 0) {
			const uint32_t first = rim.ends[0];
			rim.ends[0] = rim.ends[1];
			rim.ends[1] = first;
		}
		rim.key = nt_hash_words(hash_end(check, &rim, 0), hash_end(check, &rim, 1));
		if (!nt_grow((void **)&rims->sides, &rims->capacity, rims->count + 1, sizeof *rims->sides))
			return NT_ERROR_MEMORY;
		rims->sides[rims->count++] = rim;
		rims->met[rim.orientation > 0] = true;
	}
	return NT_OK;
}

static int by_key(const void *a, const void *b)
{
	const nt_rim_side *x = a, *y = b;
	if (x->key != y->key)
		return x->key < y->key ? -1 : 1;
	if (x->mesh != y->mesh)
		return x->mesh < y->mesh ? -1 : 1;
	return x->side < y->side ? -1 : x->side > y->side;
}

/* An edge of a seam: its side in the object that comes first, and the other object. */
typedef struct seam_edge {
	nt_rim_side rim;
	uint32_t other;
} seam_edge;

static bool same_meshes(const seam_edge *a, const seam_edge *b)
{
	return a->rim.mesh == b->rim.mesh && a->other == b->other;
}

/* By the two meshes, then by sides: keys are others in each run. */
static int by_meshes(const void *a, const void *b)
{
	const seam_edge *x = a, *y = b;
	if (!same_meshes(x, y))
		return x->rim.mesh < y->rim.mesh || (x->rim.mesh == y->rim.mesh && x->other < y->other) ? -1 : 1;
	return x->rim.side < y->rim.side ? -1 : x->rim.side > y->rim.side;
}

/* Whether two sides of different objects are front and back of a sheet, which are two points for points.c, too. */
static bool are_opposed(const nt_check *check, const nt_rim_side *a, const nt_rim_side *b)
{
	const float *normals[2] = {check->scene->meshes[a->mesh].normals, check->scene->meshes[b->mesh].normals};
	bool opposed = normals[0] && normals[1];
	for (int end = 0; end < 2 && opposed; end++)
		opposed = nt_compare_normals(normals[0] + 3 * (size_t)a->ends[end],
			normals[1] + 3 * (size_t)b->ends[end]) < 0;
	return opposed;
}

/* Whether two sides of different objects lie on each other, in space and in UV space, and are wound differently. */
static bool are_mirrored(const nt_check *check, const nt_rim_side *a, const nt_rim_side *b)
{
	const nt_mesh *meshes = check->scene->meshes;
	bool meet = a->mesh != b->mesh && a->orientation != b->orientation;
	for (int end = 0; end < 2 && meet; end++) {
		const float *p = meshes[a->mesh].texcoords + 2 * (size_t)a->ends[end];
		const float *q = meshes[b->mesh].texcoords + 2 * (size_t)b->ends[end];
		meet = p[0] == q[0] && p[1] == q[1] &&
			compare_positions(position_of(check, a, end), position_of(check, b, end)) == 0;
	}
	return meet && !are_opposed(check, a, b);
}

/* The first such pair of a run of equal keys, of at most a few sides of each orientation: a seam has two. Copies of an
 * object may be many. */
static bool find_pair(const nt_check *check, size_t first, size_t end, seam_edge *edge)
{
	enum { MOST_SIDES = 16 };
	const nt_rim_side *picked[2 * MOST_SIDES];
	size_t counts[2] = {0, 0}, count = 0;
	for (size_t i = first; i < end; i++) {
		const nt_rim_side *side = &check->rims->sides[i];
		if (counts[side->orientation > 0]++ < MOST_SIDES)
			picked[count++] = side;
	}
	for (size_t i = 0; i < count; i++)
		for (size_t k = i + 1; k < count; k++)
			if (are_mirrored(check, picked[i], picked[k])) {
				*edge = (seam_edge){*picked[i], picked[k]->mesh};
				return true;
			}
	return false;
}

/* The name of an object in a sentence. */
static void name_object(const nt_report_mesh *mesh, size_t number, char text[80])
{
	enum { MOST = 60 };
	const size_t length = strlen(mesh->name), cut = length > MOST ? nt_utf8_cut(mesh->name, MOST) : length;
	if (length)
		snprintf(text, 80, "\"%.*s%s\"", (int)cut, mesh->name, cut < length ? "..." : "");
	else
		snprintf(text, 80, "mesh %zu", number);
}

/* One finding of the edges between two objects. */
static void report_edges(nt_check *check, const seam_edge *edges, size_t count)
{
	nt_check one = *check;
	char names[2][80];
	double length = 0.0;
	one.mesh_index = edges[0].rim.mesh;
	one.mesh = &check->scene->meshes[one.mesh_index];
	one.facts = &check->report->meshes[one.mesh_index];
	one.alike = 1;
	nt_tally tally = {.code = NT_CODE_UV_MIRROR_SEAM,
		.share = (double)count / (double)(one.facts->triangle_count + 1)};
	for (size_t i = 0; i < count; i++) {
		const nt_rim_side *side = &edges[i].rim;
		nt_tally_edge(&one, &tally, side->side / 3, side->face, side->ends, NAN);
		length += nt_world_length(one.facts, position_of(check, side, 0), position_of(check, side, 1));
	}
	name_object(one.facts, one.mesh_index, names[0]);
	name_object(&check->report->meshes[edges[0].other], edges[0].other, names[1]);
	nt_tally_number(&tally, "length", length);
	nt_check_report(&one, &tally, "between the objects %s and %s, length %.4g", names[0], names[1], length);
	check->failed |= one.failed;
}

nt_status nt_check_across(nt_check *check)
{
	nt_rims *rims = check->rims;
	if (!rims->met[0] || !rims->met[1])
		return NT_OK;
	seam_edge *edges = nt_alloc(rims->count / 2 + 1, sizeof *edges);
	size_t count = 0;
	if (!edges)
		return NT_ERROR_MEMORY;
	qsort(rims->sides, rims->count, sizeof *rims->sides, by_key);
	for (size_t i = 0, end; i < rims->count; i = end) {
		for (end = i + 1; end < rims->count && rims->sides[end].key == rims->sides[i].key;)
			end++;
		count += end > i + 1 && find_pair(check, i, end, &edges[count]);
	}
	if (count)
		qsort(edges, count, sizeof *edges, by_meshes);
	for (size_t i = 0, end; i < count; i = end) {
		for (end = i + 1; end < count && same_meshes(&edges[i], &edges[end]);)
			end++;
		report_edges(check, edges + i, end - i);
	}
	free(edges);
	return NT_OK;
}
