/* SPDX-License-Identifier: MIT */
/*
 * The geometry of one glTF primitive, with the buffers that this one needs: vertices and faces. Everything that is read
 * is checked here; load_targets.c brings what morph targets add.
 *
 * Texture coordinates are handed on as (u, -v): v up, exactly. If the texture that tangents serve has a transform,
 * they go through it.
 */
#include "gltf/load.h"

#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "gltf/document.h"
#include "gltf/quantize.h"
#include "scene/values.h"

/* ---- compact views ---- */

/*
 * Primitives that share one vertex buffer are loaded with the vertices that their own corners use, so that each costs
 * what it uses and not what all of them have together. Vertices keep their order: a pass through them in ascending
 * order meets them as in the buffer. One that uses nearly all vertices takes them as they are.
 *
 * A table over the range from the least to the greatest index gives each vertex its number. If corners are few in a
 * wide range, they are sorted instead: the cost is bounded by corners alone.
 */

typedef struct compact_view {
	uint32_t *vertices; /* [count] number of each in the pool, ascending; NULL: the pool's own numbers */
	size_t count;
	uint32_t *indices;  /* [corner_count] of these vertices */
} compact_view;

enum {
	SPARSE = 8, /* vertices of the range for each corner, from which on corners are sorted */
	MOST = 8    /* all vertices but one in so many are nearly all */
};

typedef struct range {
	uint32_t least, most;
} range;

static range find_range(const uint32_t *indices, size_t count)
{
	range r = {UINT32_MAX, 0};
	for (size_t c = 0; c < count; c++) {
		r.least = indices[c] < r.least ? indices[c] : r.least;
		r.most = indices[c] > r.most ? indices[c] : r.most;
	}
	return r;
}

static nt_status number_by_table(const uint32_t *indices, size_t corner_count, size_t vertex_count, range r,
	nt_arena *arena, compact_view *view)
{
	const size_t size = (size_t)r.most - r.least + 1;
	uint32_t *table = nt_calloc(size, sizeof *table);
	if (!table)
		return NT_ERROR_MEMORY;
	for (size_t c = 0; c < corner_count; c++)
		table[indices[c] - r.least] = 1;
	for (size_t v = 0; v < size; v++)
		view->count += table[v];
	const bool most = view->count >= vertex_count - vertex_count / MOST;
	if (most)
		view->count = vertex_count;
	view->vertices = most ? NULL : nt_arena_alloc(arena, view->count, sizeof *view->vertices);
	view->indices = most ? NULL : nt_arena_alloc(arena, corner_count, sizeof *view->indices);
	const bool numbered = view->vertices && view->indices;
	for (size_t v = 0, number = 0; numbered && v < size; v++)
		if (table[v]) {
			view->vertices[number] = r.least + (uint32_t)v;
			table[v] = (uint32_t)number++;
		}
	for (size_t c = 0; numbered && c < corner_count; c++)
		view->indices[c] = table[indices[c] - r.least];
	free(table);
	return most || numbered ? NT_OK : NT_ERROR_MEMORY;
}

static int compare_numbers(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
	return (x > y) - (x < y);
}

static nt_status number_by_sorting(const uint32_t *indices, size_t corner_count, nt_arena *arena, compact_view *view)
{
	view->vertices = nt_arena_alloc(arena, corner_count, sizeof *view->vertices);
	view->indices = nt_arena_alloc(arena, corner_count, sizeof *view->indices);
	if (!view->vertices || !view->indices)
		return NT_ERROR_MEMORY;
	memcpy(view->vertices, indices, corner_count * sizeof *indices);
	qsort(view->vertices, corner_count, sizeof *view->vertices, compare_numbers);
	for (size_t c = 0; c < corner_count; c++)
		if (c == 0 || view->vertices[c] != view->vertices[view->count - 1])
			view->vertices[view->count++] = view->vertices[c];
	for (size_t c = 0; c < corner_count; c++) {
		const uint32_t *found = bsearch(&indices[c], view->vertices, view->count, sizeof *indices,
			compare_numbers);
		view->indices[c] = (uint32_t)(found - view->vertices);
	}
	return NT_OK;
}

/* Numbers the vertices that corners use, of a pool of `vertex_count`; nearly all are taken for all. indices:
 * [corner_count], each below that. All of the view is in the arena, or `indices` themselves. Returns NT_OK or
 * NT_ERROR_MEMORY. */
