/* SPDX-License-Identifier: MIT */
/*
 * Small meshes of a scene of many, by several threads: see stages.h. Those that are solved too are loaded where the one
 * before them was: their geometry stays in the cache until it is solved, and takes the memory of one mesh a thread.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include "base/parallel.h"

/* Faces from which on a mesh has all threads for its load, and those that small ones must have together. */
enum { LARGE_FACES = 128 * 1024, LEAST_SHARED_FACES = 4096 };

/* What a thread loads into. */
typedef struct slot {
	nt_arena kept;    /* until the scene takes it over */
	nt_arena passing; /* of the mesh that it is about to solve */
} slot;

typedef struct ahead {
	nt_scene *scene;
	const nt_format_entry *reader;
	nt_read_options options;
	nt_small_solves *solves; /* NULL: only loaded */
	bool *needed;            /* [mesh_count] */
	slot *slots;
} ahead;

static bool is_small(const nt_mesh *mesh)
{
	return !mesh->same_as && mesh->face_count < LARGE_FACES;
}

static bool is_solved(const ahead *job, const nt_mesh *mesh)
{
	return job->solves && mesh->plain && 3 * mesh->face_count < NT_LEAST_ALONE_CORNERS;
}

/* Leaves the results. Triangles in which no vertex was split are still those of the file. */
static void keep_results(nt_mesh *mesh)
{
	const nt_split split = mesh->split;
	nt_mesh_forget(mesh);
	mesh->split = split;
}

static void load_small(void *context, size_t item, unsigned number)
{
	const ahead *job = context;
	nt_mesh *mesh = &job->scene->meshes[item];
	if (!job->needed[item] || !is_small(mesh))
		return;
	slot *own = &job->slots[number];
	const bool solved = is_solved(job, mesh);
	const nt_mesh before = *mesh;
	nt_scene part = *job->scene;
	part.arena = solved ? own->passing : own->kept;
	nt_status status = job->reader->load(&part, mesh, &job->options, NULL);
	if (!status && solved)
		status = nt_make_unit_normals(&part, mesh, 1);
	*(solved ? &own->passing : &own->kept) = part.arena;
	if (!status && solved)
		status = nt_small_solve(job->solves, mesh, number);
	if (!status && solved)
		keep_results(mesh);
	if (solved)
		nt_arena_clear(&own->passing);
	job->needed[item] = status != NT_OK;
	if (status)
		*mesh = before;
}

/* Whether small ones are worth it. */
static bool are_many(const ahead *job)
{
	size_t faces = 0;
	for (size_t i = 0; i < job->scene->mesh_count; i++)
		faces += job->needed[i] && is_small(&job->scene->meshes[i]) ? job->scene->meshes[i].face_count : 0;
	return faces >= LEAST_SHARED_FACES;
}

/* One that shares the geometry of another has a texture transform to be looked at: that one's geometry stays. */
static void keep_shared(const nt_scene *scene)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		if (mesh->same_as && mesh->texcoords_transformed)
			scene->meshes[mesh->same_as - scene->meshes].plain = false;
	}
}

nt_status nt_load_ahead(nt_scene *scene, const nt_format_entry *reader, const nt_format_entry *writer,
	const nt_settings *settings, const nt_read_options *options, bool *needed, nt_error *error)
{
	nt_status status = reader->share(scene, needed, options, error);
	if (status)
		return status;
	const unsigned threads = nt_thread_count(options->threads);
	ahead job = {.scene = scene, .reader = reader, .options = *options, .needed = needed};
	job.options.threads = 1;
	if ((writer || threads > 1) && are_many(&job)) {
		keep_shared(scene);
		job.slots = nt_calloc(threads, sizeof *job.slots);
		job.solves = writer ? nt_small_solves_begin(scene, settings, writer->format, threads) : NULL;
		if (!job.slots || (writer && !job.solves))
			status = nt_fail_memory(error);
		else
			nt_parallel_items(threads, scene->mesh_count, load_small, &job);
		if (job.solves)
			nt_small_solves_end(job.solves);
	}
	for (unsigned i = 0; job.slots && i < threads; i++) {
		nt_arena_join(&scene->arena, &job.slots[i].kept);
		nt_arena_free(&job.slots[i].passing);
	}
	free(job.slots);
	reader->unshare(scene);
	return status;
}
