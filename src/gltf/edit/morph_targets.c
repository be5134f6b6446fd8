/* SPDX-License-Identifier: MIT */
/*
 * TANGENT of morph targets: what leads from the base's tangents to those of the mesh as a target moves it. A target
 * takes over the accessor that it has if no use of that is left; new ones are sparse if most of them are zeros.
 */
#include "gltf/bytes/bytes.h"
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/quantize.h"
#include "scene/values.h"

/* TANGENT of one target. */
typedef struct target_tangents {
	uint32_t target, accessor; /* accessor: NT_NONE while there is none that is right */
	nt_morph_storage storage;
	nt_gltf_packing packing;
	const unsigned char *bytes; /* NULL: in the view of sparse ones */
	uint64_t offset; /* in a view that it shares */
	bool found;      /* it is in the document */
	bool is_zero;
} target_tangents;

typedef struct target_job {
	nt_buffer_edits *edits;
	const nt_pool_vertices *vertices;
	uint32_t set, buffer;
	target_tangents *list; /* [count] */
	size_t count;
	nt_arena scratch;      /* of one target */
	unsigned char *sparse; /* the bytes of all sparse ones */
	size_t sparse_size, sparse_capacity;
	nt_error *error;
} target_job;

/* An accessor of a target, of the user's primitive; NT_NONE: none. */
static uint32_t find_in_target(const target_job *job, uint32_t user, uint32_t target, const char *name)
{
	return nt_gltf_reference(job->edits->document,
		nt_json_at(nt_json_find(nt_pool_primitive(job->vertices->pool, user), "targets"), target), name);
}

/* The type of a target's normals, where tangents may have it. */
static uint32_t type_of_normals(const target_job *job, uint32_t target)
{
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(job->edits->document,
		find_in_target(job, job->vertices->pool->sets.first[job->set], target, "NORMAL"));
	return a && a->normalized && (a->component_type == NT_GLTF_BYTE || a->component_type == NT_GLTF_SHORT) ?
		a->component_type : NT_GLTF_FLOAT;
}

/* If a target's deltas are packed, so are its tangents. There zeros take next to nothing: they are not sparse. */
static void choose_storage(const target_job *job, target_tangents *t, uint32_t type, size_t moved)
{
	const size_t count = job->vertices->new_count;
	const uint32_t first = job->vertices->pool->sets.first[job->set];
	const uint32_t normals = find_in_target(job, first, t->target, "NORMAL");
	t->storage = nt_morph_choose_storage(type, count, moved);
	t->packing = nt_packing_of_accessor(job->edits,
		normals != NT_NONE ? normals : find_in_target(job, first, t->target, "POSITION"));
	t->packing.view.filter = "NONE";
	t->packing.view.stride = t->storage.stride;
	if (t->packing.extension) {
		t->storage.sparse = false;
		t->storage.size = count * t->storage.stride;
	}
}

/* Whether a target has these deltas already in all meshes of the set: then nothing has to be written. */
static nt_status find_deltas(target_job *job, uint32_t target, uint32_t type, const float *deltas, bool *found)
{
	const nt_pool_vertices *vertices = job->vertices;
	const nt_vertex_pool *pool = vertices->pool;
	nt_status status = NT_OK;
	uint32_t known = NT_NONE;
	*found = !nt_vertices_differ(vertices);
	for (uint32_t i = pool->sets.first[job->set]; *found && i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t index = find_in_target(job, i, target, "TANGENT");
		float *old;
		if (index != NT_NONE && index == known)
			continue;
		known = index;
		const nt_gltf_accessor *accessor = nt_gltf_sound_accessor(job->edits->document, index);
		*found = accessor && accessor->component_type == type && accessor->components == 3 &&
			accessor->count == vertices->new_count;
		if (*found)
			status = nt_gltf_floats(job->edits->document, accessor, 3, 0, &job->scratch, &old, NULL);
		*found = *found && !status && memcmp(old, deltas, vertices->new_count * 3 * sizeof *old) == 0;
	}
	return status == NT_ERROR_MEMORY ? status : NT_OK;
}

/* Counts who of the set reads the tangents of its targets: meshes of equal geometry have them together. */
static void count_readers(const target_job *job)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	const uint32_t first = pool->sets.first[job->set];
	for (uint32_t i = first; i != NT_NONE; i = pool->sets.next[i])
		nt_pool_mesh(pool, i)->morph_tangents->reader_count = 0;
	for (uint32_t i = first; i != NT_NONE; i = pool->sets.next[i])
		nt_pool_mesh(pool, i)->morph_tangents->reader_count++;
}

/* A target goes if nobody reads it again. */
static void drop_target(const target_job *job, size_t m)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	for (uint32_t i = pool->sets.first[job->set]; i != NT_NONE; i = pool->sets.next[i]) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		if (mesh->morph_tangents->reader_count == mesh->morph_tangents->user_count)
			nt_morph_drop(mesh, m);
	}
}