static nt_status number_compact(const uint32_t *indices, size_t corner_count, size_t vertex_count, nt_arena *arena,
	compact_view *view)
{
	*view = (compact_view){.count = 0};
	memcpy(&view->indices, &indices, sizeof indices);
	if (corner_count == 0) {
		view->count = vertex_count;
		return NT_OK;
	}
	view->indices = NULL;
	const range r = find_range(indices, corner_count);
	const nt_status status = ((size_t)r.most - r.least) / SPARSE >= corner_count
		? number_by_sorting(indices, corner_count, arena, view)
		: number_by_table(indices, corner_count, vertex_count, r, arena, view);
	if (!status && !view->vertices)
		memcpy(&view->indices, &indices, sizeof indices);
	return status;
}

/* The rows of a view's vertices, as many floats each; `rows` themselves where the view has the pool's numbers. NULL:
 * memory is exhausted. */
static float *take_rows(const compact_view *view, const float *rows, size_t floats, nt_arena *arena)
{
	float *own = NULL;
	if (!view->vertices) {
		memcpy(&own, &rows, sizeof own);
		return own;
	}
	own = nt_arena_alloc(arena, view->count, floats * sizeof *own);
	for (size_t v = 0; own && v < view->count; v++)
		memcpy(own + floats * v, rows + floats * view->vertices[v], floats * sizeof *own);
	return own;
}

/* ---- a primitive ---- */

/* The attributes that a load takes of a primitive, in the order in which faults are told. */
enum { POSITIONS, NORMALS, TEXCOORDS, TANGENTS, COLORS, INPUTS };

static const struct {
	const char *name;     /* NULL: TEXCOORD_ and the number of the mesh's set */
	uint32_t least, most; /* components; a mesh has `most` */
	float fill;
} kinds[INPUTS] = {{"POSITION", 3, 3, 0}, {"NORMAL", 3, 3, 0}, {NULL, 2, 2, 0}, {"TANGENT", 4, 4, 0},
	{"COLOR_0", 3, 4, 1}};

/* The array of a mesh that an input goes to. */
static float **array_of(nt_mesh *mesh, int input)
{
	float **const arrays[] = {&mesh->positions, &mesh->normals, &mesh->texcoords, &mesh->tangents, &mesh->colors};
	return arrays[input];
}

static const char *name_of(const nt_mesh *mesh, int input, char (*texcoords)[32])
{
	if (kinds[input].name)
		return kinds[input].name;
	nt_gltf_put_number(nt_gltf_put_text(*texcoords, "TEXCOORD_"), mesh->texcoord_set);
	return *texcoords;
}

static bool is_taken(const nt_mesh *mesh, const nt_read_options *options, int input)
{
	return (input != TANGENTS || !mesh->tangents_fault) && (input != COLORS || options->world);
}

/* *found: NULL: the primitive has none. */
static nt_status find_input(nt_gltf *document, const nt_mesh *mesh, int input, const nt_gltf_accessor **found,
	nt_error *error)
{
	char pointer[NT_GLTF_POINTER], texcoords[32];
	const char *const name = name_of(mesh, input, &texcoords);
	const nt_json_value *attributes = nt_json_find(nt_gltf_primitive_of(document, mesh), "attributes");
	uint64_t index;
	*found = NULL;
	if (!nt_json_find(attributes, name))
		return NT_OK;
	char *const end = nt_gltf_put_text(nt_gltf_mesh_pointer(pointer, mesh), "/attributes");
	nt_status status =
		nt_gltf_uint(attributes, pointer, name, UINT32_MAX - 1, NT_GLTF_REQUIRED, &index, error);
	if (status)
		return status;
	nt_gltf_put_text(nt_gltf_put_text(end, "/"), name);
	status = nt_gltf_get_accessor(document, index, pointer, found, error);
	if (!status && ((*found)->components < kinds[input].least || (*found)->components > kinds[input].most))
		status = nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "accessor %llu has %u components, expected %u",
			(unsigned long long)index, (*found)->components, kinds[input].least);
	return status;
}

