/* SPDX-License-Identifier: MIT */
/*
 * A glTF document as nmtan sees it: the JSON as parsed, and arrays of the buffers, views and accessors that it has,
 * read once, before anybody asks for one. Bytes that nobody asks for are neither opened nor decoded, and a faulty
 * element is told to whoever asks for it.
 *
 * Every function that reads from the document reports faults with the JSON pointer of what is wrong.
 */
#ifndef NT_GLTF_DOCUMENT_H
#define NT_GLTF_DOCUMENT_H

#include <string.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "ext/gltf_numbers.h"
#include "ext/meshopt.h"
#include "file/input.h"
#include "file/output.h"
#include "json/json.h"
#include "scene/scene.h"

/* ---- the GLB container: glb.c ---- */

/* A 12-byte header, a JSON chunk, at most one BIN chunk, and whatever other chunks extensions put behind them. */

/* The place of a chunk's data in the file. */
typedef struct nt_glb_chunk {
	uint32_t type;
	size_t offset;
	size_t size;
} nt_glb_chunk;

typedef struct nt_glb {
	nt_glb_chunk json;
	nt_glb_chunk bin; /* size 0 and offset 0: there is none */
	bool has_bin;
	nt_glb_chunk *others; /* chunks of other types, in order; in the arena */
	size_t other_count;
} nt_glb;

bool nt_glb_has_magic(const unsigned char *bytes, size_t size);

/*
 * Finds the chunks of a GLB. Data behind the declared length is ignored, as viewers do; everything else
 * that is wrong is an error with its byte offset.
 *
 * Returns NT_OK, NT_ERROR_INPUT, NT_ERROR_UNSUPPORTED (another version of the container) or
 * NT_ERROR_MEMORY.
 */
nt_status nt_glb_parse(nt_glb *glb, nt_arena *arena, const unsigned char *bytes, size_t size,
	nt_error *error);

/*
 * Begins a file: header and head of the JSON chunk. The caller then writes exactly json_size bytes of text,
 * nt_glb_end_json(), where there is a BIN chunk exactly bin_size bytes and nt_glb_end_bin(), and chunks with
 * nt_glb_write_chunk().
 *
 *   json_size        of the text; padding is added
 *   has_bin          whether there is a BIN chunk
 *   bin_size         size of its data; padding is added
 *   other_bytes      sum of nt_glb_chunk_bytes() over the chunks that follow
 *
 * Returns NT_OK, NT_ERROR_IO, or NT_ERROR_UNSUPPORTED where the file would reach 4 GiB, which
 * the container cannot say.
 */
nt_status nt_glb_begin(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size,
	uint64_t other_bytes, nt_error *error);

/* Pads the JSON chunk with spaces and writes the head of the BIN chunk, if there is one. */
nt_status nt_glb_end_json(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size,
	nt_error *error);

/* Pads the BIN chunk. */
nt_status nt_glb_end_bin(nt_sink *sink, uint64_t bin_size, nt_error *error);

/* Bytes that a chunk with `size` bytes of data takes in the file. */
uint64_t nt_glb_chunk_bytes(uint64_t size);

/* Writes a whole chunk, padded with zeros. */
nt_status nt_glb_write_chunk(nt_sink *sink, uint32_t type, const void *data, size_t size,
	nt_error *error);

/* The end of a message about version 1, which Cesium's converter still reads. */
#define NT_GLTF_OLD_ADVICE "; the npm package gltf-pipeline converts it"

/* ---- the document: document.c, accessor.c and others ---- */

/* Room for the JSON pointers we make ourselves. */
enum { NT_GLTF_POINTER = 160 };

/* The source of a buffer's bytes. */
typedef enum nt_gltf_storage {
	NT_GLTF_STORED_NOWHERE, /* no uri and no BIN chunk: extensions may give it a meaning */
	NT_GLTF_STORED_BIN,     /* the BIN chunk of the GLB */
	NT_GLTF_STORED_DATA,    /* a data URI */
	NT_GLTF_STORED_FILE     /* an external file */
} nt_gltf_storage;

typedef struct nt_gltf_buffer {
	nt_gltf_storage storage;
	size_t number;              /* in the file: of several that name one file the first is left (open.c) */
	uint64_t length;            /* byteLength */
	bool described, opened;     /* the fields above (else the file is at fault) and below are valid */
	const unsigned char *bytes; /* NULL until opened */
	size_t size;                /* bytes that are there: byteLength or less */
	unsigned char *decoded;     /* of a data URI: owned */
	nt_file file;               /* of an external file: owned */
	uint64_t *pages;            /* one bit for each NT_GLTF_PAGE bytes that were read; NULL: they are not counted */
	const char *path;           /* of an external file */
} nt_gltf_buffer;

