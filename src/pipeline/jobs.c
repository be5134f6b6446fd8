/* SPDX-License-Identifier: MIT */
/*
 * A mesh is a job: it is loaded, gets normals, is solved, its vertices are split, and what nobody asks for any more is
 * dropped. Small meshes are jobs of one thread each, several at once; a large one has all threads, and so has one that
 * other threads would wait for. Findings are told afterwards, in the order of the file, so that neither they
 * nor bytes show which thread did what.
 *
 * The passes of a window, by the state of the meshes that they do:
 *
 *   READY    loads that only read what is open: load, normals, solve, in one job
 *   TO_LOAD  the others, and those that failed, are loaded one after the other, so that faults come in the order of
 *            the file; then they are LOADED
 *   LOADED   normals, solve
 *   JOIN     the parts of a join are solved as one mesh
 *   KEPT     tangents that stay although somebody uses them: loaded, looked at, dropped
 *
 * A mesh with the geometry of an earlier one takes its result. If the output needs only results, geometry goes at the
 * end of the job, of a pooled mesh at the end of its window.
 *
 * Meshes go through this in windows. Data of a mesh that only its pool needs is merged and freed at the end of its
 * window, so that memory follows the largest window and not the sum of all meshes. Most scenes are one window.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include "base/deadline.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/structs.h"
#include "gltf/load.h"
#include "scene/values.h"

enum {
	LARGE_CORNERS = 3 * 128 * 1024,  /* from here on a mesh is worth all threads, whatever else there is */
	LEAST_ALONE_CORNERS = 3 * 30000, /* the same if the others are less than half of it */
	LEAST_SHARED_CORNERS = 3 * 4096, /* that small meshes have together for threads to be worth it, which cost as
	                                    much as solving some hundred triangles */
	WINDOW_CORNERS = 4 << 20         /* of temporary meshes: enough for all threads, and some hundred megabytes */
};

/* The next step of a mesh: see above. */
enum state { NOTHING, TO_LOAD, READY, LOADED, JOIN, KEPT };

/* A thread. */
typedef struct worker {
	nt_scene scene;     /* of the mesh that it is about, with arenas of its own; nothing is said in it */
	nt_arena geometry;  /* of a mesh whose geometry goes once it is solved */
	nmtan_workspace *workspace; /* NULL: it is only slower */
	size_t failed;      /* the first mesh that could not be done; SIZE_MAX: none */
	nt_error error;     /* why; without one it means nothing */
} worker;

typedef struct window {
	const nt_tasks *tasks;
	nt_scene scene;     /* the meshes of the window, as if they were all */
	bool *needed;       /* [mesh_count] to be loaded */
	bool *alone;        /* [mesh_count] all threads do it, while no other mesh is done */
	uint8_t *states;    /* [mesh_count] */
	enum state pass;    /* meshes in this state are being done */
	nt_read_options of_one; /* thread that loads a mesh */
	worker *workers;    /* [worker_count] */
	unsigned worker_count;
	nmtan_timing timing; /* of meshes that are done alone */
	nt_status status, texture_status;
	nt_error *error, texture_error;
} window;

bool nt_writer_edits(const nt_format_entry *reader, const nt_format_entry *writer)
{
	return writer && nt_format_is_gltf(reader->format) && nt_format_is_gltf(writer->format);
}

/* ---- one job ---- */

/* Takes seconds that meshes which are done alone need from those of the solve. */
static void book(const window *w, nt_stage stage, double seconds)
{
	w->tasks->summary->seconds[stage] += seconds;
	w->tasks->summary->seconds[NT_STAGE_TANGENTS] -= seconds;
}

