/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in the accessors of a component.
 *
 * Accessors keep their number and their first rows. Attributes that are interleaved form a block whose
 * rows are copied as a whole and inserted behind its last one. Where bytes of a block also belong to
 * somebody else, its accessors move to new views. An accessor that has to keep its count, because a
 * primitive without indices or an animation uses it too, is left alone and the solved primitives get a
 * copy of it.
 */
#include "gltf/edit/append.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/accessor.h"
#include "gltf/primitive.h"
#include "gltf/edit/append_sparse.h"
#include "gltf/view.h"

/* ---- accessors that must keep their count ---- */

/* Primitives without indices draw every row, so rows must not be added to what they use. */
static bool must_pin(const nt_gltf_growing *g)
{
	const nt_gltf_patcher *p = g->patcher;
	for (size_t i = 0; i < g->component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[g->component->members[i]];
		if (g->component->rows.group_of[i] == NT_NONE &&
			!nt_json_find(nt_gltf_primitive_of(p->document, mesh), "indices"))
			return true;
	}
	for (size_t i = 0; i < g->item_count; i++)
		if (p->sharing.foreign[p->sharing.canonical[g->items[i].accessor.index]])
			return true;
	return false;
}

/* The elements of an accessor after growing, `stride` apart; sparse values put in where `bake`. */
static nt_status copy_rows(nt_gltf_growing *g, const nt_gltf_item *from, uint32_t stride, bool bake,
	unsigned char **result)
{
	nt_gltf_patcher *p = g->patcher;
	const nt_gltf_accessor *a = &from->accessor;
	const size_t count = g->component->rows.new_count;
	unsigned char *out = nt_arena_alloc(p->arena, count, stride);
	if (!out)
		return nt_fail_memory(p->error);
	memset(out, 0, count * stride);
	*result = out;
	if (from->override) {
		for (size_t row = 0; row < count; row++)
			memcpy(out + row * stride, from->override->values + row * from->override->width,
				from->override->width);
		return NT_OK;
	}
	const unsigned char *rows;
	nt_status status = nt_gltf_accessor_rows(p->document, a, &rows, p->error);
	for (size_t row = 0; !status && rows && row < a->count; row++)
		memcpy(out + row * stride, rows + row * a->stride, a->element_bytes);
	if (!status && bake && a->sparse_count) {
		const uint32_t *replaced;
		const unsigned char *values;
		status = nt_gltf_sparse(p->document, a, p->arena, &replaced, &values, p->error);
		for (size_t i = 0; !status && i < a->sparse_count; i++)
			memcpy(out + (size_t)replaced[i] * stride, values + i * a->element_bytes,
				a->element_bytes);
	}
	for (size_t row = (size_t)a->count; !status && row < count; row++)
		memcpy(out + row * stride, out + (size_t)nt_gltf_row_source(g, row) * stride, a->element_bytes);
	return status;
}

/* A new view with all rows of an accessor. */
static nt_status add_rows_view(nt_gltf_growing *g, const nt_gltf_item *from, bool bake, uint32_t *view)
{
	const uint32_t element = from->override ? from->override->width : from->accessor.element_bytes;
	const uint32_t stride = (element + 3) / 4 * 4;
	unsigned char *rows = NULL;
	const nt_status status = copy_rows(g, from, stride, bake, &rows);
	if (status)
		return status;
	const size_t size = g->component->rows.new_count * stride;
	return nt_edits_add_view(&g->patcher->edits, g->component->buffer, rows, size,
		NT_GLTF_ARRAY_BUFFER, stride != element ? stride : 0, view, g->patcher->error);
}

