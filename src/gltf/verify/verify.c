/* SPDX-License-Identifier: MIT */
/*
 * Reading back: see verify.h. Corners are compared, not vertices, so it does not matter how a writer
 * numbers its vertices, or shares them. tinygltf's document is asked for the arrays of one mesh after the other; blocks
 * are decoded, and meshes compared, by several threads.
 */
#include "gltf/verify/verify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "ext/draco.h"
#include "ext/tinygltf.h"
#include "file/path.h"
#include "file/uri.h"
#include "gltf/document.h"
#include "gltf/quantize.h"
#include "scene/morphs.h"

/* ---- finding the files ---- */

typedef struct file_set {
	nt_output *output;
	const char *path; /* of the document */
	nt_file file;     /* the one that was asked for last */
	bool open;
	nt_error failure; /* why a file of this run could not be read: tinygltf says that there is no such file */
} file_set;

static void close_file(file_set *set)
{
	if (set->open)
		nt_file_close(&set->file);
	set->open = false;
}

/* The file that a URI names: one of the output set, or one that was there before. tinygltf takes data URIs that it
 * cannot read for names, and asks for "./name" after "name". */
static bool find_file(void *user, const char *uri, const unsigned char **bytes, size_t *size)
{
	file_set *set = user;
	const char *name = strncmp(uri, "./", 2) == 0 ? uri + 2 : uri;
	if (nt_uri_is_data(name, strlen(name)))
		return false;
	const char *written = NULL;
	nt_buffer path = {0};
	nt_error error;
	nt_path_beside(&path, set->path, uri);
	close_file(set);
	nt_status status = path.failed ? nt_fail_memory(&error)
		: nt_output_written(set->output, path.data, &written, &error);
	if (!status)
		status = nt_file_open_untraced(&set->file, written ? written : path.data, &error);
	set->open = !status;
	if (status && (written || status == NT_ERROR_MEMORY))
		set->failure = error;
	nt_buffer_free(&path);
	*bytes = set->open ? set->file.data : NULL;
	*size = set->open ? set->file.size : 0;
	return set->open;
}

/* ---- comparing ---- */

/* Data of one primitive that is compared. */
typedef struct primitive_view {
	nt_reread_array positions, tangents, indices;
	nt_reread_array *target_tangents; /* [morph_count] of the scene's mesh; NULL: none are compared */
	size_t corner; /* the next one */
	const unsigned char *packed; /* [packed_size] the block of a compressed primitive; NULL: it is not compressed */
	size_t packed_size;
	uint32_t position_id, tangent_id; /* in the block; UINT32_MAX: outside of it */
	nt_draco *block; /* decoded */
	int tangent_bits; /* of its tangents; 0: they are not quantized by Draco */
	nt_verify_tolerance tolerance;
} primitive_view;

static nt_reread_array block_array(const nt_draco_attribute *attribute, size_t count)
{
	const size_t size = nt_component_size(attribute->component_type);
	return (nt_reread_array){.data = attribute->data, .count = count,
		.stride_bytes = size * (size_t)attribute->components, .component_type = attribute->component_type,
		.components = attribute->components, .normalized = attribute->normalized};
}

/* Half a step of the quantization, and what float arithmetic adds. */
static float tolerance_of(const nt_draco_attribute *a, size_t count)
{
	if (a->component_type != NT_GLTF_FLOAT)
		return 1e-6f; /* of what integers are mapped to */
	if (!a->quantization.bits)
		return 0;
	float largest = 0;
	const float *values = a->data;
	for (size_t i = 0; i < count * (size_t)a->components; i++)
		largest = fmaxf(largest, fabsf(values[i]));
	const double steps = (double)(((uint64_t)1 << a->quantization.bits) - 1);
	return (float)(0.501 * a->quantization.range / steps + 1e-6 * largest);
}

static uint32_t block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name)
{
	uint32_t id;
	return nt_reread_block_id(model, mesh, primitive, name, &id) ? id : UINT32_MAX;
}

