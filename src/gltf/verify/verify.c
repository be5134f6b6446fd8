/* SPDX-License-Identifier: MIT */
/*
 * Reading back: see verify.h. Corners are compared, not vertices, so it does not matter how a writer
 * numbers its vertices, or shares them. Meshes are loaded and compared by several threads, each mesh by one.
 */
#include "gltf/verify/verify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "ext/tinygltf.h"
#include "file/input.h"
#include "file/path.h"
#include "gltf/load.h"
#include "gltf/quantize.h"
#include "scene/values.h"

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
		status = nt_file_open(&set->file, written ? written : path.data, NT_NAMED_BY_US, &error);
	set->open = !status;
	if (status && (written || status == NT_ERROR_MEMORY))
		set->failure = error;
	nt_buffer_free(&path);
	*bytes = set->open ? set->file.data : NULL;
	*size = set->open ? set->file.size : 0;
	return set->open;
}

/* ---- comparing ---- */

/* A primitive as it is read back. */
typedef struct part {
	nt_mesh mesh;
	size_t corner; /* the next one */
	nt_tangent_filter filter; /* of its tangents; bits 0: none */
	float least;   /* nt_morph_deltas() */
	bool packed;   /* a block of Draco */
	float tolerance; /* how far its tangents may be from those they were made of; 0: they are the same */
} part;

/* A mesh of the scene and the primitives that it became. */
typedef struct mesh_check {
	const nt_mesh *mesh;
	size_t first;      /* of them, in the order of the document */
	size_t part_count; /* of the scene's; those without faces are not in the document */
	nt_status status;
} mesh_check;

typedef struct verification {
	const nt_scene *scene;
	const nt_write_options *options;
	nt_scene found; /* read back */
	bool edited;    /* else the document is a new one */
	mesh_check *checks; /* [count] */
	size_t count;
} verification;

static const nt_read_options reading = {.texcoord_set = -1, .outside = NT_OUTSIDE_YES, .morphs = NT_MORPH_KEEP,
	.threads = 1};

/* How the tangents of a part are stored, and what that may do to them. */
static nt_status find_tolerance(nt_gltf *document, part *p, nt_error *error)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(document, &p->mesh);
	const nt_gltf_accessor *a = nt_gltf_named(document, nt_json_find(primitive, "attributes"), "TANGENT");
	const nt_draco_quantization *grid = nt_gltf_draco_tangents_of(document, primitive);
	nt_gltf_packing packing = {.extension = NULL};
	unsigned char *bytes = NULL;
	nt_status status = NT_OK;
	p->packed = nt_gltf_draco_of(primitive) != NULL;
	p->filter.precision = !a ? NT_PRECISION_FLOAT : a->component_type == NT_GLTF_SHORT ? NT_PRECISION_SHORT :
		a->component_type == NT_GLTF_BYTE ? NT_PRECISION_BYTE : NT_PRECISION_FLOAT;
	if (a && a->view != NT_NONE)
		status = nt_gltf_get_packing(document, a->view, &packing, error);
	if (!status && packing.extension && strcmp(packing.view.filter, "NONE") != 0) {
		status = nt_gltf_unfiltered_view(document, a->view, &bytes, error);
		p->filter.filter = packing.view.filter;
		if (!status)
			p->filter.bits = nt_filter_bits(packing.view.filter, bytes + a->offset, (size_t)a->count,
				a->stride, (int)a->component_type, 4);
		free(bytes);
		p->tolerance = nt_tangent_filter_least(&p->filter);
	} else if (p->filter.precision != NT_PRECISION_FLOAT) {
		p->tolerance = 1e-6f; /* they are rounded as the writer does */
	}
	p->least = grid && grid->bits ? nt_morph_least_of_bits(grid->bits) : nt_tangent_filter_least(&p->filter);
	return status;
}

/* A mesh of the document, in the scene's arena. */
static nt_status read_part(nt_scene *found, size_t number, part *p, nt_error *error)
{
	if (number >= found->mesh_count)
		return nt_fail(error, NT_ERROR_INTERNAL, "the output, read back, has %zu primitives, expected more",
			found->mesh_count);
	p->mesh = found->meshes[number];
	const nt_status status = nt_gltf_load(found, &p->mesh, &reading, error);
	return status ? status : find_tolerance(found->source, p, error);
}

