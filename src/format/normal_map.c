/* SPDX-License-Identifier: MIT */
/*
 * From a mesh to the bytes of its normal map: see maps.h.
 */
#include "format/maps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "file/path.h"
#include "gltf/document.h"
#include "gltf/edit/edit.h"
#include "image/image.h"
#include "image/textures.h"

/* A faulty map is left out, and nothing else; its bytes stay NULL. */
static nt_status without_map(nt_status status)
{
	return status == NT_ERROR_MEMORY || status == NT_ERROR_IO ? status : NT_OK;
}

static nt_status open_file(nt_normal_map *map, const char *path, nt_error *error)
{
	const nt_status status = nt_file_open(&map->file, path, NT_NAMED_BY_DOCUMENT, error);
	if (status)
		return status;
	map->path = strdup(path);
	if (!map->path)
		return nt_fail_memory(error);
	map->bytes = map->file.data;
	map->size = map->file.size;
	map->identity[0] = map->file.device;
	map->identity[1] = map->file.inode;
	return NT_OK;
}

/* ---- OBJ ---- */

static const nt_map *map_of(const nt_material *m, enum nt_slot slot)
{
	return slot ? &m->normal_map : &m->base_color_map;
}

/* The material of a primitive if it names a map for the slot; NULL: it does not. */
static const nt_material *material_of(const nt_scene *scene, const nt_mesh *mesh, size_t primitive, enum nt_slot slot)
{
	const uint32_t index = mesh->primitives[primitive].material;
	const nt_material *m = index < scene->material_count ? &scene->materials[index] : NULL;
	return m && map_of(m, slot)->name && *map_of(m, slot)->name ? m : NULL;
}

static nt_status open_named(nt_normal_map *map, const nt_scene *scene, const nt_material *m, enum nt_slot slot,
	const nt_image_places *searched, nt_error *error)
{
	nt_image_places places = searched ? *searched : (nt_image_places){0};
	places.document = m->library ? m->library : scene->path;
	places.input = scene->path;
	places.given = map_of(m, slot)->given;
	nt_buffer path = {0};
	nt_image_found found;
	nt_status status = nt_image_find(&places, map_of(m, slot)->name, &path, &found, error);
	if (!status && found <= NT_IMAGE_FOUND_ELSEWHERE)
		status = open_file(map, path.data, error);
	nt_buffer_free(&path);
	return status;
}

static nt_status open_of_materials(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot,
	const nt_image_places *searched, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < mesh->primitive_count && !status && !map->bytes; i++) {
		const nt_material *m = material_of(scene, mesh, i, slot);
		if (m)
			status = without_map(open_named(map, scene, m, slot, searched, error));
	}
	return status;
}

const nt_map *nt_normal_map_named(const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot)
{
	for (size_t i = 0; i < mesh->primitive_count; i++) {
		const nt_material *m = material_of(scene, mesh, i, slot);
		if (m)
			return map_of(m, slot);
	}
	return NULL;
}

/* v turned over before, and back behind. */
static void place_map(const nt_placement *placement, float t[6])
{
	t[0] = placement->scale[0];
	t[2] = placement->offset[0];
	t[4] = placement->scale[1];
	t[5] = 1.0f - placement->scale[1] - placement->offset[1];
}

/* ---- glTF ---- */

static const nt_json_value *element(const nt_json_value *array, const nt_json_value *index)
{
	uint64_t i;
	return nt_json_get_uint64(index, &i) ? nt_json_at(array, (size_t)i) : NULL;
}

/* The image that every reader has comes first. */
static const nt_json_value *source_of(const nt_json_value *texture)
{
	const nt_json_value *source = nt_json_find(texture, "source"),
		*extensions = nt_json_find(texture, "extensions");
	for (nt_image_type type = NT_IMAGE_KTX2; !source && type <= NT_IMAGE_WEBP; type++)
		source = nt_json_find(nt_json_find(extensions, nt_image_extension(type)), "source");
	return source;
}

/* The textureInfo of a mesh's normal map in a slot; NULL: none. */
static const nt_json_value *info_of(const nt_gltf *document, const nt_mesh *mesh, enum nt_slot slot)
{
	const nt_json_value *owner = nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	const nt_json_value *primitive =
		nt_json_at(nt_json_find(owner, "primitives"), mesh->gltf_primitive);
	const nt_json_value *material = element(nt_gltf_root_member(document, "materials"),
		nt_json_find(primitive, "material"));
	if (!slot)
		return nt_json_find(nt_json_find(material, "pbrMetallicRoughness"), "baseColorTexture");
	return slot == NT_SLOT_NORMAL ? nt_json_find(material, "normalTexture")
		: nt_json_find(nt_json_find(nt_json_find(material, "extensions"), "KHR_materials_clearcoat"),
			"clearcoatNormalTexture");
}