/* Room for a sparse target behind those before it. NULL: memory is exhausted. */
static unsigned char *add_sparse(target_job *job, target_tangents *t)
{
	const size_t padded = (t->storage.size + 3) / 4 * 4;
	if (!nt_grow((void **)&job->sparse, &job->sparse_capacity, job->sparse_size + padded, 1))
		return NULL;
	unsigned char *bytes = job->sparse + job->sparse_size;
	memset(bytes, 0, padded);
	t->offset = job->sparse_size;
	job->sparse_size += padded;
	return bytes;
}

/* A target's tangents, and whether the document has them. */
static nt_status look_at_target(target_job *job, size_t m, float least)
{
	const nt_pool_set *set = &job->vertices->sets[job->set];
	const size_t count = job->vertices->new_count;
	target_tangents *t = &job->list[m];
	nt_arena_clear(&job->scratch);
	float *deltas = nt_arena_alloc(&job->scratch, count, 3 * sizeof *deltas);
	const float *moved_to = deltas ? nt_pool_read_target(job->vertices, job->set, m, &job->scratch) : NULL;
	if (!moved_to)
		return NT_ERROR_MEMORY;
	*t = (target_tangents){.accessor = NT_NONE,
		.target = nt_pool_set_mesh(job->vertices->pool, job->set)->morphs[m].target};
	uint32_t type = type_of_normals(job, t->target);
	const size_t moved = nt_morph_deltas(moved_to, set->tangents, count, least, &type, deltas);
	drop_target(job, m);
	const nt_status status = find_deltas(job, t->target, type, deltas, &t->found);
	if (status || t->found)
		return status;
	t->is_zero = moved == 0;
	choose_storage(job, t, type, moved);
	unsigned char *bytes = t->storage.sparse ? add_sparse(job, t) : nt_arena_alloc(&job->edits->arena,
		t->storage.size, 1);
	t->bytes = t->storage.sparse ? NULL : bytes;
	if (!bytes)
		return NT_ERROR_MEMORY;
	memset(bytes, 0, t->storage.size);
	nt_morph_store(&t->storage, deltas, count, bytes);
	return NT_OK;
}

/* Counts the uses of accessors that targets of the document will not have any more. */
static void count_replaced(const target_job *job)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	for (size_t m = 0; m < job->count; m++)
		for (uint32_t i = pool->sets.first[job->set]; !job->list[m].found && i != NT_NONE;
			i = pool->sets.next[i]) {
			const uint32_t index = find_in_target(job, i, job->list[m].target, "TANGENT");
			if (index != NT_NONE)
				job->edits->accessors[nt_gltf_same(job->edits->document, index)].replaced++;
		}
}

/* Targets take over the accessor that they have where no use of it is left; nobody appends to it. */
static void take_over(const target_job *job)
{
	const uint32_t first = job->vertices->pool->sets.first[job->set];
	const nt_gltf *document = job->edits->document;
	for (size_t m = 0; m < job->count; m++) {
		target_tangents *t = &job->list[m];
		const uint32_t index = t->found ? NT_NONE : find_in_target(job, first, t->target, "TANGENT");
		const uint32_t same = index == NT_NONE ? 0 : nt_gltf_same(document, index);
		if (index == NT_NONE || document->users[same].foreign || document->users[same].idle ||
			job->edits->accessors[same].replaced != document->users[same].attributes)
			continue;
		job->edits->accessors[same].replaced = 0; /* no second target takes it */
		t->accessor = index;
		nt_gltf_drop_elements(job->edits, index);
	}
}

/* One view for all sparse ones. NT_NONE: there are none. */
static nt_status add_sparse_view(target_job *job, uint32_t *view)
{
	unsigned char *bytes = job->sparse;
	*view = NT_NONE;
	job->sparse = NULL;
	if (!nt_arena_adopt(&job->edits->arena, bytes))
		return nt_fail_memory(job->error);
	return !bytes ? NT_OK :
		nt_edits_add_view(job->edits, job->buffer, bytes, job->sparse_size, 0, 0, view, job->error);
}

static void set_view(nt_json *json, nt_json_value *object, uint32_t view, uint64_t offset)
{
	nt_json_put_uint64(json, object, "bufferView", view);
	if (offset)
		nt_json_put_uint64(json, object, "byteOffset", offset);
}

