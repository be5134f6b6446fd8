/* SPDX-License-Identifier: MIT */
/*
 * Edits of one pool: vertices after all splits, welded; attributes that a set gets, and tangents of its morph targets;
 * vertices appended, with the indices that use them; extensions that do not hold any more.
 */
#ifndef NT_GLTF_EDIT_POOL_EDIT_H
#define NT_GLTF_EDIT_POOL_EDIT_H

#include "gltf/bytes/bytes.h"
#include "gltf/document.h"
#include "gltf/load.h"
#include "gltf/quantize.h"
#include "gltf/vertex_pools.h"

/* ---- splits of its meshes merged: merge_splits.c ---- */

/* Shared data of the meshes of a tangent set, for all vertices of their pool. */
typedef struct nt_pool_set {
	float *tangents;      /* [new_count][4] */
	float *normals;       /* [new_count][3]: NULL where normals were not made */
	float *source_normals; /* [old_count][3] of pooled meshes whose normals were not made; not to be written to */
	size_t morph_count;
	const nt_mesh *lone;  /* gives all vertices the tangents of targets: scene/values.h; NULL: several do */
	uint32_t *givers;     /* [new_count] the user that gives them; NT_NONE: they are the base's; NULL: lone */
	uint32_t *given;      /* [new_count] its vertex there; NULL: the same one of lone */
	uint64_t *digests;    /* [vertex][2] while splits are merged: of the tangents of all targets */
	bool *defined;        /* [vertex] while splits are merged: whether a corner of the set has it */
	uint32_t *first_free; /* [old_count] while splits are merged: before this one the set has tangents for all
	                         copies of a vertex */
} nt_pool_set;

/* The new indices of a user, by whatever vertices became new: by splits, or because equal ones were welded. */
typedef struct nt_user_indices {
	uint32_t *numbers; /* [count] of the pool's new vertices; NULL: the source's stay */
	size_t count;
	bool changed;      /* they are not the source's triangles */
	bool renumbered;   /* they are the source's with other numbers, of any mode; else a list of triangles */
} nt_user_indices;

/* The new vertices of a pool: where each comes from, and the indices that its users have then. */
typedef struct nt_pool_vertices {
	const nt_vertex_pool *pool;
	size_t old_count;   /* of the source */
	size_t own_count;   /* first ones that are the source's as they stand: old_count, or 0 after welding */
	size_t new_count;
	size_t normal_copies; /* of those that were appended: their made normal is another than the first's */
	uint32_t *sources;  /* [new_count - own_count] vertex of the source */
	nt_pool_set *sets;  /* [pool->sets.count] */
	nt_user_indices *users; /* [pool->user_count] */
	bool seen_equal;    /* equal ones were looked for */
	bool borrowed;      /* sources, tangents and indices are the scene's: do not write to them */
} nt_pool_vertices;

/* The vertex of the source whose attributes a vertex has. */
static inline size_t nt_vertex_source(const nt_pool_vertices *vertices, size_t vertex)
{
	return vertex < vertices->own_count ? vertex : vertices->sources[vertex - vertices->own_count];
}

/* Whether equal ones are one vertex now, so that none is where it was. */
static inline bool nt_vertices_are_welded(const nt_pool_vertices *vertices)
{
	return !vertices->own_count;
}

/* Whether vertices are not just those of the source. */
static inline bool nt_vertices_differ(const nt_pool_vertices *vertices)
{
	return vertices->new_count != vertices->own_count;
}

/* The vertices of a pool, all of whose solved meshes are there; it has a set. Data that edits may refer to lives as
 * long as the document, or is borrowed from the scene; tables of it are in `tables`. */
nt_status nt_pool_vertices_get(nt_vertex_pools *pools, size_t number, const nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, nt_error *error);

/* The tangents of a set as the m-th target moves it, in the arena: [new_count][3]. NULL: memory is exhausted. */
const float *nt_pool_read_target(const nt_pool_vertices *vertices, uint32_t set, size_t m, nt_arena *scratch);

/* ---- vertices appended: append.c, indices.c ---- */

/* Tangents of a set, or others of its attributes, as they will be stored. */
typedef struct nt_stored_tangents {
	nt_gltf_packing packing; /* of new bytes */
	nt_tangent_filter filter;
	const unsigned char *values, *stored; /* as readers have them, and before the filter */
	size_t element_bytes;
} nt_stored_tangents;

