/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved as one mesh (--across=mesh). The parts' vertices are put one behind the other, only those
 * that faces use, since parts often share an accessor of which each uses a little; their triangles follow each other in
 * the parts' order. MikkTSpace welds by value, so that nothing else is needed for a border to vanish, and the result
 * is that of one primitive with the same triangles. The rows of a part's corners are then the part's own.
 *
 * Each morph target that moves any part is solved in the same way: a part that it does not move has other tangents
 * at the border to one that it does.
 *
 * A join costs the parts once more, as arrays of 32 bytes for each vertex that is used.
 */
#include "pipeline/joins.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/angle.h"
#include "base/counts.h"
#include "base/dvec.h"
#include "gltf/load.h"
#include "pipeline/morphs.h"
#include "tangent/usable.h"
#include "topology/corners.h"

/* The parts of a join as one mesh. */
typedef struct whole {
	const nt_join *join;
	const nmtan_options *options;
	float stored_v_offset;
	nmtan_mesh mesh;
	nmtan_stored_uv stored;
	size_t corner_count;
	size_t *first_vertex;  /* [part_count + 1] */
	uint32_t *sources;     /* [mesh.vertex_count] vertex of its part */
	uint32_t *indices;
	uint8_t *halves;       /* [mesh.face_count] of the parts; NULL: none has quads */
	float *positions, *normals, *texcoords, *stored_texcoords;
	float *tangents;       /* [corner_count][4] */
	nmtan_counts counts;
} whole;

static void free_whole(whole *w)
{
	free(w->first_vertex);
	free(w->sources);
	free(w->indices);
	free(w->halves);
	free(w->positions);
	free(w->normals);
	free(w->texcoords);
	free(w->stored_texcoords);
	free(w->tangents);
}

/* ---- gathering ---- */

/* Numbers the vertices that the faces of a part use, in the order of their first corners. False: out of memory. */
static bool number_vertices(whole *w, const nt_mesh *part, size_t first_corner, uint32_t *vertex_count)
{
	uint32_t *number = nt_alloc(part->vertex_count, sizeof *number);
	if (!number)
		return false;
	memset(number, 0xFF, part->vertex_count * sizeof *number);
	for (size_t c = 0; c < part->corner_count; c++) {
		const uint32_t vertex = part->indices ? part->indices[c] : (uint32_t)c;
		if (number[vertex] == NT_NONE) {
			w->sources[*vertex_count] = vertex;
			number[vertex] = (*vertex_count)++;
		}
		w->indices[first_corner + c] = number[vertex];
	}
	free(number);
	return true;
}

static nt_status number_all(whole *w)
{
	const nt_join *join = w->join;
	for (size_t i = 0; i < join->part_count; i++)
		w->corner_count += join->parts[i]->corner_count;
	if (w->corner_count >= NT_NONE)
		return NT_ERROR_TOO_LARGE;
	w->first_vertex = nt_alloc(join->part_count + 1, sizeof *w->first_vertex);
	w->sources = nt_alloc(w->corner_count, sizeof *w->sources);
	w->indices = nt_alloc(w->corner_count, sizeof *w->indices);
	if (!w->first_vertex || !w->sources || !w->indices)
		return NT_ERROR_MEMORY;
	uint32_t vertex_count = 0;
	for (size_t i = 0, corner = 0; i < join->part_count; corner += join->parts[i++]->corner_count) {
		w->first_vertex[i] = vertex_count;
		if (!number_vertices(w, join->parts[i], corner, &vertex_count))
			return NT_ERROR_MEMORY;
	}
	w->first_vertex[join->part_count] = vertex_count;
	w->mesh.vertex_count = vertex_count;
	return NT_OK;
}

/* Rows of a part, as many floats each, to the whole's. */
static void gather(const whole *w, size_t part, const float *rows, size_t floats, float *to)
{
	for (size_t v = w->first_vertex[part]; v < w->first_vertex[part + 1]; v++)
		memcpy(to + floats * v, rows + floats * w->sources[v], floats * sizeof *rows);
}