/* The scene's vertex of a corner, copies behind the others; *source: the one it is a copy of, or itself. */
static size_t split_vertex(const nt_mesh *mesh, size_t corner, size_t *source)
{
	const uint32_t *vertices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	const size_t split = vertices ? vertices[corner] : corner;
	*source = split < mesh->vertex_count ? split : mesh->split.sources[split - mesh->vertex_count];
	return split;
}

static bool has_tangents(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents && mesh->normals;
}

static size_t vertex_at(const part *p, size_t corner)
{
	return p->mesh.indices ? p->mesh.indices[corner] : corner;
}

/* Values that are not finite have to be the same. */
static bool within(const float *a, const float *b, size_t count, float tolerance)
{
	for (size_t i = 0; i < count; i++)
		if (!(fabsf(a[i] - b[i]) <= tolerance) && !(isnan(a[i]) && isnan(b[i])) && a[i] != b[i])
			return false;
	return true;
}

/* A tangent as it was to be written against one that was read. */
static bool tangent_matches(const float *wanted, const float *found, const part *p)
{
	float rounded[4];
	if (!p->tolerance)
		return memcmp(wanted, found, sizeof rounded) == 0;
	memcpy(rounded, wanted, sizeof rounded);
	if (!p->filter.filter)
		nt_precision_round(p->filter.precision, rounded, 1, NULL);
	/* a client takes w of 1 and -1 alone */
	return within(rounded, found, 4, p->tolerance) &&
		(rounded[3] == found[3] || (fabsf(rounded[3]) != 1 && fabsf(found[3]) != 1));
}

static nt_status fail_in(const nt_mesh *mesh, const char *what, nt_error *error)
{
	nt_fail(error, NT_ERROR_INTERNAL,
		"the output, read back, differs from what was written %s of mesh \"%s\"", what,
		mesh->name ? mesh->name : "");
	nt_mesh_place(mesh, &error->place);
	return NT_ERROR_INTERNAL;
}

static nt_status fail_corner(const nt_mesh *mesh, size_t corner, nt_error *error)
{
	char what[40];
	snprintf(what, sizeof what, "at corner %zu", corner);
	return fail_in(mesh, what, error);
}

/* bad: as nt_verify_block() has it. */
static nt_status fail_block(const nt_mesh *mesh, const char *bad, nt_error *error)
{
	char what[60];
	snprintf(what, sizeof what, "in %.*s", NT_CUT(40, bad));
	return fail_in(mesh, what, error);
}

/* A corner of the primitive, at `place`, against the scene's. */
static bool corner_matches(const nt_mesh *mesh, size_t corner, const part *p, size_t place)
{
	if (place >= p->mesh.corner_count)
		return false;
	const size_t vertex = vertex_at(p, place);
	size_t source;
	const size_t split = split_vertex(mesh, corner, &source);
	const float *position = mesh->positions + 3 * source, *found = p->mesh.positions + 3 * vertex;
	if (memcmp(position, found, 3 * sizeof *found) != 0 && (!p->tolerance || !within(position, found, 3, 0)))
		return false;
	return !has_tangents(mesh) ||
		(p->mesh.tangents && tangent_matches(mesh->split.vertex_tangents + 4 * split,
			p->mesh.tangents + 4 * vertex, p));
}

/* Faces of the scene's mesh against the primitives it became, parts[p] for primitive p. */
static nt_status compare_mesh(const nt_mesh *mesh, part *parts, nt_error *error)
{
	static const unsigned char cut[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
	size_t corner = 0;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		const int diagonal = size == 4 && mesh->face_diagonals ? mesh->face_diagonals[f] : 0;
		const bool several = mesh->primitive_count > 1 && mesh->face_primitive;
		part *p = &parts[several ? mesh->face_primitive[f] : 0];
		for (size_t k = 0; k < (size == 4 ? 6u : 3u); k++)
			if (!corner_matches(mesh, corner + cut[diagonal][k], p, p->corner++))
				return fail_corner(mesh, corner + cut[diagonal][k], error);
		corner += size;
	}
	return NT_OK;
}

