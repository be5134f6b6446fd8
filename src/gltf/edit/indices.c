/* SPDX-License-Identifier: MIT */
/*
 * Indices of primitives whose vertices are others now (pool_edit.h: nt_user_indices). The accessor keeps its number
 * and, while the numbers still fit, its component type (the largest value of a type is reserved). Strips and fans whose
 * triangles changed become lists; primitives without indices get some, also if only others of their pool have copies.
 */
#include "gltf/edit/pool_edit.h"

#include <string.h>
#include "base/hash_index.h"
#include "base/numbers.h"
#include "gltf/bytes/bytes.h"
#include "gltf/document.h"

/* New indices of one primitive, encoded. */
typedef struct encoded {
	const unsigned char *bytes;
	size_t size, count;
	uint32_t type, width;
} encoded;

/* Indices that form no triangle, at the end of a list, stay, but where making normals has made a new list, or welding
 * follows a split. */
static size_t tail_of(const nt_mesh *mesh, uint64_t mode, uint64_t old_count)
{
	const size_t tail = (size_t)(old_count - mesh->corner_count);
	return mode == NT_GLTF_TRIANGLES && old_count > mesh->corner_count && tail < 3 &&
			mesh->indices && !mesh->normals_made ? tail : 0;
}

/* most: all indices are below it. */
static nt_status encode(nt_arena *arena, const nt_mesh *mesh, uint32_t *indices, size_t count, bool borrowed,
	size_t tail_count, uint64_t most, uint32_t least, encoded *out, nt_error *error)
{
	uint32_t tail[2];
	for (size_t i = 0; i < tail_count; i++)
		tail[i] = nt_mesh_pool_vertex(mesh, mesh->indices[mesh->corner_count + i]);
	out->count = count + tail_count;
	/* those of few vertices fit, whatever they are */
	if (nt_gltf_index_type(most, least) != least) {
		uint32_t highest = nt_largest(indices, count);
		for (size_t i = 0; i < tail_count; i++)
			highest = tail[i] > highest ? tail[i] : highest;
		most = (uint64_t)highest + 1;
	}
	out->type = nt_gltf_index_type(most, least);
	out->width = nt_gltf_component_bytes(out->type);
	out->size = out->count * out->width;
	/* they live as long as the scene: nothing to be encoded */
	if (out->width == sizeof *indices && tail_count == 0 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) {
		out->bytes = (const unsigned char *)indices;
		return NT_OK;
	}
	/* narrower ones take their place where nobody reads the wider ones: what is borrowed of a mesh that has its
	 * geometry is the scene's */
	const bool fits = (!borrowed || !mesh->positions) && out->size <= count * sizeof *indices;
	unsigned char *bytes = fits ? (unsigned char *)indices : nt_arena_alloc(arena, out->count, out->width);
	if (!bytes)
		return nt_fail_memory(error);
	nt_gltf_store_indices(indices, count, out->width, bytes);
	nt_gltf_store_indices(tail, tail_count, out->width, bytes + count * out->width);
	out->bytes = bytes;
	return NT_OK;
}

/* New indices are packed as those before them are; where there were none, as the positions are. Packed triangles may be
 * turned, so that other primitives are no TRIANGLES. */
static nt_gltf_packing find_packing(const nt_buffer_edits *edits, const nt_json_value *primitive, const encoded *new,
	bool triangles)
{
	const nt_json_value *indices = nt_json_find(primitive, "indices");
	const uint32_t like = indices ? nt_gltf_reference(edits->document, primitive, "indices")
		: nt_gltf_reference(edits->document, nt_json_find(primitive, "attributes"), "POSITION");
	nt_gltf_packing packing = {.extension = NULL};
	if (new->width > 1)
		packing = nt_packing_of_accessor(edits, like);
	if (!indices || !triangles)
		packing.view.mode = triangles ? "TRIANGLES" : "INDICES";
	packing.view.filter = "NONE";
	packing.view.stride = new->width;
	return packing;
}

/* The accessors over the bytes of an old one say of the new indices what these are, and where; view NT_NONE: where the
 * old ones were. */
static void describe(nt_gltf *document, uint32_t accessor, const encoded *new, uint32_t view, uint64_t offset)
{
	for (uint32_t k = nt_gltf_same(document, accessor); k != NT_NONE; k = document->accessors[k].next) {
		nt_json_value *object = nt_gltf_accessor_json(document, k);
		if (view != NT_NONE)
			nt_gltf_place_accessor(document->json, object, view, offset);
		nt_gltf_set_number(document->json, object, "componentType", new->type);
		nt_gltf_set_number(document->json, object, "count", new->count);
		nt_gltf_measure(document, &document->accessors[k], object, new->bytes, new->width, new->count,
			new->type);
	}
}

