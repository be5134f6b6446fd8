/* SPDX-License-Identifier: MIT */
/*
 * The pair: w inverted on all triangles of a mesh, and a normal map whose green points down. Both turn the bitangent
 * around, so the file renders right as it is, and wrong if one of the two is repaired. Unity's exporters write such
 * files.
 *
 * Meshes and the maps that they look up are a graph. A part of it is a pair if w is inverted on every mesh of it, and
 * one of its maps at least says that its green points down, and none anything else: a map that two meshes share cannot
 * be turned for one of them, nor w for one of two maps. Anything mixed is no pair: there w and green are repaired
 * together. A map that cannot be decoded leaves the doubt, and with it w as it is.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include "base/structs.h"
#include "image/image.h"
#include "topology/corners.h"

/* Share of the triangles whose w may be right all the same: slivers. */
enum { RIGHT_OF = 500 };

/* ---- w ---- */

bool nt_runs_backwards(const nt_mesh *mesh, const size_t v[3], const float *const tangents[3], int orientation,
	bool other_w)
{
	if (!mesh->normals || !mesh->positions)
		return false;
	const float *uv = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords;
	/* nearly all triangles end here: T of the first corner runs along growing u (nt_is_reversed() asks the same) */
	const float *p = mesh->positions + 3 * v[0], *q = mesh->positions + 3 * v[1], *r = mesh->positions + 3 * v[2];
	const float *first = tangents ? tangents[0] : mesh->tangents + 4 * v[0];
	const double b = (double)uv[2 * v[1] + 1] - uv[2 * v[0] + 1], c = (double)uv[2 * v[2] + 1] - uv[2 * v[0] + 1];
	double along = 0.0;
	for (size_t i = 0; i < 3; i++)
		along += first[i] * (c * ((double)q[i] - p[i]) - b * ((double)r[i] - p[i]));
	if (orientation * along > 0.0)
		return false;
	nt_tangent_triangle triangle = {.orientation = orientation, .other_w = other_w};
	for (size_t k = 0; k < 3; k++) {
		triangle.positions[k] = mesh->positions + 3 * v[k];
		triangle.normals[k] = mesh->normals + 3 * v[k];
		triangle.texcoords[k] = uv + 2 * v[k];
		triangle.tangents[k] = tangents ? tangents[k] : mesh->tangents + 4 * v[k];
	}
	return nt_is_reversed(&triangle);
}

void nt_judge_w(nt_mesh *mesh)
{
	enum { MAPPED = NT_SLOT_NORMAL | NT_SLOT_CLEARCOAT_NORMAL };
	size_t judged = 0, right = 0, reversed = 0;
	if (!(mesh->slots & MAPPED) || !mesh->tangents || !mesh->texcoords || mesh->face_sizes ||
		(mesh->solve_texcoords && !mesh->solve_sign))
		return;
	for (size_t t = 0; t < mesh->face_count && right <= mesh->face_count / RIGHT_OF; t++) {
		const size_t v[3] = {nt_mesh_vertex(mesh, 3 * t), nt_mesh_vertex(mesh, 3 * t + 1),
			nt_mesh_vertex(mesh, 3 * t + 2)};
		if (v[0] >= mesh->vertex_count || v[1] >= mesh->vertex_count || v[2] >= mesh->vertex_count)
			return; /* the solve says so */
		const int orientation = nt_uv_sign(mesh, v, 0);
		const bool wrong = orientation && nt_w_sign(mesh, v) == -orientation;
		judged += orientation != 0;
		right += orientation != 0 && !wrong;
		reversed += wrong && nt_runs_backwards(mesh, v, NULL, orientation, true);
	}
	const bool inverted = judged && right <= judged / RIGHT_OF && 2 * reversed <= judged;
	mesh->signs = judged == 0 && right == 0 ? NT_SIGN_NONE : inverted ? NT_SIGN_INVERTED : NT_SIGN_RIGHT;
}

bool nt_any_inverted(const nt_scene *scene)
{
	bool any = false;
	for (size_t i = 0; i < scene->mesh_count && !any; i++)
		any = scene->meshes[i].signs == NT_SIGN_INVERTED;
	return any;
}

/* ---- parts of the graph ---- */

/* Counts of a part. */
typedef struct part {
	uint32_t pair; /* its number as a pair, 0: it is none */
	uint32_t first; /* mesh */
	size_t meshes;
	bool right, inverted, up, down, unknown, undecodable;
	bool tangents_change, maps_turn;
	bool fixed_map; /* green points down in one that nmtan does not turn */
} part;

static uint32_t find(uint32_t *parents, uint32_t i)
{
	while (parents[i] != i)
		i = parents[i] = parents[parents[i]];
	return i;
}

