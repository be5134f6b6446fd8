/* SPDX-License-Identifier: MIT */
/*
 * PLY, the Stanford polygon format (G. Turk, 1994), read by one pass over the mapped file: the header
 * says which elements follow and what their rows hold; vertices and faces become columns, everything else
 * is passed over and kept for the writer where it lies. The mesh is made of the columns once all of them are there:
 * faces may come before vertices.
 *
 * Nothing the header says is trusted: each count is held against the bytes that are left before
 * anything is allocated, each list before it is read, each index before it is used. An error in an
 * ASCII body has its line, in a binary body its byte offset.
 */
#include "ply/ply.h"

#include <math.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "ply/parts.h"
#include "scene/values.h"

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

/* Names of vertex properties: the first set of a role all of which are there as scalars is it. */
static const struct {
	ply_role role;
	const char *names[4];
} sets[] = {
	{PLY_POSITION, {"x", "y", "z"}},
	{PLY_NORMAL, {"nx", "ny", "nz"}},
	{PLY_TEXCOORD, {"s", "t"}},
	{PLY_TEXCOORD, {"u", "v"}},
	{PLY_TEXCOORD, {"texture_u", "texture_v"}},
	{PLY_TEXCOORD, {"texcoord_u", "texcoord_v"}},
	{PLY_TEXCOORD, {"texture_s", "texture_t"}},
	{PLY_TEXCOORD, {"tu", "tv"}},
	{PLY_TEXCOORD, {"texcoord_0", "texcoord_1"}},
	{PLY_COLOR, {"red", "green", "blue", "alpha"}},
	{PLY_COLOR, {"red", "green", "blue"}},
	{PLY_COLOR, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
	{PLY_TANGENT, {"tx", "ty", "tz", "tw"}},
};

static nt_status find_roles(ply_source *source, nt_error *error)
{
	const ply_element *vertex = source->vertex;
	memset(source->roles, PLY_NO_PROPERTY, sizeof source->roles);
	for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
		int *const role = source->roles[sets[i].role], found[4] = {0};
		bool all = role[0] == PLY_NO_PROPERTY;
		for (int k = 0; k < 4; k++) {
			found[k] = sets[i].names[k] ? ply_find_property(vertex, sets[i].names[k]) : PLY_NO_PROPERTY;
			all &= !sets[i].names[k] || (found[k] >= 0 && !vertex->properties[found[k]].list);
		}
		for (int k = 0; all && k < 4; k++) {
			role[k] = found[k];
			if (found[k] >= 0)
				vertex->properties[found[k]].used = true;
		}
	}
	return source->roles[PLY_POSITION][0] >= 0 ? NT_OK : nt_fail_line(error, NT_ERROR_INPUT, vertex->line,
		"element \"vertex\" has no properties x, y and z");
}

/* The list of vertex numbers of faces or strips. */
static nt_status find_indices(ply_source *source, ply_element *element, nt_error *error)
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
	source->face_texcoords = source->strips ? PLY_NO_PROPERTY : ply_find_property(element, "texcoord");
	if (source->face_texcoords >= 0 && !element->properties[source->face_texcoords].list)
		source->face_texcoords = PLY_NO_PROPERTY;
	element->properties[found].used = true;
	if (source->face_texcoords >= 0)
		element->properties[source->face_texcoords].used = true;
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
	ply_element *face = ply_find_element(header, "face");
	ply_element *strips = ply_find_element(header, "tristrips");
	if (!status && face && face->count) {
		source->face = face;
		status = find_indices(source, face, error);
	} else if (!status && strips && strips->count) {
		source->strips = strips;
		status = find_indices(source, strips, error);
	}
	return status;
}

/* Names the properties and elements that a file of another format will not have, and what says nothing: statements,
 * and tangents without w. */
static void tell_unused(nt_scene *scene, const ply_source *source)
{
	const ply_header *header = &source->header;
	for (size_t e = 0; e < header->element_count; e++) {
		const ply_element *element = &header->elements[e];
		const bool read = element == source->vertex || element == source->face || element == source->strips;
		for (size_t i = 0; read && i < element->property_count; i++)
			if (!element->properties[i].used)
				nt_scene_leave_out(scene, element->properties[i].line, 1, "%.*s %.*s",
					NT_CUT(90, element->name), NT_CUT(90, element->properties[i].name));
		if (!read && element->count)
			nt_scene_leave_out(scene, element->line, 1, "element %.*s (%zu)", NT_CUT(90, element->name),
				element->count);
	}
	nt_place place = nt_line_place(scene->path, header->unknown_line);
	if (header->unknown_lines)
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, header->unknown_lines,
			"lines of the header that are no statements");
	bool three = source->roles[PLY_TANGENT][0] == PLY_NO_PROPERTY;
	for (int k = 2; k >= 0; k--) {
		const int found = ply_find_property(source->vertex, (const char *[]){"tx", "ty", "tz"}[k]);
		three = three && found >= 0 && !source->vertex->properties[found].list;
		place.line = three ? source->vertex->properties[found].line : 0;
	}
	if (three)
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"properties tx, ty and tz are no tangents without tw");
}