/* Lists that meshoptimizer packs begin triangles with any corner: these are turned to the scene's. */
static nt_status turn_triangles(nt_scene *found, const nt_mesh *mesh, part *p, nt_error *error)
{
	nt_gltf *document = found->source;
	const nt_gltf_accessor *a = nt_gltf_named(document, nt_gltf_primitive_of(document, &p->mesh), "indices");
	nt_gltf_packing packing = {.extension = NULL};
	if (a && a->view != NT_NONE && nt_gltf_get_packing(document, a->view, &packing, error) != NT_OK)
		return error->status;
	if (!packing.extension || strcmp(packing.view.mode, "TRIANGLES") != 0)
		return NT_OK;
	uint32_t *own = nt_arena_alloc(&found->arena, p->mesh.corner_count, sizeof *own);
	if (!own)
		return nt_fail_memory(error);
	p->mesh.indices = memcpy(own, p->mesh.indices, p->mesh.corner_count * sizeof *own);
	for (size_t c = 0; c + 2 < p->mesh.corner_count; c += 3)
		for (int turn = 0; turn < 3; turn++) {
			if (corner_matches(mesh, c, p, c) && corner_matches(mesh, c + 1, p, c + 1) &&
				corner_matches(mesh, c + 2, p, c + 2))
				break;
			const uint32_t first = own[c];
			own[c] = own[c + 1];
			own[c + 1] = own[c + 2];
			own[c + 2] = first;
		}
	return NT_OK;
}

/* ---- morph targets ---- */

/* The corners of a target say what leads from their stored tangents to the target's. moved: room for those of all
 * vertices. */
static nt_status compare_target(nt_gltf *document, const nt_mesh *mesh, const part *p, size_t m, float *moved,
	nt_arena *arena, nt_error *error)
{
	const nt_json_value *target = nt_json_at(nt_json_find(nt_gltf_primitive_of(document, &p->mesh), "targets"),
		mesh->morphs[m].target);
	const nt_gltf_accessor *a = nt_gltf_named(document, target, "TANGENT");
	float *deltas;
	if (!a || a->components != 3 || a->count != p->mesh.vertex_count + p->mesh.unused_vertices ||
		(a->component_type != NT_GLTF_FLOAT && !a->normalized))
		return fail_corner(mesh, 0, error);
	const nt_status status = nt_gltf_floats(document, a, 3, 0, arena, &deltas, error);
	if (status || nt_morph_read(mesh, m, moved) != NT_OK)
		return status ? status : nt_fail_memory(error);
	for (size_t c = 0; c < mesh->corner_count; c++) {
		size_t source;
		float delta[3];
		uint32_t type = a->component_type;
		const size_t split = split_vertex(mesh, c, &source), vertex = vertex_at(p, c);
		nt_morph_deltas(moved + 3 * split, p->mesh.tangents + 4 * vertex, 1, p->least, &type, delta);
		const float *found = deltas + 3 * nt_mesh_pool_vertex(&p->mesh, (uint32_t)vertex);
		if (found[0] != delta[0] || found[1] != delta[1] || found[2] != delta[2])
			return fail_corner(mesh, c, error);
	}
	return NT_OK;
}

/* Attributes outside of a block go by its vertices, so that they are in order. */
static nt_status compare_targets(nt_scene *found, const nt_mesh *mesh, const part *p, nt_error *error)
{
	if (!mesh->morph_count || !has_tangents(mesh))
		return NT_OK;
	float *moved = nt_alloc(mesh->vertex_count + mesh->split.source_count, 3 * sizeof *moved);
	nt_status status = moved ? NT_OK : nt_fail_memory(error);
	for (size_t m = 0; m < mesh->morph_count && status == NT_OK; m++)
		status = compare_target(found->source, mesh, p, m, moved, &found->arena, error);
	free(moved);
	return status;
}

/* ---- all meshes ---- */

