/* SPDX-License-Identifier: MIT */
/*
 * Primitives on their way into Draco blocks.
 */
#ifndef NT_GLTF_EDIT_DRACO_H
#define NT_GLTF_EDIT_DRACO_H

#include "gltf/bytes/bytes.h"
#include "gltf/draco.h"
#include "gltf/edit/pool_edit.h"

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