/* An accessor that several primitives share, as floats. */
typedef struct nt_gltf_floats_of {
	float *values; /* in the document's arena; NULL: nobody asked yet */
	uint32_t width;
	float fill;
} nt_gltf_floats_of;

/* In place of the number of a buffer, of view i: its own bytes, since it was decompressed. */
#define NT_GLTF_OF_VIEW(i) (((uint32_t)1 << 30) + (uint32_t)(i))

static inline bool nt_gltf_is_of_view(uint32_t buffer)
{
	return buffer >= NT_GLTF_OF_VIEW(0);
}

/* A bufferView. Once a compressed one is decoded, its buffer is NT_GLTF_OF_VIEW() of it, from 0 on. */
typedef struct nt_gltf_view {
	uint64_t offset, length;
	unsigned char *decoded; /* [length] of a compressed one, owned by the document; NULL: nobody asked yet */
	uint32_t buffer; /* NT_NONE: the file is at fault */
	uint16_t stride; /* 0: none given */
	bool compressed; /* by an extension, and not yet undone */
} nt_gltf_view;

/* The elements that a sparse accessor replaces. */
typedef struct nt_gltf_sparse_arrays {
	uint64_t count, index_offset, value_offset;
	uint32_t index_type, index_view, value_view;
} nt_gltf_sparse_arrays;

/* So many elements an accessor without a bufferView may claim: nothing in the file backs their number. */
enum { NT_GLTF_UNBACKED = 65536 };

/* An accessor, sound with its views. */
typedef struct nt_gltf_accessor {
	uint64_t count;
	uint64_t offset;         /* in the view */
	const unsigned char *decoded; /* elements from a block of Draco, or that went into one; NULL: neither */
	const struct nt_draco_attribute *packed; /* as its block has it; NULL: it is in none */
	uint32_t index;          /* NT_NONE: the file is at fault */
	uint32_t same;           /* the first accessor over the same bytes, or itself: it stands for all of them. This
	                            and the next are valid after nt_gltf_find_users() */
	uint32_t next;           /* the next accessor over the same bytes; NT_NONE: none */
	uint32_t view;           /* NT_NONE: all zeros, or decoded */
	uint32_t stride;         /* as it applies, never 0 */
	uint32_t component_type; /* enum nt_gltf_component */
	uint8_t component_bytes;
	uint8_t components;      /* of an element: 1 to 4, matrices 4, 9, 16 */
	uint8_t element_bytes;   /* with the padding of matrix columns */
	bool normalized;
	const nt_gltf_sparse_arrays *sparse; /* NULL: not sparse */
} nt_gltf_accessor;

/* Uses of an accessor, and of others over the same bytes: references.c. */
typedef struct nt_gltf_users {
	uint32_t attributes;   /* uses as attribute, of morph targets too */
	uint32_t indices : 30; /* primitives that have it as indices */
	uint32_t foreign : 1;  /* used by something else than attributes */
	uint32_t idle : 1;     /* an accessor that nobody uses is among them */
} nt_gltf_users;

/* Uses of a view. */
typedef struct nt_gltf_view_users {
	uint32_t blocks : 31; /* primitives that are compressed in it */
	uint32_t image : 1;
} nt_gltf_view_users;

/* The arrays that elements may be added to. */
typedef enum nt_gltf_growing {
	NT_GLTF_ACCESSORS,
	NT_GLTF_VIEWS,
	NT_GLTF_BUFFERS,
	NT_GLTF_GROWING /* how many */
} nt_gltf_growing;

/* The lowest number of those that something refers to although the file has no such element. */
typedef struct nt_gltf_dangling {
	uint64_t number;   /* UINT64_MAX: none */
	char pointer[160]; /* to it, as far as it has no key of the file */
} nt_gltf_dangling;