/* Vertices that the accessors of a primitive have in its document. */
static size_t count_vertices(const nt_mesh *mesh)
{
	return mesh->source_vertex_count + mesh->unused_vertices;
}

/* A mesh of an edited document stands where it stood. Strips and fans keep their own indices: there only the tangents
 * have to be there. */
static nt_status compare_edited(const verification *v, nt_scene *found, const nt_mesh *mesh, part *p, nt_error *error)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(found->source, &p->mesh);
	const bool list = nt_gltf_mode(primitive) == NT_GLTF_TRIANGLES;
	const char *bad = NULL;
	if (!p->mesh.tangents || (list && !p->packed && p->mesh.corner_count != mesh->corner_count))
		return fail_corner(mesh, 0, error);
	/* without indices it draws all that its accessors have: copies that others got would be more */
	if (!p->packed && !nt_json_find(primitive, "indices") && count_vertices(&p->mesh) != count_vertices(mesh))
		return fail_in(mesh, "in the vertices that are drawn", error);
	if (!list)
		return NT_OK;
	nt_status status = p->packed ? nt_verify_block(v->scene->source, mesh, v->options, found->source, primitive,
		&found->arena, &bad, error) : turn_triangles(found, mesh, p, error);
	if (bad)
		return fail_block(mesh, bad, error);
	if (!status && !p->packed)
		status = compare_mesh(mesh, p, error);
	return status ? status : compare_targets(found, mesh, p, error);
}

/* Primitives of a mesh that have faces are in a new document, in order. */
static bool is_written(const mesh_check *check, size_t p)
{
	const nt_mesh *mesh = check->mesh;
	return check->part_count > 1 && mesh->face_primitive ? mesh->primitives[p].face_count > 0 : p == 0;
}

static nt_status compare_check(const verification *v, const mesh_check *check, nt_error *error)
{
	nt_scene alone = v->found;
	alone.arena = (nt_arena){0};
	part *parts = nt_calloc(check->part_count, sizeof *parts);
	nt_status status = parts ? NT_OK : nt_fail_memory(error);
	for (size_t p = 0, number = check->first; p < check->part_count && status == NT_OK; p++)
		if (is_written(check, p))
			status = read_part(&alone, number++, &parts[p], error);
	if (status == NT_OK)
		status = v->edited ? compare_edited(v, &alone, check->mesh, parts, error)
				   : compare_mesh(check->mesh, parts, error);
	nt_arena_free(&alone.arena);
	free(parts);
	return status;
}

static void compare_one(void *context, size_t item, unsigned thread)
{
	verification *v = context;
	nt_error ignored;
	(void)thread;
	v->checks[item].status = compare_check(v, &v->checks[item], &ignored);
}

/* Whether a primitive of an edited document has the faces of the source's, also if it gets no tangents: copies that
 * others of its pool got are not for it. Blocks may drop faces, and accessors over them may claim anything. */
static bool keeps_faces(const nt_mesh *mesh, const nt_mesh *found)
{
	return mesh->compressed || found->compressed ||
		mesh->primitives[0].face_count == found->primitives[0].face_count;
}

/* Lists the meshes that are compared, and which primitives of the document each is. needed: [mesh_count] of the
 * document. */