/* Puts them where the old ones are, of which nobody else has any. Returns whether they fit: elements of a packed view
 * are all of a size. */
static bool replace_indices(nt_buffer_edits *edits, const nt_gltf_accessor *old, const encoded *new, bool triangles)
{
	const uint32_t old_width = nt_gltf_component_bytes(old->component_type);
	if (old->view == NT_NONE || old->sparse || old->stride != old_width)
		return false;
	const nt_gltf_view *view = nt_gltf_view_of(edits->document, old);
	const uint64_t begin = view->offset + old->offset;
	nt_segment *segment = nt_segment_at(edits, view->buffer, begin);
	if (!nt_segment_is(segment, begin, old->count * old_width) || view->compressed || view->offset % new->width ||
		begin % new->width || ((new->width != old_width || !triangles) && nt_gltf_is_of_view(view->buffer)))
		return false;
	nt_segment_edit(edits, segment, (nt_segment_change){.bytes = new->bytes, .size = new->size});
	describe(edits->document, old->index, new, NT_NONE, 0);
	return true;
}

/* A user's new indices. Users with equal ones in place of the same bytes follow the first of them. */
typedef struct written {
	uint32_t index;       /* the accessor of the source; NT_NONE: there was none */
	uint32_t same;        /* of that */
	uint32_t leader;      /* the first user with the same ones */
	uint32_t agreeing;    /* of a leader: users that follow it, itself too */
	uint32_t accessor;    /* of a leader: the one in the output */
} written;

/* Whether a user gets new ones: a primitive without any draws all vertices, so it would draw the copies of others. */
static bool is_written(const nt_pool_vertices *vertices, size_t user)
{
	const nt_user_indices *own = &vertices->users[user];
	return own->changed || (own->numbers && nt_vertices_differ(vertices) &&
		!nt_json_find(nt_pool_primitive(vertices->pool, user), "indices"));
}

static bool equal_indices(const nt_pool_vertices *vertices, size_t a, size_t b)
{
	const nt_user_indices *x = &vertices->users[a], *y = &vertices->users[b];
	return x->count == y->count &&
		(x->numbers == y->numbers || memcmp(x->numbers, y->numbers, x->count * sizeof *x->numbers) == 0);
}

/* The user before this one that has the same indices and leads; itself: none. NT_NONE: memory is exhausted.
 * last: the changed user before this one, or NT_NONE. */
static uint32_t find_leader(const nt_pool_vertices *vertices, uint32_t user, uint32_t last, const written *log,
	nt_hash_index *leaders)
{
	/* of primitives with the same triangles, which mostly follow each other, nothing is hashed again; of one alone
	 * nothing is hashed */
	if (last != NT_NONE && vertices->users[last].numbers == vertices->users[user].numbers &&
		log[last].same == log[user].same)
		return log[last].leader;
	if (vertices->pool->user_count == 1)
		return user;
	const nt_user_indices *own = &vertices->users[user];
	const uint64_t hash = nt_hash_bytes(log[user].same, own->numbers, own->count * sizeof *own->numbers);
	uint32_t leader;
	for (size_t at = NT_HASH_BEGIN; (leader = nt_hash_index_next(leaders, hash, &at)) != NT_NONE;)
		if (log[leader].same == log[user].same && equal_indices(vertices, leader, user))
			return leader;
	return nt_hash_index_add(leaders, hash, user) ? user : NT_NONE;
}

/* Fills the log of users that get new ones, but for its accessors. */
static bool find_leaders(const nt_gltf *document, const nt_pool_vertices *vertices, written *log)
{
	nt_hash_index leaders = {0};
	bool found = true;
	for (uint32_t i = 0, last = NT_NONE; found && i < vertices->pool->user_count; i++) {
		if (!is_written(vertices, i))
			continue;
		const uint32_t index = nt_gltf_reference(document, nt_pool_primitive(vertices->pool, i),
			"indices");
		log[i] = (written){.index = index, .accessor = NT_NONE,
			.same = index != NT_NONE ? nt_gltf_same(document, index) : NT_NONE};
		log[i].leader = find_leader(vertices, i, last, log, &leaders);
		found = log[i].leader != NT_NONE;
		if (found)
			log[log[i].leader].agreeing++;
		last = i;
	}
	nt_hash_index_free(&leaders);
	return found;
}