/* All before the solve of a mesh that is loaded. */
static nt_status make_normals(const window *w, worker *own, nt_mesh *mesh, unsigned threads, nt_error *error)
{
	const nt_settings *s = w->tasks->settings;
	const double begin = w->alone[mesh - w->scene.meshes] ? nt_seconds() : 0;
	if (mesh->decision == NT_SKIP_DROPPED)
		mesh->tangents = NULL;
	nt_judge_w(mesh);
	/* a scan without texture coordinates gets the normals that the user asks for; primitives of a glTF have a
	 * decision of their own for that */
	const bool makes = nt_mesh_is_wanted(mesh) || (s->normals != NT_NORMALS_AUTO && mesh->positions &&
		!nt_format_is_gltf(own->scene.format));
	nt_status status = makes ? nt_make_normals(&own->scene, mesh, s->normals, s->normals_degrees, threads, error)
				 : NT_OK;
	if (!status)
		status = nt_gltf_quantize_made_normals(&own->scene, w->tasks->options, error);
	if (begin > 0)
		book(w, NT_STAGE_NORMALS, nt_seconds() - begin);
	if (!status && nt_find_halves(&own->scene, mesh, s->quads, threads))
		status = nt_fail_memory(error);
	return status;
}

static nt_status solve(window *w, worker *own, nt_mesh *mesh, unsigned threads, nt_error *error)
{
	const nt_tasks *t = w->tasks;
	const bool alone = w->alone[mesh - w->scene.meshes];
	/* without a workspace it is only slower */
	if (!alone && !own->workspace)
		own->workspace = nmtan_workspace_create(NULL);
	const nt_job job = {.options = {.struct_bytes = sizeof job.options, .method = t->settings->method,
			.repair = t->settings->repair, .threads = threads,
			.workspace = alone ? NULL : own->workspace, .timing = alone ? &w->timing : NULL},
		.v_offset = t->written == NT_FORMAT_UNKNOWN ? 0.0f : nt_v_offset(t->scene->format, t->written),
		.triangulates = nt_format_is_gltf(t->written), .splits = t->written != NT_FORMAT_UNKNOWN,
		.digests = t->settings->digests, .arena = nt_mesh_arena(&own->scene, mesh)};
	const nt_status status = nt_job_solve(&job, mesh);
	if (status) {
		nt_fail(error, status, "cannot compute tangents: %s", nt_status_text(status));
		nt_mesh_place(mesh, &error->place);
	}
	return status;
}

static bool is_solved(const nt_mesh *mesh)
{
	return nt_mesh_is_wanted(mesh) && !mesh->plan.same_as && !mesh->plan.join;
}

/* The geometry of a mesh that nobody asks for goes; its results stay. */
static void drop_geometry(nt_mesh *mesh)
{
	const nt_split split = mesh->split;
	nt_mesh_drop_arrays(mesh);
	mesh->split = split;
}

/* Does what the pass asks of a mesh. If a load of the READY pass fails, the mesh is as before, and to be loaded. One
 * that keeps its tangents is loaded as if it were alone, and nothing stays but what is wrong with them. */
static void do_mesh(window *w, worker *own, size_t item, unsigned threads)
{
	const nt_tasks *t = w->tasks;
	nt_mesh *mesh = &w->scene.meshes[item];
	const nt_mesh before = *mesh;
	const bool looks = w->pass == KEPT, loads = w->pass == READY || (looks && t->reader->load);
	const bool drops = looks || (loads && t->options->only_results && mesh->plan.disposable &&
		!mesh->plan.temporary);
	nt_arena kept = own->scene.arena;
	nt_status status = NT_OK;
	own->scene.meshes = mesh;
	if (drops)
		own->scene.arena = own->geometry;
	if (looks)
		mesh->plan = (nt_mesh_plan){.pooled = before.plan.pooled}; /* a primitive costs what it uses */
	if (loads)
		status = t->reader->load(&own->scene, mesh, threads == 1 ? &w->of_one : t->options, &own->error);
	if (looks && !status)
		nt_look_at_kept(&own->scene, mesh, t->written, threads);
	else if (w->pass != JOIN && !status)
		status = make_normals(w, own, mesh, threads, &own->error);
	if (drops) {
		own->geometry = own->scene.arena;
		own->scene.arena = kept;
	}
	if (!looks && !status && (w->pass == JOIN || is_solved(mesh)))
		status = solve(w, own, mesh, threads, &own->error);
	if (looks) {
		const nt_kept found = mesh->kept;
		const nt_signs signs = mesh->signs;
		*mesh = before;
		mesh->kept = found;
		mesh->signs = signs;
		status = nt_may_be_left(status) ? NT_OK : status;
	} else if (drops && !status) {
		drop_geometry(mesh);
	}
	if (drops)
		nt_arena_clear(&own->geometry);
	w->states[item] = NOTHING;
	if (status && w->pass == READY) {
		*mesh = before;
		w->states[item] = TO_LOAD;
	} else if (status) {
		own->failed = item;
	}
}