typedef struct nt_gltf {
	nt_arena arena;
	nt_json *json;
	const char *path;        /* of the document; "-" for standard input */
	const unsigned char *bytes;
	size_t byte_count;
	bool is_glb;
	nt_glb glb;
	bool allow_outside;
	struct nt_output *written; /* nt_scene.written */
	bool keeps_transforms;   /* texture transforms turn no tangents: set before meshes are described */
	nt_gltf_buffer *buffers; /* [buffer_count] */
	size_t buffer_count;
	nt_gltf_view *views;       /* [view_count] zeros until nt_gltf_read_arrays() */
	size_t view_count, decoded_count; /* decoded_count: of those that were compressed */
	size_t file_accessor_count; /* accessors that the file has */
	nt_gltf_accessor *accessors; /* [accessor_count] of the file, and those of nt_gltf_separate_draco(); NULL until
	                                nt_gltf_read_arrays() */
	size_t accessor_count;
	nt_gltf_floats_of *floats; /* [accessors] NULL until one is asked for */
	struct nt_draco **draco_blocks; /* [view_count] decoded blocks: draco.c; NULL until there is something */
	void (*free_blocks)(struct nt_gltf *document); /* set with them */
	struct nt_draco_quantization *grids; /* [accessors of the source] on which accessors will be compressed: those
	                                        of joins (edit/draco_plan.c),
	                                        bits 0: on their own. NULL: all of them */
	struct nt_vertex_pools *pools; /* who shares vertices: gltf/vertex_pools.h; NULL until that is found */
	void (*free_pools)(void *pools); /* set with them */
	nt_name_table animated;  /* pointers of texture transforms that an animation turns or scales: materials.c */
	bool animated_known;     /* then these are all */
	const struct nt_gltf_material **materials; /* [materials] of those that primitives have; NULL: none yet */
	const char **image_uris; /* [image_uri_count] of images, as the source has them; NULL: none */
	size_t image_uri_count;  /* 0 until an edit may change them */
	nt_gltf_users *users;    /* [accessor_count] by `same`; NULL: not known yet */
	nt_gltf_view_users *view_users; /* [view_count] with them */
	bool dangling_known;     /* then these are, as the file had them */
	nt_gltf_dangling dangling[NT_GLTF_GROWING];
	uint64_t bytes_read;     /* of buffers */
} nt_gltf;

/* Parses a document over the scene's bytes. Returns NT_OK, NT_ERROR_INPUT,
 * NT_ERROR_UNSUPPORTED (another version of glTF) or NT_ERROR_MEMORY. */
nt_status nt_gltf_create(nt_gltf **document, const nt_scene *scene, bool allow_outside,
	nt_error *error);

bool nt_gltf_recognise(const unsigned char *bytes, size_t size);
bool nt_glb_recognise(const unsigned char *bytes, size_t size);

/* For nt_scene.free_source. */
void nt_gltf_free(void *document);

/* A member of the root: NULL where there is none. */
nt_json_value *nt_gltf_root_member(const nt_gltf *document, const char *name);

/* Whether extensionsUsed has the name. */
bool nt_gltf_uses(const nt_gltf *document, const char *extension);

/* NT_ERROR_INPUT if the file has fewer than `index` + 1 elements. `from` is the JSON pointer of the reference. */
nt_status nt_gltf_check_index(const char *array, uint64_t index, size_t count, const char *from, nt_error *error);

/* An element of a root array must be an object. */
nt_status nt_gltf_check_object(const nt_json_value *element, const char *pointer, nt_error *error);

/* Element of a root array, which must be an object. `from` is the JSON pointer of the reference. */
nt_status nt_gltf_element(const nt_gltf *document, const char *array, uint64_t index,
	const char *from, const nt_json_value **element, nt_error *error);

/* An unsigned member of an object: value at most `limit`. If the member is missing, *value gets
 * `otherwise`; NT_GLTF_REQUIRED there makes that an error. */
#define NT_GLTF_REQUIRED UINT64_MAX
nt_status nt_gltf_uint(const nt_json_value *object, const char *pointer, const char *key,
	uint64_t limit, uint64_t otherwise, uint64_t *value, nt_error *error);

/* Length and storage of a buffer; nothing is opened. */
nt_status nt_gltf_describe_buffer(nt_gltf *document, uint64_t index, const char *from,
	nt_gltf_buffer **buffer, nt_error *error);

/* The same with its bytes. */
nt_status nt_gltf_open_buffer(nt_gltf *document, uint64_t index, const char *from,
	nt_gltf_buffer **buffer, nt_error *error);

/* The path of the file of a buffer. Returns what nt_uri_resolve() and nt_output_written() do. */
nt_status nt_gltf_resolve(nt_gltf *document, const char *uri, size_t length, const char **path, nt_error *error);