/* Decodes what a compressed primitive has in its block. */
static nt_status decode_block(primitive_view *view, nt_error *error)
{
	const nt_status status = nt_draco_decode(&view->block, view->packed, view->packed_size, 0, error);
	if (status != NT_OK)
		return status;
	const nt_draco_mesh *decoded = nt_draco_get(view->block);
	const uint32_t ids[] = {view->position_id, view->tangent_id};
	nt_reread_array *const arrays[] = {&view->positions, &view->tangents};
	float *const tolerances[] = {&view->tolerance.position, &view->tolerance.tangent};
	for (size_t i = 0; i < 2; i++) {
		const nt_draco_attribute *found = ids[i] != UINT32_MAX ? nt_draco_find(decoded, ids[i]) : NULL;
		if (!found)
			continue; /* outside of the block */
		*arrays[i] = block_array(found, decoded->point_count);
		*tolerances[i] = tolerance_of(found, decoded->point_count);
		view->tangent_bits = found->quantization.bits; /* they are the last */
	}
	view->indices = (nt_reread_array){.data = (const unsigned char *)decoded->indices,
		.count = decoded->face_count * 3, .stride_bytes = sizeof(uint32_t), .component_type = NT_GLTF_UINT,
		.components = 1};
	return NT_OK;
}

static nt_status open_primitive(nt_reread *model, size_t mesh, size_t primitive,
	primitive_view *view, nt_error *error)
{
	*view = (primitive_view){.position_id = block_id(model, mesh, primitive, "POSITION"),
		.tangent_id = block_id(model, mesh, primitive, "TANGENT")};
	nt_status status =
		nt_reread_attribute(model, mesh, primitive, "POSITION", &view->positions, error);
	if (status == NT_OK)
		status = nt_reread_attribute(model, mesh, primitive, "TANGENT", &view->tangents, error);
	if (status == NT_OK)
		status = nt_reread_attribute(model, mesh, primitive, NULL, &view->indices, error);
	bool has_block = false;
	if (status == NT_OK)
		status = nt_reread_block(model, mesh, primitive, &has_block, &view->packed, &view->packed_size, error);
	if (status == NT_OK && has_block && !view->packed)
		status = nt_fail(error, NT_ERROR_INPUT, "the compressed block is not inside of a buffer");
	return status;
}

/* TANGENT of the targets that were solved. */
static nt_status open_targets(nt_reread *model, const nt_mesh *mesh, primitive_view *view, nt_error *error)
{
	if (mesh->morph_count == 0)
		return NT_OK;
	view->target_tangents = nt_calloc(mesh->morph_count, sizeof *view->target_tangents);
	nt_status status = view->target_tangents ? NT_OK : nt_fail_memory(error);
	for (size_t m = 0; m < mesh->morph_count && status == NT_OK; m++)
		status = nt_reread_target(model, mesh->gltf_mesh, mesh->gltf_primitive, mesh->morphs[m].target,
			"TANGENT", &view->target_tangents[m], error);
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
	case NT_GLTF_UBYTE:
		return *at;
	case NT_GLTF_USHORT:
		memcpy(&half, at, sizeof half);
		return half;
	default:
		memcpy(&word, at, sizeof word);
		return word;
	}
}

/* Element of a float array; NULL when there is none. */
static const unsigned char *element_at(const nt_reread_array *array, size_t vertex)
{
	return vertex < array->count ? array->data + vertex * array->stride_bytes : NULL;
}

/* How a vertex holds its tangent; of an unknown filter the bits are 0. */
static nt_tangent_filter filter_of(const nt_reread_array *array, size_t vertex)
{
	nt_tangent_filter filter = {.filter = array->filter,
		.precision = array->component_type == NT_GLTF_SHORT ? NT_PRECISION_SHORT
			: array->component_type == NT_GLTF_BYTE ? NT_PRECISION_BYTE : NT_PRECISION_FLOAT};
	if (array->filter)
		filter.bits = nt_filter_bits(array->filter, array->unfiltered + vertex * array->stride_bytes, 1,
			array->stride_bytes, array->component_type, 4);
	return filter;
}

/* Whether a vertex holds a tangent: as it is, or rounded to the integers that it is stored as, by a filter too. */
static bool tangent_matches(const nt_reread_array *array, size_t vertex, const float *tangent, float rounded[4])
{
	const unsigned char *element = element_at(array, vertex);
	if (!element)
		return false;
	const nt_tangent_filter filter = filter_of(array, vertex);
	const size_t size = nt_precision_bytes(filter.precision);
	unsigned char stored[4 * sizeof *rounded], values[4 * sizeof *rounded];
	memcpy(rounded, tangent, 4 * sizeof *rounded);
	return (!array->filter || filter.bits) &&
		nt_tangents_store(&filter, rounded, 1, stored, values, NULL, NULL) == NT_OK &&
		memcmp(element, values, size) == 0;
}

