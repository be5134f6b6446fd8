/* SPDX-License-Identifier: MIT */
/*
 * The stage that computes: tangents per corner, then the vertices they split.
 *
 * A mesh large enough to occupy all threads is solved alone, and so is one that other threads would wait for; smaller
 * ones are solved side by side, each by one thread with a workspace of its own. Each mesh's result depends on that mesh
 * only, so the order does not show. Meshes with the same geometry as an earlier one take its result.
 */
#include "pipeline/joins.h"
#include "pipeline/morphs.h"
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/counts.h"
#include "base/hash.h"
#include "base/pages.h"
#include "base/parallel.h"
#include "scene/morphs.h"

/* Corners from which one mesh is worth all threads, whatever else there is, and where the others are less than half of
 * it; and those that small ones must have together for threads to be made at all, which costs as much as solving some
 * hundred triangles. */
enum { LARGE_CORNERS = 3 * 128 * 1024, LEAST_SHARED_CORNERS = 3 * 4096 };

/* Data for all meshes of a run. */
typedef struct wishes {
	nt_scene *scene;
	const nt_settings *settings;
	float v_offset;     /* that v is stored with: none if the format stays, else see nmtan_stored_uv */
	bool triangulates;  /* the output has triangles where the input has quads */
	bool splits;        /* something is written, or judged as if it were */
} wishes;

/* Memory in which a thread solves small meshes. */
typedef struct solver {
	nmtan_workspace *workspace; /* NULL: none */
	nt_arena arena;             /* results, until the scene takes them over */
	nt_arena temporary;         /* the same of temporary meshes */
} solver;

struct nt_small_solves {
	wishes wishes;
	unsigned slots;
	solver solvers[]; /* [slots] */
};

typedef struct tangent_job {
	wishes wishes;
	nt_mesh **meshes;   /* the ones to solve */
	nt_status *statuses;
	size_t count;
	bool *is_large;     /* [count] solved by all threads: LARGE_CORNERS, or one for which other threads
	                       would wait */
	size_t small_corners; /* of the others together */
	nt_small_solves *small; /* while these are solved */
	nmtan_timing timing;    /* of the large meshes */
} tangent_job;

static wishes wishes_of(nt_scene *scene, const nt_settings *settings, nt_format output)
{
	return (wishes){.scene = scene, .settings = settings,
		.v_offset = output == NT_FORMAT_UNKNOWN ? 0.0f : nt_v_offset(scene->format, output),
		.triangulates = nt_format_is_gltf(output), .splits = output != NT_FORMAT_UNKNOWN};
}

static bool is_solved(const nt_mesh *mesh)
{
	return nt_mesh_is_wanted(mesh) && !mesh->plan.same_as;
}

/* Whether a mesh is solved by itself, or stands for its join. */
static bool is_item(const nt_mesh *mesh)
{
	return mesh->plan.join ? mesh->plan.join->first == mesh : is_solved(mesh) && !nt_mesh_is_solved_ahead(mesh);
}

/* Room for the worst case; pages that are not needed are never touched. keep_split() or drop_split() gets the
 * results. */
static nt_status make_split(const nt_mesh *mesh, nt_split *split, nmtan_split_output *output)
{
	const size_t capacity = mesh->corner_count;
	*split = (nt_split){
		.indices = nt_alloc(capacity, sizeof *split->indices),
		.sources = nt_alloc(capacity, sizeof *split->sources),
		.vertex_tangents = nt_alloc(mesh->vertex_count + capacity, 4 * sizeof(float)),
	};
	*output = (nmtan_split_output){.struct_bytes = sizeof(nmtan_split_output), .indices = split->indices,
		.sources = split->sources,
		.source_capacity = capacity, .vertex_tangents = split->vertex_tangents};
	return split->indices && split->sources && split->vertex_tangents ? NT_OK
									  : NT_ERROR_MEMORY;
}

/* Tangents of corners: for the report alone, or to be mixed with authored ones before they are split. */
static nt_status solve_corners(nt_mesh *mesh, const nmtan_mesh *view,
	const nmtan_options *options, float **tangents, nmtan_counts *counts)
{
	const nmtan_output output = {.struct_bytes = sizeof output,
		.tangents = nt_alloc(mesh->corner_count, 4 * sizeof(float))};
	*tangents = output.tangents;
	if (!output.tangents)
		return NT_ERROR_MEMORY;
	if (mesh->decision == NT_DECISION_NORMALS) { /* equal ones split no vertex, and nobody writes them */
		memset(output.tangents, 0, mesh->corner_count * 4 * sizeof(float));
		mesh->morph_count = 0;
		return NT_OK;
	}
	if (!view->texcoords) {
		nt_mend_untextured(mesh, view, output.tangents);
		return NT_OK;
	}
	return nt_status_of(nt_tangents_of_halves(view, mesh->halves, options, &output, counts));
}

