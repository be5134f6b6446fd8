/* SPDX-License-Identifier: MIT */
/*
 * The life of a scene: see scene.h.
 */
#include "scene/scene.h"

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
	nt_arena_free(&scene->arena);
	memset(scene, 0, sizeof *scene);
}

nmtan_mesh nt_mesh_view(const nt_mesh *mesh)
{
	return (nmtan_mesh){
		.face_count = mesh->face_count,
		.vertex_count = mesh->vertex_count,
		.face_sizes = mesh->face_sizes,
		.indices = mesh->indices,
		.positions = mesh->positions,
		.normals = mesh->normals,
		.texcoords = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords,
		.exact_texcoords = mesh->solve_texcoords && mesh->solve_sign ? mesh->texcoords : NULL,
		.exact_mirrored = mesh->solve_sign < 0,
	};
}
