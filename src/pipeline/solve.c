/* SPDX-License-Identifier: MIT */
/*
 * The solve of a job: tangents, then the vertices that they split. Usually the library does both at once, by vertices
 * (solve_vertices()). Joins, morph targets, quads and tangents that stay need those of corners first.
 *
 * A job is one mesh, or the primitives that are solved as one (--across=mesh). Parts of such a join are put one behind
 * the other (joins.c), and MikkTSpace welds by value, so that their borders vanish; the rows of a part's corners are
 * then the part's own. One mesh is its own whole, and nothing is copied.
 *
 * Each morph target that moves any part is solved in the same way: a part that it does not move has other tangents at
 * the border to one that it does.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/structs.h"
#include "gltf/load.h"
#include "scene/values.h"
#include "tangent/frames.h"

/* Whether a part is a mesh of the scene. */
static bool is_solved_here(const nt_whole *w, const nt_mesh *part)
{
	return !w->join || (part->plan.join == w->join && !part->plan.copied);
}

/* ---- the base ---- */

static nt_status solve_alone(const nt_whole *w, nt_mesh *mesh)
{
	if (w->mesh.texcoords && mesh->decision != NT_DECISION_NORMALS)
		return nt_whole_solve(w, &w->mesh, w->options, &mesh->corner_tangents, &mesh->counts);
	mesh->corner_tangents = nt_calloc(mesh->corner_count, 4 * sizeof(float));
	if (!mesh->corner_tangents)
		return NT_ERROR_MEMORY;
	if (mesh->decision == NT_DECISION_NORMALS) /* equal ones split no vertex, and nobody writes them */
		mesh->morph_count = 0;
	else
		nt_mend_untextured(mesh, &w->mesh, mesh->corner_tangents);
	return NT_OK;
}

/* Counts of a solve of the whole on one part: its triangles are checked again, its corners by the raw rows where the
 * solve repaired any. These are written to. */
static nt_status check_part(const nt_whole *w, const nt_mesh *part, float *raw, nmtan_counts *counts)
{
	nmtan_stored_uv stored;
	nmtan_mesh view = nt_mesh_view(part, &stored);
	stored.v_offset = w->stored.v_offset;
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

/* Raw rows, as repair found them. A corner that no triangle gives a tangent has MikkTSpace's placeholder there, which
 * others may have too: it is known by what repair made of it. Such corners get w = 0, by which a check knows them. */
static nt_status solve_raw(const nt_whole *w, const float *repaired, float **raw)
{
	static const float placeholder[4] = {1, 0, 0, -1};
	nmtan_options options = *w->options;
	options.repair = NMTAN_REPAIR_OFF;
	options.timing = NULL;
	const nt_status status = nt_whole_solve(w, &w->mesh, &options, raw, NULL);
	for (size_t c = 0; !status && c < w->corner_count; c++)
		if (memcmp(*raw + 4 * c, placeholder, sizeof placeholder) == 0 &&
			memcmp(repaired + 4 * c, placeholder, sizeof placeholder) != 0)
			(*raw)[4 * c + 3] = 0.0f;
	return status;
}

/* Each part gets its rows and its counts. */
static nt_status solve_together(const nt_whole *w)
{
	float *rows = NULL, *raw = NULL;
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	nt_status status = nt_whole_solve(w, &w->mesh, w->options, &rows, &counts);
	if (!status && nt_counts_repaired(&counts))
		status = solve_raw(w, rows, &raw);
	for (size_t i = 0, corner = 0; !status && i < w->part_count; corner += w->parts[i++]->corner_count) {
		nt_mesh *part = w->parts[i];
		if (!is_solved_here(w, part))
			continue;
		part->corner_tangents = nt_alloc(part->corner_count, 4 * sizeof *rows);
		if (!part->corner_tangents) {
			status = NT_ERROR_MEMORY;
			break;
		}
		memcpy(part->corner_tangents, rows + 4 * corner, part->corner_count * 4 * sizeof *rows);
		if (part->corner_count == 0)
			continue;
		status = check_part(w, part, raw ? raw + 4 * corner : NULL, &part->counts);
		/* the method tells how many corners are ill-conditioned, not which: the first mesh has them */
		part->counts.ill_conditioned = counts.ill_conditioned;
		counts.ill_conditioned = 0;
	}
	free(rows);
	free(raw);
	return status;
}

/* ---- morph targets ---- */

static nt_morph *find_morph(const nt_whole *w, nt_mesh *part, uint32_t target)
{
	for (size_t m = 0; is_solved_here(w, part) && nt_mesh_is_wanted(part) && m < part->morph_count; m++)
		if (part->morphs[m].target == target)
			return &part->morphs[m];
	return NULL;
}

/* The whole as a target moves it; both arrays are malloc'ed, NULL as the base has them. */
static nt_status move(const nt_whole *w, uint32_t target, float **positions, float **normals)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < w->part_count; i++) {
		const nt_morph *morph = find_morph(w, w->parts[i], target);
		float *p = NULL, *n = NULL;
		if (morph)
			status = nt_gltf_move(w->parts[i], morph, &p, &n);
		if (!w->join) {
			*positions = p;
			*normals = n;
			break;
		}
		if (!status && !(nt_whole_put(w, i, p, w->mesh.positions, positions) &&
			nt_whole_put(w, i, n, w->mesh.normals, normals)))
			status = NT_ERROR_MEMORY;
		free(p);
		free(n);
	}
	return status;
}