/* NORMAL, TANGENT or _BITANGENT of a set. */
typedef struct nt_set_attribute {
	const char *name;
	uint32_t components;
	nt_stored_tangents values;
	size_t own_count;  /* accessors of the document that take them, each for all over its bytes */
	uint32_t first_own; /* the number that the first of these has in the list, from 1 on */
	uint32_t accessor; /* the lowest of these; NT_NONE: a new one does */
	uint32_t view;     /* that those which are not in place have together; NT_NONE: there is none yet */
	uint64_t offset;
} nt_set_attribute;

/* The attributes whose values accessors of one pool take: nt_edited_accessor.override. */
typedef struct nt_override_list {
	nt_set_attribute **items; /* [count], malloc'ed */
	size_t count, capacity;
} nt_override_list;

/* Puts the values into a new view of a buffer, once. */
nt_status nt_set_attribute_place(nt_buffer_edits *edits, uint32_t buffer, nt_set_attribute *attribute, size_t count,
	bool several, nt_error *error);

/* Gives every accessor of the pool its copied elements, and overridden accessors their new values. buffer: of new
 * views. decoded_too: what was decompressed by Draco goes into plain views. */
nt_status nt_append_vertices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	const nt_override_list *overrides, bool decoded_too, nt_error *error);

/* Writes the indices of a pool's solved users where they changed. buffer: of new views. */
nt_status nt_gltf_write_indices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_error *error);

/* ---- equal vertices welded: weld.c ---- */

/*
 * Makes one vertex of those that are equal in all that the users of the pool have of them: elements of all attributes
 * and targets, bit by bit, and what takes their place. Nothing happens where none are equal, or where something else
 * refers to vertices by their numbers, which becomes a finding.
 *
 *   stored      [pool->sets.count] what takes the place of vertices->sets[].tangents: follows; NULL: nothing does
 *   bitangents  _BITANGENT will be new
 *   scratch     for what only this call needs
 *
 * Returns NT_OK or NT_ERROR_MEMORY; other errors are those of the document.
 */
nt_status nt_pool_weld(nt_buffer_edits *edits, nt_scene *scene, nt_pool_vertices *vertices,
	nt_stored_tangents *stored, bool bitangents, nt_arena *scratch, nt_error *error);

/* The vertices of a pool that stays as it is otherwise: no user of it counts as solved. *can: they can be welded. */
nt_status nt_pool_vertices_plain(const nt_vertex_pools *pools, nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, bool *can, nt_error *error);

/* ---- attributes of a tangent set: set_attributes.c ---- */

/* Finds the accessors that take the values: those that the set's meshes have and nobody else uses. Before vertices are
 * appended, which puts the values in place or into a new view. */
nt_status nt_set_attribute_settle(nt_buffer_edits *edits, const nt_vertex_pool *pool, uint32_t set,
	nt_set_attribute *attribute, nt_override_list *overrides, nt_error *error);

/* After that: lets all of the set's meshes have the values, in a new accessor if there is none. buffer: of new
 * views. */
nt_status nt_set_attribute_write(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	uint32_t set, nt_set_attribute *attribute, nt_error *error);

/* An accessor that nobody uses any more, and others over the same bytes, leave these and keep their numbers, without a
 * view. Nothing is appended to them. */
void nt_gltf_drop_elements(nt_buffer_edits *edits, uint32_t accessor);

/* Appends the JSON of an accessor; view NT_NONE: without one. Returns its number. */
uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized);

/* cross(N, T) w of every vertex of a set, glTF's own definition of the bitangent; in the arena. */
nt_status nt_gltf_bitangents(const nt_pool_vertices *vertices, uint32_t set, nt_arena *arena, float **result,
	nt_error *error);

/* ---- tangents of morph targets: morph_targets.c ---- */

/* TANGENT of the morph targets of a set's meshes: what to add to the base's, which are final. Before vertices are
 * appended. least: as nt_morph_deltas() has it. Their bytes are added to the cost. */
nt_status nt_gltf_add_morphs(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	float least, nt_morph_cost *cost, nt_error *error);

/* ---- extensions that refer to vertices: vertex_extensions.c ---- */

#define NT_GLTF_POLYGONS "FB_ngon_encoding"

/* Adds a finding for each extension of the pool's primitives and their meshes that does not hold any more, and takes
 * FB_ngon_encoding off where it would say other polygons. compressed: by Draco, which may give triangles any order.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_vertices_tell(nt_buffer_edits *edits, nt_scene *scene, const nt_pool_vertices *vertices, bool compressed,
	nt_error *error);

/* Why the numbers of a primitive's vertices have a meaning: the name of an extension, or a sentence; NULL: they have
 * none. old_count: vertices. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_vertices_find_meaning(nt_scene *scene, const nt_mesh *mesh, size_t old_count, const char **meaning);

/* Whether feature ids of a primitive are the numbers of its vertices (EXT_mesh_features). */
bool nt_vertices_are_ids(const nt_json_value *primitive);

