/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, and new values, in the accessors of a pool.
 *
 * Accessors keep their number, and their first elements unless these are new (made normals) or fewer (welded). If a
 * segment of a buffer has nothing but vertices of the pool, one attribute or several that are interleaved, the copies
 * of all go to its end. Else its accessors go to new views. An accessor that has to keep its count, because a
 * primitive without indices or an animation uses it too, is left alone and the solved primitives get a copy of it.
 */
#include "gltf/edit/pool_edit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/bytes/bytes.h"

/* An accessor of the pool, which stands for all over its bytes. */
typedef struct target {
	const nt_gltf_accessor *accessor;
	nt_set_attribute *override; /* NULL: its values stay */
	nt_segment *segment;  /* NULL: it has no view */
	uint64_t begin; /* of its elements, in the buffer */
	bool stays;     /* solved primitives have a copy of it, or do without */
	bool moved;     /* to a new view */
} target;

typedef struct appending {
	nt_buffer_edits *edits;
	nt_gltf *document; /* of the edits, as its JSON */
	nt_json *json;
	nt_arena *arena;   /* of the edits */
	const nt_pool_vertices *vertices;
	const nt_override_list *overrides;
	uint32_t buffer;  /* of new views */
	uint32_t owner;   /* the pool's vertices, as segments have them: by its first user */
	uint32_t sparse_owner; /* the same of its sparse arrays */
	bool decoded_too; /* decompressed accessors get plain views */
	bool differs;     /* vertices are not those of the source */
	nt_error *error;
	target *targets;
	size_t target_count, target_capacity;
} appending;

/* ---- the accessors of a pool ---- */

static nt_status check_count(const appending *job, const nt_gltf_accessor *a)
{
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "accessors", a->index);
	return a->count == job->vertices->old_count ? NT_OK : nt_fail_pointer(job->error, NT_ERROR_INPUT, pointer,
		"%llu elements, but other attributes of the same primitives have %zu", (unsigned long long)a->count,
		job->vertices->old_count);
}

static nt_status collect(appending *job, uint32_t index, bool solved)
{
	nt_edited_accessor *const all = job->edits->accessors;
	const uint32_t same = nt_gltf_same(job->document, index);
	const bool is_new = !all[index].seen;
	const nt_gltf_accessor *a = NULL;
	all[same].pinned |= !solved;
	all[same].solved |= solved;
	all[index].seen = true;
	nt_status status = is_new ? nt_gltf_get_accessor(job->document, index, "/accessors", &a, job->error) : NT_OK;
	if (is_new && !status)
		status = check_count(job, a);
	/* where nothing grows, the others matter as far as new values are between them: none that cannot be read */
	if (status && status != NT_ERROR_MEMORY && !job->differs && !job->decoded_too && !all[same].override) {
		nt_error_clear(job->error);
		return NT_OK;
	}
	if (status || all[same].listed || !is_new)
		return status;
	if (!nt_grow((void **)&job->targets, &job->target_capacity, job->target_count + 1, sizeof *job->targets))
		return nt_fail_memory(job->error);
	target *added = &job->targets[job->target_count++];
	*added = (target){.accessor = &job->document->accessors[same],
		.override = all[same].override ? job->overrides->items[all[same].override - 1] : NULL};
	all[same].listed = true;
	if (a->view == NT_NONE)
		return NT_OK;
	const nt_gltf_view *view = nt_gltf_view_of(job->document, a);
	added->begin = view->offset + a->offset;
	added->segment = nt_segment_at(job->edits, view->buffer, added->begin);
	return NT_OK;
}

static nt_status collect_all(appending *job)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < pool->user_count; i++)
		for (nt_gltf_use u = {0}; !status && nt_gltf_next_use(job->document, nt_pool_primitive(pool, i), &u);)
			status = collect(job, u.accessor, nt_pool_is_solved(pool, i));
	return status;
}