static nt_status gather_all(whole *w)
{
	const nt_join *join = w->join;
	const size_t count = w->mesh.vertex_count;
	nmtan_stored_uv stored;
	nt_mesh_view(join->parts[0], &stored);
	w->positions = nt_alloc(count, 3 * sizeof(float));
	w->normals = nt_alloc(count, 3 * sizeof(float));
	w->texcoords = nt_alloc(count, 2 * sizeof(float));
	w->stored_texcoords = stored.texcoords ? nt_alloc(count, 2 * sizeof(float)) : NULL;
	if (!w->positions || !w->normals || !w->texcoords || (stored.texcoords && !w->stored_texcoords))
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < join->part_count; i++) {
		/* one transform for all: all have stored coordinates or none */
		const nmtan_mesh view = nt_mesh_view(join->parts[i], &stored);
		gather(w, i, view.positions, 3, w->positions);
		gather(w, i, view.normals, 3, w->normals);
		gather(w, i, view.texcoords, 2, w->texcoords);
		if (w->stored_texcoords)
			gather(w, i, stored.texcoords, 2, w->stored_texcoords);
	}
	w->stored = (nmtan_stored_uv){.struct_bytes = sizeof w->stored, .v_offset = w->stored_v_offset,
		.mirrored = stored.mirrored, .texcoords = w->stored_texcoords};
	w->mesh = (nmtan_mesh){.struct_bytes = sizeof w->mesh, .face_count = w->corner_count / 3,
		.vertex_count = count, .indices = w->indices, .positions = w->positions, .normals = w->normals,
		.texcoords = w->texcoords, .stored = &w->stored};
	return NT_OK;
}

static nt_status solve(const whole *w, const nmtan_mesh *mesh, const nmtan_options *options, float **tangents,
	nmtan_counts *counts)
{
	*tangents = nt_alloc(w->corner_count, 4 * sizeof **tangents);
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = *tangents};
	return *tangents ? nt_status_of(nt_tangents_of_halves(mesh, w->halves, options, &output, counts))
			 : NT_ERROR_MEMORY;
}

static nt_status gather_halves(whole *w)
{
	const nt_join *join = w->join;
	bool any = false;
	for (size_t i = 0; i < join->part_count; i++)
		any |= join->parts[i]->halves != NULL;
	w->halves = any ? nt_calloc(w->mesh.face_count, 1) : NULL;
	if (any && !w->halves)
		return NT_ERROR_MEMORY;
	for (size_t i = 0, first = 0; any && i < join->part_count; first += join->parts[i++]->face_count)
		if (join->parts[i]->halves)
			memcpy(w->halves + first, join->parts[i]->halves, join->parts[i]->face_count);
	return NT_OK;
}

static nt_status make_whole(whole *w)
{
	nt_status status = number_all(w);
	if (!status)
		status = gather_all(w);
	if (!status)
		status = gather_halves(w);
	w->counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	return status ? status : solve(w, &w->mesh, w->options, &w->tangents, &w->counts);
}

/* The rows of a part among those of all corners. */
static nt_status take_rows(const nt_mesh *part, const float *rows, float **tangents)
{
	*tangents = nt_alloc(part->corner_count, 4 * sizeof **tangents);
	if (!*tangents)
		return NT_ERROR_MEMORY;
	memcpy(*tangents, rows, part->corner_count * 4 * sizeof *rows);
	return NT_OK;
}

/* ---- counts of a part ---- */

/* Counts of a solve of the whole on one part: its triangles are checked again, its corners by the raw rows where the
 * solve repaired any. These are written to. */
static nt_status check_part(const whole *w, const nt_mesh *part, float *raw, nmtan_counts *counts)
{
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(part, &stored);
	stored.v_offset = w->stored_v_offset;
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	const nt_solve rows = {.mesh = &view, .corner_count = part->corner_count, .threads = 1, .scratch = &scratch,
		.repair = raw != NULL, .tangents = raw};
	uint64_t *faulty;
	const nt_status status = nt_status_of(nt_find_unusable(&rows, counts, &faulty));
	counts->struct_bytes = sizeof *counts;
	nt_scratch_free(&scratch);
	return status;
}

/* A corner that no triangle gives a tangent has MikkTSpace's placeholder in the raw result, which others may have
 * too: it is known by what repair made of it. Such corners get w = 0, by which the check knows them. */
static void mark_unassigned(const whole *w, float *raw)
{
	static const float placeholder[4] = {1, 0, 0, -1};
	for (size_t c = 0; c < w->corner_count; c++)
		if (memcmp(raw + 4 * c, placeholder, sizeof placeholder) == 0 &&
			memcmp(w->tangents + 4 * c, placeholder, sizeof placeholder) != 0)
			raw[4 * c + 3] = 0.0f;
}

