/* SPDX-License-Identifier: MIT */
/*
 * Segments of a document's buffers: who refers to which bytes. Users are accessors, their sparse arrays, images,
 * compressed data, and views whose user is unknown; what overlaps is one segment. Segments lie apart and in order, so
 * that what becomes of them does too, and where a byte goes is told by the last segment before it.
 */
#include "gltf/bytes/bytes.h"

#include <stdlib.h>
#include "gltf/document.h"

/* ---- finding them ---- */

typedef struct user {
	uint64_t begin, end;
	uint32_t buffer;
	uint32_t apart; /* an accessor that no edit touches; NT_NONE: none */
	uint8_t count;
	bool is_head, is_block; /* perhaps a free view; Draco's */
} user;

typedef struct user_list {
	nt_buffer_edits *edits;
	user *items;
	size_t count, capacity;
	bool failed;
} user_list;

static void add_user(user_list *list, user added)
{
	if (added.begin >= added.end)
		return;
	list->failed |= !nt_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items);
	if (!list->failed)
		list->items[list->count++] = added;
}

/* A view that was decompressed has whole elements. */
static void add_in_view(user_list *list, uint32_t index, uint64_t offset, uint64_t length, uint8_t count,
	uint32_t apart)
{
	const nt_gltf_view *view = &list->edits->document->views[index];
	uint64_t begin = view->offset + offset, end = begin + length;
	if (nt_gltf_is_of_view(view->buffer) && view->stride) {
		begin -= begin % view->stride;
		end += view->stride - 1 - (end - 1) % view->stride;
		end = end < view->length ? end : view->length;
	}
	list->edits->views[index].users += count;
	add_user(list, (user){begin, end, view->buffer, apart, count, false, false});
}

static void add_accessor(user_list *list, uint32_t index)
{
	const nt_gltf *document = list->edits->document;
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(document, index);
	if (!a || a->count == 0 || a->same != index)
		return;
	/* one that nobody uses keeps its bytes whatever becomes of those over the same */
	const nt_gltf_users *users = &document->users[index];
	if (a->view != NT_NONE)
		add_in_view(list, a->view, a->offset, (a->count - 1) * a->stride + a->element_bytes, 1 + users->idle,
			users->attributes || users->indices ? NT_NONE : index);
	const nt_gltf_sparse_arrays *s = a->sparse;
	if (!s)
		return;
	add_in_view(list, s->index_view, s->index_offset, s->count * nt_gltf_component_bytes(s->index_type), 1,
		NT_NONE);
	add_in_view(list, s->value_view, s->value_offset, s->count * a->element_bytes, 1, NT_NONE);
}

/* The bytes that a view or its extension names: those behind a compressed view lie in another place than the view,
 * which has one for readers that do not know the extension. */
static void add_named(user_list *list, const nt_json_value *object)
{
	uint64_t buffer, offset = 0, length;
	if (!nt_json_find_uint64(object, "buffer", &buffer) || !nt_json_find_uint64(object, "byteLength", &length) ||
		buffer >= list->edits->document->buffer_count)
		return;
	nt_json_find_uint64(object, "byteOffset", &offset);
	if (length <= UINT64_MAX - offset)
		add_user(list, (user){offset, offset + length, (uint32_t)buffer, NT_NONE, 1, false, false});
}

/* Views without an accessor are used as a whole. */
static void add_views(user_list *list)
{
	nt_buffer_edits *edits = list->edits;
	nt_gltf *document = edits->document;
	const nt_json_value *views = nt_gltf_root_member(document, "bufferViews");
	for (uint32_t i = 0; i < edits->view_count; i++) {
		const nt_gltf_view *view = nt_gltf_sound_view(document, i);
		const nt_gltf_view_users *users = &document->view_users[i];
		if (view && !edits->views[i].users) {
			edits->views[i].users = 1;
			add_user(list, (user){view->offset, view->offset + view->length, view->buffer, NT_NONE, 1,
				view->length <= NT_FREE_VIEW_BYTES, users->blocks > 0});
			if (!users->image)
				edits->alignment = 8; /* it may be data of an extension that wants this
				                         (EXT_structural_metadata does) */
		}
		if (document->views[i].decoded)
			add_named(list, nt_json_at(views, i));
		add_named(list, nt_gltf_compression_of(nt_json_at(views, i), NULL));
	}
}