/* The next accessor over the bytes of a target that a user of the pool has; before the first: NT_NONE. */
static uint32_t next_accessor(const appending *job, const target *t, uint32_t before)
{
	uint32_t k = before == NT_NONE ? t->accessor->index : job->document->accessors[before].next;
	while (k != NT_NONE && !job->edits->accessors[k].seen)
		k = job->document->accessors[k].next;
	return k;
}

/* ---- to new views ---- */

/* Elements as a packed view stores them, or as readers have them with sparse ones put in, `*step` apart. */
static nt_status find_elements(appending *job, const target *t, bool stored, const unsigned char **elements,
	size_t *step)
{
	const nt_gltf_accessor *a = t->accessor;
	*step = a->stride;
	if (!stored)
		return nt_gltf_whole_elements(job->document, a, job->arena, elements, step, job->error);
	const nt_status status = nt_gltf_elements(job->document, a, elements, job->error);
	return status ? status : nt_packed_bytes(job->edits, t->segment->buffer, t->begin, elements, job->error);
}

/* An accessor's bounds become those of its values if these are new, or come from a decoder: the
 * encoder may have moved them. Copies do not matter. */
static nt_status settle_bounds(appending *job, const target *t, uint32_t accessor)
{
	const nt_gltf_accessor *a = t->accessor;
	nt_json_value *json = nt_gltf_accessor_json(job->document, accessor);
	const unsigned char *elements = NULL;
	size_t step;
	nt_status status = NT_OK;
	if (t->override) {
		const nt_stored_tangents *new = &t->override->values;
		nt_gltf_measure(job->document, a, json, new->values, new->element_bytes, job->vertices->new_count,
			nt_precision_component_type(new->filter.precision));
	} else if (a->decoded || (t->segment && nt_gltf_is_of_view(t->segment->buffer))) {
		status = find_elements(job, t, false, &elements, &step);
		if (!status)
			nt_gltf_measure(job->document, a, json, elements, step, (size_t)a->count, a->component_type);
	}
	return status;
}

/* All elements go to a new place: of their own, or of others that are packed like them. */
static nt_status move_elements(appending *job, target *t, uint32_t *view, uint64_t *offset)
{
	const nt_gltf_accessor *a = t->accessor;
	const size_t count = job->vertices->new_count, stride = (a->element_bytes + 3u) / 4 * 4;
	nt_gltf_packing packing = nt_packing_of(job->edits, a->view);
	const unsigned char *elements = NULL;
	size_t step = 0;
	/* a filter is one of whole elements */
	const bool stored = packing.extension && packing.view.stride == stride && !a->sparse;
	if (!stored)
		packing.view.filter = "NONE";
	packing.view.stride = stride;
	unsigned char *out = nt_arena_alloc(job->arena, count, stride);
	if (!out)
		return nt_fail_memory(job->error);
	memset(out, 0, count * stride);
	const nt_status status = find_elements(job, t, stored, &elements, &step);
	for (size_t v = 0; !status && elements && v < count; v++)
		memcpy(out + v * stride, elements + nt_vertex_source(job->vertices, v) * step, a->element_bytes);
	if (!t->stays && !status)
		nt_edits_leave_accessor(job->edits, a->index);
	/* A view says how far apart elements are if several accessors share it, or if these are matrices of small
	 * integers: the Khronos validator takes their last column to have no padding. */
	const bool is_tight = a->next == NT_NONE && stride == (size_t)a->components * a->component_bytes;
	return status ? status : nt_packed_add(job->edits, job->buffer, &packing, out, count * stride,
		NT_GLTF_ARRAY_BUFFER, is_tight ? 0 : (uint32_t)stride, view, offset, job->error);
}