static void do_small(void *context, size_t item, unsigned slot)
{
	window *w = context;
	worker *own = &w->workers[slot];
	if (w->states[item] == w->pass && !w->alone[item] && item < own->failed)
		do_mesh(w, own, item, 1);
}

/* ---- several at once ---- */

/* Before a load, as the source says. */
static size_t corners_of(const window *w, size_t item)
{
	const nt_mesh *mesh = &w->scene.meshes[item];
	const nt_join *join = w->pass == JOIN ? mesh->plan.join : NULL;
	size_t corners = mesh->corner_count ? mesh->corner_count : 3 * mesh->face_count;
	for (size_t i = 0; join && i < join->part_count; i++)
		corners = (i ? corners : 0) + join->parts[i]->corner_count;
	return corners;
}

/* Whether a job of the KEPT pass has to open or decode what meshes may share. In other passes only TO_LOAD meshes do,
 * which no job loads. */
static bool must_open(const window *w, size_t item)
{
	return w->states[item] == KEPT && w->tasks->reader->load && !w->scene.meshes[item].ready;
}

/* Marks the large ones, and one that takes longer than all others beside it, whose threads would have nothing to do;
 * and those that must open. */
static void find_alone(window *w)
{
	size_t longest = 0, most = 0, sum = 0;
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		const size_t corners = w->states[i] != NOTHING ? corners_of(w, i) : 0;
		w->alone[i] = corners >= LARGE_CORNERS || must_open(w, i);
		sum += w->alone[i] ? 0 : corners;
		if (!w->alone[i] && corners > most) {
			most = corners;
			longest = i;
		}
	}
	if (most >= LEAST_ALONE_CORNERS && sum - most < most / 2)
		w->alone[longest] = true;
}

/* Does all meshes in a state; of those that are to be loaded some stay, which are done alone. */
static nt_status do_pass(window *w, enum state pass)
{
	size_t corners = 0;
	w->pass = pass;
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		if (w->states[i] != pass)
			continue;
		if (!w->alone[i])
			corners += corners_of(w, i);
		else if (pass != READY && w->workers->failed == SIZE_MAX)
			do_mesh(w, w->workers, i, w->tasks->settings->io.threads);
	}
	if (corners)
		nt_parallel_items(corners < LEAST_SHARED_CORNERS ? 1 : w->worker_count, w->scene.mesh_count, do_small,
			w);
	const worker *first = w->workers;
	for (unsigned i = 1; i < w->worker_count; i++)
		first = w->workers[i].failed < first->failed ? &w->workers[i] : first;
	if (first->failed == SIZE_MAX) /* errors that are there have been passed over */
		return NT_OK;
	*w->error = first->error;
	return first->error.status;
}

/* ---- loads ---- */

/* Writers of other formats than the input's need every mesh, solved or not. */
static bool needs_all(const nt_tasks *t)
{
	return t->writer && !nt_writer_edits(t->reader, t->writer) && t->reader->format != t->writer->format;
}

/* For the report alone. A mesh that cannot be read fails the check of a file, but no conversion that does not need
 * it. */
static nt_status load_for_report(window *w, nt_mesh *mesh)
{
	if (mesh->plan.same_as && !mesh->plan.same_as->positions) /* that one could not be read */
		return NT_OK;
	const nt_status status = w->tasks->reader->load(&w->scene, mesh, w->tasks->options, w->error);
	if (!status || !w->tasks->writer || !nt_may_be_left(status))
		return status;
	nt_finding_add(&w->scene.findings, NT_CODE_MESH_NOT_READ, nt_mesh_place(mesh, &(nt_place){0}), 1, "%.*s",
		NT_CUT(200, w->error->message));
	mesh->positions = NULL;
	nt_error_clear(w->error);
	return NT_OK;
}

