/* SPDX-License-Identifier: MIT */
/*
 * Which meshes get tangents, and why the others do not.
 *
 * glTF: a primitive needs tangents when it is made of triangles, is shown by a scene and one of its
 * materials (variants included) has a normalTexture, a clearcoatNormalTexture or the anisotropy
 * extension; an unlit material needs nothing. Readers translate materials into slots, this file only
 * decides. OBJ and PLY say little about how a mesh is shaded, so everything with texture coordinates
 * gets tangents unless the user asks for less.
 *
 * A mesh that should get tangents and lacks normals or texture coordinates is skipped with a finding: glTF
 * clients shade it flat and ignore tangents in the first case, and have no direction in the second. If it has
 * tangents and normals all the same, those of them that are invalid can be mended.
 */
#include "scene/scene.h"

#include <stdio.h>

/* The request, and facts about all meshes together. */
typedef struct wishes {
	nt_only only;
	nt_existing existing;
	nt_making_normals normals;
	bool any_texcoords;
} wishes;

static bool needs_tangents(const nt_mesh *mesh)
{
	return mesh->slots != 0;
}

/* Whether the user's wish covers the mesh; if not, why. */
static nt_decision decide_by_wish(const nt_mesh *mesh, nt_only only, bool knows_materials)
{
	if (only == NT_ONLY_ALL || (only == NT_ONLY_AUTO && !knows_materials))
		return NT_DECISION_OPEN;
	if (!mesh->reachable)
		return NT_SKIP_UNREACHABLE;
	if (!needs_tangents(mesh))
		return mesh->unlit ? NT_SKIP_UNLIT : NT_SKIP_NO_SLOT;
	return NT_DECISION_OPEN;
}

static bool any_has_texcoords(const nt_scene *scene)
{
	bool any = false;
	for (size_t i = 0; i < scene->mesh_count && !any; i++)
		any = scene->meshes[i].triangles && scene->meshes[i].has_texcoords;
	return any;
}

/* A glTF whose material looks a map up with coordinates that are not there is wrong; what is made of other formats is
 * without the map. If no material asks for tangents, as in a scan, nothing is missing; but if other meshes of the file
 * have coordinates, this one may lack them by mistake. */
static void report_no_texcoords(nt_scene *scene, const nt_mesh *mesh, bool others_have)
{
	const bool gltf = nt_format_is_gltf(scene->format);
	const bool judged_as_gltf = nt_format_is_gltf(scene->judged);
	char detail[64];
	if (mesh->asked_set) {
		nt_finding_add_as(&scene->findings, NT_CODE_TAN_NO_UV,
			needs_tangents(mesh) && !mesh->has_tangents ? NT_SEVERITY_ERROR : NT_SEVERITY_WARNING,
			nt_mesh_place(mesh, &(nt_place){0}), mesh->asked_set);
		return;
	}
	if (!needs_tangents(mesh) && gltf)
		return;
	snprintf(detail, sizeof detail, "a material needs set %u", mesh->texcoord_set);
	if (needs_tangents(mesh))
		nt_finding_add_as(&scene->findings, NT_CODE_TAN_NO_UV, gltf ? NT_SEVERITY_ERROR : NT_SEVERITY_WARNING,
			nt_mesh_place(mesh, &(nt_place){0}), detail);
	else if (!others_have)
		nt_finding_add(&scene->findings, NT_CODE_TAN_NO_UV, nt_mesh_place(mesh, &(nt_place){0}), 1,
			"the file has none at all");
	else
		nt_finding_add_as(&scene->findings, NT_CODE_UV_MISSING,
			nt_mesh_needs_tangents(mesh, judged_as_gltf) ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
			nt_mesh_place(mesh, &(nt_place){0}),
			"the mesh has no texture coordinates and gets no tangents");
}

/* glTF: without NORMAL a client ignores TANGENT (specification, 3.7.2.1). */
static bool has_tangents_that_count(const nt_mesh *mesh)
{
	return mesh->has_tangents && mesh->has_normals;
}

/* nmtan mends values that it can read. */
static bool can_mend(const nt_mesh *mesh)
{
	return has_tangents_that_count(mesh) && !mesh->tangents_fault;
}

/* Whether the mesh has what a solve takes, or what mending takes that has to do without texture coordinates; if not,
 * what is missing first. */
static nt_decision decide_by_attributes(nt_scene *scene, const nt_mesh *mesh, const wishes *w)
{
	const bool lacks_normals = !mesh->has_normals && !w->normals;
	const bool lacks_texcoords = !mesh->has_texcoords && !can_mend(mesh);
	if (lacks_texcoords)
		report_no_texcoords(scene, mesh, w->any_texcoords);
	if (lacks_normals && needs_tangents(mesh))
		nt_finding_add(&scene->findings, NT_CODE_TAN_NO_NORMAL, nt_mesh_place(mesh, &(nt_place){0}), 1, NULL);
	if (lacks_texcoords)
		return NT_SKIP_NO_TEXCOORDS;
	return lacks_normals ? NT_SKIP_NO_NORMALS : NT_DECISION_OPEN;
}

