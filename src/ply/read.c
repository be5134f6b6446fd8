/* SPDX-License-Identifier: MIT */
/*
 * PLY, the Stanford polygon format (G. Turk, 1994), read by one pass over the mapped file: the header
 * says which elements follow and what their rows hold; vertices and faces are decoded, everything else
 * is passed over and kept for the writer where it lies. Faces may come before vertices: their place is
 * then remembered.
 *
 * Nothing the header says is trusted: each count is held against the bytes that are left before
 * anything is allocated, each list before it is read, each index before it is used. An error in an
 * ASCII body has its line, in a binary body its byte offset.
 */
#include "ply/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "base/name_table.h"
#include "ply/source.h"

bool nt_ply_recognise(const unsigned char *bytes, size_t size)
{
	return size >= 4 && memcmp(bytes, "ply", 3) == 0 &&
	       (ply_is_line_end(bytes[3]) || ply_is_blank(bytes[3]));
}

static void free_source(void *pointer)
{
	ply_source *source = pointer;
	if (!source)
		return;
	ply_free_header(&source->header);
	free(source->cuts.corners);
	free(source);
}

/* The first set of names all of which the element has as scalars. Sets end with NULL names. */
static bool find_set(const ply_element *element, const char *const *names, size_t count, int *found)
{
	for (size_t i = 0; i < count; i++) {
		found[i] = names[i] ? ply_find_property(element, names[i]) : PLY_NO_PROPERTY;
		if (names[i] && (found[i] == PLY_NO_PROPERTY || element->properties[found[i]].list))
			break;
		if (i + 1 == count)
			return true;
	}
	for (size_t i = 0; i < count; i++)
		found[i] = PLY_NO_PROPERTY;
	return false;
}

static nt_status find_roles(ply_source *source, nt_error *error)
{
	static const char *const positions[] = {"x", "y", "z"};
	static const char *const normals[] = {"nx", "ny", "nz"};
	static const char *const tangents[] = {"tx", "ty", "tz", "tw"};
	static const char *const colors[][4] = {{"red", "green", "blue", "alpha"},
		{"red", "green", "blue", NULL}, {"diffuse_red", "diffuse_green", "diffuse_blue", NULL}};
	static const char *const texcoords[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"},
		{"texcoord_u", "texcoord_v"}, {"texture_s", "texture_t"}, {"tu", "tv"},
		{"texcoord_0", "texcoord_1"}};
	enum { TEXCOORD_NAMES = sizeof texcoords / sizeof *texcoords };
	ply_roles *roles = &source->roles;
	const ply_element *vertex = source->vertex;
	if (!find_set(vertex, positions, 3, roles->position))
		return nt_fail_line(error, NT_ERROR_INPUT, vertex->line,
			"element \"vertex\" has no properties x, y and z");
	find_set(vertex, normals, 3, roles->normal);
	find_set(vertex, tangents, 4, roles->tangent);
	for (size_t i = 0; i < 3 && !find_set(vertex, colors[i], 4, roles->color); i++)
		;
	for (size_t i = 0; i < TEXCOORD_NAMES && !find_set(vertex, texcoords[i], 2, roles->texcoord); i++)
		;
	return NT_OK;
}

/* The list of vertex numbers of faces or strips. */
static nt_status find_indices(ply_source *source, const ply_element *element, nt_error *error)
{
	int found = ply_find_property(element, "vertex_indices");
	if (found == PLY_NO_PROPERTY)
		found = ply_find_property(element, "vertex_index");
	if (found == PLY_NO_PROPERTY)
		return nt_fail_line(error, NT_ERROR_INPUT, element->line,
			"element \"%s\" has no list vertex_indices or vertex_index", element->name);
	const ply_property *property = &element->properties[found];
	if (!property->list || property->type >= PLY_FLOAT32)
		return nt_fail_line(error, NT_ERROR_INPUT, property->line,
			"property \"%s\" is not a list of integers", property->name);
	source->face_indices = found;
	source->face_texcoords = ply_find_property(element, "texcoord");
	if (source->face_texcoords >= 0 && !element->properties[source->face_texcoords].list)
		source->face_texcoords = PLY_NO_PROPERTY;
	return NT_OK;
}

