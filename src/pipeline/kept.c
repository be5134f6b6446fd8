/* SPDX-License-Identifier: MIT */
/*
 * Tangents that stay as they are although a material uses them, or the output is a PLY: whether w is right is asked of
 * indices, texture coordinates and w alone, exactly; if it is, whether T is reversed, of a corner's T first. Whether a
 * renderer can use them at all is asked of tangents and normals. All threads decode compressed ones for it, once.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "report/maker/maker.h"
#include "report/report.h"
#include "topology/corners.h"

/* Triangles that say; of them those whose w differs, whose w is wrong, and whose T is reversed while w is right. */
enum { JUDGED, DIFFERS, BY_W, REVERSED, KINDS };

typedef struct sign_count {
	const nt_mesh *mesh;
	const nmtan_mesh *view; /* of it, with the texture coordinates as they are stored: w has to fit these */
	const uint8_t *halves;  /* NULL: quads are not asked */
	size_t counts[KINDS];   /* added to by any thread */
} sign_count;

static void count_triangle(const sign_count *c, size_t t, const uint32_t corners[3], size_t counts[KINDS])
{
	const nt_mesh *mesh = c->mesh;
	const size_t v[3] = {nt_mesh_vertex(mesh, corners[0]), nt_mesh_vertex(mesh, corners[1]),
		nt_mesh_vertex(mesh, corners[2])};
	const int sign = nt_w_sign(mesh, v);
	const int orientation = sign ? nt_uv_sign(mesh, v, nt_stored_v_offset(c->view)) : 0;
	if (orientation == 0)
		return;
	counts[JUDGED] += sign != NT_W_MIXED;
	if (orientation == sign)
		counts[REVERSED] += nt_runs_backwards(mesh, v, NULL, orientation, false);
	else if (!nt_is_folded_sign(mesh, c->halves, t, sign))
		counts[sign == NT_W_MIXED ? DIFFERS : BY_W]++;
}

static void count_range(void *context, size_t begin, size_t end, unsigned slot)
{
	sign_count *c = context;
	size_t counts[KINDS] = {0}, first = 3 * begin;
	(void)slot;
	for (size_t face = begin; face < end; first += nt_face_size(c->view, face++)) {
		uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
		const unsigned count = c->mesh->face_sizes ? nt_written_triangles(c->view, face, first, corners) : 1;
		const size_t wrong = counts[BY_W];
		for (unsigned i = 0; i < count; i++)
			count_triangle(c, face, corners[i], counts);
		if (count == 2 && counts[BY_W] == wrong + 1 && nt_has_sign_of_quad(c->mesh, corners))
			counts[BY_W] = wrong;
	}
	for (int i = 0; i < KINDS; i++)
		__atomic_fetch_add(&c->counts[i], counts[i], __ATOMIC_RELAXED);
}

/* Returns how many have a wrong w. If there are quads, one range has all: no other knows its first corner. */
static size_t count_wrong(sign_count *c, unsigned threads)
{
	const size_t faces = c->mesh->face_count, grain = c->mesh->face_sizes ? faces + 1 : 1 << 16;
	memset(c->counts, 0, sizeof c->counts);
	nt_parallel_ranges(nt_thread_count(threads), faces, grain, count_range, c);
	return c->counts[BY_W] + c->counts[DIFFERS];
}

/* Counts without halves of folded quads that have the quad's sign, if these are what is wrong. */
static void judge(nt_mesh *mesh, float v_offset, nt_arena *arena, unsigned threads)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	sign_count c = {.mesh = mesh, .view = &view}, others = c;
	stored.v_offset = v_offset;
	const size_t wrong = count_wrong(&c, threads);
	uint8_t *halves = wrong && !mesh->face_sizes ? nt_arena_alloc(arena, mesh->face_count, 1) : NULL;
	if (halves)
		nt_pair_quads(mesh, false, halves);
	others.halves = halves;
	if (halves && 2 * count_wrong(&others, threads) <= wrong)
		c = others;
	mesh->kept.wrong = c.counts[BY_W] + c.counts[REVERSED];
	mesh->kept.mixed = c.counts[DIFFERS];
	mesh->kept.judged = c.counts[JUDGED];
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
	for (size_t i = 0; i < mesh->corner_count; i++) {
		const size_t v = mesh->indices[i];
		c.faulty += !met[v] && nt_tangent_faults(mesh->tangents + 4 * v, mesh->normals + 3 * v);
		met[v] = 1;
	}
	return c.faulty;
}

void nt_look_at_kept(nt_scene *scene, nt_mesh *mesh, nt_format written, unsigned threads)
{
	if (mesh->tangents && mesh->texcoords && nt_mesh_needs_tangents(mesh, nt_format_is_gltf(written)))
		judge(mesh, nt_v_offset(scene->format, written), &scene->arena, threads);
	if (mesh->tangents && mesh->normals)
		mesh->kept.bad = count_faulty(mesh, &scene->arena, threads);
	if (mesh->kept.wrong || mesh->kept.mixed || !mesh->kept.judged)
		nt_judge_w(mesh);
	else
		mesh->signs = NT_SIGN_RIGHT;
}

void nt_tell_kept(nt_scene *scene, const bool *halved)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const size_t wrong = mesh->kept.wrong, mixed = mesh->kept.mixed;
		char share[64], others[64], detail[256];
		if ((!wrong && !mixed) || mesh->pair)
			continue;
		snprintf(share, sizeof share, "%.3g %% of %zu", 100.0 * (double)wrong / (double)mesh->kept.judged,
			mesh->kept.judged);
		snprintf(others, sizeof others, ", and corners of %zu more have different w", mixed);
		snprintf(detail, sizeof detail, "%s%s%s", wrong ? share : "corners with different w",
			wrong && mixed ? others : "", nt_doubt_text(mesh->doubt));
		nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_TAN_KEPT_SIGN,
			.count = wrong ? wrong : mixed, .detail = detail, .stays = halved && halved[i],
			.repair = mesh->doubt == NT_DOUBT_UNDECODABLE ? "--existing=replace" : NULL},
			nt_mesh_place(mesh, &(nt_place){0}));
	}
}
