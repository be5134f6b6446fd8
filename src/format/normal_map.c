/* SPDX-License-Identifier: MIT */
/*
 * From a mesh to the bytes of its normal map: see normal_map.h.
 */
#include "format/normal_map.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/view.h"
#include "file/image_type.h"
#include "file/relative_path.h"
#include "file/uri.h"

static bool open_file(nt_normal_map *map, const char *path)
{
	nt_error ignored;
	if (nt_file_open(&map->file, path, &ignored))
		return false;
	map->bytes = map->file.data;
	map->size = map->file.size;
	return true;
}

/* ---- OBJ ---- */

/* Inside the folder of the material library, links resolved. */
static bool open_inside(nt_normal_map *map, const char *document, const char *name)
{
	nt_buffer folder = {0}, path = {0};
	bool opened = false;
	if (!nt_link_is_absolute(name) && nt_link_folder(&folder, document) && !folder.failed) {
		nt_link_join(&path, folder.data, name);
		char *real = path.failed ? NULL : realpath(path.data, NULL);
		opened = real && nt_link_is_inside(real, folder.data) && open_file(map, real);
		free(real);
	}
	nt_buffer_free(&folder);
	nt_buffer_free(&path);
	return opened;
}

static bool open_of_materials(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh)
{
	for (size_t i = 0; i < mesh->primitive_count; i++) {
		const uint32_t index = mesh->primitives[i].material;
		const nt_material *m = index < scene->material_count ? &scene->materials[index] : NULL;
		if (m && m->normal_map && open_inside(map, m->library ? m->library : scene->path, m->normal_map))
			return true;
	}
	return false;
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

static bool open_uri(nt_normal_map *map, nt_gltf *document, const char *uri, size_t length)
{
	nt_error ignored;
	if (nt_uri_is_data(uri, length)) {
		if (nt_uri_decode_data(uri, length, &map->decoded, &map->size, &ignored))
			return false;
		map->bytes = map->decoded;
		return true;
	}
	const char *path;
	return nt_uri_resolve(&document->arena, document->path, uri, length, false, &path, &ignored) == NT_OK &&
		open_file(map, path);
}

static bool open_view(nt_normal_map *map, nt_gltf *document, uint64_t index)
{
	nt_error ignored;
	nt_gltf_view view;
	if (nt_gltf_get_view(document, index, "", &view, &ignored) ||
		nt_gltf_view_bytes(document, view.index, 0, view.length, "", &map->bytes, &ignored))
		return false;
	map->size = (size_t)view.length;
	return true;
}

static bool open_of_document(nt_normal_map *map, nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *image = image_of(document, mesh);
	size_t length;
	uint64_t view;
	const char *uri = nt_json_get_string(nt_json_find(image, "uri"), &length);
	if (uri)
		return open_uri(map, document, uri, length);
	return nt_json_get_uint64(nt_json_find(image, "bufferView"), &view) && open_view(map, document, view);
}

/* ---- both ---- */

bool nt_normal_map_open(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh)
{
	*map = (nt_normal_map){0};
	const bool gltf = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB;
	const bool opened = gltf ? scene->source && open_of_document(map, scene->source, mesh)
				 : open_of_materials(map, scene, mesh);
	const nt_image_type type = opened ? nt_image_type_of_bytes(map->bytes, map->size) : NT_IMAGE_OTHER;
	if (type == NT_IMAGE_PNG || type == NT_IMAGE_JPEG) {
		map->type = nt_image_media_type(type);
		return true;
	}
	nt_normal_map_close(map);
	return false;
}

void nt_normal_map_close(nt_normal_map *map)
{
	if (map->file.data)
		nt_file_close(&map->file);
	free(map->decoded);
	*map = (nt_normal_map){0};
}