static nt_status find_elements(ply_source *source, nt_error *error)
{
	const ply_header *header = &source->header;
	source->vertex = ply_find_element(header, "vertex");
	source->face_indices = source->face_texcoords = PLY_NO_PROPERTY;
	if (!source->vertex)
		return nt_fail_line(error, NT_ERROR_INPUT, header->body_line - 1,
			"the header has no element \"vertex\"");
	if (source->vertex->count >= NT_NONE)
		return nt_fail_line(error, NT_ERROR_INPUT, source->vertex->line,
			"%zu vertices, expected fewer than %u", source->vertex->count, NT_NONE);
	nt_status status = find_roles(source, error);
	const ply_element *face = ply_find_element(header, "face");
	const ply_element *strips = ply_find_element(header, "tristrips");
	if (!status && face && face->count) {
		source->face = face;
		status = find_indices(source, face, error);
	} else if (!status && strips && strips->count) {
		source->strips = strips;
		status = find_indices(source, strips, error);
	}
	return status;
}

/* Data of the file that the scene has not. */
static void report_unused(nt_scene *scene, const ply_source *source)
{
	if (source->header.unknown_lines) {
		nt_place place;
		nt_place_clear(&place);
		place.line = source->header.unknown_line;
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, source->header.unknown_lines,
			"lines of the header that are no statements");
	}
	for (size_t i = 0; i < source->header.element_count; i++) {
		const ply_element *element = &source->header.elements[i];
		if (element == source->vertex || element == source->face || element == source->strips ||
			element->count == 0)
			continue;
		nt_place place;
		nt_place_clear(&place);
		place.line = element->line;
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1, "element \"%s\"",
			element->name);
	}
}

/* Whether a property becomes part of the mesh. */
static bool is_used(const ply_source *source, const ply_element *element, int number)
{
	const int *roles = (const int *)&source->roles;
	if (element != source->vertex)
		return number == source->face_indices || number == source->face_texcoords;
	for (size_t i = 0; i < sizeof source->roles / sizeof *roles; i++)
		if (roles[i] == number)
			return true;
	return false;
}

/* Names the properties that a file of another format will not have. */
static nt_status list_left_out(nt_scene *scene, const ply_source *source, nt_error *error)
{
	const ply_element *const elements[] = {source->vertex, source->face};
	nt_buffer text = {0};
	for (size_t e = 0; e < 2; e++)
		for (size_t i = 0; elements[e] && i < elements[e]->property_count; i++)
			if (!is_used(source, elements[e], (int)i))
				nt_buffer_format(&text, "%s%s %s", scene->left_out_count++ ? ", " : "",
					elements[e]->name, elements[e]->properties[i].name);
	if (!text.failed && scene->left_out_count)
		scene->left_out = nt_utf8_text(&scene->arena, text.data, text.size);
	nt_buffer_free(&text);
	return scene->left_out || !scene->left_out_count ? NT_OK : nt_fail_memory(error);
}

static nt_status read_element(nt_scene *scene, nt_mesh *mesh, ply_source *source,
	const ply_element *element, ply_cursor *cursor, bool *have_vertices, nt_error *error)
{
	if (element == source->vertex) {
		*have_vertices = true;
		return ply_read_vertices(scene, mesh, source, cursor, error);
	}
	if (element != source->face && element != source->strips)
		return ply_skip_element(cursor, element, error);
	source->face_begin = (size_t)(cursor->at - cursor->begin);
	const nt_status status = *have_vertices
					    ? ply_read_faces(scene, mesh, source, cursor, error)
					    : ply_skip_element(cursor, element, error);
	source->face_end = (size_t)(cursor->at - cursor->begin);
	return status;
}