static nt_status move_away(appending *job, target *t)
{
	uint32_t view = 0;
	uint64_t offset = 0;
	nt_status status = NT_OK;
	t->moved = true;
	if (t->override) {
		nt_edits_leave_accessor(job->edits, t->accessor->index);
		status = nt_set_attribute_place(job->edits, job->buffer, t->override, job->vertices->new_count,
			t->override->own_count > 1 || t->accessor->next != NT_NONE, job->error);
		view = t->override->view;
		offset = t->override->offset;
	} else {
		status = move_elements(job, t, &view, &offset);
	}
	for (uint32_t k = next_accessor(job, t, NT_NONE); !status && k != NT_NONE; k = next_accessor(job, t, k)) {
		nt_json_value *json = nt_gltf_accessor_json(job->document, k);
		nt_gltf_place_accessor(job->json, json, view, offset);
		for (size_t i = 0; t->override && i < 2; i++)
			nt_json_remove(job->json, json, i ? "max" : "min");
	}
	return status;
}

/* ---- new values ---- */

/* Whether new values go where the old ones are: of the same type, or smaller ones that are interleaved. */
static bool values_fit(const appending *job, const target *t)
{
	const nt_tangent_filter *filter = &t->override->values.filter;
	const nt_gltf_packing packing = nt_packing_of(job->edits, t->accessor->view);
	const nt_gltf_accessor *a = t->accessor;
	if (!t->segment || a->sparse || strcmp(packing.extension ? packing.view.filter : "NONE", filter->filter) != 0)
		return false;
	if (a->component_type == nt_precision_component_type(filter->precision) &&
		(a->component_type == NT_GLTF_FLOAT || a->normalized))
		return true;
	return a->stride > a->element_bytes && t->override->values.element_bytes <= a->element_bytes &&
		t->segment->users > 1;
}

/* New values that do not fit go to new views. */
static nt_status move_values(appending *job)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < job->target_count; i++) {
		target *t = &job->targets[i];
		if (!t->override || values_fit(job, t))
			continue;
		status = move_away(job, t);
		t->segment = NULL;
	}
	return status;
}

/* The type in which they are stored. */
static void describe_values(const appending *job, const target *t, nt_json_value *accessor)
{
	const uint32_t type = nt_precision_component_type(t->override->values.filter.precision);
	if (type == t->accessor->component_type && (type == NT_GLTF_FLOAT || t->accessor->normalized))
		return;
	nt_json_put_uint64(job->json, accessor, "componentType", type);
	if (type == NT_GLTF_FLOAT)
		nt_json_remove(job->json, accessor, "normalized");
	else
		nt_json_set_bool(job->json, nt_json_put(job->json, accessor, "normalized"), true);
}

/* ---- accessors that must keep their count ---- */

/* Primitives without indices draw every vertex, so none must be added to what they use. */
static bool must_pin(const appending *job)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	for (size_t i = 0; i < pool->user_count && !nt_vertices_are_welded(job->vertices); i++)
		if (!nt_pool_is_solved(pool, i) && !nt_json_find(nt_pool_primitive(pool, i), "indices"))
			return true;
	for (size_t i = 0; i < job->target_count; i++)
		if (job->document->users[job->targets[i].accessor->index].foreign)
			return true;
	return false;
}

/* Gives the solved users a copy of an accessor. */
static nt_status clone(appending *job, target *t)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	nt_json_value *accessors = nt_gltf_root_member(job->document, "accessors");
	const uint32_t number = (uint32_t)nt_json_count(accessors), same = t->accessor->index;
	nt_json_value *copy = nt_json_append(job->json, accessors);
	uint32_t view = 0;
	uint64_t offset = 0;
	t->stays = t->moved = true;
	nt_json_set_copy(job->json, copy, nt_json_at(accessors, same));
	nt_status status = move_elements(job, t, &view, &offset);
	nt_gltf_place_accessor(job->json, copy, view, offset);
	nt_json_put_uint64(job->json, copy, "count", job->vertices->new_count);
	if (!status)
		status = settle_bounds(job, t, number);
	for (size_t i = 0; i < pool->user_count; i++) {
		nt_gltf_use u = {0};
		while (nt_pool_is_solved(pool, i) &&
			nt_gltf_next_use(job->document, nt_pool_primitive(pool, i), &u))
			if (nt_gltf_same(job->document, u.accessor) == same)
				nt_json_put_uint64(job->json, u.attributes, u.name, number);
	}
	return status;
}