/* Books bytes of a buffer as read: whole pages, each once. Data URIs were read with the JSON. */
enum { NT_GLTF_PAGE = 4096 };
void nt_gltf_note_read(nt_gltf *document, nt_gltf_buffer *buffer, uint64_t begin, uint64_t length);

/* Bytes that were read: the JSON and what was booked. */
uint64_t nt_gltf_bytes_read(const nt_gltf *document);

/* nodes.c. Calls place(context, mesh, matrix) for every mesh that a node shows; faulty nodes are passed over.
 * `world`: for those of the default scene (of all roots, if there is no scene), with their matrix in the world; else
 * for those of any scene, or of an extension. */
typedef nt_status (*nt_gltf_place_mesh)(void *context, uint64_t mesh, const double matrix[16]);
nt_status nt_gltf_walk(const nt_gltf *document, bool world, nt_gltf_place_mesh place, void *context, nt_error *error);

/* references.c. Finds who refers to accessors and views, and the dangling references with them. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_gltf_find_users(nt_gltf *document, nt_error *error);

/* references.c. Notes the lowest dangling references alone, of a document that nothing was added to yet. */
void nt_gltf_find_dangling(nt_gltf *document);

/* references.c. NT_ERROR_INPUT with the place of a reference if what was added since then took the number that it
 * names. */
nt_status nt_gltf_check_dangling(const nt_gltf *document, nt_error *error);

/* Adds an extension to extensionsUsed or extensionsRequired, where it is not there yet. */
void nt_gltf_list_extension(nt_gltf *document, const char *list, const char *name);

/* Takes an extension off "extensionsUsed" or "extensionsRequired". */
void nt_gltf_remove_extension(nt_gltf *document, const char *list, const char *name);

/* The same of both, if no primitive has the extension. */
void nt_gltf_unlist_unused(nt_gltf *document, const char *name);

/* ---- JSON pointers ---- */

/* Both append to a pointer that ends at `end`, where there is room, and return its new end. */
static inline char *nt_gltf_put_text(char *end, const char *text)
{
	const size_t length = strlen(text);
	memcpy(end, text, length + 1);
	return end + length;
}

static inline char *nt_gltf_put_number(char *end, uint64_t number)
{
	char digits[20];
	size_t at = sizeof digits;
	do {
		digits[--at] = (char)('0' + number % 10);
	} while (number /= 10);
	memcpy(end, digits + at, sizeof digits - at);
	end += sizeof digits - at;
	*end = '\0';
	return end;
}

/* Writes "/array/index". */
static inline void nt_gltf_pointer(char pointer[NT_GLTF_POINTER], const char *array, uint64_t index)
{
	pointer[0] = '/';
	char *const end = nt_gltf_put_text(pointer + 1, array);
	*end = '/';
	nt_gltf_put_number(end + 1, index);
}

/* Writes the pointer of the primitive that a mesh is; returns its end. */
static inline char *nt_gltf_mesh_pointer(char pointer[NT_GLTF_POINTER], const nt_mesh *mesh)
{
	char *const end = nt_gltf_put_number(nt_gltf_put_text(pointer, "/meshes/"), mesh->gltf_mesh);
	return nt_gltf_put_number(nt_gltf_put_text(end, "/primitives/"), mesh->gltf_primitive);
}

/* The same for the length of an expression: nt_gltf_of_mesh(mesh).pointer */
typedef struct nt_gltf_mesh_text {
	char pointer[NT_GLTF_POINTER];
} nt_gltf_mesh_text;

static inline nt_gltf_mesh_text nt_gltf_of_mesh(const nt_mesh *mesh)
{
	nt_gltf_mesh_text text;
	nt_gltf_mesh_pointer(text.pointer, mesh);
	return text;
}

/* ---- views: view.c ---- */

/* How meshoptimizer packed a view. */
typedef struct nt_gltf_packing {
	const char *extension; /* NULL: it is plain */
	uint32_t buffer;       /* that has the packed bytes */
	uint32_t place;        /* the buffer that the view itself names, which may have no bytes */
	uint64_t offset;
	nt_meshopt_view view;
} nt_gltf_packing;

/* Reads all buffers and views of the source, without their bytes: for nt_gltf_read_arrays(). */
void nt_gltf_read_views(nt_gltf *document);

/* A view of the source. NT_ERROR_INPUT: there is none, or the file is at fault. `from` is the JSON pointer of the
 * reference. */
nt_status nt_gltf_get_view(nt_gltf *document, uint64_t index, const char *from, const nt_gltf_view **view,
	nt_error *error);