/* The corners of a part, as the whole has them or a target moves them. */
static nmtan_mesh view_of_part(const nmtan_mesh *whole, const nt_mesh *part, size_t corner)
{
	nmtan_mesh view = *whole;
	view.face_count = part->face_count;
	view.indices = whole->indices ? whole->indices + corner : NULL;
	return view;
}

/* The effect of adding half of the deltas, part by part, if a target turns any tangent enough for it to matter. */
static nt_status measure_halfway(const nt_whole *w, uint32_t target, const nmtan_mesh *moved, const float *rows)
{
	bool turns = false;
	for (size_t i = 0, corner = 0; !turns && i < w->part_count; corner += w->parts[i++]->corner_count)
		turns = find_morph(w, w->parts[i], target) &&
			nt_morphs_turn(w->parts[i], &w->works[i], rows + 4 * corner);
	if (!turns)
		return NT_OK;
	float *positions = NULL, *normals = NULL, *halfway = NULL;
	nmtan_options untimed = *w->options;
	untimed.timing = NULL;
	nt_status status = nt_morphs_halfway(&w->mesh, moved, &positions, &normals) ? NT_OK : NT_ERROR_MEMORY;
	nmtan_mesh middle = w->mesh;
	middle.positions = positions ? positions : middle.positions;
	middle.normals = normals ? normals : middle.normals;
	if (!status)
		status = nt_whole_solve(w, &middle, &untimed, &halfway, NULL);
	free(positions);
	free(normals);
	for (size_t i = 0, corner = 0; !status && i < w->part_count; corner += w->parts[i++]->corner_count) {
		nt_morph *morph = find_morph(w, w->parts[i], target);
		const nmtan_mesh base = view_of_part(&w->mesh, w->parts[i], corner),
				 to = view_of_part(moved, w->parts[i], corner);
		if (morph)
			nt_morphs_compare_halfway(w->parts[i], &w->works[i], &base, &to, rows + 4 * corner,
				halfway + 4 * corner, morph);
	}
	free(halfway);
	return status;
}

static nt_status solve_target(const nt_whole *w, uint32_t target)
{
	float *positions = NULL, *normals = NULL, *rows = NULL;
	nmtan_mesh moved = w->mesh;
	nt_status status = move(w, target, &positions, &normals);
	moved.positions = positions ? positions : moved.positions;
	moved.normals = normals ? normals : moved.normals;
	if (!status && moved.texcoords) {
		status = nt_whole_solve(w, &moved, w->options, &rows, NULL);
		if (!status)
			status = measure_halfway(w, target, &moved, rows);
	} else if (!status) {
		rows = nt_alloc(w->corner_count, 4 * sizeof *rows);
		status = rows ? NT_OK : NT_ERROR_MEMORY;
		if (rows)
			nt_turn_untextured(w->parts[0], &w->mesh, &moved, rows);
	}
	for (size_t i = 0, corner = 0; !status && i < w->part_count; corner += w->parts[i++]->corner_count) {
		nt_mesh *part = w->parts[i];
		nt_morph *morph = find_morph(w, part, target);
		const nmtan_mesh base = view_of_part(&w->mesh, part, corner), to = view_of_part(&moved, part, corner);
		if (!morph)
			continue;
		morph->turned_triangles = nt_morphs_count_turned(&base, &to);
		status = nt_morphs_classify(part, &w->works[i], morph, rows + 4 * corner);
	}
	free(positions);
	free(normals);
	free(rows);
	return status;
}

