/* SPDX-License-Identifier: MIT */
/*
 * Digests of geometry, the same in every run. Exporters rename objects and leave out their names; positions stay. They
 * are compared exactly: a digest is for what was not changed but for its name.
 */
#include "report/check.h"

#include <string.h>
#include "base/hash.h"

static uint64_t mix(uint64_t a, uint64_t b)
{
	return nt_hash_unkeyed(a, &b, sizeof b);
}

static uint64_t mix_text(uint64_t hash, const char *text)
{
	return nt_hash_unkeyed(hash, text, strlen(text));
}

/* 0 and -0 are one. */
static uint64_t mix_position(uint64_t hash, const float *p)
{
	const float values[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
	return nt_hash_unkeyed(hash, values, sizeof values);
}

/* Vertices may lie anywhere: what is asked of a corner's is fetched before it is its turn. */
static void prefetch(const nt_surface *s, const uint64_t *points, size_t corner)
{
	enum { AHEAD = 24 };
	const size_t corners = 3 * s->triangle_count;
	for (size_t k = corner; k < corner + 3 && k + 2 * AHEAD < corners; k++) {
		__builtin_prefetch(&s->points[nt_side_vertex(s, k + 2 * AHEAD)]);
		__builtin_prefetch(&points[nt_side_point(s, k + AHEAD)]);
	}
}

/* A turned triangle is the same, a reversed one is not: each corner is mixed with the one after it. */
nt_status nt_digest_surface(const nt_surface *surface, nt_scratch *scratch, uint64_t *digest)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	uint64_t *points = nt_scratch_alloc(scratch, surface->point_count, sizeof *points), sum = 0;
	if (!points)
		return NT_ERROR_MEMORY;
	memset(points, 0, surface->point_count * sizeof *points);
	for (size_t v = 0; v < surface->mesh->vertex_count; v++) {
		const uint32_t point = surface->points[v];
		if (point != NT_NONE && !points[point])
			points[point] = mix_position(1, surface->mesh->positions + 3 * v);
	}
	for (size_t t = 0; t < surface->triangle_count; t++) {
		prefetch(surface, points, 3 * t);
		const uint64_t a = points[nt_side_point(surface, 3 * t)], b = points[nt_side_point(surface, 3 * t + 1)];
		const uint64_t c = points[nt_side_point(surface, 3 * t + 2)];
		sum += mix(a, b) + mix(b, c) + mix(c, a);
	}
	*digest = mix(sum, surface->triangle_count) | 1;
	nt_scratch_back(scratch, mark);
	return NT_OK;
}

static bool has_places(const nt_report_finding *finding)
{
	return finding->box.minimum[0] <= finding->box.maximum[0];
}

uint64_t nt_digest_finding(const nt_report_finding *finding, const char *detail)
{
	uint64_t hash = mix_text(0, nt_code_info(finding->code)->name);
	if (!has_places(finding))
		return mix_text(hash, detail ? detail : "");
	hash = mix_position(mix_position(hash, finding->box.minimum), finding->box.maximum);
	for (unsigned i = 0; i < finding->spot_count; i++)
		for (unsigned k = 0; k < finding->spots[i].corner_count; k++)
			hash = mix_position(hash, finding->spots[i].positions[k]);
	return hash;
}

void nt_digest_complete(nt_report *report)
{
	uint64_t file = 0;
	for (size_t i = 0; i < report->mesh_count; i++)
		file += report->meshes[i].digest;
	for (size_t i = 0; i < report->finding_count; i++) {
		nt_report_finding *finding = &report->findings[i];
		const uint64_t whole = finding->mesh == NT_NONE ? file : report->meshes[finding->mesh].digest;
		if (!has_places(finding))
			finding->geometry = whole ? mix(finding->geometry, whole) : 0;
	}
}