/* Splits with morph targets: wherever the base or a target needs it. */
static nt_status split_morphs(nt_mesh *mesh, const nmtan_mesh *view, const nmtan_options *options,
	nmtan_split_output *output)
{
	float *keys = nt_alloc(mesh->corner_count, 4 * sizeof *keys);
	nt_status status = keys ? nt_morphs_keys(mesh, view, keys) : NT_ERROR_MEMORY;
	if (!status)
		status = nt_status_of(nmtan_split(view, keys, options, output));
	mesh->split.source_count = output->source_count;
	if (!status)
		status = nt_morphs_finish(mesh);
	free(keys);
	return status;
}

/* From tangents of corners to vertices. */
static nt_status split_corners(nt_mesh *mesh, const nmtan_options *options, nmtan_split_output *output)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	const nt_status status = make_split(mesh, &mesh->split, output);
	if (status)
		return status;
	return mesh->morph_count ? split_morphs(mesh, &view, options, output)
				 : nt_status_of(nmtan_split(&view, mesh->corner_tangents, options, output));
}

static void free_corners(nt_mesh *mesh, bool failed)
{
	nt_morphs_free(mesh, failed);
	free(mesh->corner_tangents);
	mesh->corner_tangents = NULL;
}

static void drop_split(nt_mesh *mesh)
{
	free(mesh->split.indices);
	free(mesh->split.sources);
	free(mesh->split.vertex_tangents);
	mesh->split = (nt_split){0};
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

/* Takes over what was split; without copies a mesh keeps its own indices. */
static nt_status keep_split(const wishes *job, nt_mesh *mesh, const nmtan_split_output *output, nt_arena *arena)
{
	nt_split *split = &mesh->split;
	const size_t count = output->source_count;
	if (job->settings->digests && mesh->decision != NT_DECISION_NORMALS)
		mesh->tangents_digest = nt_hash_unkeyed(0, split->vertex_tangents,
			4 * sizeof(float) * (mesh->vertex_count + count));
	split->source_count = count;
	if (count == 0) {
		free(split->indices);
		split->indices = NULL;
	} else {
		split->indices = keep_block(arena, split->indices, mesh->corner_count, sizeof *split->indices);
	}
	split->sources = keep_block(arena, split->sources, count, sizeof *split->sources);
	nt_drop_pages(split->vertex_tangents + 4 * (mesh->vertex_count + count),
		4 * sizeof(float) * (mesh->corner_count - count));
	split->vertex_tangents = keep_block(arena, split->vertex_tangents, mesh->vertex_count + count,
		4 * sizeof(float));
	const nt_status status = nt_morphs_keep(mesh, arena);
	if (split->sources && split->vertex_tangents && (split->indices || count == 0))
		return status;
	*split = (nt_split){0};
	return NT_ERROR_MEMORY;
}

static nt_status solve_mesh(const wishes *job, nt_mesh *mesh, const nmtan_options *options, nt_arena *arena)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	stored.v_offset = job->v_offset;
	mesh->counts = (nmtan_counts)NMTAN_COUNTS_INIT;
	const bool by_corner = mesh->decision != NT_DECISION_SOLVE || mesh->morph_count || mesh->halves;
	nt_status status;
	if (mesh->decision == NT_DECISION_NORMALS && !job->triangulates)
		return NT_OK; /* the edit of a glTF alone asks for a split */
	if (!job->splits && by_corner) {
		status = solve_corners(mesh, &view, options, &mesh->corner_tangents, &mesh->counts);
		return status ? status : nt_morphs_restore(mesh, false);
	}

	/* vertices take less memory than corners, so that they are split although nothing is written */
	nmtan_split_output output = {.source_count = 0};
	if (by_corner || (job->triangulates && mesh->face_sizes)) {
		status = solve_corners(mesh, &view, options, &mesh->corner_tangents, &mesh->counts);
		if (!status && job->triangulates && mesh->face_sizes && options->repair == NMTAN_REPAIR_ON)
			status = nt_cut_folded_quads(mesh, stored.v_offset, options->threads);
		if (!status)
			status = nt_morphs_restore(mesh, true);
		if (!status)
			status = nt_morphs_solve(mesh, &view, options);
		if (!status)
			status = split_corners(mesh, options, &output);
		free_corners(mesh, status);
	} else if (!(status = make_split(mesh, &mesh->split, &output))) {
		/* small ones have a workspace, whose pages are there */
		const nt_vertex_request request = {.lazy_indices = true, .lends_copies = !options->workspace};
		status = nt_status_of(nt_vertex_tangents(&view, options, &request, &output, &mesh->counts));
	}
	if (!status)
		return keep_split(job, mesh, &output, arena);
	drop_split(mesh);
	return status;
}

