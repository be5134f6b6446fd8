/* SPDX-License-Identifier: MIT */
/*
 * Users of the bytes of a document's buffers: accessors, their sparse arrays, images, compressed
 * data, and views whose user is unknown. Sorted by buffer and begin, and searched as a binary tree whose nodes have the
 * largest end below them, so that a question about a range looks at few beside those that it is about.
 */
#include "gltf/bytes/bytes.h"

#include <stdlib.h>
#include "gltf/document.h"

static bool add_user(nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	uint32_t accessor)
{
	if (!nt_grow((void **)&users->list, &users->capacity, users->count + 1, sizeof *users->list))
		return false;
	users->list[users->count++] = (nt_byte_user){begin, end, 0, buffer, accessor};
	return true;
}

static bool add_view_user(nt_byte_users *users, nt_gltf *document, uint32_t index, uint64_t offset,
	uint64_t length, uint32_t accessor, bool *view_used)
{
	nt_gltf_view view;
	if (nt_gltf_get_view(document, index, "", &view, NULL) != NT_OK)
		return true;
	view_used[index] = true;
	return add_user(users, view.buffer, view.offset + offset, view.offset + offset + length,
		accessor);
}

static bool add_accessor(nt_byte_users *users, nt_gltf *document, uint32_t index,
	bool *view_used)
{
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(document, index);
	if (!a || a->count == 0 || a->same != index)
		return true;
	bool added = true;
	/* one that nobody uses keeps its bytes whatever becomes of those over the same */
	const int times = nt_gltf_users_of(document, index)->idle ? 2 : 1;
	for (int i = 0; added && i < times && a->view != NT_NONE; i++)
		added = add_view_user(users, document, a->view, a->offset,
			(a->count - 1) * a->stride + a->element_bytes, index, view_used);
	if (a->sparse) {
		added = added && add_view_user(users, document, a->sparse->index_view, a->sparse->index_offset,
			a->sparse->count * nt_gltf_component_bytes(a->sparse->index_type), index, view_used);
		added = added && add_view_user(users, document, a->sparse->value_view, a->sparse->value_offset,
			a->sparse->count * a->element_bytes, index, view_used);
	}
	return added;
}

/* The place of a decompressed view, for readers that do not know the extension. */
static bool add_place(nt_byte_users *users, const nt_json_value *view)
{
	uint64_t buffer, offset = 0, length;
	if (!nt_json_find_uint64(view, "buffer", &buffer) || !nt_json_find_uint64(view, "byteLength", &length))
		return true;
	nt_json_find_uint64(view, "byteOffset", &offset);
	return add_user(users, (uint32_t)buffer, offset, offset + length, NT_NONE);
}

/* The bytes behind a compressed view lie in another place than the view. */
static bool add_compressed(nt_byte_users *users, const nt_json_value *view)
{
	const nt_json_value *packed = nt_gltf_compression_of(view, NULL);
	uint64_t buffer, offset = 0, length;
	if (!nt_json_find_uint64(packed, "buffer", &buffer) || buffer >= UINT32_MAX ||
		!nt_json_find_uint64(packed, "byteLength", &length))
		return true;
	nt_json_find_uint64(packed, "byteOffset", &offset);
	if (length > UINT64_MAX - offset)
		return true;
	return add_user(users, (uint32_t)buffer, offset, offset + length, NT_NONE);
}

/* Views without an accessor are used as a whole. */
static bool add_whole_views(nt_byte_users *users, nt_gltf *document, bool *view_used, size_t view_count)
{
	const nt_json_value *views = nt_gltf_root_member(document, "bufferViews");
	bool added = true;
	for (size_t i = 0; added && i < view_count; i++) {
		nt_gltf_view view;
		if (!view_used[i] &&
			nt_gltf_get_view(document, i, "", &view, NULL) == NT_OK) {
			added = add_user(users, view.buffer, view.offset, view.offset + view.length,
				NT_NONE);
			if (!document->view_users[i].image)
				users->unknown = true;
		}
		if (document->views[i].decoded)
			added = added && add_place(users, nt_json_at(views, i));
		added = added && add_compressed(users, nt_json_at(views, i));
	}
	return added;
}

static int compare_users(const void *a, const void *b)
{
	const nt_byte_user *x = a, *y = b;
	if (x->buffer != y->buffer)
		return x->buffer < y->buffer ? -1 : 1;
	if (x->begin != y->begin)
		return x->begin < y->begin ? -1 : 1;
	if (x->end != y->end)
		return x->end < y->end ? -1 : 1;
	return (x->accessor > y->accessor) - (x->accessor < y->accessor);
}

