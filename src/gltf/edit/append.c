/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in the accessors of a pool.
 *
 * Accessors keep their number and their first elements. Attributes that are interleaved form a block whose
 * vertices are copied as a whole and inserted behind its last one. If bytes of a block also belong to somebody else,
 * its accessors move to new views. An accessor that has to keep its count, because a primitive without indices or an
 * animation uses it too, is left alone and the solved primitives get a copy of it.
 */
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"
#include "gltf/bytes/bytes.h"

/* ---- accessors that must keep their count ---- */

/* Primitives without indices draw every vertex, so none must be added to what they use. */
static bool must_pin(const nt_appending *job)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	for (size_t i = 0; i < pool->user_count && !job->vertices->renumbered; i++)
		if (!nt_pool_is_solved(pool, i) && !nt_json_find(nt_pool_primitive(pool, i), "indices"))
			return true;
	for (size_t i = 0; i < job->target_count; i++)
		if (job->document->users[job->targets[i].accessor.same].foreign)
			return true;
	return false;
}

/* The elements of an accessor with the appended ones, `stride` apart; sparse values put in where `bake`, as a packed
 * view stores them where `stored`. */
static nt_status copy_elements(nt_appending *job, const nt_append_target *from, uint32_t stride, bool bake, bool stored,
	unsigned char **result)
{
	const nt_gltf_accessor *a = &from->accessor;
	const size_t count = job->vertices->new_count;
	unsigned char *out = nt_arena_alloc(job->arena, count, stride);
	if (!out)
		return nt_fail_memory(job->error);
	memset(out, 0, count * stride);
	*result = out;
	/* welded ones are gathered from all of the source's */
	unsigned char *all = job->vertices->own_count < a->count
		? nt_arena_alloc(job->arena, (size_t)a->count, stride) : out;
	if (!all)
		return nt_fail_memory(job->error);
	if (all != out)
		memset(all, 0, (size_t)a->count * stride);
	if (from->override) {
		for (size_t v = 0; v < count; v++)
			memcpy(out + v * stride, (stored ? from->override->stored : from->override->values) +
				v * from->override->width, from->override->width);
		return NT_OK;
	}
	const unsigned char *elements = NULL;
	nt_status status = nt_gltf_elements(job->document, a, &elements, job->error);
	if (!status && stored)
		status = nt_packed_bytes(job->edits, from->buffer, from->begin, &elements, job->error);
	for (size_t v = 0; !status && elements && v < a->count; v++)
		memcpy(all + v * stride, elements + v * a->stride, a->element_bytes);
	if (!status && bake && a->sparse) {
		const uint32_t *replaced;
		const unsigned char *values;
		status = nt_gltf_sparse(job->document, a, job->arena, &replaced, &values, job->error);
		for (size_t i = 0; !status && i < a->sparse->count; i++)
			memcpy(all + (size_t)replaced[i] * stride, values + i * a->element_bytes,
				a->element_bytes);
	}
	for (size_t v = job->vertices->own_count; !status && v < count; v++)
		memcpy(out + v * stride, all + nt_vertex_source(job->vertices, v) * stride, a->element_bytes);
	return status;
}

/* All elements of an accessor go to a new place: of its own, or of others that are packed like it. */
static nt_status add_elements(nt_appending *job, nt_append_target *from, bool bake, nt_json_value *accessor)
{
	const uint32_t element = from->override ? from->override->width : from->accessor.element_bytes;
	const uint32_t stride = (element + 3) / 4 * 4;
	nt_gltf_packing packing = nt_packing_of(job->edits, from->accessor.view);
	unsigned char *elements = NULL;
	/* of several accessors a view has to say how far apart elements are */
	const bool shared = from->accessor.same != from->accessor.index || from->accessor.next != NT_NONE;
	/* a filter is one of whole elements */
	const bool stored =
		packing.extension && packing.view.stride == stride && !(bake && from->accessor.sparse);
	if (!stored)
		packing.view.filter = "NONE";
	packing.view.stride = stride;
	nt_status status = copy_elements(job, from, stride, bake, stored, &elements);
	if (!status)
		status = nt_packed_add(job->edits, job->buffer, &packing, elements,
			job->vertices->new_count * stride, NT_GLTF_ARRAY_BUFFER,
			shared || stride != element ? stride : 0, &from->new_view, &from->new_offset, job->error);
	if (!status)
		nt_gltf_place_accessor(job->json, accessor, from->new_view, from->new_offset);
	return status;
}