/* in: [INPUTS]. Counts must agree, and something in the file must stand behind them. */
static nt_status find_inputs(nt_gltf *document, nt_mesh *mesh, const nt_read_options *options,
	const nt_gltf_accessor **in, nt_error *error)
{
	char pointer[NT_GLTF_POINTER], texcoords[32];
	nt_status status = NT_OK;
	bool backed = false;
	for (int i = 0; !status && i < INPUTS; i++) {
		in[i] = NULL;
		if (is_taken(mesh, options, i))
			status = find_input(document, mesh, i, &in[i], error);
		if (!status && !in[POSITIONS])
			status = nt_fail_pointer(error, NT_ERROR_INPUT, nt_gltf_of_mesh(mesh).pointer,
				"the primitive has no POSITION");
	}
	if (status)
		return status;
	mesh->vertex_count = mesh->source_vertex_count = (size_t)in[POSITIONS]->count;
	for (int i = 0; i < INPUTS; i++) {
		if (!in[i])
			continue;
		backed |= i <= TEXCOORDS && (in[i]->view != NT_NONE || in[i]->decoded);
		if (in[i]->count == mesh->vertex_count)
			continue;
		nt_gltf_put_text(nt_gltf_put_text(nt_gltf_mesh_pointer(pointer, mesh), "/attributes/"),
			name_of(mesh, i, &texcoords));
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"accessor %u has %llu elements, POSITION has %zu", in[i]->index,
			(unsigned long long)in[i]->count, mesh->vertex_count);
	}
	return backed || mesh->vertex_count <= NT_GLTF_UNBACKED ? NT_OK :
		nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, nt_gltf_of_mesh(mesh).pointer,
			"%zu vertices, but neither positions nor normals nor texture coordinates have a bufferView",
			mesh->vertex_count);
}

/* Integer normals are normalised, after morph targets have added to what they stand for; float ones are taken as they
 * are. */
static void normalise_quantized(const nt_gltf_accessor *accessor, float *normals, size_t count)
{
	for (size_t i = 0; accessor->component_type != NT_GLTF_FLOAT && i < count; i++)
		nt_gltf_normalise(normals + 3 * i);
}

typedef struct flipping {
	const float *from;
	float *to;
} flipping;

static void flip_range(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const flipping *f = context;
	for (size_t i = begin; i < end; i++) {
		f->to[2 * i] = f->from[2 * i];
		f->to[2 * i + 1] = -f->from[2 * i + 1];
	}
}

/* v points down in glTF. The copy is needed: the input stays as it is. */
static nt_status flip_texcoords(nt_scene *scene, nt_mesh *mesh, unsigned threads, nt_error *error)
{
	enum { GRAIN = 1 << 16 };
	const size_t count = mesh->vertex_count;
	const float *stored = mesh->texcoords;
	mesh->texcoords = nt_arena_alloc(nt_mesh_arena(scene, mesh), count, 2 * sizeof(float));
	if (!mesh->texcoords)
		return nt_fail_memory(error);
	flipping f = {stored, mesh->texcoords};
	nt_parallel_ranges(count < 2 * GRAIN ? 1 : nt_thread_count(threads), count, GRAIN, flip_range, &f);
	return NT_OK;
}

/* An attribute as floats. Data that primitives share is decoded once. */
static nt_status load_floats(nt_scene *scene, const nt_mesh *mesh, const nt_gltf_accessor *accessor, uint32_t width,
	float fill, float **floats, nt_error *error)
{
	return mesh->plan.pooled ? nt_gltf_shared_floats(scene->source, accessor, width, fill, floats, error)
			    : nt_gltf_floats(scene->source, accessor, width, fill, nt_mesh_arena(scene, mesh),
				      floats, error);
}

static float step_of(const nt_draco_quantization *grid)
{
	return grid->bits ? grid->range / (float)((1u << grid->bits) - 1) : 0;
}

/* Draco's rounding of tangents, past and to come: none to come if they keep their grid. */
static void find_tangent_steps(const nt_scene *scene, nt_mesh *mesh, const nt_read_options *options)
{
	const nt_draco_quantization *source =
		nt_gltf_draco_tangents_of(scene->source, nt_gltf_primitive_of(scene->source, mesh));
	const nt_draco_quantization next = nt_gltf_draco_tangent_grid(source, options->draco_bits);
	const bool stays = source && source->bits == next.bits && source->range == next.range &&
		memcmp(source->origin, next.origin, sizeof next.origin) == 0;
	mesh->tangent_step = source ? step_of(source) : 0;
	mesh->tangent_margin = (mesh->plan.quantized || (source && options->draco != NT_DRACO_OFF)) && !stays ?
		step_of(&next) : 0;
}

/* The vertices that a pooled mesh uses. It keeps the pool's numbers if it uses all, or has no indices. */
static nt_status make_compact(nt_scene *scene, nt_mesh *mesh, const nt_gltf_accessor *normals, size_t index_count,
	nt_error *error)
{
	nt_arena *arena = nt_mesh_arena(scene, mesh);
	const size_t pool_count = mesh->vertex_count;
	compact_view view = {.count = pool_count};
	if (mesh->plan.pooled && mesh->indices &&
		number_compact(mesh->indices, index_count, pool_count, arena, &view))
		return nt_fail_memory(error);
	if (!view.vertices)
		return mesh->plan.pooled && normals && normals->component_type != NT_GLTF_FLOAT
			? nt_gltf_own_normals(scene, mesh, error) : NT_OK;
	for (int i = 0; i < INPUTS; i++) {
		float **const rows = array_of(mesh, i);
		if (*rows && !(*rows = take_rows(&view, *rows, kinds[i].most, arena)))
			return nt_fail_memory(error);
	}
	mesh->pool_vertices = view.vertices;
	mesh->unused_vertices = pool_count - view.count;
	mesh->vertex_count = mesh->source_vertex_count = view.count;
	mesh->indices = view.indices;
	return NT_OK;
}