/* All elements in the order of the file; faces that come before the vertices at the end. */
static nt_status read_body(nt_scene *scene, nt_mesh *mesh, ply_source *source, const nt_read_options *options,
	nt_error *error)
{
	const ply_header *header = &source->header;
	const unsigned char *body = scene->bytes + header->body;
	ply_cursor cursor = {.begin = scene->bytes, .at = body, .end = scene->bytes + scene->byte_count,
		.body = body, .body_line = header->body_line, .encoding = header->encoding,
		.threads = nt_thread_count(options->threads)};
	bool have_vertices = false, faces_first = false;
	for (size_t i = 0; i < header->element_count; i++) {
		const ply_element *element = &header->elements[i];
		faces_first |= !have_vertices && (element == source->face || element == source->strips);
		const nt_status status =
			read_element(scene, mesh, source, element, &cursor, &have_vertices, error);
		if (status)
			return status;
	}
	if (header->encoding == PLY_ASCII)
		ply_next_row(&cursor);
	if (cursor.at < cursor.end) {
		nt_place place;
		nt_place_clear(&place);
		place.offset = (uint64_t)(cursor.at - cursor.begin);
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"%zu bytes after the last element", (size_t)(cursor.end - cursor.at));
	}
	nt_status status = NT_OK;
	if (faces_first) {
		cursor.at = scene->bytes + source->face_begin;
		status = ply_read_faces(scene, mesh, source, &cursor, error);
	}
	if (!status)
		status = ply_settle_origin(scene, mesh, source, &options->origin, &cursor, error);
	if (source->cuts.unsound)
		nt_finding_add(&scene->findings, NT_CODE_POLYGON_DEGENERATE, &source->cuts.first_unsound,
			source->cuts.unsound, NULL);
	return status;
}

/* The image that MeshLab names in a comment becomes the base colour of a material. */
static nt_status make_materials(nt_scene *scene, const ply_header *header, nt_error *error)
{
	if (header->texture_count == 0)
		return NT_OK;
	scene->materials = nt_arena_alloc(&scene->arena, header->texture_count,
		sizeof *scene->materials);
	if (!scene->materials)
		return nt_fail_memory(error);
	for (size_t i = 0; i < header->texture_count; i++) {
		nt_material *material = &scene->materials[i];
		*material = nt_material_default(header->textures[i]);
		material->library = scene->path;
		material->base_color_map = nt_map_of(header->textures[i]);
	}
	scene->material_count = header->texture_count;
	return NT_OK;
}

static nt_status make_scene(nt_scene *scene, nt_error *error)
{
	scene->meshes = nt_arena_alloc(&scene->arena, 1, sizeof *scene->meshes);
	scene->instances = nt_arena_alloc(&scene->arena, 1, sizeof *scene->instances);
	if (!scene->meshes || !scene->instances)
		return nt_fail_memory(error);
	*scene->instances = (nt_instance){.matrix = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0}};
	*scene->meshes = (nt_mesh){.name = "", .gltf_mesh = NT_NONE, .gltf_primitive = NT_NONE,
		.reachable = true};
	scene->instance_count = scene->mesh_count = 1;
	return NT_OK;
}

nt_status nt_ply_open(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	scene->format = NT_FORMAT_PLY;
	ply_source *source = nt_calloc(1, sizeof *source);
	if (!source)
		return nt_fail_memory(error);
	scene->source = source;
	scene->free_source = free_source;

	nt_status status =
		ply_parse_header(&source->header, scene->bytes, scene->byte_count, error);
	if (!status)
		status = find_elements(source, error);
	if (!status)
		status = make_scene(scene, error);
	if (!status)
		status = make_materials(scene, &source->header, error);
	if (!status)
		status = list_left_out(scene, source, error);
	if (!status) {
		report_unused(scene, source);
		status = read_body(scene, scene->meshes, source, options, error);
	}
	if (!status) {
		nt_mesh *mesh = scene->meshes;
		mesh->triangles = source->face || source->strips;
		mesh->has_positions = true;
		mesh->has_normals = mesh->normals != NULL;
		mesh->has_texcoords = mesh->texcoords != NULL;
		mesh->has_tangents = mesh->tangents != NULL;
		mesh->source_vertex_count = mesh->vertex_count;
	}
	return status ? nt_error_in_file(error, scene->path) : NT_OK;
}