static nt_status solve_join(const wishes *job, const nt_join *join, const nmtan_options *options, nt_arena *arena)
{
	nt_status status = nt_join_solve(join, job->v_offset, job->splits, options);
	for (size_t i = 0; i < join->part_count; i++) {
		nt_mesh *mesh = join->parts[i];
		if (mesh->plan.copied)
			continue;
		/* kept ones are compared with them */
		if (!status && (!job->splits || !nt_mesh_is_wanted(mesh)))
			continue;
		nmtan_split_output output;
		if (!status)
			status = split_corners(mesh, options, &output);
		free_corners(mesh, status);
		if (!status)
			status = keep_split(job, mesh, &output, arena);
		else
			drop_split(mesh);
	}
	return status;
}

/* A mesh, or the join that it is the first of. */
static nt_status solve_item(const wishes *job, nt_mesh *mesh, unsigned threads, nmtan_workspace *workspace,
	nt_arena *arena, nmtan_timing *timing)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = job->settings->method,
		.repair = job->settings->repair, .threads = threads, .workspace = workspace,
		.timing = timing};
	return mesh->plan.join ? solve_join(job, mesh->plan.join, &options, arena)
			       : solve_mesh(job, mesh, &options, arena);
}

static size_t corners_of(const nt_mesh *mesh)
{
	if (!mesh->plan.join)
		return mesh->corner_count;
	size_t corners = 0;
	for (size_t i = 0; i < mesh->plan.join->part_count; i++)
		corners += mesh->plan.join->parts[i]->corner_count;
	return corners;
}

/* Marks the large ones, and one that takes longer than the others beside it, whose threads would have nothing to do;
 * counts the corners of what is left. */
static void find_large(tangent_job *job)
{
	size_t longest = 0, most = 0, sum = 0;
	for (size_t i = 0; i < job->count; i++) {
		const size_t corners = corners_of(job->meshes[i]);
		job->is_large[i] = corners >= LARGE_CORNERS;
		if (job->is_large[i])
			continue;
		sum += corners;
		if (corners > most) {
			most = corners;
			longest = i;
		}
	}
	const bool alone = most >= NT_LEAST_ALONE_CORNERS && sum - most < most / 2;
	if (alone)
		job->is_large[longest] = true;
	job->small_corners = alone ? sum - most : sum;
}

static void solve_large(tangent_job *job)
{
	for (size_t i = 0; i < job->count; i++)
		if (job->is_large[i])
			job->statuses[i] = solve_item(&job->wishes, job->meshes[i], job->wishes.settings->threads, NULL,
				nt_mesh_arena(job->wishes.scene, job->meshes[i]), &job->timing);
}

nt_small_solves *nt_small_solves_begin(nt_scene *scene, const nt_settings *settings, nt_format output, unsigned slots)
{
	nt_small_solves *small = nt_calloc(1, sizeof *small + slots * sizeof *small->solvers);
	if (small) {
		small->wishes = wishes_of(scene, settings, output);
		small->slots = slots;
	}
	return small;
}

nt_status nt_small_solve(nt_small_solves *small, nt_mesh *mesh, unsigned slot)
{
	solver *own = &small->solvers[slot];
	/* without a workspace it is only slower */
	if (!own->workspace)
		own->workspace = nmtan_workspace_create(NULL);
	return solve_item(&small->wishes, mesh, 1, own->workspace, mesh->plan.temporary ? &own->temporary : &own->arena,
		NULL);
}

void nt_small_solves_end(nt_small_solves *small)
{
	const wishes *job = &small->wishes;
	for (unsigned i = 0; i < small->slots; i++) {
		nmtan_workspace_destroy(small->solvers[i].workspace);
		nt_arena_join(&job->scene->arena, &small->solvers[i].arena);
		nt_arena_join(&job->scene->temporary, &small->solvers[i].temporary);
	}
	free(small);
}