static nt_status clone_accessor(nt_gltf_growing *g, nt_gltf_item *from)
{
	nt_gltf_patcher *p = g->patcher;
	uint32_t view;
	const nt_status status = add_rows_view(g, from, true, &view);
	if (status)
		return status;
	nt_json_value *accessors = nt_gltf_root_member(p->document, "accessors");
	from->clone = (uint32_t)nt_json_count(accessors);
	nt_json_value *clone = nt_json_append(p->json, accessors);
	nt_json_set_copy(p->json, clone, nt_json_at(accessors, from->accessor.index));
	nt_json_set_uint64(p->json, nt_json_put(p->json, clone, "bufferView"), view);
	nt_json_remove(p->json, clone, "byteOffset");
	nt_json_remove(p->json, clone, "sparse");
	nt_json_set_uint64(p->json, nt_json_put(p->json, clone, "count"), g->component->rows.new_count);
	return NT_OK;
}

static nt_status use_clone(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	nt_gltf_growing *g = context;
	for (size_t i = 0; i < g->item_count; i++)
		if (g->items[i].accessor.index == accessor && g->items[i].clone != NT_NONE)
			nt_json_set_uint64(g->patcher->json,
				nt_json_put(g->patcher->json, attributes, name), g->items[i].clone);
	return NT_OK;
}

/* Copies the pinned accessors, points solved members to the copies and takes them off the list. */
static nt_status clone_pinned(nt_gltf_growing *g)
{
	const nt_gltf_patcher *p = g->patcher;
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < g->item_count; i++) {
		const uint32_t index = g->items[i].accessor.index;
		if (g->pinned[index] || p->sharing.foreign[p->sharing.canonical[index]])
			status = clone_accessor(g, &g->items[i]);
	}
	for (size_t i = 0; !status && i < g->component->member_count; i++)
		if (g->component->rows.group_of[i] != NT_NONE)
			nt_gltf_visit_attributes(nt_gltf_primitive_of(p->document,
				&p->scene->meshes[g->component->members[i]]),
				p->sharing.accessor_count, use_clone, g);
	size_t kept = 0;
	for (size_t i = 0; i < g->item_count; i++)
		if (g->items[i].clone == NT_NONE)
			g->items[kept++] = g->items[i];
	g->item_count = kept;
	return status;
}

/* ---- growing in place ---- */

static int compare_items(const void *a, const void *b)
{
	const nt_gltf_item *x = a, *y = b;
	const bool x_has = x->accessor.view != NT_NONE, y_has = y->accessor.view != NT_NONE;
	if (x_has != y_has)
		return x_has ? -1 : 1;
	if (x->buffer != y->buffer)
		return x->buffer < y->buffer ? -1 : 1;
	if (x->begin != y->begin)
		return x->begin < y->begin ? -1 : 1;
	return (x->accessor.index > y->accessor.index) - (x->accessor.index < y->accessor.index);
}

/* Interleaved accessors: rows of `width` bytes, `stride` apart. */
typedef struct block {
	nt_gltf_item *items;
	size_t count;
	uint32_t buffer, stride, width;
	uint64_t begin, end;
	bool overridden;
} block;

/* The longest run of items from `items` on that share rows. */
static block find_block(const nt_gltf_growing *g, nt_gltf_item *items, size_t left)
{
	block b = {.items = items, .count = 1, .buffer = items->buffer,
		.stride = items->accessor.stride, .width = items->accessor.element_bytes,
		.begin = items->begin, .overridden = items->override != NULL};
	while (b.count < left) {
		const nt_gltf_item *next = &items[b.count];
		const uint64_t end = next->begin - b.begin + next->accessor.element_bytes;
		if (next->accessor.view == NT_NONE || next->buffer != b.buffer ||
			next->accessor.stride != b.stride || end > b.stride)
			break;
		if (end > b.width)
			b.width = (uint32_t)end;
		b.overridden |= next->override != NULL;
		b.count++;
	}
	b.end = b.begin + (g->component->rows.old_count - 1) * (uint64_t)b.stride + b.width;
	return b;
}

/* Moves an accessor to a view of its own. */
static nt_status move_away(nt_gltf_growing *g, const nt_gltf_item *moved)
{
	nt_gltf_patcher *p = g->patcher;
	uint32_t view;
	const nt_status status = add_rows_view(g, moved, false, &view);
	if (status)
		return status;
	nt_json_value *json =
		nt_json_at(nt_gltf_root_member(p->document, "accessors"), moved->accessor.index);
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "bufferView"), view);
	nt_json_remove(p->json, json, "byteOffset");
	return NT_OK;
}