/* The same where faults are told by others; NULL: there is none, or the file is at fault. */
static inline const nt_gltf_view *nt_gltf_sound_view(const nt_gltf *document, uint64_t index)
{
	const bool sound = index < document->view_count && document->views[index].buffer != NT_NONE;
	return sound ? &document->views[index] : NULL;
}

/* The extension object of a compressed view; NULL: none. *name (may be NULL) receives the extension. */
nt_json_value *nt_gltf_compression_of(const nt_json_value *view, const char **name);

/* Decompresses a view of EXT_meshopt_compression or KHR_meshopt_compression, if it is one and nobody did. */
nt_status nt_gltf_decompress_view(nt_gltf *document, uint32_t view, nt_error *error);

/* How a view is packed, whether or not it has been decompressed. */
nt_status nt_gltf_get_packing(const nt_gltf *document, uint32_t view, nt_gltf_packing *packing, nt_error *error);

/* The bytes of a view that was decompressed, as they are before its filter; free() gives them back. */
nt_status nt_gltf_unfiltered_view(nt_gltf *document, uint32_t view, unsigned char **bytes, nt_error *error);

/* Bytes of a view, `length` of them from `offset` on; a compressed view is decompressed first. `what` is the
 * JSON pointer of who wants them. */
nt_status nt_gltf_view_bytes(nt_gltf *document, uint32_t view, uint64_t offset, uint64_t length,
	const char *what, const unsigned char **bytes, nt_error *error);

/* ---- accessors: accessor.c ---- */

/* Reads all buffers, views and accessors, unless that is done: before anybody asks for one, and before there are
 * threads. A document that is only copied needs none of them. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_read_arrays(nt_gltf *document, nt_error *error);

/* An accessor. NT_ERROR_INPUT: there is none, or the file is at fault. `from` is the JSON pointer of the reference. */
nt_status nt_gltf_get_accessor(nt_gltf *document, uint64_t index, const char *from,
	const nt_gltf_accessor **accessor, nt_error *error);

/* The same where faults are told by others; NULL: there is none (NT_NONE), or the file is at fault. */
static inline const nt_gltf_accessor *nt_gltf_sound_accessor(const nt_gltf *document, uint64_t index)
{
	const bool sound = index < document->accessor_count && document->accessors[index].index != NT_NONE;
	return sound ? &document->accessors[index] : NULL;
}

/* The view of a sound accessor that has one. */
static inline const nt_gltf_view *nt_gltf_view_of(const nt_gltf *document, const nt_gltf_accessor *accessor)
{
	return &document->views[accessor->view];
}

/* Finds which lie over the same bytes. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_find_same_bytes(nt_gltf *document, nt_error *error);

/* The JSON of a view, NULL where there is none. */
static inline nt_json_value *nt_gltf_view_json(const nt_gltf *document, uint64_t index)
{
	return nt_json_at(nt_gltf_root_member(document, "bufferViews"), (size_t)index);
}

/* The JSON of an accessor, NULL where there is none. */
nt_json_value *nt_gltf_accessor_json(const nt_gltf *document, uint64_t index);

/* Makes what an accessor says of its least and most values, if it does, that of the elements that are written:
 * bounds as nt_component_bounds() has them. */
void nt_gltf_state_bounds(nt_json *json, nt_json_value *accessor, size_t components, double bounds[2][4]);

/* The same of new elements of an accessor, `stride` apart. */
void nt_gltf_measure(nt_gltf *document, const nt_gltf_accessor *accessor, nt_json_value *json, const void *elements,
	size_t stride, size_t count, uint32_t component_type);

/* The bytes of an accessor's elements, `stride` apart; NULL where it has no view. */
nt_status nt_gltf_elements(nt_gltf *document, const nt_gltf_accessor *accessor,
	const unsigned char **elements, nt_error *error);

/* The elements with what a sparse accessor replaces, `*step` apart: as the file has them, or in the arena. NULL: all
 * are zero. */
nt_status nt_gltf_whole_elements(nt_gltf *document, const nt_gltf_accessor *accessor, nt_arena *arena,
	const unsigned char **elements, size_t *step, nt_error *error);

/* The elements a sparse accessor replaces: their numbers and new values, tightly packed. Numbers are
 * checked: increasing and below the count. The array is in the arena. */
nt_status nt_gltf_sparse(nt_gltf *document, const nt_gltf_accessor *accessor, nt_arena *arena,
	const uint32_t **elements, const unsigned char **values, nt_error *error);