/* Tells which transforms the tangents of a mesh cannot serve. */
static void tell_transforms(nt_scene *scene, const nt_mesh *mesh)
{
	nt_place place;
	nt_mesh_place(mesh, &place);
	if (mesh->transforms_differ)
		nt_finding_add(&scene->findings, NT_CODE_TAN_UVSET_CONFLICT, &place, 1,
			"set %u with different texture transforms", mesh->texcoord_set);
	if (mesh->transform_animated)
		nt_finding_add(&scene->findings, NT_CODE_TAN_UV_TRANSFORM_ANIMATED, &place, 1, NULL);
}

/* The READY pass, and the loads of the others. */
static nt_status load_and_do_ready(window *w)
{
	const nt_tasks *t = w->tasks;
	const bool all = needs_all(t);
	nt_status status = NT_OK;
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		const nt_mesh *mesh = &w->scene.meshes[i];
		w->needed[i] = nt_mesh_is_wanted(mesh) ||
			((all || t->settings->report) && mesh->triangles && mesh->has_positions);
	}
	if (t->reader->prepare)
		status = t->reader->prepare(&w->scene, w->needed, t->options, w->error);
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		const nt_mesh *mesh = &w->scene.meshes[i];
		w->states[i] = !w->needed[i] ? NOTHING : mesh->ready && !mesh->plan.same_as ? READY : TO_LOAD;
	}
	w->pass = READY;
	find_alone(w);
	if (!status)
		status = do_pass(w, READY);
	for (size_t i = 0; !status && i < w->scene.mesh_count; i++) {
		nt_mesh *mesh = &w->scene.meshes[i];
		const bool left = w->states[i] != NOTHING;
		if (left && (nt_mesh_is_wanted(mesh) || all))
			status = t->reader->load(&w->scene, mesh, t->options, w->error);
		else if (left)
			status = load_for_report(w, mesh);
		if (left)
			w->states[i] = mesh->plan.same_as ? NOTHING : LOADED;
		if (left && mesh->plan.same_as)
			nt_judge_w(mesh); /* its material may be another */
		const bool loaded = mesh->positions || mesh->split.vertex_tangents;
		if (!status && loaded && (mesh->transforms_differ || mesh->transform_animated))
			tell_transforms(&w->scene, mesh);
	}
	return status;
}

/* Loads the copies in joins; for a report alone, what cannot be read is left out. They have normals of their own,
 * whatever the others get. */
static nt_status load_copies(window *w)
{
	const nt_tasks *t = w->tasks;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < w->scene.join_count; i++)
		for (size_t k = 0; !status && k < w->scene.joins[i].part_count; k++) {
			nt_mesh *mesh = w->scene.joins[i].parts[k];
			if (mesh->plan.copied) {
				if (mesh->plan.same_as && !mesh->plan.same_as->positions) /* that one was not loaded */
					mesh->plan.same_as = NULL;
				status = t->reader->load(&w->scene, mesh, t->options, w->error);
				if (status && !mesh->plan.join && status != NT_ERROR_MEMORY) {
					mesh->positions = NULL;
					nt_error_clear(w->error);
					status = NT_OK;
				}
			}
			if (!status && !nt_mesh_is_wanted(mesh) && mesh->positions)
				status = nt_make_normals(&w->scene, mesh, NT_NORMALS_AUTO, 0, t->settings->io.threads,
					w->error);
		}
	return status;
}

/* ---- what is said ---- */

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
	size_t turned = 0; /* counted once for each target */
	for (size_t m = 0; m < mesh->morph_count; m++)
		turned += mesh->morphs[m].turned_triangles;
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
		{NT_CODE_TAN_MORPH_TURNED, turned},
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