static void solve_one_small(void *context, size_t item, unsigned slot)
{
	const tangent_job *job = context;
	if (!job->is_large[item])
		job->statuses[item] = nt_small_solve(job->small, job->meshes[item], slot);
}

static nt_status solve_small(tangent_job *job, nt_format output)
{
	const nt_settings *settings = job->wishes.settings;
	const unsigned threads = job->small_corners < LEAST_SHARED_CORNERS ? 1 : nt_thread_count(settings->threads);
	job->small = nt_small_solves_begin(job->wishes.scene, settings, output, threads);
	if (!job->small)
		return NT_ERROR_MEMORY;
	nt_parallel_items(threads, job->count, solve_one_small, job);
	nt_small_solves_end(job->small);
	return NT_OK;
}

/* Data that is not kept yet lives as long as the scene. */
static bool keep_results(nt_scene *scene, nt_mesh *mesh)
{
	/* all of them are tried: what is not kept is freed */
	bool kept = nt_arena_adopt(nt_mesh_arena(scene, mesh), mesh->cut_arrays);
	kept &= nt_arena_adopt(nt_mesh_arena(scene, mesh), mesh->corner_tangents);
	return kept;
}

/* The effect of half of a morph target's deltas. */
static void add_halfway(nt_finding_list *list, const nt_mesh *mesh, const nt_morph *morph)
{
	if (morph->halfway_triangles)
		nt_finding_add(list, NT_CODE_TAN_MORPH_HALFWAY, nt_mesh_place(mesh, &(nt_place){0}),
			morph->halfway_triangles,
			morph->name[0] ? "target %u \"%.*s\", %.1f degrees" : "target %u%.*s, %.1f degrees",
			morph->target, NT_CUT(80, morph->name), morph->halfway_degrees);
}

/* Triangles for whose corners the file has no texture coordinates; it has some for others. */
static size_t count_missing(const nt_mesh *mesh)
{
	size_t count = 0, corner = 0;
	for (size_t f = 0; mesh->vertex_lacks && f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		unsigned all = NT_LACKS_TEXCOORD;
		for (size_t k = 0; k < size; k++)
			all &= mesh->vertex_lacks[nt_mesh_vertex(mesh, corner + k)];
		count += all ? size - 2 : 0;
		corner += size;
	}
	return count;
}

static void add_findings(nt_scene *scene, const nt_mesh *mesh)
{
	nt_finding_list *list = &scene->findings;
	const nmtan_counts *c = &mesh->counts;
	const size_t triangles = nt_mesh_triangle_count(mesh), missing = count_missing(mesh);
	const size_t degenerate = c->degenerate_texcoords - missing;
	const bool unmapped = triangles > 0 && degenerate == triangles;
	const uint8_t unless_needed = !nt_mesh_needs_tangents(mesh, nt_format_is_gltf(scene->judged)); /* an info */
	char detail[96];
	if (missing)
		snprintf(detail, sizeof detail, "%zu of %zu triangles %s no texture coordinates", missing, triangles,
			missing == 1 ? "has" : "have");
	const struct {
		nt_code code;
		size_t count;
	} rows[] = {
		{unmapped ? NT_CODE_UV_UNMAPPED : NT_CODE_UV_DEGENERATE_TRIANGLE, degenerate},
		{NT_CODE_UV_FOLDED_QUAD, c->folded_quads},
		{NT_CODE_UV_ROUNDED_AWAY, c->stored_differently},
		{NT_CODE_NORMALS_SCALED, mesh->scaled_normals},
		{NT_CODE_TAN_MORPH_TURNED, mesh->morph_turned},
		{NT_CODE_TAN_REPAIRED, nt_counts_repaired(c)},
		{NT_CODE_TAN_EXISTING_REPAIRED, mesh->replaced_tangents},
		{NT_CODE_TAN_EXISTING_LEFT, mesh->left_tangents},
		{NT_CODE_UV_MISSING, missing},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		const bool of_texcoords = i < 2 || rows[i].code == NT_CODE_UV_MISSING;
		if (rows[i].count)
			nt_finding_put(list, (nt_finding){.code = rows[i].code, .count = rows[i].count,
				.severity = of_texcoords ? unless_needed : 0, .judged = of_texcoords ? mesh : NULL,
				.detail = rows[i].code == NT_CODE_UV_MISSING ? detail : ""},
				nt_mesh_place(mesh, &(nt_place){0}));
	}
	if (mesh->may_be_quads)
		nt_finding_put(list, (nt_finding){.code = NT_CODE_TAN_QUADS_LIKELY, .count = mesh->may_be_quads,
			.detail = "", .repair = mesh->slots ? NULL : "--quads=pairs --only=all"},
			nt_mesh_place(mesh, &(nt_place){0}));
	if (mesh->replaced_normals)
		nt_finding_add(list, NT_CODE_NORMALS_MADE, nt_mesh_place(mesh, &(nt_place){0}), mesh->replaced_normals,
			"for the tangents alone, NORMAL keeps its zeros");
	for (size_t m = 0; m < mesh->morph_count; m++)
		add_halfway(list, mesh, &mesh->morphs[m]);
}