/* The accessor of a target, for what is stored in a view. */
static void describe_target(const target_job *job, target_tangents *t, uint32_t view)
{
	nt_gltf *document = job->edits->document;
	nt_json *json = document->json;
	const nt_morph_storage *s = &t->storage;
	const bool is_new = t->accessor == NT_NONE;
	if (is_new)
		t->accessor = nt_gltf_new_accessor(json, NT_NONE, s->type, "VEC3", job->vertices->new_count,
			s->type != NT_GLTF_FLOAT);
	nt_json_value *accessor = nt_gltf_accessor_json(document, t->accessor);
	static const char *const gone[] = {"bufferView", "byteOffset", "sparse", "min", "max", "normalized"};
	for (size_t k = 0; !is_new && k < sizeof gone / sizeof *gone; k++)
		nt_json_remove(json, accessor, gone[k]);
	if (!is_new) {
		nt_json_put_uint64(json, accessor, "componentType", s->type);
		nt_json_put_uint64(json, accessor, "count", job->vertices->new_count);
		nt_json_set_string(json, nt_json_put(json, accessor, "type"), "VEC3", 4);
	}
	if (!is_new && s->type != NT_GLTF_FLOAT)
		nt_json_set_bool(json, nt_json_put(json, accessor, "normalized"), true);
	if (!s->sparse) {
		set_view(json, accessor, view, t->offset);
		return;
	}
	nt_json_value *sparse = nt_json_put(json, accessor, "sparse");
	nt_json_set_object(json, sparse);
	nt_json_put_uint64(json, sparse, "count", s->element_count);
	nt_json_value *indices = nt_json_put(json, sparse, "indices");
	nt_json_set_object(json, indices);
	nt_json_put_uint64(json, indices, "componentType", s->index_type);
	set_view(json, indices, view, t->offset);
	nt_json_value *values = nt_json_put(json, sparse, "values");
	nt_json_set_object(json, values);
	set_view(json, values, view, t->offset + s->value_offset);
}

/* Accessors of one type that have nothing but zeros, and no accessor of their own, have one together. */
static nt_status write_targets(target_job *job)
{
	nt_json *json = job->edits->document->json;
	const nt_vertex_pool *pool = job->vertices->pool;
	uint32_t sparse_view, zero = NT_NONE, zero_type = 0;
	nt_status status = add_sparse_view(job, &sparse_view);
	for (size_t m = 0; !status && m < job->count; m++) {
		target_tangents *t = &job->list[m];
		uint32_t view = sparse_view;
		if (t->found)
			continue;
		const bool is_shared = t->is_zero && t->accessor == NT_NONE;
		if (is_shared && zero != NT_NONE && zero_type == t->storage.type) {
			t->accessor = zero;
		} else {
			if (!t->storage.sparse)
				status = nt_packed_add(job->edits, job->buffer, &t->packing, t->bytes,
					t->storage.size, NT_GLTF_ARRAY_BUFFER, t->storage.type == NT_GLTF_FLOAT ? 0 :
					(uint32_t)t->storage.stride, &view, &t->offset, job->error);
			describe_target(job, t, view);
		}
		if (is_shared) {
			zero = t->accessor;
			zero_type = t->storage.type;
		}
		for (uint32_t i = pool->sets.first[job->set]; i != NT_NONE; i = pool->sets.next[i])
			nt_json_put_uint64(json, nt_json_at(nt_json_find(nt_pool_primitive(pool, i), "targets"),
				t->target), "TANGENT", t->accessor);
	}
	return status;
}

/* Bytes that are written for targets, and that the set's first primitive takes without them. */
static void add_cost(const target_job *job, nt_morph_cost *cost)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	const nt_json_value *primitive = nt_pool_primitive(pool, pool->sets.first[job->set]);
	cost->mesh_bytes += nt_gltf_vertex_bytes(job->edits->document, primitive) * job->vertices->new_count;
	const nt_gltf_accessor *indices = nt_gltf_named(job->edits->document, primitive, "indices");
	cost->mesh_bytes += indices ? indices->count * indices->element_bytes : 0;
	for (size_t m = 0; m < job->count; m++)
		if (!job->list[m].found) {
			cost->targets++;
			cost->bytes += job->list[m].storage.size;
		}
}

nt_status nt_gltf_add_morphs(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	float least, nt_morph_cost *cost, nt_error *error)
{
	target_job job = {.edits = edits, .vertices = vertices, .set = set, .buffer = buffer,
		.count = nt_pool_set_mesh(vertices->pool, set)->morph_count, .error = error};
	if (!job.count)
		return NT_OK;
	count_readers(&job);
	job.list = nt_calloc(job.count, sizeof *job.list);
	nt_status status = job.list ? NT_OK : NT_ERROR_MEMORY;
	for (size_t m = 0; !status && m < job.count; m++)
		status = look_at_target(&job, m, least);
	if (status)
		nt_fail_memory(error);
	if (!status) {
		count_replaced(&job);
		take_over(&job);
	}
	if (!status)
		status = write_targets(&job);
	if (!status)
		add_cost(&job, cost);
	nt_arena_free(&job.scratch);
	free(job.sparse);
	free(job.list);
	return status;
}
