/* SPDX-License-Identifier: MIT */
/*
 * The plan of a document, made before any mesh is loaded: from its JSON, but for Draco. It says of each primitive with
 * whom it shares vertices (its pool), whose geometry it has, with whom it is solved, whether it is solved as a decoder
 * of Draco will have it, and whether what it holds may go once its pool has its results. Reader, stages and writer
 * keep to it.
 */
#include "gltf/edit/edit.h"

#include "gltf/load.h"
#include "gltf/vertex_pools.h"

/* Whether a mesh will be loaded: to be solved, or only to be checked, or for others. */
static bool is_loaded(const nt_mesh *mesh, const nt_read_options *options)
{
	return nt_mesh_is_wanted(mesh) || nt_mesh_is_kept_and_used(mesh) ||
		((options->report || options->across) && mesh->triangles && mesh->has_positions);
}

/* Tangents that go before anything asks which accessors are used, and which are not there: those that cannot be read
 * and are solved anew, and with --morph=drop those of targets. Accessors keep their numbers. */
static void drop_tangents(const nt_scene *scene, nt_morph_choice morphs)
{
	const nt_gltf *document = scene->source;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		if (!nt_mesh_gets_tangents(mesh) || !(mesh->tangents_fault || morphs == NT_MORPH_DROP))
			continue;
		nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
		if (mesh->tangents_fault)
			nt_json_remove(document->json, nt_json_find(primitive, "attributes"), "TANGENT");
		nt_json_value *targets = nt_json_find(primitive, "targets");
		for (size_t t = 0; morphs == NT_MORPH_DROP && t < nt_json_count(targets); t++)
			nt_json_remove(document->json, nt_json_at(targets, t), "TANGENT");
	}
}

/* Meshes of one pool with different triangles are loaded with the vertices that each uses. */
static void find_pooled(const nt_scene *scene, const nt_read_options *options)
{
	const nt_gltf *document = scene->source;
	const nt_vertex_pools *pools = document->pools;
	for (size_t p = 0; p < pools->count; p++) {
		size_t count = 0;
		for (uint32_t i = pools->first[p]; i < pools->first[p + 1]; i++)
			count += is_loaded(&scene->meshes[pools->order[i]], options) &&
				!scene->meshes[pools->order[i]].plan.same_as;
		for (uint32_t i = pools->first[p]; count > 1 && i < pools->first[p + 1]; i++)
			scene->meshes[pools->order[i]].plan.pooled = true;
	}
}

/* A mesh's data is temporary if only its results are needed, and go to its pool. If a later mesh has the
 * same geometry and a texture transform, which findings are about, the texture coordinates stay. */
static void find_temporary(const nt_scene *scene, const nt_read_options *options)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		if (mesh->plan.same_as && mesh->texcoords_transformed)
			scene->meshes[mesh->plan.same_as - scene->meshes].plan.disposable = false;
	}
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		nt_mesh_plan *plan = &mesh->plan;
		plan->temporary = options->only_results && plan->pooled && plan->disposable && nt_mesh_is_wanted(mesh);
	}
}

nt_status nt_gltf_plan(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	size_t loaded = 0, wanted = 0;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		loaded += is_loaded(&scene->meshes[i], options);
		wanted += nt_mesh_is_wanted(&scene->meshes[i]);
	}
	/* one that keeps its tangents has nothing to do with others; a report asks for all its attributes */
	const bool alone = loaded == 1 && !wanted && !options->compresses && !options->report;
	if (loaded == 0 || alone)
		return NT_OK;
	if (options->edits)
		drop_tangents(scene, options->morphs);
	nt_status status = nt_vertex_pools_find(scene, options, error);
	if (!status)
		status = nt_gltf_find_same(scene, options, error);
	if (!status && (options->across || options->report))
		status = nt_gltf_find_joins(scene, options->across, options->checks_kept, error);
	if (status)
		return status;
	/* what is only compared is not said of the meshes */
	for (size_t i = 0; options->across && i < scene->join_count; i++)
		for (size_t k = 0; k < scene->joins[i].part_count; k++)
			scene->joins[i].parts[k]->plan.join = &scene->joins[i];
	find_pooled(scene, options);
	find_temporary(scene, options);
	return options->compresses ? nt_gltf_find_quantized(scene, options, error) : NT_OK;
}