static nt_status clone_pinned(appending *job)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < job->target_count; i++) {
		const uint32_t same = job->targets[i].accessor->index;
		const nt_edited_accessor *edited = &job->edits->accessors[same];
		if (!edited->solved)
			job->targets[i].stays = true;
		else if (edited->pinned || job->document->users[same].foreign)
			status = clone(job, &job->targets[i]);
	}
	return status;
}

/* ---- in place ---- */

static int compare_targets(const void *a, const void *b)
{
	const target *x = a, *y = b;
	if (x->segment != y->segment)
		return !x->segment ? 1 : !y->segment ? -1 : x->segment < y->segment ? -1 : 1;
	if (x->begin != y->begin)
		return x->begin < y->begin ? -1 : 1;
	return (x->accessor->index > y->accessor->index) - (x->accessor->index < y->accessor->index);
}

/* Interleaved accessors: the targets of one segment. */
typedef struct block {
	target *targets;
	size_t count;
	nt_segment *segment;
	size_t stride, width; /* of a vertex */
	bool overridden, changes;
} block;

/* Whether new values of a target are not where another accessor has its own. */
static bool lies_apart(const block *b, const target *t, const nt_gltf_accessor *other, uint64_t begin)
{
	const uint64_t stride = b->stride, behind = (t->begin + stride - begin % stride) % stride;
	return !t->override || (other->stride == stride && behind >= other->element_bytes &&
		behind + t->accessor->element_bytes <= stride);
}

/* Knows the accessors of a segment that no edit touches and that lie between what gets new values, if that is all that
 * happens. */
static void know_apart(const appending *job, const block *b)
{
	uint32_t k = job->differs ? NT_NONE : b->segment->apart;
	for (; k != NT_NONE; k = job->edits->accessors[k].apart) {
		const nt_gltf_accessor *a = &job->document->accessors[k];
		const uint64_t begin = nt_gltf_view_of(job->document, a)->offset + a->offset;
		bool apart = true;
		for (size_t i = 0; apart && i < b->count; i++)
			apart = lies_apart(b, &b->targets[i], a, begin);
		if (apart)
			nt_segment_know(b->segment, job->owner, 1 + nt_gltf_users_of(job->document, k)->idle);
	}
}

/* Whether the segment of a block has nothing but vertices of the pool, without new values where another has its own.
 * A filter may need all that fills an element of a packed view. */
static bool fits_in_place(const appending *job, const block *b)
{
	const nt_gltf_packing packing = nt_packing_of(job->edits, b->targets->accessor->view);
	bool fits = nt_segment_is_known(b->segment, job->owner) && b->width <= b->stride &&
		(!packing.extension || packing.view.stride == b->stride);
	for (size_t i = 0; fits && i < b->count; i++) {
		const target *t = &b->targets[i];
		fits = t->accessor->stride == b->stride;
		for (size_t k = 0; fits && t->override && k < b->count; k++)
			fits = k == i || lies_apart(b, t, b->targets[k].accessor, b->targets[k].begin);
	}
	return fits;
}

/* The bytes of a segment, as readers have them and as they are stored. Each target has been checked against its own
 * view; the segment is their union. */
static nt_status segment_bytes(appending *job, const block *b, const unsigned char **decoded,
	const unsigned char **stored)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < b->count; i++) {
		const unsigned char *elements;
		status = nt_gltf_elements(job->document, b->targets[i].accessor, &elements, job->error);
		if (!status && i == 0)
			*stored = *decoded = elements - (b->targets->begin - b->segment->begin);
	}
	return status ? status : nt_packed_bytes(job->edits, b->segment->buffer, b->segment->begin, stored, job->error);
}

