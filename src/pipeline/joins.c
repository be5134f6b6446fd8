/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved as one mesh (--across=mesh): the parts' vertices one behind the other, only those that
 * faces use, since parts often share an accessor of which each uses a little; their triangles follow each other in the
 * parts' order. A join costs the parts once more, as arrays of 32 bytes for each vertex that is used.
 *
 * For a report on meshes that were solved each by itself: which borders a join would change.
 */
#include "pipeline/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/angle.h"
#include "base/vec.h"
#include "topology/corners.h"

/* ---- gathering ---- */

/* Numbers the vertices that the faces of a part use, in the order of their first corners. False: out of memory. */
static bool number_vertices(nt_whole *w, const nt_mesh *part, uint32_t *indices)
{
	uint32_t *number = nt_alloc(part->vertex_count, sizeof *number);
	if (!number)
		return false;
	memset(number, 0xFF, part->vertex_count * sizeof *number);
	for (size_t c = 0; c < part->corner_count; c++) {
		const size_t vertex = nt_mesh_vertex(part, c);
		if (number[vertex] == NT_NONE) {
			number[vertex] = (uint32_t)w->mesh.vertex_count;
			w->sources[w->mesh.vertex_count++] = (uint32_t)vertex;
		}
		indices[c] = number[vertex];
	}
	free(number);
	return true;
}

/* Rows of a part, as many floats each, to the whole's. */
static void put_rows(const nt_whole *w, size_t part, const float *rows, size_t floats, float *to)
{
	for (size_t v = w->first_vertex[part]; v < w->first_vertex[part + 1]; v++)
		memcpy(to + floats * v, rows + floats * w->sources[v], floats * sizeof *rows);
}

bool nt_whole_put(const nt_whole *w, size_t part, const float *rows, const float *base, float **to)
{
	const size_t count = w->mesh.vertex_count;
	if (rows && !*to && (*to = nt_alloc(count, 3 * sizeof **to)))
		memcpy(*to, base, count * 3 * sizeof **to);
	if (rows && *to)
		put_rows(w, part, rows, 3, *to);
	return !rows || *to;
}

/* One transform for all: all parts have stored coordinates or none. */
static bool gather_rows(nt_whole *w, float *arrays[4])
{
	static const size_t floats[] = {3, 3, 2, 2};
	for (size_t i = 0; i < w->part_count; i++) {
		const nmtan_mesh view = nt_mesh_view(w->parts[i], &w->stored);
		const float *const rows[] = {view.positions, view.normals, view.texcoords, w->stored.texcoords};
		for (size_t k = 0; k < 4; k++) {
			if (!arrays[k] && rows[k])
				arrays[k] = nt_arena_alloc(&w->arena, w->mesh.vertex_count, floats[k] * sizeof(float));
			if (rows[k] && !arrays[k])
				return false;
			if (rows[k])
				put_rows(w, i, rows[k], floats[k], arrays[k]);
		}
	}
	return true;
}

static bool gather_halves(nt_whole *w)
{
	uint8_t *halves = NULL;
	for (size_t i = 0, first = 0; i < w->part_count; first += w->parts[i++]->face_count) {
		const nt_mesh *part = w->parts[i];
		if (!part->halves)
			continue;
		if (!halves && (halves = nt_arena_alloc(&w->arena, w->corner_count / 3, 1)))
			memset(halves, NT_HALF_NONE, w->corner_count / 3);
		if (!halves)
			return false;
		memcpy(halves + first, part->halves, part->face_count);
	}
	w->halves = halves;
	return true;
}

nt_status nt_whole_gather(nt_whole *w)
{
	for (size_t i = 0; i < w->part_count; i++)
		w->corner_count += w->parts[i]->corner_count;
	if (w->corner_count >= NT_NONE)
		return NT_ERROR_TOO_LARGE;
	uint32_t *indices = nt_arena_alloc(&w->arena, w->corner_count, sizeof *indices);
	float *arrays[4] = {NULL};
	w->first_vertex = nt_arena_alloc(&w->arena, w->part_count + 1, sizeof *w->first_vertex);
	w->sources = nt_arena_alloc(&w->arena, w->corner_count, sizeof *w->sources);
	if (!indices || !w->first_vertex || !w->sources)
		return NT_ERROR_MEMORY;
	for (size_t i = 0, corner = 0; i < w->part_count; corner += w->parts[i++]->corner_count) {
		w->first_vertex[i] = w->mesh.vertex_count;
		if (!number_vertices(w, w->parts[i], indices + corner))
			return NT_ERROR_MEMORY;
	}
	w->first_vertex[w->part_count] = w->mesh.vertex_count;
	if (!gather_rows(w, arrays) || !gather_halves(w))
		return NT_ERROR_MEMORY;
	w->stored.texcoords = arrays[3];
	w->mesh = (nmtan_mesh){.struct_bytes = sizeof w->mesh, .face_count = w->corner_count / 3,
		.vertex_count = w->mesh.vertex_count, .indices = indices, .positions = arrays[0],
		.normals = arrays[1], .texcoords = arrays[2], .stored = &w->stored};
	return NT_OK;
}

