/* SPDX-License-Identifier: MIT */
/*
 * The queue of tasks over the meshes of a scene: load, make normals, solve, split, merge. Meshes go through it in
 * windows, one after the other in the order of the file. Data of a mesh that only its pool needs is freed at the
 * end of its window, so that memory follows the largest window and not the sum of all meshes. Most scenes are one
 * window.
 *
 * Small meshes are loaded by several threads, each as if it were alone. Meshes that need only results are solved by
 * the same thread at once, while their geometry is in the cache, and hold no geometry afterwards. A mesh that fails
 * there is loaded again where it stands, so that findings and faults come in the order of the file.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include "base/parallel.h"
#include "gltf/load.h"

enum {
	LARGE_FACES = 128 * 1024,    /* from here on a mesh has all threads for its load */
	LEAST_SHARED_FACES = 4096,   /* that small meshes have together where threads are worth it */
	WINDOW_CORNERS = 4 << 20     /* of temporary meshes: enough for all threads, and some hundred megabytes */
};

/* Memory into which a thread loads. */
typedef struct loader {
	nt_arena kept;      /* until the scene takes it over */
	nt_arena temporary; /* the same of temporary meshes */
	nt_arena per_mesh;  /* temporary arena: of the mesh that it is about to solve */
} loader;

/* One window. */
typedef struct window {
	const nt_tasks *tasks;
	nt_scene scene;          /* the meshes of the window, as if they were all */
	bool *needed;            /* [mesh_count] still to be loaded */
	nt_read_options of_one;  /* thread that loads a mesh */
	nt_small_solves *solves; /* NULL: small meshes are only loaded */
	loader *loaders; /* one for each thread */
	nt_error *error;
} window;

/* ---- what is loaded ---- */

bool nt_writer_edits(const nt_format_entry *reader, const nt_format_entry *writer)
{
	return writer && nt_format_is_gltf(reader->format) && nt_format_is_gltf(writer->format);
}

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

/* Loads the copies in joins. For a report alone, what cannot be read is left out. */
static nt_status load_copies(window *w)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < w->scene.join_count; i++)
		for (size_t k = 0; !status && k < w->scene.joins[i].part_count; k++) {
			nt_mesh *mesh = w->scene.joins[i].parts[k];
			if (!mesh->plan.copied)
				continue;
			if (mesh->plan.same_as && !mesh->plan.same_as->positions) /* that one was not loaded */
				mesh->plan.same_as = NULL;
			status = w->tasks->reader->load(&w->scene, mesh, w->tasks->options, w->error);
			if (!status || mesh->plan.join || status == NT_ERROR_MEMORY)
				continue;
			mesh->positions = NULL;
			nt_error_clear(w->error);
			status = NT_OK;
		}
	return status;
}

/* ---- small meshes ---- */

static bool is_small(const nt_mesh *mesh)
{
	return !mesh->plan.same_as && mesh->face_count < LARGE_FACES;
}

/* The geometry of a mesh that nobody asks for goes; its results stay, of a pooled one until they are merged. */
static void drop_geometry(nt_mesh *mesh)
{
	const nt_split split = mesh->split;
	if (mesh->plan.temporary)
		return;
	nt_mesh_drop_arrays(mesh);
	mesh->split = split;
}

static void load_small(void *context, size_t item, unsigned thread)
{
	const window *w = context;
	nt_mesh *mesh = &w->scene.meshes[item];
	if (!w->needed[item] || !is_small(mesh) || !mesh->ready)
		return;
	loader *own = &w->loaders[thread];
	const bool ahead = w->solves && mesh->plan.disposable && 3 * mesh->face_count < NT_LEAST_ALONE_CORNERS;
	const nt_mesh before = *mesh;
	nt_arena *arena = ahead ? &own->per_mesh : &own->kept;
	nt_scene alone = w->scene;
	alone.arena = *arena;
	alone.temporary = own->temporary;
	nt_status status = w->tasks->reader->load(&alone, mesh, &w->of_one, NULL);
	if (!status && ahead)
		nt_judge_w(mesh);
	if (!status && ahead)
		status = nt_make_unit_normals(&alone, mesh, 1);
	if (!status && ahead)
		status = nt_find_halves(&alone, mesh, w->tasks->settings->quads, 1);
	*arena = alone.arena;
	own->temporary = alone.temporary;
	if (!status && ahead)
		status = nt_small_solve(w->solves, mesh, thread);
	if (!status && ahead)
		drop_geometry(mesh);
	if (ahead)
		nt_arena_clear(&own->per_mesh);
	w->needed[item] = status != NT_OK;
	if (status)
		*mesh = before;
}

static bool are_many(const window *w)
{
	size_t faces = 0;
	for (size_t i = 0; i < w->scene.mesh_count; i++)
		faces += w->needed[i] && is_small(&w->scene.meshes[i]) ? w->scene.meshes[i].face_count : 0;
	return faces >= LEAST_SHARED_FACES;
}