/* ---- vertices ---- */

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
 * which the caller may want to check. Integers become 0 to 1 as colours. */
static nt_status read_vertices(nt_scene *scene, nt_mesh *mesh, const ply_source *source, ply_rows *rows)
{
	const size_t count = source->vertex->count;
	const bool faces = source->face || source->strips;
	const struct {
		float **array;
		size_t width;
		ply_finiteness other;
	} roles[PLY_ROLES] = {
		[PLY_POSITION] = {&mesh->positions, 3, faces ? PLY_REFUSED : PLY_ANY},
		[PLY_NORMAL] = {&mesh->normals, 3, faces ? PLY_MENDED : PLY_ANY},
		[PLY_TEXCOORD] = {&mesh->texcoords, 2, faces ? PLY_MENDED : PLY_ANY},
		[PLY_COLOR] = {&mesh->colors, 4, PLY_ANY},
		[PLY_TANGENT] = {&mesh->tangents, 4, PLY_ANY},
	};
	for (int r = 0; r < PLY_ROLES; r++) {
		const int *properties = source->roles[r];
		const size_t width = roles[r].width;
		if (properties[0] == PLY_NO_PROPERTY)
			continue;
		*roles[r].array = nt_arena_alloc(&scene->arena, count, width * sizeof(float));
		if (!*roles[r].array)
			return nt_fail_memory(rows->error);
		for (size_t k = 0; k < width && properties[k] >= 0; k++)
			rows->columns[properties[k]] = (ply_column){.use = PLY_FLOATS, .floats = *roles[r].array + k,
				.stride = width, .other = roles[r].other, .divisor = r == PLY_COLOR
				? (float)ply_one(source->vertex->properties[properties[k]].type) : 1};
	}
	for (size_t i = 0; mesh->colors && source->roles[PLY_COLOR][3] == PLY_NO_PROPERTY && i < count; i++)
		mesh->colors[4 * i + 3] = 1.0f;
	const nt_status status = ply_read_rows(rows);
	if (!status && rows->unsound) {
		mend_rows(scene, mesh->normals, 3, count, NT_CODE_MESH_NORMAL_ZERO);
		mend_rows(scene, mesh->texcoords, 2, count, NT_CODE_UV_NOT_FINITE);
	}
	if (!status && mesh->colors)
		nt_linearise(scene, mesh, count);
	mesh->vertex_count = count;
	return status;
}

/* ---- the body ---- */

/* All elements in the order of the file. */
static nt_status read_body(nt_scene *scene, nt_mesh *mesh, ply_source *source, const nt_read_options *options,
	nt_error *error)
{
	const ply_header *header = &source->header;
	ply_faces faces = {.scene = scene, .mesh = mesh, .source = source};
	const unsigned char *at = header->bytes + header->body, *const end = header->bytes + header->size;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < header->element_count; i++) {
		ply_element *element = &header->elements[i];
		const bool is_faces = element == source->face || element == source->strips;
		element->rows.begin = (size_t)(at - header->bytes);
		ply_rows own, *rows = is_faces ? &faces.rows : &own;
		status = ply_begin_rows(rows, header, element, at, error);
		rows->threads = nt_thread_count(options->threads);
		if (!status)
			status = is_faces ? ply_read_faces(&faces)
				: element == source->vertex ? read_vertices(scene, mesh, source, rows)
				: ply_skip_rows(rows);
		at = rows->at;
		element->rows.end = (size_t)(at - header->bytes);
		if (!is_faces)
			ply_free_rows(rows);
	}
	while (header->encoding == PLY_ASCII && at < end && ply_is_space(*at))
		at++;
	if (!status && at < end) {
		nt_place place;
		nt_place_clear(&place);
		place.offset = (uint64_t)(at - header->bytes);
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"%zu bytes after the last element", (size_t)(end - at));
	}
	if (!status && (source->face || source->strips))
		status = ply_make_faces(&faces, &options->origin);
	ply_free_faces(&faces);
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
		tell_unused(scene, source);
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