/* Values that a reader will see as before stay as they are stored, since several elements of a packed view may mean the
 * same. */
static void put_values(const appending *job, const block *b, const target *t, const unsigned char *decoded,
	unsigned char *out)
{
	const nt_pool_vertices *vertices = job->vertices;
	const nt_stored_tangents *new = &t->override->values;
	const size_t width = new->element_bytes, place = (size_t)(t->begin - b->segment->begin);
	for (size_t v = 0; v < vertices->new_count; v++) {
		const unsigned char *value = new->values + v * width;
		const bool known = v < vertices->old_count || nt_vertices_are_welded(vertices);
		if (known && width == t->accessor->element_bytes &&
			memcmp(decoded + place + nt_vertex_source(vertices, v) * b->stride, value, width) == 0)
			continue;
		memset(out + place + v * b->stride, 0, t->accessor->element_bytes);
		memcpy(out + place + v * b->stride, new->stored + v * width, width);
	}
}

/* Copied vertices come in behind those of a segment; all are replaced if some values are new, or none is where it
 * was. */
static nt_status edit_segment(appending *job, const block *b)
{
	const nt_pool_vertices *vertices = job->vertices;
	const size_t own = vertices->own_count, count = vertices->new_count;
	const bool kept = own && !b->overridden;
	/* the last vertex may end before its stride does: padding comes first */
	const size_t gap = kept ? b->stride - b->width : 0, first = kept ? own : 0;
	const size_t size = kept ? (count - own) * b->stride : (count - 1) * b->stride + b->width;
	const unsigned char *decoded = NULL, *stored = NULL;
	nt_status status = segment_bytes(job, b, &decoded, &stored);
	unsigned char *out = nt_arena_alloc(job->arena, size, 1);
	if (status || !out)
		return status ? status : nt_fail_memory(job->error);
	memset(out, 0, size);
	if (own && !kept)
		memcpy(out, stored, (size_t)(b->segment->end - b->segment->begin));
	for (size_t v = own; v < count; v++)
		memcpy(out + gap + (v - first) * b->stride, stored + nt_vertex_source(vertices, v) * b->stride,
			b->width);
	for (size_t i = 0; i < b->count; i++)
		if (b->targets[i].override)
			put_values(job, b, &b->targets[i], decoded, out);
	nt_segment_edit(job->edits, b->segment, (nt_segment_change){.kept = kept, .bytes = out, .size = size,
		.stride = job->differs ? (uint32_t)b->stride : 0});
	return NT_OK;
}

static nt_status edit_block(appending *job, const block *b)
{
	nt_status status = NT_OK;
	know_apart(job, b);
	if (b->changes && fits_in_place(job, b))
		return edit_segment(job, b);
	for (size_t i = 0; !status && i < b->count; i++)
		if (!b->targets[i].stays && (job->differs || b->targets[i].override))
			status = move_away(job, &b->targets[i]);
	return status;
}

/* ---- sparse accessors ---- */

/* Numbers of the elements that are replaced, then those of their copies: these have the highest, so that numbers stay
 * in order. */
typedef struct replacement {
	uint32_t *elements;
	unsigned char *values;
	size_t count;
} replacement;

/* If all that was replaced has the values of others now, the first element is replaced by what it is: a sparse accessor
 * may not be without any. */
static nt_status replace_first(appending *job, const nt_gltf_accessor *a, replacement *out)
{
	const unsigned char *elements;
	const nt_status status = nt_gltf_elements(job->document, a, &elements, job->error);
	if (status)
		return status;
	out->count = 1;
	out->elements[0] = 0;
	memset(out->values, 0, a->element_bytes);
	if (elements)
		memcpy(out->values, elements + nt_vertex_source(job->vertices, 0) * a->stride, a->element_bytes);
	return NT_OK;
}