/* Whether a vertex of a target says what leads from its stored tangent to the target's. */
static bool target_matches(const nt_reread_array *array, size_t vertex, const float *moved, const float *stored,
	float least)
{
	const unsigned char *element = element_at(array, vertex);
	uint32_t type = (uint32_t)array->component_type;
	float delta[3];
	if (!element || array->components != 3 || (type != NT_GLTF_FLOAT && !array->normalized))
		return false;
	nt_morph_deltas(moved, stored, 1, least, &type, delta);
	for (size_t k = 0; k < 3; k++)
		if (nt_component_value(element + k * nt_component_size(array->component_type),
			array->component_type, array->normalized) != delta[k])
			return false;
	return true;
}

/* The scene's vertex of a corner, copies behind the others; *source: the one it is a copy of, or itself. */
static size_t split_vertex(const nt_mesh *mesh, size_t corner, size_t *source)
{
	const uint32_t *vertices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	const size_t split = vertices ? vertices[corner] : corner;
	*source = split < mesh->vertex_count ? split : mesh->split.sources[split - mesh->vertex_count];
	return split;
}

/* A corner of the document's primitive, at `place`, against the scene's. Arrays that are not float are decoded by the
 * reader of the source, so that positions of other types are not compared. */
static bool corner_matches(const nt_mesh *mesh, size_t corner, const primitive_view *view, size_t place)
{
	if (place >= corner_count(view))
		return false;
	size_t source;
	const size_t split = split_vertex(mesh, corner, &source);
	const size_t vertex = vertex_at(view, place);
	const unsigned char *position = element_at(&view->positions, vertex);
	if (!position || (view->positions.component_type == NT_GLTF_FLOAT &&
				 memcmp(position, mesh->positions + 3 * source, 12) != 0))
		return false;
	if (!mesh->split.vertex_tangents || !mesh->normals)
		return true;
	float stored[4];
	return tangent_matches(&view->tangents, vertex, mesh->split.vertex_tangents + 4 * split, stored);
}

static nt_status fail_corner(const nt_mesh *mesh, size_t corner, nt_error *error)
{
	nt_fail(error, NT_ERROR_INTERNAL,
		"the output, read back, differs from what was written at corner %zu of mesh \"%s\"",
		corner, mesh->name ? mesh->name : "");
	nt_mesh_place(mesh, &error->place);
	return NT_ERROR_INTERNAL;
}

/* How many corners of a triangle match the document's at `place`, its first one after `turn` others. */
static unsigned match_triangle(const nt_mesh *mesh, const size_t corners[3], const primitive_view *view, size_t place,
	unsigned turn)
{
	unsigned k = 0;
	while (k < 3 && corner_matches(mesh, corners[k], view, place + (k + turn) % 3))
		k++;
	return k;
}

/* By how many corners the document's triangle is turned; 3: it is another one. */
static unsigned find_turn(const nt_mesh *mesh, const size_t corners[3], const primitive_view *view, size_t place)
{
	unsigned turn = 0;
	while (turn < 3 && match_triangle(mesh, corners, view, place, turn) < 3)
		turn = view->indices.turned ? turn + 1 : 3;
	return turn;
}

/* Faces of the scene's mesh against the primitives it became, views[p] for primitive p. */
static nt_status compare_mesh(const nt_mesh *mesh, primitive_view *views, nt_error *error)
{
	static const unsigned char cut[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
	size_t corner = 0;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		const int diagonal = size == 4 && mesh->face_diagonals ? mesh->face_diagonals[f] : 0;
		const bool several = mesh->primitive_count > 1 && mesh->face_primitive;
		primitive_view *view = &views[several ? mesh->face_primitive[f] : 0];
		for (size_t k = 0; k < (size == 4 ? 6u : 3u); k += 3, view->corner += 3) {
			const unsigned char *of = cut[diagonal] + k;
			const size_t corners[3] = {corner + of[0], corner + of[1], corner + of[2]};
			if (find_turn(mesh, corners, view, view->corner) < 3)
				continue;
			return fail_corner(mesh, corners[match_triangle(mesh, corners, view, view->corner, 0)], error);
		}
		corner += size;
	}
	return NT_OK;
}