static nt_status solve_targets(const nt_whole *w)
{
	const size_t count = w->join ? w->join->target_count : w->parts[0]->morph_count;
	nt_status status = NT_OK;
	for (uint32_t t = 0; !status && t < count; t++)
		if (!w->join || w->join->moves[t])
			status = solve_target(w, w->join ? t : w->parts[0]->morphs[t].target);
	return status;
}

/* ---- from corners to vertices ---- */

/* Room for the worst case; pages that are not needed are never touched. */
static nt_status make_split(nt_mesh *mesh, nmtan_split_output *output)
{
	const size_t capacity = mesh->corner_count;
	nt_split *split = &mesh->split;
	*split = (nt_split){
		.indices = nt_alloc(capacity, sizeof *split->indices),
		.sources = nt_alloc(capacity, sizeof *split->sources),
		.vertex_tangents = nt_alloc(mesh->vertex_count + capacity, 4 * sizeof(float)),
	};
	*output = (nmtan_split_output){.struct_bytes = sizeof *output, .indices = split->indices,
		.sources = split->sources, .source_capacity = capacity, .vertex_tangents = split->vertex_tangents};
	return split->indices && split->sources && split->vertex_tangents ? NT_OK : NT_ERROR_MEMORY;
}

/* A block becomes the arena's: a copy of what is used of it, where that is little. */
static void *keep_block(nt_arena *arena, void *block, size_t count, size_t size)
{
	enum { LARGE_BYTES = 1 << 20 };
	if (count * size >= LARGE_BYTES)
		return nt_arena_adopt(arena, block) ? block : NULL;
	void *kept = nt_arena_alloc(arena, count, size);
	if (kept && count)
		memcpy(kept, block, count * size);
	free(block);
	return kept;
}

/* Takes over what was split, or frees it after failure; without copies a mesh keeps its own indices. */
static nt_status keep_split(const nt_job *job, nt_mesh *mesh, const nmtan_split_output *output, nt_status status)
{
	nt_split *split = &mesh->split;
	const size_t count = output->source_count;
	if (status || count == 0) {
		free(split->indices);
		split->indices = NULL;
	}
	if (status) {
		free(split->sources);
		free(split->vertex_tangents);
		*split = (nt_split){0};
		return status;
	}
	if (job->digests && mesh->decision != NT_DECISION_NORMALS)
		mesh->tangents_digest = nt_hash_unkeyed(0, split->vertex_tangents,
			4 * sizeof(float) * (mesh->vertex_count + count));
	split->source_count = count;
	if (count)
		split->indices = keep_block(job->arena, split->indices, mesh->corner_count, sizeof *split->indices);
	split->sources = keep_block(job->arena, split->sources, count, sizeof *split->sources);
	nt_drop_pages(split->vertex_tangents + 4 * (mesh->vertex_count + count),
		4 * sizeof(float) * (mesh->corner_count - count));
	split->vertex_tangents = keep_block(job->arena, split->vertex_tangents, mesh->vertex_count + count,
		4 * sizeof(float));
	if (split->sources && split->vertex_tangents && (split->indices || count == 0))
		return NT_OK;
	*split = (nt_split){0};
	return NT_ERROR_MEMORY;
}

/* With morph targets: wherever the base or a target needs it. */
static nt_status split_corners(const nt_job *job, nt_mesh *mesh, const nt_morph_work *work)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	nmtan_split_output output;
	float *keys = mesh->morph_count ? nt_alloc(mesh->corner_count, 4 * sizeof *keys) : NULL;
	nt_status status = make_split(mesh, &output);
	if (mesh->morph_count && !keys)
		status = NT_ERROR_MEMORY;
	if (keys)
		nt_morphs_keys(mesh, work, keys);
	if (!status)
		status = nt_status_of(nmtan_split(&view, keys ? keys : mesh->corner_tangents, &job->options, &output));
	if (!status && mesh->morph_count)
		status = nt_morphs_finish(mesh, work, output.source_count, job->arena);
	free(keys);
	return keep_split(job, mesh, &output, status);
}

