/* SPDX-License-Identifier: MIT */
/*
 * Reading back: see verify.h. Corners are compared, not vertices, so it does not matter how a writer
 * numbers its vertices, or shares them.
 */
#include "io/verify.h"

#include <stdlib.h>
#include <string.h>
#include "ext/tinygltf.h"
#include "io/gltf_precision.h"
#include "io/link.h"

/* ---- finding the files ---- */

enum { COMPANION_LIMIT = 64 };

typedef struct companion {
	char *uri;
	nt_file file;
} companion;

typedef struct file_set {
	nt_output *output;
	const char *path; /* of the document */
	companion items[COMPANION_LIMIT];
	size_t count;
	nt_error *error;
} file_set;

/* The file that a URI names: one of the output set, or one that was there before. */
static bool open_companion(file_set *set, const char *uri, nt_file *file)
{
	const char *slash = strrchr(set->path, '/');
	nt_buffer path = {0};
	nt_buffer_append(&path, set->path, slash ? (size_t)(slash - set->path) + 1 : 0);
	nt_buffer_text(&path, uri);
	nmtan_status status = path.failed ? nt_fail_memory(set->error) : NMTAN_OK;
	const char *written = NULL;
	if (status == NMTAN_OK)
		status = nt_output_written(set->output, path.data, &written, set->error);
	if (status == NMTAN_OK)
		status = nt_file_open(file, written ? written : path.data, set->error);
	nt_buffer_free(&path);
	return status == NMTAN_OK;
}

/* tinygltf asks for a file several times. Images are not its business. */
static bool find_companion(void *user, const char *uri, const unsigned char **bytes, size_t *size)
{
	file_set *set = user;
	for (size_t i = 0; i < set->count; i++)
		if (strcmp(set->items[i].uri, uri) == 0) {
			*bytes = set->items[i].file.data;
			*size = set->items[i].file.size;
			return true;
		}
	if (set->count == COMPANION_LIMIT)
		return false;
	companion *item = &set->items[set->count];
	item->uri = strdup(uri);
	if (!item->uri || !open_companion(set, uri, &item->file)) {
		free(item->uri);
		return false;
	}
	set->count++;
	*bytes = item->file.data;
	*size = item->file.size;
	return true;
}

static void close_companions(file_set *set)
{
	for (size_t i = 0; i < set->count; i++) {
		nt_file_close(&set->items[i].file);
		free(set->items[i].uri);
	}
}

/* ---- comparing ---- */

/* What is compared of one primitive. */
typedef struct primitive_view {
	nt_reread_array positions, tangents, indices;
	size_t corner; /* the next one */
} primitive_view;

static nmtan_status open_primitive(const nt_reread *model, size_t mesh, size_t primitive,
	primitive_view *view, nt_error *error)
{
	view->corner = 0;
	nmtan_status status =
		nt_reread_attribute(model, mesh, primitive, "POSITION", &view->positions, error);
	if (status == NMTAN_OK)
		status = nt_reread_attribute(model, mesh, primitive, "TANGENT", &view->tangents, error);
	if (status == NMTAN_OK)
		status = nt_reread_attribute(model, mesh, primitive, NULL, &view->indices, error);
	return status;
}

static size_t corner_count(const primitive_view *view)
{
	return view->indices.data ? view->indices.count : view->positions.count;
}

static size_t vertex_at(const primitive_view *view, size_t corner)
{
	const nt_reread_array *array = &view->indices;
	if (!array->data)
		return corner;
	const unsigned char *at = array->data + corner * array->stride_bytes;
	uint16_t half;
	uint32_t word;
	switch (array->component_type) {
	case NT_GLTF_UNSIGNED_BYTE:
		return *at;
	case NT_GLTF_UNSIGNED_SHORT:
		memcpy(&half, at, sizeof half);
		return half;
	default:
		memcpy(&word, at, sizeof word);
		return word;
	}
}

/* Row of a float array; NULL when there is none. */
static const unsigned char *row_at(const nt_reread_array *array, size_t vertex)
{
	return vertex < array->count ? array->data + vertex * array->stride_bytes : NULL;
}

/* Whether a row holds a tangent: as it is, or rounded to the integers that it is stored as. */
static bool tangent_matches(const nt_reread_array *array, const unsigned char *row, const float *tangent)
{
	const nt_precision precision = array->component_type == NT_GLTF_SHORT ? NT_PRECISION_SHORT
		: array->component_type == NT_GLTF_BYTE ? NT_PRECISION_BYTE : NT_PRECISION_FLOAT;
	float rounded[4];
	unsigned char bytes[sizeof rounded];
	memcpy(rounded, tangent, sizeof rounded);
	nt_precision_round(precision, rounded, 1, NULL);
	nt_precision_encode(precision, rounded, 1, bytes);
	return memcmp(row, bytes, nt_precision_bytes(precision)) == 0;
}

/* The document's next corner of the primitive against the scene's. Arrays that are not float are decoded by the
 * reader of the source, so that positions of other types are not compared. */