/* An accessor's bounds become those of its values if these are new, or come from a decoder: the
 * encoder may have moved them. Copies do not matter. */
static nt_status settle_bounds(nt_appending *job, const nt_append_target *of, uint32_t accessor)
{
	const nt_gltf_accessor *a = &of->accessor;
	const nt_gltf_override *override = of->override;
	uint32_t stride = override ? override->width : a->sparse ? a->element_bytes : a->stride;
	int type = (int)a->component_type;
	const unsigned char *elements = NULL;
	double bounds[2][4];
	nt_status status = NT_OK;
	if ((!override && !a->decoded && !nt_gltf_is_of_view(of->buffer)) || a->components > 4 ||
		a->element_bytes != a->components * a->component_bytes)
		return NT_OK;
	if (override) {
		elements = override->values;
		type = stride == 16 ? NT_GLTF_FLOAT : stride == 8 ? NT_GLTF_SHORT : NT_GLTF_BYTE;
	} else if (a->sparse) {
		unsigned char *baked = NULL;
		status = copy_elements(job, of, stride, true, false, &baked);
		elements = baked;
	} else {
		status = nt_gltf_elements(job->document, a, &elements, job->error);
	}
	if (status || !elements)
		return status;
	nt_component_bounds(elements, stride, override ? job->vertices->new_count : (size_t)a->count, type,
		a->components, bounds);
	nt_gltf_state_bounds(job->json, nt_gltf_accessor_json(job->document, accessor), a->components, bounds);
	return NT_OK;
}

static nt_status clone_accessor(nt_appending *job, nt_append_target *from)
{
	nt_json_value *accessors = nt_gltf_root_member(job->document, "accessors");
	from->clone = (uint32_t)nt_json_count(accessors);
	nt_json_value *clone = nt_json_append(job->json, accessors);
	nt_json_set_copy(job->json, clone, nt_json_at(accessors, from->accessor.index));
	const nt_status status = add_elements(job, from, true, clone);
	nt_json_put_uint64(job->json, clone, "count", job->vertices->new_count);
	return status ? status : settle_bounds(job, from, from->clone);
}

static void use_clones(nt_appending *job, const nt_json_value *primitive)
{
	for (nt_gltf_use u = {0}; nt_gltf_next_use(job->document, primitive, &u);)
		for (size_t i = 0; i < job->target_count; i++)
			if (job->targets[i].accessor.index == u.accessor && job->targets[i].clone != NT_NONE)
				nt_json_put_uint64(job->json, u.attributes, u.name, job->targets[i].clone);
}

/* Whether an accessor that stays lies at the end of vertices in which others of the pool lie: copies of these
 * would come in before its last element. */
static bool ends_vertices(const nt_appending *job, const nt_append_target *pinned)
{
	bool before = false, behind = false;
	for (size_t i = 0; i < job->target_count; i++) {
		const nt_append_target *t = &job->targets[i];
		if (t->clone != NT_NONE || t->accessor.view == NT_NONE || t->buffer != pinned->buffer)
			continue;
		before |= t->begin < pinned->begin && pinned->begin - t->begin < t->accessor.stride;
		behind |= t->begin > pinned->begin && t->begin - pinned->begin < t->accessor.stride;
	}
	return before && !behind;
}

/* Copies the pinned accessors, points solved users to the copies and takes them off the list. */
static nt_status clone_pinned(nt_appending *job)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < job->target_count; i++) {
		const uint32_t index = job->targets[i].accessor.index;
		if (job->edits->accessors[index].pinned || job->document->users[job->targets[i].accessor.same].foreign)
			status = clone_accessor(job, &job->targets[i]);
	}
	for (size_t i = 0; !status && i < job->vertices->pool->user_count; i++)
		if (nt_pool_is_solved(job->vertices->pool, i))
			use_clones(job, nt_pool_primitive(job->vertices->pool, i));
	for (size_t i = 0; i < job->target_count; i++)
		if (job->targets[i].clone != NT_NONE && job->targets[i].accessor.view != NT_NONE &&
			ends_vertices(job, &job->targets[i]))
			job->edits->accessors[job->targets[i].accessor.same].appended_by = 0;
	size_t kept = 0;
	for (size_t i = 0; i < job->target_count; i++)
		if (job->targets[i].clone == NT_NONE)
			job->targets[kept++] = job->targets[i];
	job->target_count = kept;
	return status;
}