static nt_status block_bytes(nt_gltf_growing *g, const block *b, const unsigned char **bytes)
{
	nt_gltf_patcher *p = g->patcher;
	const nt_gltf_accessor *first = &b->items->accessor;
	nt_gltf_view view;
	nt_status status =
		nt_gltf_get_view(p->document, first->view, "/accessors", &view, p->error);
	/* each item has been checked against its own view; the block is their union */
	for (size_t i = 0; !status && i < b->count; i++) {
		const unsigned char *rows;
		status = nt_gltf_accessor_rows(p->document, &b->items[i].accessor, &rows, p->error);
		if (i == 0)
			*bytes = rows;
	}
	return status;
}

/* Inserts the copied rows behind the block. */
static nt_status insert_rows(nt_gltf_growing *g, const block *b, const unsigned char *rows)
{
	nt_gltf_patcher *p = g->patcher;
	const size_t added = nt_gltf_added_rows(g), old_count = g->component->rows.old_count;
	unsigned char *out = nt_arena_alloc(p->arena, added, b->stride);
	if (!out)
		return nt_fail_memory(p->error);
	/* The last row of the block may end before its stride does: padding comes first. */
	const size_t gap = b->stride - b->width;
	for (size_t i = 0; i < added; i++) {
		memset(out + i * b->stride, 0, gap);
		memcpy(out + i * b->stride + gap,
			rows + (size_t)nt_gltf_row_source(g, old_count + i) * b->stride, b->width);
	}
	return nt_edits_replace(&p->edits, b->buffer, b->end, 0, out, added * b->stride, p->error);
}

/* Replaces the whole block: some of its values are new. */
static nt_status replace_rows(nt_gltf_growing *g, const block *b, const unsigned char *rows)
{
	nt_gltf_patcher *p = g->patcher;
	const size_t count = g->component->rows.new_count, old_size = (size_t)(b->end - b->begin);
	const size_t size = (count - 1) * b->stride + b->width;
	unsigned char *out = nt_arena_alloc(p->arena, count, b->stride);
	if (!out)
		return nt_fail_memory(p->error);
	memset(out, 0, count * b->stride);
	memcpy(out, rows, old_size);
	for (size_t row = g->component->rows.old_count; row < count; row++)
		memcpy(out + row * b->stride, rows + (size_t)nt_gltf_row_source(g, row) * b->stride, b->width);
	for (size_t i = 0; i < b->count; i++) {
		const nt_gltf_override *override = b->items[i].override;
		unsigned char *at = out + (b->items[i].begin - b->begin);
		for (size_t row = 0; override && row < count; row++) {
			memset(at + row * b->stride, 0, b->items[i].accessor.element_bytes);
			memcpy(at + row * b->stride, override->values + row * override->width,
				override->width);
		}
	}
	return nt_edits_replace(&p->edits, b->buffer, b->begin, old_size, out, size, p->error);
}

static nt_status grow_block(nt_gltf_growing *g, const block *b, uint64_t previous_end)
{
	nt_gltf_patcher *p = g->patcher;
	nt_status status = NT_OK;
	if (b->begin < previous_end || nt_byte_users_foreign(&p->edits.users, b->buffer, b->begin, b->end,
					       p->own, g->component->number + 1)) {
		for (size_t i = 0; !status && i < b->count; i++)
			status = move_away(g, &b->items[i]);
		return status;
	}
	const unsigned char *rows;
	status = block_bytes(g, b, &rows);
	if (!status && !nt_gltf_note_edit(g, b->buffer, b->begin, b->end))
		status = nt_fail_memory(p->error);
	if (status)
		return status;
	return b->overridden ? replace_rows(g, b, rows) : insert_rows(g, b, rows);
}

/* ---- the whole ---- */