static int compare_users(const void *a, const void *b)
{
	const user *x = a, *y = b;
	if (x->buffer != y->buffer)
		return x->buffer < y->buffer ? -1 : 1;
	if (x->begin != y->begin)
		return x->begin < y->begin ? -1 : 1;
	return (x->end > y->end) - (x->end < y->end);
}

/* In order, what overlaps is one segment. */
static void join(nt_buffer_edits *edits, const user_list *list)
{
	nt_segment *segment = NULL;
	uint32_t heads = 0;
	for (size_t i = 0; i < list->count; i++) {
		const user *u = &list->items[i];
		if (!segment || segment->buffer != u->buffer || segment->end <= u->begin) {
			segment = &edits->segments[edits->segment_count++];
			*segment = (nt_segment){.begin = u->begin, .end = u->end, .buffer = u->buffer,
				.apart = NT_NONE};
			heads = 0;
		}
		if (u->apart != NT_NONE) {
			edits->accessors[u->apart].apart = segment->apart;
			segment->apart = u->apart;
		}
		segment->end = u->end > segment->end ? u->end : segment->end;
		segment->users += u->count;
		heads += u->is_head && u->begin == segment->begin;
		if (u->is_block && u->begin == segment->begin) {
			segment->users -= heads;
			heads = 0;
		}
	}
}

bool nt_segments_find(nt_buffer_edits *edits)
{
	const size_t accessor_count = edits->document->accessor_count;
	user_list list = {.edits = edits};
	list.failed = !nt_grow((void **)&list.items, &list.capacity, accessor_count, sizeof *list.items);
	for (uint32_t i = 0; i < accessor_count; i++)
		add_accessor(&list, i);
	add_views(&list);
	/* mostly they come in their order */
	bool sorted = true;
	for (size_t i = 1; sorted && i < list.count; i++)
		sorted = compare_users(&list.items[i - 1], &list.items[i]) <= 0;
	if (!sorted)
		qsort(list.items, list.count, sizeof *list.items, compare_users);
	edits->segments = nt_alloc(list.count, sizeof *edits->segments);
	edits->changes = nt_calloc(list.count, sizeof *edits->changes);
	list.failed |= !edits->segments || !edits->changes;
	if (!list.failed)
		join(edits, &list);
	free(list.items);
	return !list.failed;
}

/* ---- asking and changing them ---- */

static bool is_before(const nt_segment *segment, uint32_t buffer, uint64_t position)
{
	return segment->buffer < buffer || (segment->buffer == buffer && segment->begin < position);
}

size_t nt_segments_before(nt_buffer_edits *edits, uint32_t buffer, uint64_t position)
{
	const nt_segment *segments = edits->segments;
	size_t low = edits->near, high = edits->segment_count;
	/* mostly questions ascend: the next segments are looked at first */
	if (low && !is_before(&segments[low - 1], buffer, position))
		low = 0;
	for (size_t step = 1; step < high - low; step *= 2)
		if (!is_before(&segments[low + step], buffer, position))
			high = low + step;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (is_before(&segments[middle], buffer, position))
			low = middle + 1;
		else
			high = middle;
	}
	return edits->near = low;
}

nt_segment *nt_segment_at(nt_buffer_edits *edits, uint32_t buffer, uint64_t position)
{
	const size_t count = nt_segments_before(edits, buffer, position + 1);
	nt_segment *segment = count ? &edits->segments[count - 1] : NULL;
	return segment && segment->buffer == buffer && position < segment->end ? segment : NULL;
}

nt_segment *nt_segment_of(nt_buffer_edits *edits, uint32_t index, uint64_t offset)
{
	const nt_gltf_view *view = nt_gltf_sound_view(edits->document, index);
	return view ? nt_segment_at(edits, view->buffer, view->offset + offset) : NULL;
}

void nt_segment_know(nt_segment *segment, uint32_t pool, uint32_t users)
{
	if (!segment)
		return;
	segment->known = segment->pool == pool ? segment->known + users : users;
	segment->pool = pool;
}

void nt_segment_edit(nt_buffer_edits *edits, nt_segment *segment, nt_segment_change change)
{
	segment->changed = true;
	edits->changes[segment - edits->segments] = change;
}