static const nt_json_value *image_of(const nt_gltf *document, const nt_mesh *mesh, enum nt_slot slot,
	nt_normal_map *map)
{
	const nt_json_value *texture = element(nt_gltf_root_member(document, "textures"),
		nt_json_find(info_of(document, mesh, slot), "index"));
	const nt_json_value *extensions = nt_json_find(texture, "extensions");
	uint64_t number = NT_NONE;
	nt_json_get_uint64(source_of(texture), &number);
	map->image = (uint32_t)number;
	map->turnable = true;
	for (nt_image_type type = NT_IMAGE_KTX2; type <= NT_IMAGE_WEBP; type++)
		map->turnable &= !nt_json_find(extensions, nt_image_extension(type));
	return element(nt_gltf_root_member(document, "images"), source_of(texture));
}

static nt_status open_uri(nt_normal_map *map, nt_gltf *document, const char *uri, size_t length, nt_error *error)
{
	if (nt_uri_is_data(uri, length)) {
		const nt_status status = nt_uri_decode_data(uri, length, &map->decoded, &map->size, error);
		map->bytes = status ? NULL : map->decoded;
		map->identity[1] = (uint64_t)(uintptr_t)uri;
		return status;
	}
	const char *path;
	const nt_status status =
		nt_uri_resolve(&document->arena, document->path, uri, length, document->allow_outside, &path, error);
	return status ? status : open_file(map, path, error);
}

static nt_status open_view(nt_normal_map *map, nt_gltf *document, uint64_t index, nt_error *error)
{
	const nt_gltf_view *view;
	nt_status status = nt_gltf_read_arrays(document, error);
	if (!status)
		status = nt_gltf_get_view(document, index, "", &view, error);
	if (!status)
		status = nt_gltf_view_bytes(document, (uint32_t)index, 0, view->length, "", &map->bytes, error);
	map->size = status ? 0 : (size_t)view->length;
	map->identity[1] = (uint64_t)(uintptr_t)map->bytes;
	return status;
}

/* The set of texture coordinates that a textureInfo names. */
static uint64_t set_of(const nt_json_value *info)
{
	uint64_t set = 0;
	nt_json_get_uint64(nt_json_find(info, "texCoord"), &set);
	nt_json_get_uint64(nt_json_find(nt_json_find(nt_json_find(info, "extensions"), "KHR_texture_transform"),
		"texCoord"), &set);
	return set;
}

static nt_status open_of_document(nt_normal_map *map, nt_gltf *document, const nt_json_value *image, nt_error *error)
{
	size_t length = 0;
	uint64_t view;
	const char *uri = map->image < document->image_uri_count ? document->image_uris[map->image] : NULL;
	if (uri)
		length = strlen(uri);
	else
		uri = nt_json_get_string(nt_json_find(image, "uri"), &length);
	if (uri)
		return without_map(open_uri(map, document, uri, length, error));
	if (nt_json_get_uint64(nt_json_find(image, "bufferView"), &view))
		return without_map(open_view(map, document, view, error));
	return NT_OK;
}

/* KHR_texture_transform, turned as gltf/load.c turns coordinates. */
static void read_transform(const nt_json_value *info, float t[6])
{
	const nt_json_value *json = nt_json_find(nt_json_find(info, "extensions"), "KHR_texture_transform");
	const nt_json_value *lists[2] = {nt_json_find(json, "scale"), nt_json_find(json, "offset")};
	double angle = 0.0, values[2][2] = {{1.0, 1.0}, {0.0, 0.0}};
	nt_json_get_double(nt_json_find(json, "rotation"), &angle);
	for (int i = 0; i < 2; i++)
		for (size_t k = 0; k < 2; k++)
			nt_json_get_double(nt_json_at(lists[i], k), &values[i][k]);
	const double c = cos(angle), s = sin(angle);
	const double whole[6] = {c * values[0][0], s * values[0][1], values[1][0], -s * values[0][0], c * values[0][1],
		values[1][1]};
	for (int i = 0; i < 6; i++)
		t[i] = (float)whole[i];
}

/* ---- both ---- */

void nt_normal_map_transform(const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot, float t[6])
{
	static const float identity[6] = {1, 0, 0, 0, 1, 0};
	memcpy(t, identity, sizeof identity);
	const nt_map *map = nt_normal_map_named(scene, mesh, slot);
	if (nt_format_is_gltf(scene->format) && scene->source)
		read_transform(info_of(scene->source, mesh, slot), t);
	else if (map && map->placement.moved)
		place_map(&map->placement, t);
	for (int i = 0; i < 6; i++)
		if (!isfinite(t[i]))
			memcpy(t, identity, sizeof identity);
}

/* It has bytes and a type, or nothing. */
static void settle(nt_normal_map *map)
{
	if (map->bytes) {
		map->type = nt_image_type_of_bytes(map->bytes, map->size);
		map->turnable &= nt_image_is_converted(map->type);
	} else {
		nt_normal_map_close(map);
	}
}

nt_status nt_normal_map_open(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot,
	const nt_image_places *searched, nt_error *error)
{
	*map = (nt_normal_map){.turnable = true};
	nt_status status = NT_OK;
	const bool gltf = nt_format_is_gltf(scene->format);
	if (!gltf && slot != NT_SLOT_CLEARCOAT_NORMAL)
		status = open_of_materials(map, scene, mesh, slot, searched, error);
	else if (gltf && scene->source && (slot || set_of(info_of(scene->source, mesh, slot)) == mesh->texcoord_set))
		status = open_of_document(map, scene->source, image_of(scene->source, mesh, slot, map), error);
	settle(map);
	return status;
}