static nt_status find_replacements(appending *job, const nt_gltf_accessor *a, replacement *out)
{
	const uint32_t *replaced;
	const unsigned char *values;
	const nt_status status = nt_gltf_sparse(job->document, a, job->arena, &replaced, &values, job->error);
	if (status)
		return status;
	const nt_pool_vertices *vertices = job->vertices;
	const size_t old_count = (size_t)a->sparse->count, most = old_count + vertices->new_count - vertices->own_count;
	const uint32_t element = a->element_bytes;
	out->elements = nt_arena_alloc(job->arena, most, sizeof *out->elements);
	out->values = nt_arena_alloc(job->arena, most, element);
	uint32_t *position = nt_alloc((size_t)a->count, sizeof *position); /* of an element in replaced */
	if (!out->elements || !out->values || !position) {
		free(position);
		return nt_fail_memory(job->error);
	}
	memset(position, 0xFF, (size_t)a->count * sizeof *position);
	for (size_t i = 0; i < old_count; i++)
		position[replaced[i]] = (uint32_t)i;
	memcpy(out->elements, replaced, old_count * sizeof *replaced);
	memcpy(out->values, values, old_count * element);
	/* welding leaves none where it was */
	out->count = nt_vertices_are_welded(vertices) ? 0 : old_count;
	for (size_t vertex = vertices->own_count; vertex < vertices->new_count; vertex++) {
		const uint32_t at = position[nt_vertex_source(vertices, vertex)];
		if (at == NT_NONE)
			continue;
		out->elements[out->count] = (uint32_t)vertex;
		memcpy(out->values + out->count * element, values + (size_t)at * element, element);
		out->count++;
	}
	free(position);
	return out->count ? NT_OK : replace_first(job, a, out);
}

/* One of the two arrays of a sparse accessor, as it is and as it will be. */
typedef struct sparse_array {
	uint32_t view;
	uint64_t offset, old_size, old_width;
	const unsigned char *bytes;
	size_t size, width; /* width: of an element, for its alignment */
} sparse_array;

/* Puts the new array where the old one is, else into a new view. Morph targets often share one array of indices: they
 * replace the same elements, so that what it becomes for one is right for all. */
static nt_status put_sparse_array(appending *job, nt_json_value *json, const sparse_array *array)
{
	const nt_gltf_view *view = &job->document->views[array->view];
	const uint64_t begin = view->offset + array->offset;
	nt_segment *segment = nt_segment_at(job->edits, view->buffer, begin);
	if (segment && nt_segment_is_known(segment, job->sparse_owner) && segment->begin == begin &&
		segment->end == begin + array->old_size && begin % array->width == 0 &&
		(array->width == array->old_width || !nt_gltf_is_of_view(view->buffer))) {
		nt_segment_edit(job->edits, segment, (nt_segment_change){.bytes = array->bytes, .size = array->size});
		return NT_OK;
	}
	uint32_t number;
	nt_edits_leave(job->edits, array->view, array->offset);
	const nt_status status = nt_edits_add_view(job->edits, job->buffer, array->bytes, array->size, 0, 0, &number,
		job->error);
	nt_gltf_place_accessor(job->json, json, number, 0);
	return status;
}

/* Copies of elements that a sparse accessor replaces are replaced too. */
static nt_status append_sparse(appending *job, const nt_gltf_accessor *a)
{
	const nt_gltf_sparse_arrays *s = a->sparse;
	replacement r = {0};
	nt_status status = find_replacements(job, a, &r);
	if (status || (!nt_vertices_are_welded(job->vertices) && r.count == s->count))
		return status;
	const uint32_t type = nt_gltf_index_type(r.elements[r.count - 1], s->index_type);
	const uint32_t width = nt_gltf_component_bytes(type), old_width = nt_gltf_component_bytes(s->index_type);
	unsigned char *numbers = nt_arena_alloc(job->arena, r.count, width);
	if (!numbers)
		return nt_fail_memory(job->error);
	nt_gltf_store_indices(r.elements, r.count, width, numbers);

	nt_json_value *sparse = nt_json_find(nt_gltf_accessor_json(job->document, a->index), "sparse");
	nt_json_put_uint64(job->json, sparse, "count", r.count);
	if (type != s->index_type)
		nt_json_put_uint64(job->json, nt_json_find(sparse, "indices"), "componentType", type);
	status = put_sparse_array(job, nt_json_find(sparse, "indices"), &(sparse_array){s->index_view, s->index_offset,
		s->count * old_width, old_width, numbers, r.count * width, width});
	return status ? status : put_sparse_array(job, nt_json_find(sparse, "values"), &(sparse_array){s->value_view,
		s->value_offset, s->count * a->element_bytes, a->component_bytes, r.values,
		r.count * a->element_bytes, a->component_bytes});
}