/* The node of a range is the one in its middle. Returns the largest end in it. */
static uint64_t set_reach(nt_byte_user *list, size_t low, size_t high)
{
	if (low >= high)
		return 0;
	const size_t middle = low + (high - low) / 2;
	const uint64_t before = set_reach(list, low, middle), behind = set_reach(list, middle + 1, high);
	const uint64_t reach = before > behind ? before : behind;
	return list[middle].reach = list[middle].end > reach ? list[middle].end : reach;
}

bool nt_byte_users_find(nt_byte_users *users, nt_gltf *document)
{
	const size_t view_count = document->view_count, accessor_count = document->accessor_count;
	users->document = document;
	bool *view_used = nt_calloc(view_count, sizeof *view_used);
	bool added = view_used && nt_grow((void **)&users->list, &users->capacity, accessor_count, sizeof *users->list);
	for (size_t i = 0; added && i < accessor_count; i++)
		added = add_accessor(users, document, (uint32_t)i, view_used);
	added = added && add_whole_views(users, document, view_used, view_count);
	free(view_used);
	if (!added)
		return false;
	/* mostly they come in their order */
	bool sorted = true;
	for (size_t i = 1; sorted && i < users->count; i++)
		sorted = compare_users(&users->list[i - 1], &users->list[i]) <= 0;
	if (!sorted)
		qsort(users->list, users->count, sizeof *users->list, compare_users);
	set_reach(users->list, 0, users->count);
	return true;
}

/* Number of users before the first one of `buffer` that begins at or behind `position`. */
static size_t users_before(const nt_byte_users *users, uint32_t buffer, uint64_t position)
{
	size_t low = 0, high = users->count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		const nt_byte_user *user = &users->list[middle];
		if (user->buffer < buffer || (user->buffer == buffer && user->begin < position))
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

/* A question about the users in [first, last) of the list that end behind `begin`. */
typedef struct question {
	const nt_byte_users *users;
	size_t first, last, found;
	uint64_t begin;
	uint32_t own;
	const nt_edited_accessor *owners; /* NULL: accessors are their own */
	const nt_byte_rows *rows; /* [row_count] that alone change; 0: all may */
	size_t row_count;
	bool counts;            /* all; otherwise one that is not `own` is enough */
} question;

/* Whether a user is an accessor that no edit touches, with elements between the rows that change. */
static bool lies_apart(const question *q, const nt_byte_user *user)
{
	const nt_gltf *document = q->users->document;
	if (!q->row_count || user->accessor == NT_NONE || document->users[user->accessor].attributes ||
		document->users[user->accessor].indices)
		return false;
	const nt_gltf_accessor *a = &document->accessors[user->accessor];
	const uint64_t stride = a->stride;
	bool apart = user->end - user->begin == (a->count - 1) * stride + a->element_bytes;
	for (size_t i = 0; apart && i < q->row_count; i++) {
		const nt_byte_rows *rows = &q->rows[i];
		const uint64_t behind = (rows->begin % stride + stride - user->begin % stride) % stride;
		apart = rows->stride == stride && behind >= a->element_bytes && behind + rows->width <= stride;
	}
	return apart;
}

static bool is_asked_for(const question *q, const nt_byte_user *user)
{
	const uint32_t accessor = user->accessor;
	return q->counts || accessor == NT_NONE ||
		((q->owners ? q->owners[accessor].appended_by : accessor) != q->own && !lies_apart(q, user));
}

static void look(question *q, size_t low, size_t high)
{
	if (low >= high || low >= q->last || high <= q->first || (q->found && !q->counts))
		return;
	const size_t middle = low + (high - low) / 2;
	const nt_byte_user *user = &q->users->list[middle];
	if (user->reach <= q->begin)
		return;
	look(q, low, middle);
	const bool touches = middle >= q->first && middle < q->last && user->end > q->begin;
	q->found += touches && is_asked_for(q, user);
	look(q, middle + 1, high);
}

static size_t find_users(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end, question q)
{
	q.users = users;
	q.begin = begin;
	q.first = users_before(users, buffer, 0);
	q.last = users_before(users, buffer, end);
	look(&q, 0, users->count);
	return q.found;
}

bool nt_byte_users_foreign(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	const nt_edited_accessor *owners, uint32_t own, const nt_byte_rows *rows, size_t row_count)
{
	return find_users(users, buffer, begin, end,
		(question){.owners = owners, .own = own, .rows = rows, .row_count = row_count});
}

bool nt_byte_users_other(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	uint32_t accessor)
{
	return find_users(users, buffer, begin, end, (question){.own = accessor});
}

size_t nt_byte_users_count(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end)
{
	return find_users(users, buffer, begin, end, (question){.counts = true});
}