/*
 * An accessor as floats, `width` per element: normalized integers as the specification maps them, other
 * integers by value. Components beyond those of the accessor get `fill`. Points into the input where it
 * already is that.
 */
nt_status nt_gltf_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width,
	float fill, nt_arena *arena, float **floats, nt_error *error);

/* The same, not to be written to: an accessor that several primitives use is decoded once, and lives as long as the
 * document. Several threads may call this. */
nt_status nt_gltf_shared_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width, float fill,
	float **floats, nt_error *error);

/* An accessor of unsigned scalars as 32-bit indices, each below `vertex_count` and not the value that
 * is reserved for restarts. Points into the input where it already is that. */
nt_status nt_gltf_indices(nt_gltf *document, const nt_gltf_accessor *accessor, size_t vertex_count,
	nt_arena *arena, uint32_t **indices, nt_error *error);

/* Size of a component; 0 for an unknown type. */
uint32_t nt_gltf_component_bytes(uint64_t component_type);

/* The narrowest type for numbers up to `most` that is not narrower than `least`. For a primitive's indices that is
 * the number of vertices, since the largest number of a type is reserved for restarts. */
uint32_t nt_gltf_index_type(uint64_t most, uint32_t least);

/* Numbers as a type of `width` bytes has them: count * width bytes. */
void nt_gltf_store_indices(const uint32_t *indices, size_t count, uint32_t width, unsigned char *bytes);

/* ---- primitives: document.c ---- */

/* Whether a mesh has tangents to be written. */
bool nt_gltf_is_solved(const nt_mesh *mesh);

/* The primitive of a mesh in the document. */
nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh);

/* Its mode, of triangles where none is said. */
uint64_t nt_gltf_mode(const nt_json_value *primitive);

/* Bytes that a vertex has, TANGENT too; attributes that cannot be read are not counted. */
size_t nt_gltf_vertex_bytes(const nt_gltf *document, const nt_json_value *primitive);

/* Takes an extension off an object. */
void nt_gltf_drop_extension(nt_json *json, nt_json_value *object, const char *name);

/* A use of an accessor by a primitive: an attribute, or one of a morph target. */
typedef struct nt_gltf_use {
	nt_json_value *attributes; /* the primitive's, or the target's */
	const char *name;
	uint32_t accessor;
	size_t object, member;     /* what comes next */
} nt_gltf_use;

/* Goes through them: a zeroed use becomes the first one, each the next. False: that was the last. */
bool nt_gltf_next_use(const nt_gltf *document, const nt_json_value *primitive, nt_gltf_use *use);

/* The accessor that a member of an object names; NT_NONE: none that is there. */
uint32_t nt_gltf_reference(const nt_gltf *document, const nt_json_value *object, const char *name);

/* The accessor that a member names; NULL: none, or a faulty one. */
static inline const nt_gltf_accessor *nt_gltf_named(const nt_gltf *document, const nt_json_value *object,
	const char *name)
{
	return nt_gltf_sound_accessor(document, nt_gltf_reference(document, object, name));
}

/* The first accessor over the same bytes, of one that is there. */
static inline uint32_t nt_gltf_same(const nt_gltf *document, uint32_t accessor)
{
	return document->accessors[accessor].same;
}

/* Uses of it, and of others over its bytes: after nt_gltf_find_users(). */
static inline const nt_gltf_users *nt_gltf_users_of(const nt_gltf *document, uint32_t accessor)
{
	return &document->users[nt_gltf_same(document, accessor)];
}

/* ---- what a document says of the buffers that were written beside it: sidecar.c ---- */

/*
 * Their names, and in "extras" the digest by which a later run knows them for ours (file/output.h).
 *
 *   "extras": {"nmtan:xxh128": DIGEST}                             we wrote these bytes, for this document
 *   "extras": {"nmtan:xxh128": DIGEST, "nmtan:replaces": DIGEST}   under a staging name, to replace that
 */

/* For nt_output_options.find_ownership. */
nt_status nt_gltf_find_ownership(nt_output *output, const char *path, nt_error *error);

/* Gives a buffer the uri and the digest of a settled sidecar. Extras that are no object stay as they are. */
nt_status nt_gltf_record(nt_json *json, nt_json_value *buffer, const nt_sink *sidecar, bool staging,
	nt_error *error);

/* Takes the digest away: the buffer is not, or no longer, a file that was written for this document. */
void nt_gltf_forget_record(nt_json *json, nt_json_value *buffer);

#endif