/* The base's tangent of a corner as a client has it; its vertex was seen to be there. */
static void stored_tangent(const nt_mesh *mesh, const primitive_view *view, size_t corner, size_t vertex,
	float tangent[4])
{
	size_t source;
	const size_t split = split_vertex(mesh, corner, &source);
	if (view->block)
		memcpy(tangent, element_at(&view->tangents, vertex), 4 * sizeof *tangent);
	else
		tangent_matches(&view->tangents, vertex, mesh->split.vertex_tangents + 4 * split, tangent);
}

/* Attributes outside of a block go by its vertices, so that they are in order. */
static nt_status compare_targets(const nt_mesh *mesh, const primitive_view *view, nt_error *error)
{
	if (!view->target_tangents || !mesh->split.vertex_tangents || !mesh->normals)
		return NT_OK;
	float *moved = nt_alloc(mesh->vertex_count + mesh->split.source_count, 3 * sizeof *moved);
	nt_status status = moved ? NT_OK : nt_fail_memory(error);
	for (size_t m = 0; m < mesh->morph_count && status == NT_OK; m++) {
		if (nt_morph_read(mesh, m, moved) != NT_OK)
			status = nt_fail_memory(error);
		size_t turn = 0;
		for (size_t c = 0; c < mesh->corner_count && status == NT_OK; c++) {
			size_t source;
			float stored[4];
			if (c % 3 == 0 && view->indices.turned)
				turn = find_turn(mesh, (const size_t[]){c, c + 1, c + 2}, view, c);
			const size_t split = split_vertex(mesh, c, &source);
			const size_t vertex = vertex_at(view, c - c % 3 + (c % 3 + turn) % 3);
			const nt_tangent_filter filter = filter_of(&view->tangents, vertex);
			const float least = view->tangent_bits ? nt_morph_least_of_bits(view->tangent_bits)
							       : nt_tangent_filter_least(&filter);
			stored_tangent(mesh, view, c, vertex, stored);
			if (!target_matches(&view->target_tangents[m], vertex, moved + 3 * split, stored, least))
				status = fail_corner(mesh, c, error);
		}
	}
	free(moved);
	return status;
}

/* ---- compressed primitives ---- */

/* A corner as the scene has it. */
static nt_verify_vertex wanted_corner(const nt_mesh *mesh, size_t corner)
{
	size_t source;
	const size_t split = split_vertex(mesh, corner, &source);
	nt_verify_vertex result;
	memcpy(result.position, mesh->positions + 3 * source, sizeof result.position);
	memcpy(result.tangent, mesh->split.vertex_tangents + 4 * split, sizeof result.tangent);
	return result;
}

/* The same as the document has it. */
static bool found_corner(const primitive_view *view, size_t corner, nt_verify_vertex *found)
{
	const size_t vertex = vertex_at(view, corner);
	const unsigned char *position = element_at(&view->positions, vertex);
	const unsigned char *tangent = element_at(&view->tangents, vertex);
	if (!position || !tangent || view->positions.components != 3 ||
		view->tangents.component_type != NT_GLTF_FLOAT || view->tangents.components != 4)
		return false;
	const nt_reread_array *array = &view->positions;
	const size_t step = nt_component_size(array->component_type);
	for (size_t k = 0; k < 3; k++)
		found->position[k] = nt_component_value(position + k * step, array->component_type, array->normalized);
	memcpy(found->tangent, tangent, sizeof found->tangent);
	return true;
}

/* Takes out the triangles of which two corners are at one position, as edgebreaker does; returns how many corners are
 * left. */
static size_t drop_degenerate(nt_verify_vertex *corners, size_t count)
{
	size_t kept = 0;
	for (size_t c = 0; c < count; c += 3) {
		const float *a = corners[c].position, *b = corners[c + 1].position, *d = corners[c + 2].position;
		if (memcmp(a, b, 3 * sizeof *a) == 0 || memcmp(b, d, 3 * sizeof *a) == 0 ||
			memcmp(d, a, 3 * sizeof *a) == 0)
			continue;
		memmove(&corners[kept], &corners[c], 3 * sizeof *corners);
		kept += 3;
	}
	return kept;
}

