/* SPDX-License-Identifier: MIT */
/*
 * The life of a scene: see scene.h.
 */
#include "scene/scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void nt_scene_init(nt_scene *scene, const char *path)
{
	*scene = (nt_scene){.path = path};
}

void nt_scene_free(nt_scene *scene)
{
	if (scene->free_source)
		scene->free_source(scene->source);
	if (scene->unmap)
		scene->unmap(scene);
	nt_finding_list_free(&scene->findings);
	nt_buffer_free(&scene->left_out);
	nt_arena_free(&scene->arena);
	nt_arena_free(&scene->temporary);
	memset(scene, 0, sizeof *scene);
}

void nt_scene_leave_out(nt_scene *scene, size_t line, size_t count, const char *format, ...)
{
	char text[200];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(text, sizeof text, format, arguments);
	va_end(arguments);
	nt_buffer_text(&scene->left_out, scene->left_out_count ? ", " : "");
	nt_buffer_clean(&scene->left_out, text);
	if (line && (!scene->left_out_line || line < scene->left_out_line))
		scene->left_out_line = line;
	scene->left_out_count += count;
}

/* `mesh "head", primitive 2, material "skin"`. */
static void name_primitive(const nt_mesh *mesh, char *words, size_t room)
{
	int used = mesh->name[0] ? snprintf(words, room, "mesh \"%.*s\"", NT_CUT(80, mesh->name)) :
				   snprintf(words, room, "mesh %u", mesh->gltf_mesh);
	used += snprintf(words + used, room - (size_t)used, ", primitive %u", mesh->gltf_primitive);
	if (mesh->gltf_material_name)
		snprintf(words + used, room - (size_t)used, ", material \"%.*s\"",
			NT_CUT(80, mesh->gltf_material_name));
	else if (mesh->gltf_material != NT_NONE)
		snprintf(words + used, room - (size_t)used, ", material %u", mesh->gltf_material);
}

const nt_place *nt_mesh_place(const nt_mesh *mesh, nt_place *place)
{
	nt_place_clear(place);
	if (mesh->file)
		snprintf(place->file, sizeof place->file, "%s", mesh->file);
	place->line = mesh->line;
	if (mesh->gltf_mesh != NT_NONE) {
		snprintf(place->pointer, sizeof place->pointer, "/meshes/%u/primitives/%u", mesh->gltf_mesh,
			mesh->gltf_primitive);
		name_primitive(mesh, place->object, sizeof place->object);
	} else if (mesh->name[0]) {
		snprintf(place->object, sizeof place->object, "object \"%.*s\"", NT_CUT(200, mesh->name));
	} else if (!mesh->file) {
		strcpy(place->object, "mesh");
	}
	return place;
}

void nt_mesh_share(nt_mesh *mesh)
{
	const nt_mesh own = *mesh;
	*mesh = *own.plan.same_as;
	/* all but geometry and results: what it is called, what decides, and its material */
	mesh->name = own.name;
	mesh->gltf_mesh = own.gltf_mesh;
	mesh->gltf_primitive = own.gltf_primitive;
	mesh->gltf_material = own.gltf_material;
	mesh->gltf_material_name = own.gltf_material_name;
	mesh->slots = own.slots;
	mesh->triangles = own.triangles;
	mesh->reachable = own.reachable;
	mesh->unlit = own.unlit;
	memcpy(mesh->wrap, own.wrap, sizeof mesh->wrap);
	memcpy(mesh->wrap_offset, own.wrap_offset, sizeof mesh->wrap_offset);
	mesh->texcoord_set = own.texcoord_set;
	mesh->untextured = own.untextured;
	mesh->texcoords_transformed = own.texcoords_transformed;
	mesh->transforms_differ = own.transforms_differ;
	mesh->transform_animated = own.transform_animated;
	mesh->texcoord_conflict = own.texcoord_conflict;
	mesh->texcoord_other_set = own.texcoord_other_set;
	mesh->moving_targets = own.moving_targets;
	mesh->targets_without_tangents = own.targets_without_tangents;
	mesh->decision = own.decision;
	mesh->plan.same_as = own.plan.same_as;
	mesh->plan.join = own.plan.join;
	mesh->plan.copied = own.plan.copied;
	mesh->primitives = own.primitives;
	mesh->primitive_count = own.primitive_count;
	if (mesh->primitive_count == 1)
		mesh->primitives[0].face_count = mesh->face_count;
}

void nt_mesh_drop_arrays(nt_mesh *mesh)
{
	mesh->positions = mesh->normals = mesh->solve_normals = mesh->colors = mesh->tangents = NULL;
	mesh->stored_normals = NULL;
	mesh->texcoords = mesh->solve_texcoords = mesh->corner_tangents = mesh->split.vertex_tangents = NULL;
	mesh->pool_vertices = mesh->indices = mesh->vertex_sources = mesh->split.indices = mesh->split.sources = NULL;
	mesh->halves = NULL;
	mesh->face_polygon = mesh->face_smoothing = mesh->face_primitive = NULL;
	mesh->vertex_lacks = mesh->face_sizes = mesh->face_diagonals = NULL;
	mesh->morphs = NULL;
	mesh->morph_tangents = NULL;
	mesh->morph_count = 0;
}

nmtan_mesh nt_mesh_view(const nt_mesh *mesh, nmtan_stored_uv *stored)
{
	const bool transformed = mesh->solve_texcoords && mesh->solve_sign;
	*stored = (nmtan_stored_uv){
		.struct_bytes = sizeof(nmtan_stored_uv),
		.texcoords = transformed ? mesh->texcoords : NULL,
		.mirrored = mesh->solve_sign < 0,
	};
	return (nmtan_mesh){
		.struct_bytes = sizeof(nmtan_mesh),
		.face_count = mesh->face_count,
		.vertex_count = mesh->vertex_count,
		.face_sizes = mesh->face_sizes,
		.indices = mesh->indices,
		.positions = mesh->positions,
		.position_stride_bytes = 3 * sizeof(float),
		.normals = mesh->solve_normals ? mesh->solve_normals : mesh->normals,
		.normal_stride_bytes = 3 * sizeof(float),
		.texcoords = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords,
		.texcoord_stride_bytes = 2 * sizeof(float),
		.stored = stored,
	};
}

nt_material nt_material_default(const char *name)
{
	return (nt_material){.name = name, .base_color = {1, 1, 1, 1}, .roughness = 1, .normal_scale = 1};
}

nt_place nt_material_place(const nt_scene *scene, const nt_material *material, size_t line)
{
	nt_place place = nt_line_place(material->library ? material->library : scene->path,
		line ? line : material->line);
	if (material->name[0])
		snprintf(place.object, sizeof place.object, "material \"%.*s\"",
			NT_CUT(200, material->name));
	return place;
}

const nt_place *nt_map_place(const nt_scene *scene, const nt_material *material, const nt_map *map, nt_place *place)
{
	*place = nt_material_place(scene, material, map->line);
	if (map->given) {
		snprintf(place->file, sizeof place->file, "%s", map->name);
		place->line = 0;
	}
	return place;
}

bool nt_scene_has_triangles(const nt_scene *scene)
{
	bool any = false;
	for (size_t i = 0; i < scene->mesh_count; i++)
		any |= scene->meshes[i].triangles && scene->meshes[i].face_count;
	return any;
}

bool nt_material_takes_texcoords(const nt_material *material)
{
	bool takes = material->anisotropy != 0;
	for (size_t i = 0; i < NT_MATERIAL_MAPS && !takes; i++)
		takes = material->maps[i].name != NULL;
	return takes;
}