/* ---- appending in place ---- */

static int compare_targets(const void *a, const void *b)
{
	const nt_append_target *x = a, *y = b;
	const bool x_has = x->accessor.view != NT_NONE, y_has = y->accessor.view != NT_NONE;
	if (x_has != y_has)
		return x_has ? -1 : 1;
	if (x->buffer != y->buffer)
		return x->buffer < y->buffer ? -1 : 1;
	if (x->begin != y->begin)
		return x->begin < y->begin ? -1 : 1;
	return (x->accessor.index > y->accessor.index) - (x->accessor.index < y->accessor.index);
}

/* Interleaved accessors: vertices of `width` bytes, `stride` apart. */
typedef struct block {
	nt_append_target *targets;
	size_t count;
	uint32_t buffer, stride, width;
	uint64_t begin, end;
	bool overridden;
	bool misfits; /* its vertices are not the elements of the packed view that has them */
} block;

/* The longest run of targets from `targets` on that share vertices. */
static block find_block(const nt_appending *job, nt_append_target *targets, size_t left)
{
	block b = {.targets = targets, .count = 1, .buffer = targets->buffer,
		.stride = targets->accessor.stride, .width = targets->accessor.element_bytes,
		.begin = targets->begin, .overridden = targets->override != NULL};
	while (b.count < left) {
		const nt_append_target *next = &targets[b.count];
		const uint64_t end = next->begin - b.begin + next->accessor.element_bytes;
		if (next->accessor.view == NT_NONE || next->buffer != b.buffer ||
			next->accessor.stride != b.stride || end > b.stride)
			break;
		if (end > b.width)
			b.width = (uint32_t)end;
		b.overridden |= next->override != NULL;
		b.count++;
	}
	const nt_gltf_packing packing = nt_packing_of(job->edits, targets->accessor.view);
	if (packing.extension) {
		/* what fills an element goes with it: a filter may need it */
		b.misfits = packing.view.stride != b.stride;
		b.begin -= b.begin % b.stride;
		b.width = b.stride;
	}
	b.end = b.begin + (job->vertices->old_count - 1) * (uint64_t)b.stride + b.width;
	return b;
}

/* Whether new values would go where another accessor of the block has its own, or the next target behind the block.
 * next: NULL: there is none. */
static bool is_crowded(const block *b, const nt_append_target *next)
{
	if (!b->overridden)
		return false;
	bool crowded = next && next->accessor.view != NT_NONE && next->buffer == b->buffer && next->begin < b->end;
	for (size_t i = 0; !crowded && i < b->count; i++)
		for (size_t k = 0; b->targets[i].override && !crowded && k < b->count; k++) {
			const nt_append_target *x = &b->targets[i], *y = &b->targets[k];
			crowded = x->accessor.same != y->accessor.same &&
				x->begin < y->begin + y->accessor.element_bytes &&
				y->begin < x->begin + x->accessor.element_bytes;
		}
	return crowded;
}

/* Moves a target to a view of its own, or to where one before it went that lies over the same bytes. A sparse accessor
 * becomes plain there; one of a Draco block is not sparse. */
static nt_status move_away(nt_appending *job, nt_append_target *moved)
{
	nt_json_value *accessor = nt_gltf_accessor_json(job->document, moved->accessor.index);
	const nt_append_target *other = moved;
	while (other > job->targets && other[-1].begin == moved->begin &&
		(other == moved || other->accessor.same != moved->accessor.same))
		other--;
	if (other == moved || other->accessor.same != moved->accessor.same || other->new_view == NT_NONE)
		return add_elements(job, moved, !moved->accessor.decoded, accessor);
	moved->new_view = other->new_view;
	moved->new_offset = other->new_offset;
	nt_gltf_place_accessor(job->json, accessor, other->new_view, other->new_offset);
	return NT_OK;
}