/* Component k of a row of new tangents, by the size of the row. */
static double new_value(const nt_gltf_override *override, size_t row, size_t k)
{
	const size_t size = override->width / 4;
	const unsigned char *at = override->values + row * override->width + k * size;
	float real;
	int16_t integer;
	int8_t small;
	switch (size) {
	case sizeof small:
		memcpy(&small, at, sizeof small);
		return small;
	case sizeof integer:
		memcpy(&integer, at, sizeof integer);
		return integer;
	default:
		memcpy(&real, at, sizeof real);
		return real;
	}
}

/* Bounds of values that were replaced: "min" or "max" of an accessor that has it. */
static void set_bound(nt_gltf_patcher *p, const nt_gltf_growing *g, const nt_gltf_item *from, const char *key, int sign)
{
	nt_json_value *bound = nt_json_find(nt_json_at(
		nt_gltf_root_member(p->document, "accessors"), from->accessor.index), key);
	if (nt_json_count(bound) != 4)
		return;
	for (size_t k = 0; k < 4; k++) {
		double extreme = 0;
		for (size_t row = 0; row < g->component->rows.new_count; row++) {
			const double value = new_value(from->override, row, k);
			if (row == 0 || (sign < 0 ? value < extreme : value > extreme))
				extreme = value;
		}
		nt_json_set_double(p->json, nt_json_at(bound, k), extreme);
	}
}

static nt_status grow_items(nt_gltf_growing *g)
{
	nt_gltf_patcher *p = g->patcher;
	if (g->item_count)
		qsort(g->items, g->item_count, sizeof *g->items, compare_items);
	nt_status status = NT_OK;
	uint64_t previous_end = 0;
	uint32_t previous_buffer = NT_NONE;
	for (size_t i = 0; !status && i < g->item_count && g->items[i].accessor.view != NT_NONE;) {
		const block b = find_block(g, &g->items[i], g->item_count - i);
		if (nt_gltf_added_rows(g) || b.overridden)
			status = grow_block(g, &b, b.buffer == previous_buffer ? previous_end : 0);
		if (b.buffer != previous_buffer || b.end > previous_end)
			previous_end = b.end;
		previous_buffer = b.buffer;
		i += b.count;
	}
	for (size_t i = 0; !status && g->decoded_too && i < g->item_count; i++)
		if (g->items[i].accessor.decoded)
			status = move_away(g, &g->items[i]);
	for (size_t i = 0; i < g->item_count; i++)
		if (g->items[i].override) {
			set_bound(p, g, &g->items[i], "min", -1);
			set_bound(p, g, &g->items[i], "max", 1);
		}
	for (size_t i = 0; !status && (nt_gltf_added_rows(g) || g->decoded_too) && i < g->item_count; i++) {
		const nt_gltf_item *grown = &g->items[i];
		nt_json_value *json = nt_json_at(nt_gltf_root_member(p->document, "accessors"),
			grown->accessor.index);
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "count"),
			g->component->rows.new_count);
		if (grown->accessor.sparse_count && nt_gltf_added_rows(g))
			status = nt_gltf_grow_sparse(g, grown);
	}
	return status;
}

nt_status nt_gltf_grow_attributes(nt_gltf_patcher *p, const nt_gltf_cluster *component,
	nt_gltf_override *overrides, size_t override_count, bool decoded_too)
{
	nt_gltf_growing g = {.patcher = p, .component = component, .decoded_too = decoded_too,
		.seen = nt_calloc(p->sharing.accessor_count, sizeof(bool)),
		.pinned = nt_calloc(p->sharing.accessor_count, sizeof(bool))};
	nt_status status = g.seen && g.pinned ? NT_OK : nt_fail_memory(p->error);
	if (!status)
		status = nt_gltf_collect_items(&g, overrides, override_count);
	if (!status && nt_gltf_added_rows(&g) && must_pin(&g))
		status = clone_pinned(&g);
	if (!status)
		status = grow_items(&g);
	free(g.items);
	free(g.edited);
	free(g.seen);
	free(g.pinned);
	return status;
}