static bool corner_matches(const nt_mesh *mesh, size_t corner, primitive_view *view)
{
	if (view->corner >= corner_count(view))
		return false;
	const uint32_t *vertices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	const size_t split = vertices ? vertices[corner] : corner;
	const size_t source = split < mesh->vertex_count ? split
		: mesh->split.sources[split - mesh->vertex_count];
	const size_t vertex = vertex_at(view, view->corner++);
	const unsigned char *position = row_at(&view->positions, vertex);
	const unsigned char *tangent = row_at(&view->tangents, vertex);
	if (!position || (view->positions.component_type == NT_GLTF_FLOAT &&
				 memcmp(position, mesh->positions + 3 * source, 12) != 0))
		return false;
	return !mesh->split.vertex_tangents || !mesh->normals ||
		(tangent && tangent_matches(&view->tangents, tangent, mesh->split.vertex_tangents + 4 * split));
}

static nmtan_status fail_corner(const nt_mesh *mesh, size_t corner, nt_error *error)
{
	nt_fail(error, NMTAN_ERROR_INTERNAL,
		"the output, read back, differs from what was written at corner %zu of mesh \"%s\"",
		corner, mesh->name ? mesh->name : "");
	error->place = mesh->place;
	return NMTAN_ERROR_INTERNAL;
}

/* Faces of the scene's mesh against the primitives it became, views[p] for primitive p. */
static nmtan_status compare_mesh(const nt_mesh *mesh, primitive_view *views, nt_error *error)
{
	static const unsigned char cut[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
	size_t corner = 0;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		const int diagonal = size == 4 && mesh->face_diagonals ? mesh->face_diagonals[f] : 0;
		const bool several = mesh->primitive_count > 1 && mesh->face_primitive;
		primitive_view *view = &views[several ? mesh->face_primitive[f] : 0];
		for (size_t k = 0; k < (size == 4 ? 6u : 3u); k++)
			if (!corner_matches(mesh, corner + cut[diagonal][k], view))
				return fail_corner(mesh, corner + cut[diagonal][k], error);
		corner += size;
	}
	return NMTAN_OK;
}

/* A mesh of a composed document: its primitives are those that have faces, in order. */
static nmtan_status verify_composed(const nt_reread *model, const nt_mesh *mesh, size_t number,
	nt_error *error)
{
	const size_t count = mesh->primitive_count ? mesh->primitive_count : 1;
	primitive_view *views = nt_calloc(count, sizeof *views);
	size_t *faces = nt_calloc(count, sizeof *faces);
	nmtan_status status = views && faces ? NMTAN_OK : nt_fail_memory(error);
	for (size_t f = 0; f < mesh->face_count && status == NMTAN_OK; f++)
		faces[count > 1 && mesh->face_primitive ? mesh->face_primitive[f] : 0]++;
	size_t primitive = 0;
	for (size_t p = 0; p < count && status == NMTAN_OK; p++)
		if (faces[p])
			status = open_primitive(model, number, primitive++, &views[p], error);
	if (status == NMTAN_OK)
		status = compare_mesh(mesh, views, error);
	free(views);
	free(faces);
	return status;
}

/* A mesh of a patched document stands where it stood. Strips and fans keep their own indices: there only the
 * number of tangents is checked. */
static nmtan_status verify_patched(const nt_reread *model, const nt_mesh *mesh, nt_error *error)
{
	primitive_view view;
	const nmtan_status status =
		open_primitive(model, mesh->gltf_mesh, mesh->gltf_primitive, &view, error);
	if (status != NMTAN_OK || !mesh->split.vertex_tangents)
		return status;
	if (corner_count(&view) == mesh->corner_count)
		return compare_mesh(mesh, &view, error);
	return view.tangents.count == view.positions.count ? NMTAN_OK : fail_corner(mesh, 0, error);
}

static nmtan_status compare_scene(const nt_scene *scene, const nt_reread *model, nt_error *error)
{
	size_t number = 0;
	for (size_t m = 0; m < scene->mesh_count; m++) {
		const nt_mesh *mesh = &scene->meshes[m];
		const bool patched = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB;
		nmtan_status status = NMTAN_OK;
		if (patched)
			status = mesh->split.vertex_tangents ? verify_patched(model, mesh, error) : NMTAN_OK;
		else if (mesh->face_count)
			status = verify_composed(model, mesh, number++, error);
		if (status != NMTAN_OK)
			return status == NMTAN_ERROR_INPUT ? error->status = NMTAN_ERROR_INTERNAL : status;
	}
	return NMTAN_OK;
}

nmtan_status nt_verify_gltf(const nt_scene *scene, nt_output *output, const char *path,
	nt_error *error)
{
	const char *written;
	nt_file file;
	nt_reread *model = NULL;
	nmtan_status status = nt_output_written(output, path, &written, error);
	if (status != NMTAN_OK || !written)
		return status;
	status = nt_file_open(&file, written, error);
	if (status != NMTAN_OK)
		return status;
	nt_error ignored;
	file_set set = {.output = output, .path = path, .error = &ignored};
	status = nt_reread_open(&model, file.data, file.size, find_companion, &set, error);
	if (status == NMTAN_ERROR_INPUT)
		status = error->status = NMTAN_ERROR_INTERNAL;
	if (status == NMTAN_OK)
		status = compare_scene(scene, model, error);
	nt_reread_free(model);
	close_companions(&set);
	nt_file_close(&file);
	return status == NMTAN_OK ? status : nt_error_in_file(error, path);
}