/* ---- the whole ---- */

static nt_status edit_targets(appending *job)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < job->target_count; i++) {
		const target *t = &job->targets[i];
		/* an accessor of nobody over the same bytes does not mind others behind them */
		nt_segment_know(t->segment, job->owner, 1 + nt_gltf_users_of(job->document, t->accessor->index)->idle);
	}
	if (job->target_count)
		qsort(job->targets, job->target_count, sizeof *job->targets, compare_targets);
	for (size_t i = 0; !status && i < job->target_count && job->targets[i].segment;) {
		block b = {.targets = &job->targets[i], .segment = job->targets[i].segment,
			.stride = job->targets[i].accessor->stride};
		for (; i < job->target_count && job->targets[i].segment == b.segment; i++, b.count++) {
			b.overridden |= job->targets[i].override != NULL;
			b.changes |= job->targets[i].override || (job->differs && !job->targets[i].stays);
		}
		b.width = (size_t)(b.segment->end - b.segment->begin - (job->vertices->old_count - 1) * b.stride);
		status = edit_block(job, &b);
	}
	for (size_t i = 0; !status && i < job->target_count; i++) {
		const target *t = &job->targets[i];
		const nt_gltf_sparse_arrays *s = t->stays || t->moved ? NULL : t->accessor->sparse;
		if (!s)
			continue;
		nt_segment_know(nt_segment_of(job->edits, s->index_view, s->index_offset), job->sparse_owner, 1);
		nt_segment_know(nt_segment_of(job->edits, s->value_view, s->value_offset), job->sparse_owner, 1);
	}
	for (size_t i = 0; !status && i < job->target_count; i++) {
		target *t = &job->targets[i];
		if (t->stays)
			continue;
		if (job->decoded_too && t->accessor->decoded && !t->moved)
			status = move_away(job, t);
		for (uint32_t k = next_accessor(job, t, NT_NONE); !status && k != NT_NONE;
			k = next_accessor(job, t, k)) {
			if (t->override)
				describe_values(job, t, nt_gltf_accessor_json(job->document, k));
			status = settle_bounds(job, t, k);
			if (job->differs || job->decoded_too)
				nt_json_put_uint64(job->json, nt_gltf_accessor_json(job->document, k), "count",
					job->vertices->new_count);
		}
		if (!status && t->accessor->sparse && job->differs && !t->moved)
			status = append_sparse(job, t->accessor);
	}
	return status;
}

nt_status nt_append_vertices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	const nt_override_list *overrides, bool decoded_too, nt_error *error)
{
	appending job = {.edits = edits, .document = edits->document, .json = edits->document->json,
		.arena = &edits->arena, .vertices = vertices, .overrides = overrides, .buffer = buffer,
		.owner = 2 * vertices->pool->users[0] + 1, .sparse_owner = 2 * vertices->pool->users[0] + 2,
		.decoded_too = decoded_too,
		.differs = nt_vertices_differ(vertices), .error = error};
	nt_status status = collect_all(&job);
	if (!status)
		status = move_values(&job);
	if (!status && job.differs && must_pin(&job))
		status = clone_pinned(&job);
	if (!status)
		status = edit_targets(&job);
	free(job.targets);
	return status;
}