static nt_decision decide(nt_scene *scene, const nt_mesh *mesh, const wishes *w)
{
	const bool knows_materials = nt_format_is_gltf(scene->format);
	if (!mesh->triangles)
		return NT_SKIP_NOT_TRIANGLES;
	if (w->existing == NT_EXISTING_DROP && mesh->has_tangents && !needs_tangents(mesh))
		return NT_SKIP_DROPPED;
	if (mesh->face_count == 0)
		return NT_SKIP_EMPTY;
	const nt_existing existing = mesh->fix ? (nt_existing)mesh->fix : w->existing;
	nt_decision decision = mesh->fix ? NT_DECISION_OPEN : decide_by_wish(mesh, w->only, knows_materials);
	if (decision != NT_DECISION_OPEN)
		return decision;
	if (mesh->texcoord_conflict)
		nt_finding_add(&scene->findings, NT_CODE_TAN_UVSET_CONFLICT, nt_mesh_place(mesh, &(nt_place){0}), 1,
			"sets %u and %u", mesh->texcoord_set, mesh->texcoord_other_set);
	const bool keeps = has_tangents_that_count(mesh) &&
		(existing == NT_EXISTING_KEEP || existing == NT_EXISTING_DROP);
	if (mesh->asked_set) /* without it nothing is mended either */
		report_no_texcoords(scene, mesh, w->any_texcoords);
	if (keeps || mesh->asked_set)
		return keeps ? NT_SKIP_HAS_TANGENTS : NT_SKIP_NO_TEXCOORDS;
	decision = decide_by_attributes(scene, mesh, w);
	if (decision != NT_DECISION_OPEN)
		return decision;
	/* what cannot be computed anew is not thrown away either */
	const bool repair = existing == NT_EXISTING_REPAIR || !mesh->has_texcoords;
	return can_mend(mesh) && repair ? NT_DECISION_REPAIR : NT_DECISION_SOLVE;
}

/* A mesh of a glTF that would be skipped, for which normals were asked. Tangents that it has follow them. A block of
 * Draco stays as it is. */
static nt_decision decide_shading(const nt_scene *scene, const nt_mesh *mesh, nt_decision decision, const wishes *w)
{
	const bool for_tangents = decision == NT_SKIP_NO_SLOT || decision == NT_SKIP_UNLIT ||
		decision == NT_SKIP_NO_TEXCOORDS;
	if (!for_tangents || !nt_format_is_gltf(scene->format) || w->normals < NT_MAKING_ALL_MISSING ||
		(mesh->has_normals && w->normals < NT_MAKING_ALL) || !mesh->has_positions || mesh->compressed)
		return decision;
	if (mesh->has_tangents)
		return mesh->has_texcoords ? NT_DECISION_SOLVE : decision;
	return NT_DECISION_NORMALS;
}

void nt_select(nt_scene *scene, nt_only only, nt_existing existing, nt_making_normals normals)
{
	const wishes w = {only, existing, normals, any_has_texcoords(scene)};
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		mesh->decision = decide_shading(scene, mesh, decide(scene, mesh, &w), &w);
		if (mesh->tangents_fault && mesh->decision != NT_DECISION_SOLVE)
			nt_finding_add(&scene->findings, NT_CODE_TAN_ACCESSOR, nt_mesh_place(mesh, &(nt_place){0}), 1,
				"%s", mesh->tangents_fault);
	}
}

const char *nt_decision_text(nt_decision decision)
{
	static const char *const texts[NT_DECISION_COUNT] = {
		[NT_DECISION_OPEN] = "not decided",
		[NT_DECISION_SOLVE] = "tangents are computed",
		[NT_DECISION_REPAIR] = "invalid tangents are replaced",
		[NT_DECISION_NORMALS] = "normals are made",
		[NT_SKIP_NO_SLOT] = "no material of it uses tangents",
		[NT_SKIP_UNLIT] = "its material is unlit",
		[NT_SKIP_NOT_TRIANGLES] = "points or lines",
		[NT_SKIP_EMPTY] = "no faces",
		[NT_SKIP_UNREACHABLE] = "in no scene",
		[NT_SKIP_NO_TEXCOORDS] = "no texture coordinates",
		[NT_SKIP_NO_NORMALS] = "no normals",
		[NT_SKIP_HAS_TANGENTS] = "has tangents",
		[NT_SKIP_DROPPED] = "loses tangents that no material uses",
	};
	return (unsigned)decision < NT_DECISION_COUNT ? texts[decision] : "unknown";
}