/* Triangles of a strip or fan, in the order and with the first corners that the specification gives. */
static void list_triangles(uint64_t mode, const uint32_t *chain, size_t face_count, uint32_t *corners)
{
	for (size_t i = 0; i < face_count; i++) {
		size_t a = i, b = i + 1 + i % 2, c = i + 2 - i % 2;
		if (mode == NT_GLTF_FAN) {
			a = i + 1;
			b = i + 2;
			c = 0;
		}
		const size_t from[3] = {a, b, c};
		for (int k = 0; k < 3; k++)
			corners[3 * i + (size_t)k] = chain ? chain[from[k]] : (uint32_t)from[k];
	}
}

/* The corners that a primitive lists; *count is untouched where it lists none. */
static nt_status load_chain(nt_gltf *document, const nt_mesh *mesh, const nt_json_value *primitive,
	nt_arena *arena, uint32_t **chain, uint64_t *count, nt_error *error)
{
	uint64_t index;
	*chain = NULL;
	nt_status status = nt_gltf_uint(primitive, nt_gltf_of_mesh(mesh).pointer, "indices", UINT32_MAX - 1,
		NT_NONE, &index, error);
	if (status || index == NT_NONE)
		return status;
	char pointer[NT_GLTF_POINTER];
	nt_gltf_put_text(nt_gltf_mesh_pointer(pointer, mesh), "/indices");
	const nt_gltf_accessor *accessor;
	status = nt_gltf_get_accessor(document, index, pointer, &accessor, error);
	if (status)
		return status;
	*count = accessor->count;
	return nt_gltf_indices(document, accessor, mesh->vertex_count, arena, chain, error);
}

/* Faces, of compact vertices where the mesh shares them. */
static nt_status load_faces(nt_scene *scene, nt_gltf *document, nt_mesh *mesh, const nt_json_value *primitive,
	const nt_gltf_accessor *normals, nt_error *error)
{
	const uint64_t mode = nt_gltf_mode(primitive);
	uint64_t count = mesh->vertex_count;
	nt_status status = load_chain(document, mesh, primitive, nt_mesh_arena(scene, mesh), &mesh->indices,
		&count, error);
	if (!status)
		status = make_compact(scene, mesh, normals, (size_t)count, error);
	if (status)
		return status;
	mesh->face_count = mode == NT_GLTF_TRIANGLES ? (size_t)count / 3 : count < 3 ? 0 : (size_t)count - 2;
	mesh->corner_count = mesh->face_count * 3;
	mesh->primitives[0].face_count = mesh->face_count;
	if (mode == NT_GLTF_TRIANGLES)
		return NT_OK;
	const uint32_t *chain = mesh->indices;
	mesh->indices = nt_arena_alloc(nt_mesh_arena(scene, mesh), mesh->corner_count, sizeof *mesh->indices);
	if (!mesh->indices)
		return nt_fail_memory(error);
	list_triangles(mode, chain, mesh->face_count, mesh->indices);
	return NT_OK;
}