static nt_status block_bytes(nt_appending *job, const block *b, const unsigned char **bytes)
{
	const nt_gltf_accessor *first = &b->targets->accessor;
	nt_gltf_view view;
	nt_status status =
		nt_gltf_get_view(job->document, first->view, "/accessors", &view, job->error);
	/* each target has been checked against its own view; the block is their union */
	for (size_t i = 0; !status && i < b->count; i++) {
		const unsigned char *elements;
		status = nt_gltf_elements(job->document, &b->targets[i].accessor, &elements, job->error);
		if (i == 0)
			*bytes = elements - (b->targets->begin - b->begin);
	}
	return status;
}

/* Vertices come in behind the block: views that end before its last vertex does go on to its end, to have them too.
 * So it is where each accessor of a block has a view that ends with its last element. */
static void lengthen_views(nt_appending *job, const block *b)
{
	for (size_t i = 0; i < b->count; i++) {
		const uint32_t index = b->targets[i].accessor.view;
		nt_gltf_view view;
		if (nt_gltf_get_view(job->document, index, "", &view, NULL) != NT_OK ||
			nt_gltf_is_of_view(view.buffer) ||
			view.offset + view.length >= b->end)
			continue;
		nt_json_value *object = nt_gltf_view_json(job->document, index);
		nt_json_put_uint64(job->json, object, "byteLength", b->end - view.offset);
		job->document->views[index].length = b->end - view.offset;
	}
}

/* Inserts the copied vertices behind the block. */
static nt_status insert_vertices(nt_appending *job, const block *b, const unsigned char *elements)
{
	const size_t old_count = job->vertices->old_count, added = job->vertices->new_count - old_count;
	unsigned char *out = nt_arena_alloc(job->arena, added, b->stride);
	if (!out)
		return nt_fail_memory(job->error);
	/* The last vertex of the block may end before its stride does: padding comes first. */
	const size_t gap = b->stride - b->width;
	for (size_t i = 0; i < added; i++) {
		memset(out + i * b->stride, 0, gap);
		memcpy(out + i * b->stride + gap,
			elements + nt_vertex_source(job->vertices, old_count + i) * b->stride, b->width);
	}
	return nt_edits_replace(job->edits, b->buffer, b->end, 0, out, added * b->stride, job->error);
}

/* Replaces the whole block: some of its values are new. Values that a reader will see as before stay as they are
 * stored, since several elements of a packed view may mean the same. */
static nt_status replace_vertices(nt_appending *job, const block *b, const unsigned char *decoded,
	const unsigned char *elements)
{
	const size_t count = job->vertices->new_count, old_size = (size_t)(b->end - b->begin);
	const size_t size = (count - 1) * b->stride + b->width;
	unsigned char *out = nt_arena_alloc(job->arena, count, b->stride);
	if (!out)
		return nt_fail_memory(job->error);
	memset(out, 0, count * b->stride);
	if (job->vertices->own_count)
		memcpy(out, elements, old_size);
	for (size_t v = job->vertices->own_count; v < count; v++)
		memcpy(out + v * b->stride, elements + nt_vertex_source(job->vertices, v) * b->stride, b->width);
	for (size_t i = 0; i < b->count; i++) {
		const nt_gltf_override *override = b->targets[i].override;
		unsigned char *at = out + (b->targets[i].begin - b->begin);
		const unsigned char *before = decoded + (b->targets[i].begin - b->begin);
		for (size_t v = 0; override && v < count; v++) {
			const bool known = v < job->vertices->old_count || !job->vertices->own_count;
			if (known && override->width == b->targets[i].accessor.element_bytes &&
				memcmp(before + nt_vertex_source(job->vertices, v) * b->stride,
					override->values + v * override->width, override->width) == 0)
				continue;
			memset(at + v * b->stride, 0, b->targets[i].accessor.element_bytes);
			memcpy(at + v * b->stride, override->stored + v * override->width,
				override->width);
		}
	}
	return nt_edits_replace(job->edits, b->buffer, b->begin, old_size, out, size, job->error);
}

