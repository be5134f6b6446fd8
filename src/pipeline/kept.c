/* SPDX-License-Identifier: MIT */
/*
 * Tangents that stay as they are although a material uses them: whether w is right is asked of indices, texture
 * coordinates and w alone, exactly; whether a renderer can use them at all, of tangents and normals. All threads decode
 * compressed ones for it, once.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "report/maker/quads.h"
#include "report/report.h"

/* The sign of w at all corners of a triangle; 0: some have none; MIXED: they differ. */
enum { MIXED = 2 };

static int common_sign(const nt_mesh *mesh, const size_t v[3])
{
	int signs[3];
	for (int k = 0; k < 3; k++) {
		const float w = mesh->tangents[4 * v[k] + 3];
		signs[k] = (w > 0.0f) - (w < 0.0f);
	}
	if (!signs[0] || !signs[1] || !signs[2])
		return 0;
	return signs[0] == signs[1] && signs[1] == signs[2] ? signs[0] : MIXED;
}

typedef struct sign_count {
	const nt_mesh *mesh;
	const uint8_t *halves; /* NULL: quads are not asked */
	size_t wrong, judged;  /* added to by any thread */
} sign_count;

static void count_range(void *context, size_t begin, size_t end, unsigned slot)
{
	sign_count *c = context;
	const nt_mesh *mesh = c->mesh;
	const int turn = mesh->solve_texcoords ? mesh->solve_sign : 1;
	size_t wrong = 0, judged = 0;
	(void)slot;
	for (size_t t = begin; t < end; t++) {
		size_t v[3];
		for (size_t k = 0; k < 3; k++)
			v[k] = mesh->indices ? mesh->indices[3 * t + k] : 3 * t + k;
		const int sign = common_sign(mesh, v);
		if (sign == 0 || turn == 0)
			continue;
		const int orientation = turn * nmtan_orientation(mesh->texcoords + 2 * v[0],
			mesh->texcoords + 2 * v[1], mesh->texcoords + 2 * v[2]);
		judged += orientation != 0;
		wrong += orientation != 0 && orientation != sign && !nt_is_folded_sign(mesh, c->halves, t, sign);
	}
	__atomic_fetch_add(&c->wrong, wrong, __ATOMIC_RELAXED);
	__atomic_fetch_add(&c->judged, judged, __ATOMIC_RELAXED);
}

/* Triangles whose w is not that of their orientation. */
static size_t count_wrong(const nt_mesh *mesh, const uint8_t *halves, unsigned threads, size_t *judged)
{
	enum { GRAIN = 1 << 16 };
	sign_count c = {.mesh = mesh, .halves = halves};
	nt_parallel_ranges(nt_thread_count(threads), mesh->face_count, GRAIN, count_range, &c);
	*judged = c.judged;
	return c.wrong;
}

/* The same without halves of folded quads that have the quad's sign, if these are what is wrong. */
static size_t count_wrong_of(const nt_mesh *mesh, nt_arena *arena, unsigned threads, size_t *judged)
{
	const size_t wrong = count_wrong(mesh, NULL, threads, judged);
	uint8_t *halves = wrong ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	if (!halves)
		return wrong;
	nt_pair_quads(mesh, false, halves);
	const size_t others = count_wrong(mesh, halves, threads, judged);
	return 2 * others > wrong ? wrong : others;
}

typedef struct fault_count {
	const nt_mesh *mesh;
	size_t faulty; /* added to by any thread */
} fault_count;

static void count_faulty_range(void *context, size_t begin, size_t end, unsigned slot)
{
	fault_count *c = context;
	size_t faulty = 0;
	(void)slot;
	for (size_t v = begin; v < end; v++)
		faulty += nt_tangent_faults(c->mesh->tangents + 4 * v, c->mesh->normals + 3 * v) != 0;
	__atomic_fetch_add(&c->faulty, faulty, __ATOMIC_RELAXED);
}