nt_status nt_whole_solve(const nt_whole *w, const nmtan_mesh *mesh, const nmtan_options *options, float **rows,
	nmtan_counts *counts)
{
	*rows = nt_alloc(w->corner_count, 4 * sizeof **rows);
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = *rows};
	return *rows ? nt_status_of(nt_tangents_of_halves(mesh, w->halves, options, &output, counts))
		     : NT_ERROR_MEMORY;
}

/* ---- borders that joins would change ---- */

/* The cosine of 5 degrees: from here on a tangent counts as another one. */
static const double BORDER_COSINE = 0.99619469809174553;

/* The tangent of a corner that was solved, split or not. */
static const float *solved_tangent(const nt_mesh *mesh, size_t corner)
{
	if (!mesh->split.vertex_tangents)
		return mesh->corner_tangents + 4 * corner;
	const uint32_t *indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	return mesh->split.vertex_tangents + 4 * (indices ? indices[corner] : corner);
}

/* Triangles without an orientation have any tangent. */
static bool has_orientation(const nt_mesh *mesh, size_t triangle)
{
	const float *uv[3];
	for (size_t k = 0; k < 3; k++)
		uv[k] = mesh->texcoords + 2 * nt_mesh_vertex(mesh, 3 * triangle + k);
	return nmtan_orientation(uv[0], uv[1], uv[2]) != 0;
}

static void compare_part(nt_scene *scene, const nt_mesh *mesh, const float *joined)
{
	static const double degrees = 57.29577951308232;
	size_t count = 0;
	double least = 1;
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const nt_dvec3 a = nt_dvec3_load(solved_tangent(mesh, c)), b = nt_dvec3_load(joined + 4 * c);
		const double cosine = nt_dvec3_dot(a, b) / sqrt(nt_dvec3_dot(a, a) * nt_dvec3_dot(b, b));
		if (!(cosine < BORDER_COSINE) || !has_orientation(mesh, c / 3))
			continue;
		count++;
		least = fmin(least, cosine);
	}
	if (count)
		nt_finding_add(&scene->findings, NT_CODE_TAN_PRIMITIVE_BORDER,
			nt_mesh_place(mesh, &(nt_place){0}), count,
			"by up to %.1f degrees", nt_angle(sqrt(fmax(0, 1 - least * least)), least) * degrees);
}

/* Whether all parts are there: what a report could not read is left out. */
static bool is_comparable(const nt_join *join)
{
	for (size_t i = 0; i < join->part_count; i++) {
		const nt_mesh *part = join->parts[i];
		if (!part->positions || !part->normals || !part->texcoords)
			return false;
	}
	return true;
}

/* The finding goes to the meshes that were solved anew; what --existing=repair keeps is not nmtan's. */
static nt_status compare_join(nt_scene *scene, const nt_join *join, const nmtan_options *options)
{
	nt_whole w = {.join = join, .parts = join->parts, .part_count = join->part_count, .options = options};
	float *rows = NULL;
	nt_status status = nt_whole_gather(&w);
	if (!status)
		status = nt_whole_solve(&w, &w.mesh, options, &rows, NULL);
	for (size_t i = 0, corner = 0; !status && i < join->part_count; corner += join->parts[i++]->corner_count)
		if (join->parts[i]->decision == NT_DECISION_SOLVE)
			compare_part(scene, join->parts[i], rows + 4 * corner);
	free(rows);
	nt_arena_free(&w.arena);
	return status;
}

nt_status nt_stage_borders(nt_scene *scene, const nt_settings *settings, nt_error *error)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = settings->method,
		.repair = settings->repair, .threads = settings->io.threads};
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->join_count; i++)
		if (is_comparable(&scene->joins[i])) {
			status = compare_join(scene, &scene->joins[i], &options);
			/* each by itself they are not */
			status = status == NT_ERROR_TOO_LARGE ? NT_OK : status;
		}
	return status ? nt_fail(error, status, "cannot compare borders: %s", nt_status_text(status)) : NT_OK;
}