nt_status nt_normal_map_open_named(nt_normal_map *map, const nt_scene *scene, const nt_material *material,
	enum nt_slot slot, const nt_image_places *searched, nt_error *error)
{
	*map = (nt_normal_map){.turnable = true};
	const nt_status status = without_map(open_named(map, scene, material, slot, searched, error));
	settle(map);
	return status;
}

nt_status nt_normal_map_open_image(nt_normal_map *map, nt_gltf *document, size_t image, nt_error *error)
{
	*map = (nt_normal_map){.image = (uint32_t)image};
	const nt_status status =
		open_of_document(map, document, nt_json_at(nt_gltf_root_member(document, "images"), image), error);
	settle(map);
	return status;
}

nt_status nt_normal_map_keep_uris(nt_scene *scene, nt_error *error)
{
	nt_gltf *document = scene->source;
	const nt_json_value *images = nt_gltf_root_member(document, "images");
	const size_t count = nt_json_count(images);
	document->image_uris = nt_arena_alloc(&document->arena, count, sizeof *document->image_uris);
	for (size_t i = 0; document->image_uris && i < count; i++) {
		size_t length;
		const char *uri = nt_gltf_external_uri(nt_json_at(images, i), &length);
		document->image_uris[i] = uri ? nt_arena_text(&document->arena, uri, length) : NULL;
		if (uri && !document->image_uris[i])
			return nt_fail_memory(error);
	}
	document->image_uri_count = document->image_uris ? count : 0;
	return document->image_uris ? NT_OK : nt_fail_memory(error);
}

/* ---- one image of base colours ---- */

/* An image of base colours, as the parts of a scene name it. */
typedef struct color_name {
	const char *text, *library; /* of an OBJ; text: NULL: none */
	const nt_json_value *image; /* of a glTF; NULL: none */
} color_name;

static bool is_same_name(const color_name *a, const color_name *b)
{
	return a->image == b->image && a->library == b->library && !a->text == !b->text &&
		(!a->text || strcmp(a->text, b->text) == 0);
}

/* The image that a part names, and whether it lies as the texture coordinates do. */
static color_name color_of(const nt_scene *scene, const nt_mesh *mesh, size_t primitive, bool *lies_plain)
{
	color_name name = {0};
	if (nt_format_is_gltf(scene->format)) {
		const nt_json_value *info = info_of(scene->source, mesh, 0);
		float t[6];
		name.image = image_of(scene->source, mesh, 0, &(nt_normal_map){0});
		read_transform(info, t);
		*lies_plain &= !name.image || (set_of(info) == mesh->texcoord_set && t[0] == 1 && t[1] == 0 &&
			t[2] == 0 && t[3] == 0 && t[4] == 1 && t[5] == 0);
		return name;
	}
	const nt_material *m = material_of(scene, mesh, primitive, 0);
	if (m) {
		name = (color_name){.text = m->base_color_map.name, .library = m->library};
		*lies_plain &= !m->base_color_map.placement.moved;
	}
	return name;
}

nt_status nt_color_image_open(nt_normal_map *map, const char **obstacle, const nt_scene *scene,
	const nt_image_places *searched, nt_error *error)
{
	const nt_mesh *first = NULL;
	color_name known = {0};
	bool any = false, same = true, lies_plain = true;
	*map = (nt_normal_map){0};
	*obstacle = NULL;
	for (size_t i = 0; i < scene->instance_count; i++) {
		const nt_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
		const size_t parts = nt_format_is_gltf(scene->format) ? 1 : mesh->primitive_count;
		for (size_t k = 0; k < parts && mesh->triangles && mesh->face_count && mesh->texcoords; k++) {
			const color_name name = color_of(scene, mesh, k, &lies_plain);
			any |= name.image || name.text;
			same &= !first || is_same_name(&name, &known);
			known = first ? known : name;
			first = first ? first : mesh;
		}
	}
	if (!any)
		return NT_OK;
	*obstacle = !same ? "not all of the mesh has one image of base colours"
		: !lies_plain ? "the image of base colours lies otherwise than the texture coordinates" : NULL;
	const nt_status status = *obstacle ? NT_OK : nt_normal_map_open(map, scene, first, 0, searched, error);
	if (!status && !map->bytes && !*obstacle)
		*obstacle = "the image of base colours cannot be read";
	if (!status && map->bytes && map->type == NT_IMAGE_KTX2) {
		*obstacle = "the image of base colours is a KTX2";
		nt_normal_map_close(map);
	}
	return status;
}

nt_status nt_look_for_images(nt_scene *scene, nt_error *error)
{
	return nt_format_is_gltf(scene->format) ? nt_gltf_look_for_images(scene, false, error) : NT_OK;
}

void nt_normal_map_close(nt_normal_map *map)
{
	if (map->file.data)
		nt_file_close(&map->file);
	free(map->path);
	free(map->decoded);
	*map = (nt_normal_map){0};
}