/* Tangents that no renderer can use, of vertices that a triangle uses. */
static size_t count_faulty(const nt_mesh *mesh, nt_arena *arena, unsigned threads)
{
	enum { GRAIN = 1 << 16 };
	fault_count c = {.mesh = mesh};
	nt_parallel_ranges(nt_thread_count(threads), mesh->vertex_count, GRAIN, count_faulty_range, &c);
	uint8_t *met = c.faulty && mesh->indices ? nt_arena_alloc(arena, mesh->vertex_count, 1) : NULL;
	if (!met)
		return c.faulty;
	memset(met, 0, mesh->vertex_count);
	c.faulty = 0;
	for (size_t i = 0; i < 3 * mesh->face_count; i++) {
		const size_t v = mesh->indices[i];
		c.faulty += !met[v] && nt_tangent_faults(mesh->tangents + 4 * v, mesh->normals + 3 * v);
		met[v] = 1;
	}
	return c.faulty;
}

/* Looks at one mesh as if it were alone; `memory` is empty before and after. */
static nt_status look_at(nt_scene *scene, const nt_tasks *tasks, nt_mesh *to, nt_arena *memory, nt_error *error)
{
	nt_mesh mesh = *to;
	nt_scene own = *scene;
	own.arena = *memory;
	own.temporary = (nt_arena){0};
	own.findings = (nt_finding_list){0}; /* what a load finds is said of meshes that are solved */
	mesh.plan = (nt_mesh_plan){.pooled = mesh.plan.pooled}; /* a primitive costs what it uses */
	size_t wrong = 0, judged = 0, faulty = 0;
	const nt_status status = tasks->reader->load(&own, &mesh, tasks->options, error);
	if (!status && mesh.tangents && mesh.texcoords)
		wrong = count_wrong_of(&mesh, &own.arena, tasks->settings->threads, &judged);
	if (!status && mesh.tangents && mesh.normals)
		faulty = count_faulty(&mesh, &own.arena, tasks->settings->threads);
	if (faulty)
		nt_finding_add(&scene->findings, NT_CODE_TAN_EXISTING_BAD, nt_mesh_place(&mesh, &(nt_place){0}), faulty,
			NULL);
	if (!status && (wrong || !judged))
		nt_judge_w(&mesh);
	to->signs = judged && !wrong ? NT_SIGN_RIGHT : mesh.signs;
	to->wrong_w = wrong;
	to->judged_w = judged;
	*memory = own.arena;
	nt_arena_clear(memory);
	nt_arena_free(&own.temporary);
	nt_finding_list_free(&own.findings);
	return nt_may_be_left(status) ? NT_OK : status;
}

nt_status nt_stage_kept(nt_scene *scene, const nt_tasks *tasks, nt_error *error)
{
	nt_arena memory = {0};
	bool *kept = nt_format_is_gltf(scene->format) ? nt_alloc(scene->mesh_count, sizeof *kept) : NULL;
	if (!kept)
		return nt_format_is_gltf(scene->format) ? nt_fail_memory(error) : NT_OK;
	for (size_t i = 0; i < scene->mesh_count; i++)
		kept[i] = nt_mesh_is_kept_and_used(&scene->meshes[i]);
	nt_status status = tasks->reader->prepare(scene, kept, tasks->options, error);
	for (size_t i = 0; !status && i < scene->mesh_count; i++)
		if (kept[i])
			status = look_at(scene, tasks, &scene->meshes[i], &memory, error);
	nt_arena_free(&memory);
	free(kept);
	return status;
}

void nt_tell_kept(nt_scene *scene)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		char detail[160];
		if (!mesh->wrong_w || mesh->pair)
			continue;
		snprintf(detail, sizeof detail, "%.3g %% of %zu%s", 100.0 * (double)mesh->wrong_w /
			(double)mesh->judged_w, mesh->judged_w, nt_doubt_text(mesh->doubt));
		nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_TAN_KEPT_SIGN, .count = mesh->wrong_w,
			.detail = detail, .stays = mesh->halved,
			.repair = mesh->doubt == NT_DOUBT_UNDECODABLE ? "--existing=replace" : NULL},
			nt_mesh_place(mesh, &(nt_place){0}));
	}
}