static void add_counts(nt_summary *summary, const nt_mesh *mesh)
{
	if (mesh->decision == NT_DECISION_NORMALS)
		return;
	summary->solved_count++;
	summary->triangle_count += nt_mesh_triangle_count(mesh);
	summary->repaired += mesh->decision == NT_DECISION_REPAIR && mesh->has_tangents
		? mesh->replaced_tangents : nt_counts_repaired(&mesh->counts);
	summary->quad_count += mesh->quad_count;
	summary->vertex_count += mesh->unused_vertices + mesh->source_vertex_count;
	summary->appended_normals += mesh->vertex_count - mesh->source_vertex_count;
	summary->appended_tangents += mesh->split.source_count;
	nt_counts_add(&summary->counts, &mesh->counts);
}

/* Results are shared with the meshes that have the same geometry, and counted for each. */
static void tell_meshes(window *w)
{
	nt_scene *scene = &w->scene;
	const nt_settings *s = w->tasks->settings;
	uint64_t *digest = &w->tasks->summary->tangents_digest;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (mesh->plan.same_as && nt_mesh_is_wanted(mesh))
			nt_mesh_share(mesh);
		if (mesh->normals_made)
			nt_tell_normals(scene, mesh, s->normals);
	}
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (!nt_mesh_is_wanted(mesh))
			continue;
		w->tasks->summary->same_count += mesh->plan.same_as != NULL;
		if (mesh->morph_tangents)
			mesh->morph_tangents->user_count += (mesh->plan.same_as != NULL) + s->verify;
		if (mesh->tangents_digest)
			*digest = nt_hash_unkeyed(*digest, &mesh->tangents_digest, sizeof mesh->tangents_digest);
		add_findings(scene, mesh);
		add_counts(w->tasks->summary, mesh);
	}
}

/* ---- one window ---- */

static nt_status do_loaded_and_joins(window *w)
{
	nt_status status = do_pass(w, LOADED);
	if (!status)
		status = load_copies(w);
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		nt_mesh *mesh = &w->scene.meshes[i];
		if (mesh->plan.join && mesh->plan.same_as)
			nt_mesh_share(mesh);
		w->states[i] = mesh->plan.join && mesh->plan.join->first == mesh ? JOIN : NOTHING;
	}
	w->pass = JOIN;
	find_alone(w);
	if (!status)
		status = do_pass(w, JOIN);
	book(w, NT_STAGE_WELD, w->timing.weld);
	book(w, NT_STAGE_SPLIT, w->timing.split);
	return status;
}

/* The jobs, and beside them the textures. */
static void do_part(void *context, unsigned slot)
{
	window *w = context;
	const nt_tasks *t = w->tasks;
	if (slot == 0)
		w->status = do_loaded_and_joins(w);
	else
		w->texture_status = nt_make_textures(t->textures, t->settings, &w->texture_error);
}

static nt_status do_beside_textures(window *w)
{
	/* a thread costs more than making nothing */
	nt_textures *textures = w->tasks->textures;
	if (textures && nt_textures_requests(textures) && nt_thread_count(w->tasks->settings->io.threads) > 1) {
		nt_pool_run(2, do_part, w);
	} else {
		do_part(w, 0);
		if (textures && !w->status)
			do_part(w, 1);
	}
	if (w->texture_status && !w->status)
		*w->error = w->texture_error;
	return w->status ? w->status : w->texture_status;
}

/* Gives pools the results of their meshes, and frees what temporary meshes hold. */
static nt_status merge_meshes(window *w)
{
	const nt_tasks *t = w->tasks;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && t->options->edits && i < w->scene.mesh_count; i++)
		if (w->scene.meshes[i].plan.pooled && nt_mesh_is_wanted(&w->scene.meshes[i]))
			status = t->writer->merge(t->scene, &w->scene.meshes[i], w->error);
	for (size_t i = 0; i < w->scene.mesh_count; i++)
		if (w->scene.meshes[i].plan.temporary)
			nt_mesh_drop_arrays(&w->scene.meshes[i]);
	nt_arena_free(&w->scene.temporary);
	return status;
}