static nt_status load_all_small(window *w)
{
	const nt_tasks *t = w->tasks;
	nt_status status = t->reader->prepare(&w->scene, w->needed, t->options, w->error);
	if (status)
		return status;
	const unsigned threads = nt_thread_count(t->options->threads);
	if ((t->options->only_results || threads > 1) && are_many(w)) {
		w->loaders = nt_calloc(threads, sizeof *w->loaders);
		w->solves = t->options->only_results
			? nt_small_solves_begin(&w->scene, t->settings, t->writer->format, threads) : NULL;
		if (!w->loaders || (t->options->only_results && !w->solves))
			status = nt_fail_memory(w->error);
		else
			nt_parallel_items(threads, w->scene.mesh_count, load_small, w);
		if (w->solves)
			nt_small_solves_end(w->solves);
	}
	for (unsigned i = 0; w->loaders && i < threads; i++) {
		nt_arena_join(&w->scene.arena, &w->loaders[i].kept);
		nt_arena_join(&w->scene.temporary, &w->loaders[i].temporary);
		nt_arena_free(&w->loaders[i].per_mesh);
	}
	free(w->loaders);
	return status;
}

/* ---- one window ---- */

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

static nt_status load_meshes(window *w)
{
	const nt_tasks *t = w->tasks;
	const bool all = needs_all(t);
	for (size_t i = 0; i < w->scene.mesh_count; i++) {
		const nt_mesh *mesh = &w->scene.meshes[i];
		w->needed[i] = nt_mesh_is_wanted(mesh) ||
			((all || t->settings->report) && mesh->triangles && mesh->has_positions);
	}
	nt_status status = t->reader->prepare ? load_all_small(w) : NT_OK;
	for (size_t i = 0; !status && i < w->scene.mesh_count; i++) {
		nt_mesh *mesh = &w->scene.meshes[i];
		if (w->needed[i] && (nt_mesh_is_wanted(mesh) || all))
			status = t->reader->load(&w->scene, mesh, t->options, w->error);
		else if (w->needed[i])
			status = load_for_report(w, mesh);
		const bool loaded = mesh->positions || nt_mesh_is_solved_ahead(mesh);
		if (!status && loaded && (mesh->transforms_differ || mesh->transform_animated))
			tell_transforms(&w->scene, mesh);
	}
	return status ? status : load_copies(w);
}

/* Gives pools the results of their meshes, and what these hold back. */
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

static nt_status do_window(window *w)
{
	const nt_tasks *t = w->tasks;
	nt_status status = NT_OK;
	t->begin_stage(t->run, NT_STAGE_DECODE);
	if (t->reader->load)
		status = load_meshes(w);
	for (size_t i = 0; !status && i < w->scene.mesh_count; i++) {
		if (w->scene.meshes[i].decision == NT_SKIP_DROPPED)
			w->scene.meshes[i].tangents = NULL;
		if (!nt_mesh_is_solved_ahead(&w->scene.meshes[i]))
			nt_judge_w(&w->scene.meshes[i]);
	}
	t->begin_stage(t->run, NT_STAGE_NORMALS);
	if (!status)
		status = nt_stage_normals(&w->scene, t->settings->normals, t->settings->normals_degrees,
			t->settings->threads, w->error);
	if (!status)
		status = nt_gltf_quantize_made_normals(&w->scene, t->options, w->error);
	t->begin_stage(t->run, NT_STAGE_TANGENTS);
	for (size_t i = 0; !status && i < w->scene.mesh_count; i++)
		if (nt_find_halves(&w->scene, &w->scene.meshes[i], t->settings->quads, t->settings->threads))
			status = nt_fail_memory(w->error);
	if (!status)
		status = nt_stage_tangents_and_textures(&w->scene, t->settings,
			t->writer ? t->writer->format : NT_FORMAT_UNKNOWN, t->textures, t->summary, w->error);
	if (!status && t->writer && !t->settings->report)
		status = nt_stage_kept(&w->scene, t, w->error);
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

nt_status nt_tasks_do(const nt_tasks *t, nt_error *error)
{
	nt_scene *scene = t->scene;
	bool *needed = nt_alloc(scene->mesh_count, sizeof *needed);
	nt_status status = needed ? NT_OK : nt_fail_memory(error);
	size_t first = 0;
	do {
		const size_t end = find_end(scene, first);
		window w = {.tasks = t, .scene = *scene, .needed = needed, .of_one = *t->options, .error = error};
		w.of_one.threads = 1;
		w.scene.meshes += first;
		w.scene.mesh_count = end - first;
		if (!status)
			status = do_window(&w);
		scene->arena = w.scene.arena;
		scene->temporary = w.scene.temporary;
		scene->findings = w.scene.findings;
		first = end;
	} while (!status && first < scene->mesh_count);
	free(needed);
	return status;
}
