/* SPDX-License-Identifier: MIT */
/*
 * Which corners share a normal if faces that meet at an angle make a crease: see frames.h. At each position the
 * corners are the nodes of a graph; two are joined if their faces have an edge there in common and meet at less than
 * the angle.
 * So a crease that ends within a surface opens only as far as it goes. Expected linear time: of an edge of many faces
 * each is compared with the last few before it.
 */
#include <math.h>
#include <string.h>
#include "base/hash.h"
#include "base/vec.h"
#include "tangent/frames.h"
#include "topology/corners.h"

enum { MOST_COMPARED = 8 };

typedef struct crease_job {
	const nmtan_mesh *mesh;
	size_t corner_count, size; /* of the table, a power of two */
	double cosine;
	uint32_t *points;   /* [vertex count] first vertex at the position */
	uint32_t *slots;    /* [size] 1 + a vertex; then 1 + the last side of an edge; 0: free */
	uint32_t *before;   /* [corner_count] 1 + the side of the same edge before; 0: none */
	uint32_t *faces;    /* [corner_count] */
	uint32_t *firsts;   /* [face_count] first corner */
	nt_dvec3 *normals;  /* [face_count] unit vectors; 0: no area */
	uint32_t *groups;   /* [corner_count] a corner of the same group with a lower number, or itself */
} crease_job;

static void find_points(crease_job *job, size_t vertices)
{
	memset(job->slots, 0, job->size * sizeof *job->slots);
	for (size_t v = 0; v < vertices; v++) {
		const float *p = nt_position(job->mesh, v);
		size_t at = nt_hash_words(nt_hash_floats(p[0] + 0.0f, p[1] + 0.0f), nt_hash_floats(p[2] + 0.0f, 0)) &
			(job->size - 1);
		for (; job->slots[at]; at = (at + 1) & (job->size - 1)) {
			const float *q = nt_position(job->mesh, job->slots[at] - 1);
			if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2])
				break;
		}
		if (!job->slots[at])
			job->slots[at] = (uint32_t)v + 1;
		job->points[v] = job->slots[at] - 1;
	}
}

static void find_faces(crease_job *job)
{
	size_t first = 0;
	for (size_t face = 0; face < job->mesh->face_count; face++) {
		const size_t size = nt_face_size(job->mesh, face);
		job->firsts[face] = (uint32_t)first;
		if (!nt_face_normal(job->mesh, first, size, &job->normals[face]))
			job->normals[face] = (nt_dvec3){0, 0, 0};
		for (size_t k = 0; k < size; k++)
			job->faces[first + k] = (uint32_t)face;
		first += size;
	}
}

static uint32_t point_of(const crease_job *job, uint32_t corner)
{
	return job->points[nt_vertex_of(job->mesh, corner)];
}

static uint32_t next_corner(const crease_job *job, uint32_t corner)
{
	const uint32_t face = job->faces[corner], next = corner + 1;
	return next < job->corner_count && job->faces[next] == face ? next : job->firsts[face];
}

/* The lowest corner of a group; paths become shorter on the way. */
static uint32_t find_group(uint32_t *groups, uint32_t corner)
{
	while (groups[corner] != corner)
		corner = groups[corner] = groups[groups[corner]];
	return corner;
}

static void join(uint32_t *groups, uint32_t a, uint32_t b)
{
	a = find_group(groups, a);
	b = find_group(groups, b);
	groups[a > b ? a : b] = a < b ? a : b;
}

/* A face without area makes no crease. */
static bool is_smooth(const crease_job *job, uint32_t face, uint32_t other)
{
	const nt_dvec3 n = job->normals[face], m = job->normals[other];
	return nt_dvec3_dot(n, n) == 0.0 || nt_dvec3_dot(m, m) == 0.0 || nt_dvec3_dot(n, m) > job->cosine;
}

/* Joins the corners of a side, which runs from a corner to the next, with those of earlier sides of its edge. */
static void add_side(crease_job *job, uint32_t side)
{
	const uint32_t end = next_corner(job, side), a = point_of(job, side), b = point_of(job, end);
	size_t at = nt_hash_words(a < b ? a : b, a < b ? b : a) & (job->size - 1);
	for (; job->slots[at]; at = (at + 1) & (job->size - 1)) {
		const uint32_t other = job->slots[at] - 1, c = point_of(job, other);
		const uint32_t d = point_of(job, next_corner(job, other));
		if ((a == c && b == d) || (a == d && b == c))
			break;
	}
	uint32_t other = job->slots[at];
	job->before[side] = other;
	job->slots[at] = side + 1;
	for (int i = 0; other && i < MOST_COMPARED; other = job->before[other - 1], i++) {
		const uint32_t begin = other - 1, far = next_corner(job, begin);
		if (!is_smooth(job, job->faces[side], job->faces[begin]))
			continue;
		const bool along = point_of(job, begin) == a;
		join(job->groups, side, along ? begin : far);
		join(job->groups, end, along ? far : begin);
	}
}

nmtan_status nt_crease_groups(const nmtan_mesh *mesh, size_t corner_count, double degrees, nt_scratch *scratch,
	uint32_t *groups)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const size_t vertices = mesh->indices ? mesh->vertex_count : corner_count;
	const size_t most = vertices > corner_count ? vertices : corner_count;
	crease_job job = {.mesh = mesh, .corner_count = corner_count, .size = 16, .groups = groups,
		.cosine = cos(degrees / 57.29577951308232)};
	while (job.size < 2 * most)
		job.size *= 2;
	job.points = nt_scratch_alloc(scratch, vertices, sizeof *job.points);
	job.slots = nt_scratch_alloc(scratch, job.size, sizeof *job.slots);
	job.before = nt_scratch_alloc(scratch, corner_count, sizeof *job.before);
	job.faces = nt_scratch_alloc(scratch, corner_count, sizeof *job.faces);
	job.firsts = nt_scratch_alloc(scratch, mesh->face_count, sizeof *job.firsts);
	job.normals = nt_scratch_alloc(scratch, mesh->face_count, sizeof *job.normals);
	if (most >= UINT32_MAX || !job.points || !job.slots || !job.before || !job.faces || !job.firsts || !job.normals)
		return NMTAN_ERROR_MEMORY;
	find_points(&job, vertices);
	find_faces(&job);
	memset(job.slots, 0, job.size * sizeof *job.slots);
	for (size_t c = 0; c < corner_count; c++)
		groups[c] = (uint32_t)c;
	for (size_t c = 0; c < corner_count; c++)
		add_side(&job, (uint32_t)c);
	for (size_t c = 0; c < corner_count; c++)
		groups[c] = find_group(groups, (uint32_t)c);
	for (size_t c = 0; c < corner_count; c++)
		groups[c]++;
	nt_scratch_back(scratch, mark);
	return NMTAN_OK;
}