/* Tangents that stay as they are although somebody uses them. */
static nt_status look_at_all_kept(window *w)
{
	const nt_tasks *t = w->tasks;
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		const nt_mesh *mesh = &w->scene.meshes[i];
		w->needed[i] = t->reader->load ? nt_mesh_is_kept_and_used(mesh)
					       : mesh->tangents && !nt_mesh_is_wanted(mesh);
		w->states[i] = w->needed[i] ? KEPT : NOTHING;
	}
	nt_status status = t->reader->load ? t->reader->prepare(&w->scene, w->needed, t->options, w->error) : NT_OK;
	find_alone(w);
	if (!status)
		status = do_pass(w, KEPT);
	for (size_t i = 0; !status && i < w->scene.mesh_count; i++) {
		const nt_mesh *mesh = &w->scene.meshes[i];
		if (mesh->kept.bad)
			nt_finding_add(&w->scene.findings, NT_CODE_TAN_EXISTING_BAD,
				nt_mesh_place(mesh, &(nt_place){0}), mesh->kept.bad, NULL);
	}
	return status;
}

static nt_status do_window(window *w)
{
	const nt_tasks *t = w->tasks;
	nt_status status = NT_OK;
	t->begin_stage(t->run, NT_STAGE_DECODE);
	for (size_t i = 0; !t->reader->load && i < w->scene.mesh_count; i++)
		w->states[i] = LOADED;
	if (t->reader->load)
		status = load_and_do_ready(w);
	else
		find_alone(w);
	t->begin_stage(t->run, NT_STAGE_TANGENTS);
	if (!status)
		status = do_beside_textures(w);
	for (unsigned i = 0; i < w->worker_count; i++) {
		nt_arena_join(&w->scene.arena, &w->workers[i].scene.arena);
		nt_arena_join(&w->scene.temporary, &w->workers[i].scene.temporary);
	}
	if (status)
		return status;
	tell_meshes(w);
	if (t->writer && !t->settings->report)
		status = look_at_all_kept(w);
	return status ? status : merge_meshes(w);
}

/* ---- all ---- */

/* The end of the window that begins at a mesh. */
static size_t find_end(const nt_scene *scene, size_t first)
{
	size_t corners = 0, end = first;
	while (end < scene->mesh_count && corners <= WINDOW_CORNERS) {
		const nt_mesh *mesh = &scene->meshes[end++];
		corners += mesh->plan.temporary && !mesh->plan.same_as ? 3 * mesh->face_count : 0;
	}
	return end;
}

nt_status nt_stage_jobs(const nt_tasks *t, nt_error *error)
{
	nt_scene *scene = t->scene;
	const unsigned worker_count = nt_thread_count(t->settings->io.threads);
	bool *marks = nt_calloc(scene->mesh_count, 2 * sizeof *marks);
	uint8_t *states = nt_calloc(scene->mesh_count, 1);
	worker *workers = nt_calloc(worker_count, sizeof *workers);
	nt_status status = marks && states && workers ? NT_OK : nt_fail_memory(error);
	for (unsigned i = 0; !status && i < worker_count; i++) {
		workers[i].scene = *scene;
		workers[i].scene.arena = workers[i].scene.temporary = (nt_arena){0};
		workers[i].scene.mesh_count = 1;
		workers[i].failed = SIZE_MAX;
	}
	for (size_t first = 0, end; !status && (first == 0 || first < scene->mesh_count); first = end ? end : 1) {
		end = find_end(scene, first);
		window w = {.tasks = t, .scene = *scene, .needed = marks, .alone = marks + scene->mesh_count,
			.states = states, .of_one = *t->options, .workers = workers, .worker_count = worker_count,
			.timing = NMTAN_TIMING_INIT, .error = error};
		w.of_one.threads = 1;
		w.scene.meshes += first;
		w.scene.mesh_count = end - first;
		status = do_window(&w);
		scene->arena = w.scene.arena;
		scene->temporary = w.scene.temporary;
		scene->findings = w.scene.findings;
	}
	for (unsigned i = 0; workers && i < worker_count; i++) {
		nt_arena_free(&workers[i].geometry);
		nmtan_workspace_destroy(workers[i].workspace);
	}
	free(marks);
	free(states);
	free(workers);
	return status;
}
