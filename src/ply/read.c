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

#include <math.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "base/hash_index.h"
#include "ply/parts.h"
#include "scene/origin.h"
#include "scene/srgb.h"

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

static const char *const tangent_names[] = {"tx", "ty", "tz", "tw"};

static nt_status find_roles(ply_source *source, nt_error *error)
{
	static const char *const positions[] = {"x", "y", "z"};
	static const char *const normals[] = {"nx", "ny", "nz"};
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
	find_set(vertex, tangent_names, 4, roles->tangent);
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

/* Statements that say nothing, and properties that lack one of their set. */
static void report_unused(nt_scene *scene, const ply_source *source)
{
	const ply_element *vertex = source->vertex;
	nt_place place = nt_line_place(scene->path, source->header.unknown_line);
	if (source->header.unknown_lines)
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, source->header.unknown_lines,
			"lines of the header that are no statements");
	int tangent[3];
	if (source->roles.tangent[0] == PLY_NO_PROPERTY && find_set(vertex, tangent_names, 3, tangent)) {
		place = nt_line_place(scene->path, vertex->properties[tangent[0]].line);
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"properties tx, ty and tz are no tangents without tw");
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

/* Names the properties and elements that a file of another format will not have. */
static void list_left_out(nt_scene *scene, const ply_source *source)
{
	for (size_t e = 0; e < source->header.element_count; e++) {
		const ply_element *element = &source->header.elements[e];
		const bool read = element == source->vertex || element == source->face || element == source->strips;
		for (size_t i = 0; read && i < element->property_count; i++)
			if (!is_used(source, element, (int)i))
				nt_scene_leave_out(scene, element->properties[i].line, 1,
					"%.*s %.*s", NT_CUT(90, element->name),
					NT_CUT(90, element->properties[i].name));
		if (!read && element->count)
			nt_scene_leave_out(scene, element->line, 1, "element %.*s (%zu)", NT_CUT(90, element->name),
				element->count);
	}
}

/* ---- vertices ---- */

/* Allocates an array of `width` floats per row and makes it the column of as many properties. divided: integers become
 * 0 to 1 or -1 to 1. */
static bool add_columns(ply_rows *rows, nt_arena *arena, const int *properties, size_t width, bool divided,
	ply_finiteness other, float **array)
{
	if (properties[0] == PLY_NO_PROPERTY)
		return true;
	*array = nt_arena_alloc(arena, rows->element->count, width * sizeof **array);
	for (size_t i = 0; *array && i < width; i++) {
		if (properties[i] == PLY_NO_PROPERTY)
			continue;
		const ply_type type = rows->element->properties[properties[i]].type;
		rows->columns[properties[i]] = (ply_column){.use = PLY_FLOATS, .floats = *array + i, .stride = width,
			.divisor = divided ? (float)ply_one(type) : 1, .other = other};
	}
	return *array != NULL;
}

/* Rows of normals or texture coordinates that are not finite become zeros. */
static void mend_rows(nt_scene *scene, float *values, size_t width, size_t count, nt_code code)
{
	size_t bad = 0, first = 0;
	for (size_t row = 0; values && row < count; row++) {
		bool sound = true;
		for (size_t k = 0; k < width; k++)
			sound &= isfinite(values[row * width + k]) != 0;
		if (sound)
			continue;
		memset(values + row * width, 0, width * sizeof *values);
		first = bad++ ? first : row;
	}
	if (bad)
		nt_finding_add(&scene->findings, code, NULL, bad, "vertex %zu is the first", first);
}

/* Positions of a mesh must be finite, as in OBJ. Normals and texture coordinates that are not become zeros, with a
 * finding, and colours white, since glTF cannot store NaN. Points are passed through as they are, and so are tangents,
 * which the caller may want to check. */
static nt_status read_vertices(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_cursor *cursor, nt_error *error)
{
	const size_t count = source->vertex->count;
	const ply_roles *roles = &source->roles;
	const bool faces = source->face || source->strips;
	const ply_finiteness other = faces ? PLY_MENDED : PLY_ANY, place = faces ? PLY_REFUSED : PLY_ANY;
	nt_arena *arena = &scene->arena;
	source->vertex_begin = (size_t)(cursor->at - cursor->begin);
	nt_status status = ply_check_count(cursor, source->vertex, error);
	if (status)
		return status;
	ply_rows rows;
	if (!ply_begin_rows(&rows, cursor, source->vertex) ||
		!add_columns(&rows, arena, roles->position, 3, false, place, &mesh->positions) ||
		!add_columns(&rows, arena, roles->normal, 3, false, other, &mesh->normals) ||
		!add_columns(&rows, arena, roles->texcoord, 2, false, other, &mesh->texcoords) ||
		!add_columns(&rows, arena, roles->tangent, 4, false, PLY_ANY, &mesh->tangents) ||
		!add_columns(&rows, arena, roles->color, 4, true, PLY_ANY, &mesh->colors))
		status = nt_fail_memory(error);
	for (size_t i = 0; !status && mesh->colors && roles->color[3] == PLY_NO_PROPERTY && i < count; i++)
		mesh->colors[4 * i + 3] = 1.0f;
	if (!status)
		status = ply_read_rows(&rows, error);
	if (!status && rows.unsound) {
		mend_rows(scene, mesh->normals, 3, count, NT_CODE_MESH_NORMAL_ZERO);
		mend_rows(scene, mesh->texcoords, 2, count, NT_CODE_UV_NOT_FINITE);
	}
	if (!status && mesh->colors)
		nt_linearise(scene, mesh, count);
	mesh->vertex_count = count;
	ply_free_rows(&rows);
	return status;
}

/* ---- the body ---- */

/* Faces of what was read, once positions are what they will be. */
static nt_status make_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_polygons *polygons,
	const nt_origin *origin, ply_cursor *cursor, nt_error *error)
{
	size_t unsound = 0;
	const unsigned char *first = NULL;
	nt_status status = ply_make_faces(scene, mesh, source, polygons, &unsound, &first, error);
	if (!status)
		status = ply_settle_origin(scene, mesh, source, origin, cursor, error);
	if (!status && nt_scene_has_origin(scene))
		status = ply_make_faces(scene, mesh, source, polygons, &unsound, &first, error);
	if (!status && unsound) {
		const nt_place place = ply_place(cursor, first);
		nt_finding_add(&scene->findings, NT_CODE_POLYGON_DEGENERATE, &place, unsound, NULL);
	}
	return status;
}