static void add_counts(nt_summary *summary, nt_mesh *mesh)
{
	if (mesh->decision == NT_DECISION_NORMALS)
		return;
	mesh->normal_copies = mesh->vertex_count - mesh->source_vertex_count;
	mesh->tangent_copies = mesh->split.source_count;
	summary->solved_count++;
	summary->triangle_count += nt_mesh_triangle_count(mesh);
	summary->repaired += mesh->decision == NT_DECISION_REPAIR && mesh->has_tangents
		? mesh->replaced_tangents : nt_counts_repaired(&mesh->counts);
	summary->quad_count += mesh->quad_count;
	summary->vertex_count += mesh->unused_vertices + mesh->source_vertex_count;
	summary->appended_normals += mesh->normal_copies;
	summary->appended_tangents += mesh->tangent_copies;
	nt_counts_add(&summary->counts, &mesh->counts);
}

/* Each solved result is kept, shared with the meshes that have the same geometry, and counted for each. */
static nt_status finish(const tangent_job *job, nt_summary *summary, nt_error *error)
{
	nt_scene *scene = job->wishes.scene;
	bool kept = true;
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (is_solved(&scene->meshes[i]) || scene->meshes[i].plan.join)
			kept = keep_results(scene, &scene->meshes[i]) && kept;
	if (!kept)
		return nt_fail_memory(error);
	for (size_t i = 0; i < job->count; i++) {
		const nt_mesh *mesh = job->meshes[i];
		if (job->statuses[i]) {
			nt_fail(error, job->statuses[i], "cannot compute tangents: %s",
				nt_status_text(job->statuses[i]));
			nt_mesh_place(mesh, &error->place);
			return job->statuses[i];
		}
	}
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (!nt_mesh_is_wanted(mesh))
			continue;
		if (mesh->plan.same_as) {
			nt_mesh_share(mesh);
			summary->same_count++;
		}
		if (mesh->morph_tangents)
			mesh->morph_tangents->user_count += (mesh->plan.same_as != NULL) + job->wishes.settings->verify;
		add_findings(scene, mesh);
		add_counts(summary, mesh);
	}
	return NT_OK;
}

nt_status nt_stage_tangents(nt_scene *scene, const nt_settings *settings, nt_format output,
	nt_summary *summary, nt_error *error)
{
	tangent_job job = {.wishes = wishes_of(scene, settings, output),
		.meshes = nt_alloc(scene->mesh_count, sizeof *job.meshes),
		.statuses = nt_calloc(scene->mesh_count, sizeof *job.statuses),
		.is_large = nt_calloc(scene->mesh_count, sizeof *job.is_large),
		.timing = NMTAN_TIMING_INIT};
	nt_status status = NT_OK;
	if (!job.meshes || !job.statuses || !job.is_large) {
		status = nt_fail_memory(error);
	} else {
		for (size_t i = 0; i < scene->mesh_count; i++)
			if (is_item(&scene->meshes[i]))
				job.meshes[job.count++] = &scene->meshes[i];
		find_large(&job);
		solve_large(&job);
		summary->seconds[NT_STAGE_WELD] += job.timing.weld;
		summary->seconds[NT_STAGE_SPLIT] += job.timing.split;
		summary->seconds[NT_STAGE_TANGENTS] -= job.timing.weld + job.timing.split;
		status = solve_small(&job, output) ? nt_fail_memory(error) : finish(&job, summary, error);
	}
	free(job.meshes);
	free(job.statuses);
	free(job.is_large);
	return status;
}