/* The sequential method keeps corners where they are; if they are elsewhere, their vertices have to be the same. */
static nt_status compare_block(const nt_mesh *mesh, const primitive_view *view, nt_error *error)
{
	size_t count = mesh->corner_count;
	nt_verify_vertex *wanted = nt_alloc(count, sizeof *wanted), *found = nt_alloc(count, sizeof *found);
	nt_status status = wanted && found ? NT_OK : nt_fail_memory(error);
	bool ordered = true;
	for (size_t c = 0; c < count && status == NT_OK; c++)
		wanted[c] = wanted_corner(mesh, c);
	if (status == NT_OK && view->indices.count != count && !view->target_tangents)
		count = drop_degenerate(wanted, count);
	if (status == NT_OK && view->indices.count != count)
		status = fail_corner(mesh, 0, error);
	for (size_t c = 0; c < count && status == NT_OK; c++) {
		if (!found_corner(view, c, &found[c]))
			status = fail_corner(mesh, c, error);
		else
			ordered &= nt_verify_close(&wanted[c], &found[c], &view->tolerance);
	}
	size_t first = SIZE_MAX;
	if (status == NT_OK && !ordered &&
		nt_verify_vertices(wanted, count, found, count, &view->tolerance, &first) != NT_OK)
		status = nt_fail_memory(error);
	if (status == NT_OK && first != SIZE_MAX)
		status = fail_corner(mesh, first, error);
	free(wanted);
	free(found);
	return status;
}

static bool counts_match(const nt_mesh *mesh, const primitive_view *view)
{
	bool match = view->tangents.count == view->positions.count;
	for (size_t m = 0; view->target_tangents && m < mesh->morph_count; m++)
		match &= view->target_tangents[m].count == view->positions.count;
	return match;
}

/* ---- all meshes ---- */

/* A mesh of the scene and what the document has of it. */
typedef struct mesh_check {
	const nt_mesh *mesh;
	primitive_view *views; /* [view_count] the primitives that it became */
	size_t view_count;
	uint64_t mode; /* of an edited document's primitive */
	nt_status status;
} mesh_check;

typedef struct verification {
	const nt_scene *scene;
	nt_reread *model;
	bool edited; /* else the document is a new one */
	mesh_check *checks; /* [count] */
	size_t count;
} verification;

static void close_check(mesh_check *check)
{
	for (size_t p = 0; p < check->view_count; p++)
		free(check->views[p].target_tangents);
	free(check->views);
}

/* A mesh of a composed document, or one for each of its groups from *number on, which becomes the next one's: their
 * primitives are those that have faces, in order. */
static nt_status open_composed(const verification *v, mesh_check *check, size_t *number, nt_error *error)
{
	const nt_mesh *mesh = check->mesh;
	const size_t count = check->view_count;
	size_t *faces = nt_calloc(count, sizeof *faces);
	nt_status status = faces ? NT_OK : nt_fail_memory(error);
	for (size_t f = 0; f < mesh->face_count && status == NT_OK; f++)
		faces[count > 1 && mesh->face_primitive ? mesh->face_primitive[f] : 0]++;
	size_t primitive = 0;
	uint32_t group = 0;
	for (size_t p = 0; p < count && status == NT_OK; p++) {
		if (!faces[p])
			continue;
		if (primitive && mesh->primitives[p].group != group) {
			++*number;
			primitive = 0;
		}
		group = mesh->primitive_count ? mesh->primitives[p].group : 0;
		status = open_primitive(v->model, *number, primitive++, &check->views[p], error);
	}
	++*number;
	free(faces);
	return status;
}

/* A mesh of an edited document stands where it stood. */
static nt_status open_edited(const verification *v, mesh_check *check, nt_error *error)
{
	const nt_mesh *mesh = check->mesh;
	const nt_gltf *document = v->scene->source;
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	check->mode = nt_gltf_mode(primitive);
	const nt_status status = open_primitive(v->model, mesh->gltf_mesh, mesh->gltf_primitive, check->views, error);
	return status == NT_OK ? open_targets(v->model, mesh, check->views, error) : status;
}