nt_status nt_gltf_load(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
	nt_error *error)
{
	nt_gltf *document = scene->source;
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	if (mesh->plan.same_as) {
		nt_mesh_share(mesh);
		return NT_OK;
	}
	/* of one that was not prepared, too */
	nt_status status = nt_gltf_read_arrays(document, error);
	if (!status && !mesh->ready)
		status = nt_gltf_decode_draco(document, primitive, nt_gltf_of_mesh(mesh).pointer, error);
	const nt_gltf_accessor *in[INPUTS];
	if (!status)
		status = find_inputs(document, mesh, options, in, error);
	/* as they are stored, of all vertices of the pool */
	for (int i = 0; !status && i < INPUTS; i++)
		if (in[i])
			status = load_floats(scene, mesh, in[i], kinds[i].most, kinds[i].fill, array_of(mesh, i),
				error);
	if (!status)
		status = load_faces(scene, document, mesh, primitive, in[NORMALS], error);
	if (!status)
		mesh->byte_tangents = in[TANGENTS] && in[TANGENTS]->component_type == NT_GLTF_BYTE;
	if (!status && mesh->texcoords)
		status = flip_texcoords(scene, mesh, options->threads, error);
	if (!status && mesh->tangents)
		find_tangent_steps(scene, mesh, options);
	if (!status && mesh->plan.quantized)
		status = nt_gltf_quantize_vertices(scene, mesh, in[POSITIONS], in[NORMALS], in[TEXCOORDS], options,
			error);
	if (!status && mesh->texcoords && mesh->transform)
		status = nt_mesh_transform(mesh, mesh->transform, nt_mesh_arena(scene, mesh), error);
	if (!status && options->report)
		mesh->vertex_bytes = nt_gltf_vertex_bytes(document, primitive);
	/* a mesh in the world is written without its targets */
	if (!status && !options->world && options->morphs == NT_MORPH_BAKE)
		status = nt_gltf_load_targets(scene, mesh, in[NORMALS], error);
	if (!status && in[NORMALS])
		normalise_quantized(in[NORMALS], mesh->normals, mesh->vertex_count);
	if (status && error) {
		nt_place place;
		memcpy(error->place.object, nt_mesh_place(mesh, &place)->object, sizeof error->place.object);
	}
	return status;
}

nt_status nt_gltf_load_normals(nt_gltf *document, const nt_mesh *mesh, nt_arena *arena, float **normals,
	nt_error *error)
{
	const nt_gltf_accessor *found;
	nt_status status = find_input(document, mesh, NORMALS, &found, error);
	if (!status)
		status = nt_gltf_shared_floats(document, found, 3, 0, normals, error);
	if (status || found->component_type == NT_GLTF_FLOAT)
		return status;
	const size_t count = (size_t)found->count;
	float *own = nt_arena_alloc(arena, count, 3 * sizeof *own);
	if (!own)
		return nt_fail_memory(error);
	*normals = memcpy(own, *normals, count * 3 * sizeof *own);
	normalise_quantized(found, own, count);
	return NT_OK;
}

/* ---- several at a time ---- */

/* Whether the bytes of a view are there, which are unpacked for it. */
static bool open_view(nt_gltf *document, uint32_t index)
{
	nt_gltf_buffer *buffer;
	nt_error ignored;
	return index == NT_NONE || (nt_gltf_decompress_view(document, index, &ignored) == NT_OK &&
		(document->views[index].decoded ||
			nt_gltf_open_buffer(document, document->views[index].buffer, "", &buffer, &ignored) == NT_OK));
}

/* The same of an accessor that a member names, if there is one. */
static bool open_accessor(nt_gltf *document, const nt_json_value *object, const char *name)
{
	const nt_gltf_accessor *a = nt_gltf_named(document, object, name);
	if (!a)
		return !nt_json_find(object, name);
	const nt_gltf_sparse_arrays *sparse = a->sparse;
	return open_view(document, a->view) &&
		(!sparse || (open_view(document, sparse->index_view) && open_view(document, sparse->value_view)));
}

/* Whether all that a load takes of a mesh is there now. */
static bool make_ready(nt_gltf *document, const nt_mesh *mesh, const nt_read_options *options)
{
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes"),
		*targets = nt_json_find(primitive, "targets");
	char texcoords[32];
	nt_error ignored;
	bool ready = nt_gltf_decode_draco(document, primitive, "", &ignored) == NT_OK &&
		open_accessor(document, primitive, "indices");
	for (int i = 0; ready && i < INPUTS; i++)
		ready = !is_taken(mesh, options, i) ||
			open_accessor(document, attributes, name_of(mesh, i, &texcoords));
	const bool bakes = !options->world && options->morphs == NT_MORPH_BAKE;
	for (size_t i = 0; ready && bakes && i < nt_json_count(targets); i++)
		ready = open_accessor(document, nt_json_at(targets, i), "POSITION") &&
			open_accessor(document, nt_json_at(targets, i), "NORMAL");
	return ready;
}

nt_status nt_gltf_prepare(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error)
{
	nt_status status = NT_OK;
	bool some = false;
	for (size_t i = 0; !some && i < scene->mesh_count; i++)
		some = needed[i];
	if (some)
		status = nt_gltf_read_arrays(scene->source, error);
	if (!status)
		status = nt_gltf_decode_ahead(scene, needed, options, error);
	for (size_t i = 0; !status && i < scene->mesh_count; i++)
		if (needed[i] && !scene->meshes[i].plan.same_as)
			scene->meshes[i].ready = make_ready(scene->source, &scene->meshes[i], options);
	return status;
}