/* The type of a user's indices in the source; if there are none, the narrowest that all hardware likes. */
static nt_status find_old(nt_gltf *document, const nt_mesh *mesh, uint32_t index, nt_gltf_accessor *old,
	nt_error *error)
{
	*old = (nt_gltf_accessor){.count = mesh->source_vertex_count + mesh->unused_vertices,
		.component_type = NT_GLTF_USHORT};
	if (index == NT_NONE)
		return NT_OK;
	const nt_gltf_accessor *found;
	const nt_status status = nt_gltf_get_accessor(document, index, nt_gltf_of_mesh(mesh).pointer, &found, error);
	if (status)
		return status;
	*old = *found;
	/* Draco's indices have 32 bits; the accessor may say less. */
	uint64_t type;
	if (old->decoded && nt_json_find_uint64(nt_gltf_accessor_json(document, index), "componentType", &type))
		old->component_type = (uint32_t)type;
	return NT_OK;
}

/* Writes the indices of a leader: in place where that will do, else behind the end. */
static nt_status write_user(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices, size_t user,
	uint64_t mode, written *leader, nt_error *error)
{
	nt_gltf *document = edits->document;
	const nt_mesh *mesh = nt_pool_mesh(vertices->pool, user);
	const nt_user_indices *own = &vertices->users[user];
	const bool welded = nt_vertices_are_welded(vertices);
	nt_gltf_accessor old;
	encoded new = {0};
	nt_status status = find_old(document, mesh, leader->index, &old, error);
	/* welded vertices are fewer: two bytes may do for them */
	const uint32_t least = welded && old.component_type == NT_GLTF_UINT ? NT_GLTF_USHORT
		: old.component_type;
	if (!status)
		status = encode(&edits->arena, mesh, own->numbers, own->count, vertices->borrowed,
			welded ? 0 : tail_of(mesh, mode, old.count), vertices->new_count, least, &new, error);
	if (status)
		return status;
	/* the accessor stays where everybody who uses these indices will have the same new ones, or has got others */
	const nt_gltf_users *users = leader->index != NT_NONE ? &document->users[leader->same] : NULL;
	const bool stays = users && !users->idle && !users->attributes &&
		leader->agreeing + edits->accessors[leader->same].index_moved == users->indices;
	leader->accessor = leader->index;
	const bool triangles = mode == NT_GLTF_TRIANGLES || !own->renumbered;
	if (stays && replace_indices(edits, &old, &new, triangles))
		return NT_OK;
	const nt_gltf_packing packing = find_packing(edits, nt_pool_primitive(vertices->pool, user), &new,
		triangles);
	uint32_t view;
	uint64_t offset;
	if (stays)
		nt_edits_leave_accessor(edits, leader->index);
	else if (leader->index != NT_NONE)
		edits->accessors[leader->same].index_moved += leader->agreeing;
	status = nt_packed_add(edits, buffer, &packing, new.bytes, new.size, NT_GLTF_ELEMENT_ARRAY_BUFFER, 0, &view,
		&offset, error);
	if (status)
		return status;
	if (stays) {
		describe(document, leader->index, &new, view, offset);
		return NT_OK;
	}
	leader->accessor = nt_gltf_new_accessor(document->json, view, new.type, "SCALAR", new.count, false);
	nt_gltf_set_number(document->json, nt_gltf_accessor_json(document, leader->accessor), "byteOffset", offset);
	return NT_OK;
}

static nt_status edit_user(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices, size_t user,
	written *log, nt_error *error)
{
	nt_json *json = edits->document->json;
	const uint64_t mode = nt_gltf_mode(nt_pool_primitive(vertices->pool, user));
	written *leader = &log[log[user].leader];
	const nt_status status = log[user].leader != user ? NT_OK :
		write_user(edits, buffer, vertices, user, mode, leader, error);
	if (status)
		return status;
	nt_json_value *primitive = nt_pool_primitive(vertices->pool, user);
	/* in place, each user keeps its accessor */
	if (leader->accessor != leader->index)
		nt_json_put_uint64(json, primitive, "indices", leader->accessor);
	if (mode != NT_GLTF_TRIANGLES && !vertices->users[user].renumbered)
		nt_json_put_uint64(json, primitive, "mode", NT_GLTF_TRIANGLES);
	return NT_OK;
}

nt_status nt_gltf_write_indices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_error *error)
{
	const nt_vertex_pool *pool = vertices->pool;
	size_t first = 0;
	while (first < pool->user_count && !is_written(vertices, first))
		first++;
	if (first == pool->user_count)
		return NT_OK;
	written *log = nt_arena_alloc(&edits->arena, pool->user_count, sizeof *log);
	if (!log || !find_leaders(edits->document, vertices, log))
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	for (size_t i = first; !status && i < pool->user_count; i++)
		if (is_written(vertices, i))
			status = edit_user(edits, buffer, vertices, i, log, error);
	return status;
}