/* Looks up what the document has of each mesh, in order, as far as that goes. */
static nt_status open_checks(verification *v, nt_error *error)
{
	size_t number = 0;
	nt_status status = NT_OK;
	for (size_t m = 0; m < v->scene->mesh_count && status == NT_OK; m++) {
		const nt_mesh *mesh = &v->scene->meshes[m];
		const bool solved = mesh->split.vertex_tangents && nt_mesh_gets_tangents(mesh);
		if (v->edited ? !solved : !mesh->face_count)
			continue;
		mesh_check *check = &v->checks[v->count];
		*check = (mesh_check){.mesh = mesh,
			.view_count = !v->edited && mesh->primitive_count ? mesh->primitive_count : 1};
		check->views = nt_calloc(check->view_count, sizeof *check->views);
		if (!check->views)
			return nt_fail_memory(error);
		status = v->edited ? open_edited(v, check, error) : open_composed(v, check, &number, error);
		if (status == NT_OK)
			v->count++;
		else
			close_check(check);
	}
	return status;
}

/* Strips and fans keep their own indices: there only the number of tangents is checked. */
static nt_status compare_edited(const mesh_check *check, nt_error *error)
{
	primitive_view *view = check->views;
	nt_status status;
	if (!view->packed && check->mode == NT_GLTF_TRIANGLES && corner_count(view) == check->mesh->corner_count) {
		status = compare_mesh(check->mesh, view, error);
		return status ? status : compare_targets(check->mesh, view, error);
	}
	if (!view->packed)
		return counts_match(check->mesh, view) ? NT_OK : fail_corner(check->mesh, 0, error);
	status = decode_block(view, error);
	if (status == NT_OK)
		status = compare_block(check->mesh, view, error);
	if (status == NT_OK)
		status = compare_targets(check->mesh, view, error);
	nt_draco_free(view->block);
	view->block = NULL;
	return status;
}

static nt_status compare_check(const verification *v, const mesh_check *check, nt_error *error)
{
	for (size_t p = 0; p < check->view_count; p++)
		check->views[p].corner = 0;
	return v->edited ? compare_edited(check, error) : compare_mesh(check->mesh, check->views, error);
}

static void compare_one(void *context, size_t item, unsigned thread)
{
	verification *v = context;
	nt_error ignored;
	(void)thread;
	v->checks[item].status = compare_check(v, &v->checks[item], &ignored);
}

/* A mesh that failed is compared again, alone, to say where it differs: the first of them that does. */
static nt_status compare_all(verification *v, unsigned threads, nt_error *error)
{
	nt_parallel_items(threads, v->count, compare_one, v);
	nt_status status = NT_OK;
	for (size_t i = 0; i < v->count && status == NT_OK; i++)
		if (v->checks[i].status != NT_OK)
			status = compare_check(v, &v->checks[i], error);
	return status;
}

static nt_status compare_scene(const nt_scene *scene, nt_reread *model, unsigned threads, nt_error *error)
{
	verification v = {.scene = scene, .model = model,
		.edited = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB,
		.checks = nt_calloc(scene->mesh_count, sizeof *v.checks)};
	if (!v.checks)
		return nt_fail_memory(error);
	const nt_status opened = open_checks(&v, error);
	nt_status status = compare_all(&v, nt_thread_count(threads), error);
	if (status == NT_OK)
		status = opened;
	for (size_t i = 0; i < v.count; i++)
		close_check(&v.checks[i]);
	free(v.checks);
	return status == NT_ERROR_INPUT ? error->status = NT_ERROR_INTERNAL : status;
}

nt_status nt_verify_gltf(nt_scene *scene, nt_output *output, const char *path, unsigned threads,
	nt_error *error)
{
	const char *written;
	nt_file file;
	nt_reread *model = NULL;
	nt_status status = nt_output_written(output, path, &written, error);
	if (status != NT_OK || !written)
		return status;
	status = nt_file_open_untraced(&file, written, error);
	if (status != NT_OK)
		return status;
	nt_error refusal;
	nt_error_clear(&refusal);
	file_set set = {.output = output, .path = path};
	status = nt_reread_open(&model, file.data, file.size, find_file, &set, &refusal);
	close_file(&set);
	if (set.failure.status) {
		refusal = set.failure;
		status = refusal.status;
	}
	if (status == NT_OK)
		status = compare_scene(scene, model, threads, error);
	else if (status != NT_ERROR_INPUT)
		*error = refusal;
	if (status == NT_ERROR_INPUT) {
		nt_finding_add(&scene->findings, NT_CODE_NOT_VERIFIED, NULL, 1, "%s", refusal.message);
		status = NT_OK;
	}
	nt_reread_free(model);
	nt_file_close(&file);
	return status == NT_OK ? status : nt_error_in_file(error, path);
}