/* After all edits: vertices were copied. Adds a finding for each scene with FB_geometry_metadata, which counts them. */
void nt_vertices_tell_scenes(nt_scene *scene);

/* ---- primitives on their way into Draco blocks: draco.c, draco_gather.c and draco_encode.c ---- */

/* A primitive that is to be compressed. First comes what is known of it, then what was looked up in the
 * document, the third what was encoded. */
typedef struct nt_gltf_recoding {
	nt_buffer_edits *edits;
	nt_gltf *document; /* of the edits, as its JSON */
	nt_json *json;
	nt_arena *arena;   /* of names and attributes */
	const nt_write_options *options;
	nt_pool_vertices *vertices;
	const nt_mesh *mesh;

	nt_json_value *primitive, *extension; /* until the JSON changes */
	uint64_t view;
	const nt_draco_mesh *source; /* NULL: the primitive is plain */
	nt_draco_attribute *attributes; /* their values are where the document or the scene has them */
	size_t attribute_count;
	const char **names;
	bool outside; /* something of the primitive is not in the block */
	const char *obstacle; /* why it cannot be compressed; NULL: nothing is known to stand in the way */

	bool encoded;
	bool sequential_instead; /* edgebreaker does not take it, or does not give it back */
	size_t faces_without_area; /* for which it does not */
	nt_draco_block block; /* where it is compressed */
} nt_gltf_recoding;

/* Attributes that nmtan may add to those of the source: NORMAL, TANGENT, _BITANGENT. */
enum { NT_GLTF_OWN_ATTRIBUTES = 3 };

/* draco_gather.c. Whether an accessor is indices of the pool's primitives alone, and nobody's attribute. */
bool nt_gltf_draco_owns_indices(const nt_gltf_recoding *recoding, uint64_t accessor);

/* draco_gather.c. There is room for what the primitive has and NT_GLTF_OWN_ATTRIBUTES. The name lives as long as the
 * JSON. */
void nt_gltf_draco_add(nt_gltf_recoding *recoding, const char *name, nt_draco_attribute attribute);

/* draco_gather.c. The attributes of a plain primitive; recoding->obstacle where it cannot be compressed. */
nt_status nt_gltf_draco_gather_plain(nt_gltf_recoding *recoding, nt_error *error);

/* draco_gather.c. Takes what the block holds out of the buffers, and gives the primitive its extension. */
void nt_gltf_draco_take_out(nt_gltf_recoding *recoding);

/* draco_encode.c. Encodes what was looked up: ->encoded then, with the block or the obstacle. Looks at no JSON, so that
 * several may be encoded at once. Returns NT_OK or what is not the mesh's fault: NT_ERROR_MEMORY, NT_ERROR_MODULE,
 * NT_ERROR_IO. */
nt_status nt_gltf_draco_encode(nt_gltf_recoding *recoding, nt_error *error);

/* The same for several on several threads; the list gets another order. One that fails is left as it was, for
 * nt_gltf_draco_encode(), which has it alone and says what is wrong. */
void nt_gltf_draco_encode_all(nt_gltf_recoding **list, size_t count, unsigned threads);

/* ---- a pool, compressed or plain: draco.c ---- */

/* Whether a solved user of the pool is compressed by Draco. */
bool nt_gltf_has_draco(const nt_vertex_pool *pool);

/* Looks up what the block of a pool will hold, which is compressed or to be compressed, for
 * nt_gltf_draco_encode_all(). Names and attributes are in the arena. */
nt_status nt_gltf_draco_look_up(nt_gltf_recoding *recoding, nt_buffer_edits *edits, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error);

/* The beginning of that, which looks at no values: whether an obstacle stands in the way, and what of a plain pool
 * goes into a block. It takes the pool of the vertices and their count in the source. */
nt_status nt_gltf_draco_begin(nt_gltf_recoding *recoding, nt_gltf *document, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error);

/*
 * Writes a pool that was looked up, and perhaps encoded: compressed (again) where that is possible, else plain, with a
 * finding. Other pools may have been written meanwhile: what is in a block belongs to one pool.
 * *done false: plain, and what plain pools need is still to be done; the indices of those that were compressed count as
 * changed. buffer: of new views.
 */
nt_status nt_gltf_write_draco(nt_gltf_recoding *recoding, uint32_t buffer, nt_scene *scene, bool *done,
	nt_error *error);

/* Makes the compressed users of a pool plain; their indices count as changed. */
void nt_gltf_draco_make_plain(nt_buffer_edits *edits, nt_pool_vertices *vertices);

#endif