static bool counts(const nt_mesh *mesh)
{
	return mesh->triangles && mesh->reachable &&
		(mesh->normal_maps[0].number || mesh->normal_maps[1].number);
}

static void add_mesh(part *p, const nt_scene *scene, uint32_t index, const nt_settings *settings, bool turns)
{
	const nt_mesh *mesh = &scene->meshes[index];
	p->first = p->meshes++ ? p->first : index;
	p->inverted |= mesh->signs == NT_SIGN_INVERTED;
	p->right |= mesh->signs == NT_SIGN_OPEN || mesh->signs == NT_SIGN_RIGHT;
	p->tangents_change |= mesh->signs == NT_SIGN_INVERTED && nt_mesh_gets_tangents(mesh) &&
		!mesh->keeps_inverted;
	for (int slot = 0; slot < 2; slot++) {
		const nt_mesh_map *map = &mesh->normal_maps[slot];
		if (!map->number)
			continue;
		const bool down = map->green == NT_GREEN_DOWN;
		p->down |= down;
		p->up |= map->examined && (map->green == NT_GREEN_UP || map->green == NT_GREEN_MIXED);
		p->unknown |= !map->examined;
		p->undecodable |= !map->decodable;
		p->maps_turn |= turns && map->turnable && (down || settings->flip_green == NT_FLIP_ON) &&
			(!scene->turned_images ||
				(map->image < scene->turned_image_count && scene->turned_images[map->image]));
		p->fixed_map |= down && !map->turnable;
	}
}

/* One half alone is changed: what the file looked like is lost. */
static void tell_half(nt_scene *scene, const part *p, const nt_settings *settings)
{
	const char *repair = p->maps_turn || settings->existing == NT_EXISTING_REPAIR
		? "--existing=repair --flip-green=auto" : "--existing=replace --flip-green=auto";
	nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_TAN_GREEN_PAIR, .count = p->meshes,
		.severity = 1 + NT_SEVERITY_WARNING, .repair = repair, .stays = p->fixed_map,
		.detail = p->maps_turn ? "only the map is turned: repair the tangents too"
			: p->fixed_map ? "only the tangents are changed, and nmtan does not turn this map"
				       : "only the tangents are changed: turn the map too"},
		nt_mesh_place(&scene->meshes[p->first], &(nt_place){0}));
}

/* Gives meshes their pair, and says of each what is to be said. */
static void settle(nt_scene *scene, const nt_settings *settings, uint32_t *parents, part *parts, bool *halved)
{
	const bool turns = (!settings->check || settings->converts) && settings->flip_green != NT_FLIP_OFF;
	uint32_t pair_count = 0;
	for (uint32_t i = 0; i < scene->mesh_count; i++)
		if (counts(&scene->meshes[i]))
			add_mesh(&parts[find(parents, i)], scene, i, settings, turns);
	for (uint32_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		part *p = &parts[find(parents, i)];
		if (!counts(mesh))
			continue;
		const bool all_inverted = p->inverted && !p->right && !p->up;
		mesh->doubt = !all_inverted || !p->unknown ? NT_DOUBT_NONE
			: p->undecodable ? NT_DOUBT_UNDECODABLE : NT_DOUBT_UNEXAMINED;
		if (!all_inverted || p->unknown || !p->down)
			continue;
		const bool first = p->first == i, half = p->tangents_change != p->maps_turn;
		if (first && half)
			tell_half(scene, p, settings);
		halved[i] = half;
		if (p->tangents_change || p->maps_turn)
			continue;
		if (first) {
			p->pair = ++pair_count;
			nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_TAN_GREEN_PAIR,
				.count = p->meshes, .detail = "shown right; change both or neither",
				.stays = p->fixed_map}, nt_mesh_place(mesh, &(nt_place){0}));
		}
		mesh->pair = p->pair;
	}
}

nt_status nt_find_pairs(nt_scene *scene, const nt_settings *settings, size_t map_count, bool *halved)
{
	const size_t count = scene->mesh_count + map_count;
	uint32_t *parents = nt_alloc(count, sizeof *parents);
	part *parts = nt_calloc(count, sizeof *parts);
	const bool made = parents && parts;
	for (uint32_t i = 0; made && i < count; i++)
		parents[i] = i;
	for (uint32_t i = 0; made && i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++) {
			const uint32_t map = scene->meshes[i].normal_maps[slot].number;
			if (map && counts(&scene->meshes[i]))
				parents[find(parents, (uint32_t)scene->mesh_count + map - 1)] = find(parents, i);
		}
	if (made)
		settle(scene, settings, parents, parts, halved);
	free(parents);
	free(parts);
	return made ? NT_OK : NT_ERROR_MEMORY;
}
