/* SPDX-License-Identifier: MIT */
/*
 * From a mesh to the bytes of its normal map: see normal_map.h.
 */
#include "format/normal_map.h"

#include <stdlib.h>
#include <string.h>
#include "file/image_type.h"
#include "file/lookup.h"
#include "file/relative_path.h"
#include "file/uri.h"
#include "gltf/document.h"
#include "gltf/view.h"

/* What is wrong with a map takes it away, and no more; its bytes stay NULL. */
static nt_status without_map(nt_status status)
{
	return status == NT_ERROR_MEMORY || status == NT_ERROR_IO ? status : NT_OK;
}

static nt_status open_file(nt_normal_map *map, const char *path, nt_error *error)
{
	const nt_status status = nt_file_open(&map->file, path, error);
	if (status)
		return status;
	map->bytes = map->file.data;
	map->size = map->file.size;
	return NT_OK;
}

/* ---- OBJ ---- */

/* Inside the folder of the material library, links resolved. */
static nt_status open_inside(nt_normal_map *map, const char *document, const char *name, nt_error *error)
{
	nt_buffer folder = {0}, path = {0};
	char *real = NULL;
	nt_status status = nt_link_folder(&folder, document, error);
	if (!status) {
		nt_link_join(&path, folder.data, name);
		status = path.failed ? nt_fail_memory(error) : nt_lookup_real(path.data, &real, error);
	}
	if (!status && nt_link_is_inside(real, folder.data))
		status = open_file(map, real, error);
	free(real);
	nt_buffer_free(&folder);
	nt_buffer_free(&path);
	return status;
}

static nt_status open_of_materials(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < mesh->primitive_count && !status && !map->bytes; i++) {
		const uint32_t index = mesh->primitives[i].material;
		const nt_material *m = index < scene->material_count ? &scene->materials[index] : NULL;
		if (m && m->normal_map && !nt_link_is_absolute(m->normal_map))
			status = without_map(open_inside(map, m->library ? m->library : scene->path, m->normal_map,
				error));
	}
	return status;
}

/* ---- glTF ---- */

static const nt_json_value *element(const nt_json_value *array, const nt_json_value *index)
{
	uint64_t i;
	return nt_json_get_uint64(index, &i) ? nt_json_at(array, (size_t)i) : NULL;
}

static const nt_json_value *image_of(const nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *owner = nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	const nt_json_value *primitive =
		nt_json_at(nt_json_find(owner, "primitives"), mesh->gltf_primitive);
	const nt_json_value *material = element(nt_gltf_root_member(document, "materials"),
		nt_json_find(primitive, "material"));
	const nt_json_value *texture = element(nt_gltf_root_member(document, "textures"),
		nt_json_find(nt_json_find(material, "normalTexture"), "index"));
	return element(nt_gltf_root_member(document, "images"), nt_json_find(texture, "source"));
}

static nt_status open_uri(nt_normal_map *map, nt_gltf *document, const char *uri, size_t length, nt_error *error)
{
	if (nt_uri_is_data(uri, length)) {
		const nt_status status = nt_uri_decode_data(uri, length, &map->decoded, &map->size, error);
		map->bytes = status ? NULL : map->decoded;
		return status;
	}
	const char *path;
	const nt_status status =
		nt_uri_resolve(&document->arena, document->path, uri, length, false, &path, error);
	return status ? status : open_file(map, path, error);
}

static nt_status open_view(nt_normal_map *map, nt_gltf *document, uint64_t index, nt_error *error)
{
	nt_gltf_view view;
	nt_status status = nt_gltf_get_view(document, index, "", &view, error);
	if (!status)
		status = nt_gltf_view_bytes(document, view.index, 0, view.length, "", &map->bytes, error);
	map->size = status ? 0 : (size_t)view.length;
	return status;
}

static nt_status open_of_document(nt_normal_map *map, nt_gltf *document, const nt_mesh *mesh, nt_error *error)
{
	const nt_json_value *image = image_of(document, mesh);
	size_t length;
	uint64_t view;
	const char *uri = nt_json_get_string(nt_json_find(image, "uri"), &length);
	if (uri)
		return without_map(open_uri(map, document, uri, length, error));
	if (nt_json_get_uint64(nt_json_find(image, "bufferView"), &view))
		return without_map(open_view(map, document, view, error));
	return NT_OK;
}

/* ---- both ---- */

nt_status nt_normal_map_open(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh, nt_error *error)
{
	*map = (nt_normal_map){0};
	const bool gltf = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB;
	nt_status status = NT_OK;
	if (!gltf)
		status = open_of_materials(map, scene, mesh, error);
	else if (scene->source)
		status = open_of_document(map, scene->source, mesh, error);
	const nt_image_type type = map->bytes ? nt_image_type_of_bytes(map->bytes, map->size) : NT_IMAGE_OTHER;
	if (type == NT_IMAGE_PNG || type == NT_IMAGE_JPEG)
		map->type = nt_image_media_type(type);
	else
		nt_normal_map_close(map);
	return status;
}

void nt_normal_map_close(nt_normal_map *map)
{
	if (map->file.data)
		nt_file_close(&map->file);
	free(map->decoded);
	*map = (nt_normal_map){0};
}