static nt_status list_checks(verification *v, bool *needed, nt_error *error)
{
	size_t number = 0;
	for (size_t m = 0; m < v->scene->mesh_count; m++) {
		const nt_mesh *mesh = &v->scene->meshes[m];
		const bool solved = mesh->split.vertex_tangents && nt_mesh_gets_tangents(mesh);
		mesh_check *check = &v->checks[v->count];
		*check = (mesh_check){.mesh = mesh, .first = v->edited ? m : number,
			.part_count = !v->edited && mesh->primitive_count ? mesh->primitive_count : 1};
		if (v->edited && m < v->found.mesh_count && !keeps_faces(mesh, &v->found.meshes[m]))
			return fail_in(mesh, "in the number of faces", error);
		if (v->edited ? !solved : !mesh->face_count)
			continue;
		v->count++;
		number = check->first;
		for (size_t p = 0; p < check->part_count; p++)
			if (is_written(check, p) && number++ < v->found.mesh_count)
				needed[number - 1] = true;
	}
	return NT_OK;
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

/* Accessors that several primitives have are decoded once. No texture coordinates are asked for. */
static nt_status prepare_loads(nt_scene *found, nt_error *error)
{
	nt_gltf *document = found->source;
	uint32_t *users = nt_calloc(document->accessor_count, sizeof *users);
	if (!users)
		return nt_fail_memory(error);
	for (int pass = 0; pass < 2; pass++)
		for (size_t i = 0; i < found->mesh_count; i++) {
			const uint32_t positions = nt_gltf_reference(document, nt_json_find(
				nt_gltf_primitive_of(document, &found->meshes[i]), "attributes"), "POSITION");
			found->meshes[i].texcoord_set = UINT32_MAX;
			if (positions != NT_NONE && pass)
				found->meshes[i].plan.pooled = users[positions] > 1;
			else if (positions != NT_NONE)
				users[positions]++;
		}
	free(users);
	return NT_OK;
}

/* If our reader refuses an output, that is our mistake, whatever tinygltf says. */
static nt_status fail_reading(nt_status status, nt_error *error)
{
	if (status != NT_ERROR_INPUT && status != NT_ERROR_UNSUPPORTED && status != NT_ERROR_MISSING)
		return status;
	const nt_error refusal = *error;
	nt_fail(error, NT_ERROR_INTERNAL, "the output cannot be read back: %s", refusal.message);
	error->place = refusal.place;
	return NT_ERROR_INTERNAL;
}

static nt_status compare_scene(verification *v, nt_error *error)
{
	nt_read_options opening = reading;
	opening.threads = v->options->threads;
	bool *needed = NULL;
	nt_status status = nt_gltf_open(&v->found, &reading, error);
	if (status == NT_OK)
		status = prepare_loads(&v->found, error);
	v->checks = nt_calloc(v->scene->mesh_count, sizeof *v->checks);
	needed = nt_calloc(v->found.mesh_count, sizeof *needed);
	if (status == NT_OK && (!v->checks || !needed))
		status = nt_fail_memory(error);
	if (status == NT_OK)
		status = list_checks(v, needed, error);
	if (status == NT_OK)
		status = nt_gltf_prepare(&v->found, needed, &opening, error);
	if (status == NT_OK)
		status = compare_all(v, nt_thread_count(opening.threads), error);
	free(v->checks);
	free(needed);
	return fail_reading(status, error);
}

nt_status nt_verify_gltf(nt_scene *scene, nt_output *output, const char *path, const nt_write_options *options,
	nt_error *error)
{
	const char *written;
	nt_file file;
	nt_status status = nt_output_written(output, path, &written, error);
	if (status != NT_OK || !written)
		return status;
	status = nt_file_open(&file, written, NT_NAMED_BY_US, error);
	if (status != NT_OK)
		return status;
	nt_error refusal;
	nt_error_clear(&refusal);
	file_set set = {.output = output, .path = path};
	status = nt_tinygltf_accept(file.data, file.size, find_file, &set, &refusal);
	close_file(&set);
	if (set.failure.status) {
		refusal = set.failure;
		status = refusal.status;
	}
	if (status == NT_ERROR_INPUT) {
		nt_finding_add(&scene->findings, NT_CODE_NOT_VERIFIED, NULL, 1, "%s", refusal.message);
		status = NT_OK;
	}
	if (status == NT_OK) {
		nt_trace *const trace = nt_trace_use(NULL);
		verification v = {.scene = scene, .options = options,
			.edited = scene->format == NT_FORMAT_GLTF || scene->format == NT_FORMAT_GLB};
		nt_scene_init(&v.found, path);
		v.found.bytes = file.data;
		v.found.byte_count = file.size;
		v.found.written = output;
		status = compare_scene(&v, error);
		nt_scene_free(&v.found);
		nt_trace_use(trace);
	} else {
		*error = refusal;
	}
	nt_file_close(&file);
	return status == NT_OK ? status : nt_error_in_file(error, path);
}