/* ---- the job ---- */

/* Corner tangents of all parts, and what targets make of them. */
static nt_status solve_corners(const nt_job *job, const nt_whole *w)
{
	nt_status status = w->join ? solve_together(w) : solve_alone(w, w->parts[0]);
	bool targets = false;
	if (!status && !w->join && job->splits && job->triangulates && w->mesh.face_sizes &&
		job->options.repair == NMTAN_REPAIR_ON)
		status = nt_cut_folded_quads(w->parts[0], job->v_offset, job->options.threads, job->arena);
	for (size_t i = 0; i < w->part_count; i++)
		targets |= job->splits && is_solved_here(w, w->parts[i]) && w->parts[i]->morph_count;
	for (size_t i = 0; !status && i < w->part_count; i++)
		if (is_solved_here(w, w->parts[i]))
			status = nt_morphs_restore(w->parts[i], &w->works[i], targets);
	return !status && targets ? solve_targets(w) : status;
}

/* Splits the parts; those that nobody writes, or that are only compared, keep tangents of corners. */
static nt_status finish_part(const nt_job *job, nt_mesh *mesh, nt_morph_work *work, nt_status status)
{
	const bool splits = job->splits && nt_mesh_is_wanted(mesh);
	if (!status && splits)
		status = split_corners(job, mesh, work);
	nt_morphs_free(work);
	if (status || splits) {
		free(mesh->corner_tangents);
		mesh->corner_tangents = NULL;
	}
	return nt_arena_adopt(job->arena, mesh->corner_tangents) || status ? status : NT_ERROR_MEMORY;
}

/* Vertices take less memory than corners, so that they are split although nothing is written. */
static nt_status solve_vertices(const nt_job *job, nt_mesh *mesh, const nmtan_mesh *view)
{
	nmtan_split_output output;
	nt_status status = make_split(mesh, &output);
	/* small ones have a workspace, whose pages are there */
	const nt_vertex_request request = {.lazy_indices = true, .lends_copies = !job->options.workspace};
	if (!status)
		status = nt_status_of(nt_vertex_tangents(view, &job->options, &request, &output, &mesh->counts));
	return keep_split(job, mesh, &output, status);
}

nt_status nt_job_solve(const nt_job *job, nt_mesh *mesh)
{
	const nt_join *join = mesh->plan.join;
	nt_whole w = {.join = join, .parts = join ? join->parts : &mesh, .part_count = join ? join->part_count : 1,
		.options = &job->options};
	nt_status status = NT_OK;
	if (!join && mesh->decision == NT_DECISION_NORMALS && !job->triangulates)
		return NT_OK; /* the edit of a glTF alone asks for a split */
	for (size_t i = 0; i < w.part_count; i++)
		if (is_solved_here(&w, w.parts[i]))
			w.parts[i]->counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	if (join) {
		status = nt_whole_gather(&w);
	} else {
		w.mesh = nt_mesh_view(mesh, &w.stored);
		w.corner_count = mesh->corner_count;
		w.halves = mesh->halves;
	}
	w.stored.v_offset = job->v_offset;
	const bool by_corner = join || mesh->decision != NT_DECISION_SOLVE || mesh->morph_count || mesh->halves ||
		(job->splits && job->triangulates && mesh->face_sizes);
	if (!by_corner)
		return solve_vertices(job, mesh, &w.mesh);
	nt_morph_work own = {0};
	w.works = join ? nt_calloc(w.part_count, sizeof *w.works) : &own;
	if (!status)
		status = w.works ? solve_corners(job, &w) : NT_ERROR_MEMORY;
	for (size_t i = 0; w.works && i < w.part_count; i++)
		if (is_solved_here(&w, w.parts[i])) {
			const nt_status finished = finish_part(job, w.parts[i], &w.works[i], status);
			status = status ? status : finished;
		}
	if (join)
		free(w.works);
	nt_arena_free(&w.arena);
	return status;
}