/* All elements in the order of the file; faces that come before the vertices at the end. */
static nt_status read_body(nt_scene *scene, nt_mesh *mesh, ply_source *source, const nt_read_options *options,
	nt_error *error)
{
	const ply_header *header = &source->header;
	ply_cursor cursor = ply_begin_body(scene, header, nt_thread_count(options->threads));
	ply_polygons polygons = {0};
	bool have_vertices = false, faces_first = false;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < header->element_count; i++) {
		const ply_element *element = &header->elements[i];
		const bool faces = element == source->face || element == source->strips;
		if (faces)
			source->face_begin = (size_t)(cursor.at - cursor.begin);
		if (element == source->vertex)
			status = read_vertices(scene, mesh, source, &cursor, error);
		else if (faces && have_vertices)
			status = ply_read_faces(scene, mesh, source, &polygons, &cursor, error);
		else
			status = ply_skip_element(&cursor, element, error);
		if (faces)
			source->face_end = (size_t)(cursor.at - cursor.begin);
		faces_first |= faces && !have_vertices;
		have_vertices |= element == source->vertex;
	}
	if (!status && header->encoding == PLY_ASCII)
		ply_next_row(&cursor);
	if (!status && cursor.at < cursor.end) {
		nt_place place;
		nt_place_clear(&place);
		place.offset = (uint64_t)(cursor.at - cursor.begin);
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"%zu bytes after the last element", (size_t)(cursor.end - cursor.at));
	}
	if (!status && faces_first) {
		cursor.at = scene->bytes + source->face_begin;
		status = ply_read_faces(scene, mesh, source, &polygons, &cursor, error);
	}
	if (!status && (source->face || source->strips))
		status = make_faces(scene, mesh, source, &polygons, &options->origin, &cursor, error);
	ply_free_polygons(&polygons);
	return status;
}

/* ---- the scene ---- */

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
	if (!status) {
		list_left_out(scene, source);
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