/* Whether a part is a mesh of the scene. */
static bool is_solved_here(const whole *w, const nt_mesh *part)
{
	return part->plan.join == w->join && !part->plan.copied;
}

static nt_status count_parts(const whole *w)
{
	float *raw = NULL;
	nt_status status = NT_OK;
	if (nt_counts_repaired(&w->counts)) {
		nmtan_options options = *w->options;
		options.repair = NMTAN_REPAIR_OFF;
		options.timing = NULL;
		status = solve(w, &w->mesh, &options, &raw, NULL);
		if (!status)
			mark_unassigned(w, raw);
	}
	/* the method tells how many corners are ill-conditioned, not which: the first mesh has them */
	size_t ill_conditioned = w->counts.ill_conditioned;
	for (size_t i = 0, corner = 0; !status && i < w->join->part_count;
		corner += w->join->parts[i++]->corner_count) {
		nt_mesh *part = w->join->parts[i];
		if (!is_solved_here(w, part) || part->corner_count == 0)
			continue;
		status = check_part(w, part, raw ? raw + 4 * corner : NULL, &part->counts);
		part->counts.ill_conditioned = ill_conditioned;
		ill_conditioned = 0;
	}
	free(raw);
	return status;
}

/* ---- morph targets ---- */

static nt_morph *find_morph(const nt_mesh *part, uint32_t target)
{
	for (size_t m = 0; nt_mesh_is_wanted(part) && m < part->morph_count; m++)
		if (part->morphs[m].target == target)
			return &part->morphs[m];
	return NULL;
}

/* The whole as a target moves it; both arrays are malloc'ed. */
static nt_status move_whole(const whole *w, uint32_t target, float **positions, float **normals)
{
	const size_t count = w->mesh.vertex_count;
	nt_status status = NT_OK;
	*positions = nt_alloc(count, 3 * sizeof **positions);
	*normals = nt_alloc(count, 3 * sizeof **normals);
	if (!*positions || !*normals)
		return NT_ERROR_MEMORY;
	memcpy(*positions, w->positions, count * 3 * sizeof **positions);
	memcpy(*normals, w->normals, count * 3 * sizeof **normals);
	for (size_t i = 0; !status && i < w->join->part_count; i++) {
		float *p = NULL, *n = NULL;
		const nt_morph *morph = find_morph(w->join->parts[i], target);
		if (morph)
			status = nt_gltf_move(w->join->parts[i], morph, &p, &n);
		if (!status && p)
			gather(w, i, p, 3, *positions);
		if (!status && n)
			gather(w, i, n, 3, *normals);
		free(p);
		free(n);
	}
	return status;
}

/* The corners of a part, as the whole has them or a target moves them. */
static nmtan_mesh view_of_part(const nmtan_mesh *whole_mesh, const nt_mesh *part, size_t corner)
{
	nmtan_mesh view = *whole_mesh;
	view.face_count = part->face_count;
	view.indices = whole_mesh->indices + corner;
	return view;
}

/* The rows of a target go to the parts. */
static nt_status hand_out_target(const whole *w, uint32_t target, const nmtan_mesh *moved, const float *tangents,
	bool *turns)
{
	for (size_t i = 0, corner = 0; i < w->join->part_count; corner += w->join->parts[i++]->corner_count) {
		nt_mesh *part = w->join->parts[i];
		nt_morph *morph = is_solved_here(w, part) ? find_morph(part, target) : NULL;
		if (!morph)
			continue;
		const nt_status status = take_rows(part, tangents + 4 * corner, &morph->corner_tangents);
		if (status)
			return status;
		const nmtan_mesh base = view_of_part(&w->mesh, part, corner), to = view_of_part(moved, part, corner);
		part->morph_turned += nt_morphs_count_turned(&base, &to);
		*turns |= nt_morphs_turn(part, morph);
	}
	return NT_OK;
}