/* The bytes of a block to which nothing is appended that get new values. NULL: memory is exhausted. */
static nt_byte_rows *list_rows(nt_appending *job, const block *b, size_t *count)
{
	nt_byte_rows *rows = nt_arena_alloc(job->arena, b->count, sizeof *rows);
	*count = 0;
	for (size_t i = 0; rows && !nt_vertices_differ(job->vertices) && i < b->count; i++)
		if (b->targets[i].override)
			rows[(*count)++] = (nt_byte_rows){b->targets[i].begin, b->stride,
				b->targets[i].accessor.element_bytes};
	return rows;
}

static nt_status append_to_block(nt_appending *job, const block *b, uint64_t previous_end,
	const nt_append_target *next)
{
	size_t row_count;
	const nt_byte_rows *rows = list_rows(job, b, &row_count);
	nt_status status = rows ? NT_OK : nt_fail_memory(job->error);
	if (!rows)
		return status;
	if (b->begin < previous_end || b->misfits || is_crowded(b, next) ||
		nt_byte_users_foreign(&job->edits->users, b->buffer, b->begin, b->end, job->edits->accessors,
			nt_append_owner(job), rows, row_count)) {
		for (size_t i = 0; !status && i < b->count; i++)
			if (nt_vertices_differ(job->vertices) || b->targets[i].override)
				status = move_away(job, &b->targets[i]);
		return status;
	}
	const unsigned char *decoded = NULL, *elements = NULL;
	status = block_bytes(job, b, &decoded);
	elements = decoded;
	if (!status)
		status = nt_packed_bytes(job->edits, b->buffer, b->begin, &elements, job->error);
	if (!status && !nt_append_note_edit(job, b->buffer, b->begin, b->end))
		status = nt_fail_memory(job->error);
	if (status)
		return status;
	if (nt_vertices_differ(job->vertices))
		lengthen_views(job, b);
	return b->overridden || !job->vertices->own_count ? replace_vertices(job, b, decoded, elements)
							  : insert_vertices(job, b, elements);
}

/* ---- the whole ---- */

static nt_status append_to_targets(nt_appending *job)
{
	if (job->target_count)
		qsort(job->targets, job->target_count, sizeof *job->targets, compare_targets);
	nt_status status = NT_OK;
	uint64_t previous_end = 0;
	uint32_t previous_buffer = NT_NONE;
	for (size_t i = 0; !status && i < job->target_count && job->targets[i].accessor.view != NT_NONE;) {
		const block b = find_block(job, &job->targets[i], job->target_count - i);
		if (nt_vertices_differ(job->vertices) || b.overridden)
			status = append_to_block(job, &b, b.buffer == previous_buffer ? previous_end : 0,
				i + b.count < job->target_count ? &job->targets[i + b.count] : NULL);
		if (b.buffer != previous_buffer || b.end > previous_end)
			previous_end = b.end;
		previous_buffer = b.buffer;
		i += b.count;
	}
	for (size_t i = 0; !status && job->decoded_too && i < job->target_count; i++)
		if (job->targets[i].accessor.decoded)
			status = move_away(job, &job->targets[i]);
	for (size_t i = 0; !status && i < job->target_count; i++)
		status = settle_bounds(job, &job->targets[i], job->targets[i].accessor.index);
	const bool counts_change = nt_vertices_differ(job->vertices) || job->decoded_too;
	for (size_t i = 0; !status && counts_change && i < job->target_count; i++) {
		const nt_append_target *target = &job->targets[i];
		nt_json_value *json = nt_gltf_accessor_json(job->document, target->accessor.index);
		nt_json_put_uint64(job->json, json, "count", job->vertices->new_count);
		if (target->accessor.sparse && nt_vertices_differ(job->vertices) && nt_json_find(json, "sparse"))
			status = nt_append_sparse(job, target);
	}
	return status;
}

nt_status nt_append_vertices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_override_list *overrides, bool decoded_too, nt_error *error)
{
	nt_appending job = {.edits = edits, .document = edits->document,
		.json = edits->document->json, .arena = &edits->arena, .buffer = buffer, .vertices = vertices,
		.decoded_too = decoded_too, .error = error};
	nt_status status = nt_append_collect(&job, overrides);
	if (!status && nt_vertices_differ(vertices) && must_pin(&job))
		status = clone_pinned(&job);
	if (!status)
		status = append_to_targets(&job);
	free(job.targets);
	free(job.edited);
	return status;
}