/* The effect of adding half of the deltas, part by part. */
static nt_status measure_halfway(const whole *w, uint32_t target, const nmtan_mesh *moved)
{
	float *halfway;
	const nt_status status = nt_morphs_solve_halfway(&w->mesh, moved, w->halves, w->options, &halfway);
	for (size_t i = 0, corner = 0; !status && i < w->join->part_count;
		corner += w->join->parts[i++]->corner_count) {
		const nt_mesh *part = w->join->parts[i];
		nt_morph *morph = is_solved_here(w, part) ? find_morph(part, target) : NULL;
		const nmtan_mesh base = view_of_part(&w->mesh, part, corner), to = view_of_part(moved, part, corner);
		if (morph)
			nt_morphs_compare_halfway(part, &base, &to, halfway + 4 * corner, morph);
	}
	free(halfway);
	return status;
}

static nt_status solve_target(const whole *w, uint32_t target)
{
	float *positions = NULL, *normals = NULL, *tangents = NULL;
	bool turns = false;
	nt_status status = move_whole(w, target, &positions, &normals);
	nmtan_mesh moved = w->mesh;
	moved.positions = positions;
	moved.normals = normals;
	if (!status)
		status = solve(w, &moved, w->options, &tangents, NULL);
	if (!status)
		status = hand_out_target(w, target, &moved, tangents, &turns);
	free(tangents);
	if (!status && turns)
		status = measure_halfway(w, target, &moved);
	for (size_t i = 0; !status && i < w->join->part_count; i++) {
		nt_mesh *part = w->join->parts[i];
		nt_morph *morph = is_solved_here(w, part) ? find_morph(part, target) : NULL;
		if (morph)
			status = nt_morphs_classify(part, morph);
	}
	free(positions);
	free(normals);
	return status;
}

/* Whether targets were loaded, of a part that gets tangents. */
static bool has_morphs(const whole *w)
{
	for (size_t i = 0; i < w->join->part_count; i++)
		if (is_solved_here(w, w->join->parts[i]) && w->join->parts[i]->morph_count)
			return true;
	return false;
}

/* ---- the join ---- */

static nt_status hand_out(const whole *w)
{
	nt_status status = NT_OK;
	for (size_t i = 0, corner = 0; !status && i < w->join->part_count;
		corner += w->join->parts[i++]->corner_count) {
		nt_mesh *part = w->join->parts[i];
		if (is_solved_here(w, part))
			status = take_rows(part, w->tangents + 4 * corner, &part->corner_tangents);
	}
	return status;
}

static nt_status restore_parts(const whole *w, bool targets)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < w->join->part_count; i++)
		if (is_solved_here(w, w->join->parts[i]))
			status = nt_morphs_restore(w->join->parts[i], targets);
	return status;
}

nt_status nt_join_solve(const nt_join *join, float stored_v_offset, bool targets, const nmtan_options *options)
{
	whole w = {.join = join, .options = options, .stored_v_offset = stored_v_offset};
	for (size_t i = 0; i < join->part_count; i++) {
		if (!is_solved_here(&w, join->parts[i]))
			continue;
		join->parts[i]->morph_turned = 0;
		join->parts[i]->counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	}
	targets = targets && has_morphs(&w);
	nt_status status = make_whole(&w);
	if (!status)
		status = hand_out(&w);
	if (!status)
		status = count_parts(&w);
	if (!status)
		status = restore_parts(&w, targets);
	for (uint32_t t = 0; !status && targets && t < join->target_count; t++)
		if (join->moves[t])
			status = solve_target(&w, t);
	free_whole(&w);
	return status;
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
	for (size_t k = 0; k < 3; k++) {
		const size_t corner = 3 * triangle + k;
		uv[k] = mesh->texcoords + 2 * (mesh->indices ? mesh->indices[corner] : corner);
	}
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
	whole w = {.join = join, .options = options};
	nt_status status = make_whole(&w);
	for (size_t i = 0, corner = 0; !status && i < join->part_count; corner += join->parts[i++]->corner_count)
		if (join->parts[i]->decision == NT_DECISION_SOLVE)
			compare_part(scene, join->parts[i], w.tangents + 4 * corner);
	free_whole(&w);
	return status;
}

nt_status nt_stage_borders(nt_scene *scene, const nt_settings *settings, nt_error *error)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = settings->method,
		.repair = settings->repair, .threads = settings->threads};
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < scene->join_count; i++)
		if (is_comparable(&scene->joins[i])) {
			status = compare_join(scene, &scene->joins[i], &options);
			/* each by itself they are not */
			status = status == NT_ERROR_TOO_LARGE ? NT_OK : status;
		}
	return status ? nt_fail(error, status, "cannot compare borders: %s", nt_status_text(status)) : NT_OK;
}
