/* SPDX-License-Identifier: MIT */
/*
 * tinygltf has two jobs here: the JSON of glTF documents that we make, and a second opinion on files that
 * we wrote, since its parser is not ours. In both the bytes of buffers and images stay with the caller:
 * nothing here opens a file.
 */
#ifndef NT_EXT_TINYGLTF_H
#define NT_EXT_TINYGLTF_H

#include "base/error.h"
#include "ext/gltf_numbers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No index: an optional reference that is absent, and the result of an addition that failed. */
#define NT_MODEL_NONE UINT32_MAX

/* ---- a new document ---- */

/*
 * A document in the making: one buffer, one scene. Additions return the index of what they added. When one
 * fails, it and all later ones return NT_MODEL_NONE, and nt_model_json() says why.
 *
 * Texts may be any bytes: what is not UTF-8 is taken as Latin-1, which is what old files have. NULL and ""
 * mean no name. Floats are written with the fewest digits that give them back.
 */
typedef struct nt_model nt_model;

/* An empty document with that asset.generator. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_model_create(nt_model **model, const char *generator, nt_error *error);

/* NULL is allowed. */
void nt_model_free(nt_model *model);

/* A range of the buffer. offset is a multiple of 4, length not 0. */
uint32_t nt_model_view(nt_model *model, uint64_t offset, uint64_t length, int target);

/* An accessor over a whole view, tightly packed. */
typedef struct nt_model_accessor {
	uint32_t view;
	int component_type;
	int components;        /* 1 to 4: SCALAR, VEC2, VEC3, VEC4 */
	size_t count;
	const float *min, *max; /* [components], finite; NULL: none */
	bool normalized;
} nt_model_accessor;
uint32_t nt_model_add_accessor(nt_model *model, const nt_model_accessor *accessor);

/* An image by URI (percent-encoded already, written as it is), or in a view with its media type. */
uint32_t nt_model_image_uri(nt_model *model, const char *name, const char *uri);
uint32_t nt_model_image_view(nt_model *model, const char *name, uint32_t view,
	const char *media_type);

/* A texture of an image. extension: NULL, or the one through which the image is referred to and that the
 * document then requires: "KHR_texture_basisu" or "EXT_texture_webp". */
uint32_t nt_model_texture(nt_model *model, uint32_t image, const char *extension);

typedef struct nt_model_material {
	const char *name;
	float base_color[4];
	float emissive[3];  /* above 1: KHR_materials_emissive_strength */
	float metallic, roughness;
	bool blend;         /* alphaMode BLEND */
	uint32_t base_color_texture, emissive_texture, normal_texture; /* or NT_MODEL_NONE */
	float normal_scale;
} nt_model_material;
uint32_t nt_model_add_material(nt_model *model, const nt_model_material *material);

/* A mesh without primitives, which must get some. */
uint32_t nt_model_mesh(nt_model *model, const char *name);

/* Triangles of a mesh. */
typedef struct nt_model_attribute {
	const char *name; /* POSITION ... */
	uint32_t accessor;
} nt_model_attribute;
void nt_model_primitive(nt_model *model, uint32_t mesh, const nt_model_attribute *attributes,
	size_t attribute_count, uint32_t indices, uint32_t material);

/* A root node of the scene that shows a mesh. matrix: column-major; the identity is not written. */
uint32_t nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double matrix[16]);

/* Lists an extension as used and required. */
void nt_model_require(nt_model *model, const char *extension);

/* The document's text, in two pieces: where the buffer is embedded its base64 goes between them, else the
 * second is empty. Free with nt_model_text_free(). */
typedef struct nt_model_text {
	char *data;
	size_t size, cut; /* all bytes; those of the first piece */
} nt_model_text;

/* How the document refers to its buffer. */
typedef enum nt_model_buffer {
	NT_MODEL_CHUNK,  /* the BIN chunk of the .glb */
	NT_MODEL_FILE,   /* an nt_model_file */
	NT_MODEL_EMBEDDED /* a data URI */
} nt_model_buffer;

/* A buffer in a file of its own. */
typedef struct nt_model_file {
	const char *uri;    /* percent-encoded, written as it is */
	const char *extras; /* JSON; NULL: none */
} nt_model_file;

/*
 * The document as compact JSON.
 *
 *   buffer_length  bytes; 0: the document has no buffer
 *   file           of the buffer; NT_MODEL_FILE only
 *
 * Returns NT_OK, NT_ERROR_MEMORY or NT_ERROR_INTERNAL; also for an addition that failed.
 */
nt_status nt_model_json(nt_model *model, uint64_t buffer_length, nt_model_buffer buffer,
	const nt_model_file *file, nt_model_text *text, nt_error *error);
void nt_model_text_free(nt_model_text *text);

/* ---- reading back ---- */

typedef struct nt_reread nt_reread;

/* Gives the bytes of a file that a document refers to, by its URI after percent-decoding. They must stay
 * until nt_reread_open() returns. False: there is none, which is an error for buffers and none for images. */
typedef bool (*nt_reread_find)(void *user, const char *uri, const unsigned char **bytes, size_t *size);

/*
 * Reads a .glb or .gltf with tinygltf. Images are not decoded.
 *
 *   bytes  [size] the file
 *   find   called for buffers and images in other files; NULL: there are none
 *
 * Returns NT_OK; NT_ERROR_INPUT with tinygltf's words when it refuses the file, or JSON is nested
 * deeper than 512; NT_ERROR_UNSUPPORTED from 4 GB on, which its interface cannot take; NT_ERROR_MEMORY.
 */
nt_status nt_reread_open(nt_reread **model, const unsigned char *bytes, size_t size,
	nt_reread_find find, void *user, nt_error *error);

/* NULL is allowed. */
void nt_reread_free(nt_reread *model);

size_t nt_reread_mesh_count(const nt_reread *model);
size_t nt_reread_primitive_count(const nt_reread *model, size_t mesh);

/* The elements of an accessor, inside its buffer. Element i begins at data + i * stride_bytes. */
typedef struct nt_reread_array {
	const unsigned char *data;
	size_t count, stride_bytes;
	int component_type, components;
	bool normalized;
} nt_reread_array;

/*
 * An attribute of a primitive by its name; its indices for a NULL name.
 *
 * Returns NT_OK (with data NULL and count 0 when the primitive has none), NT_ERROR_INPUT when the
 * accessor is not inside its view and buffer, or NT_ERROR_MEMORY. Views that meshoptimizer packed are unpacked.
 * What Draco has in the primitive's block is zeros here, and its indices are none: see nt_reread_block().
 */
nt_status nt_reread_attribute(nt_reread *model, size_t mesh, size_t primitive,
	const char *name, nt_reread_array *array, nt_error *error);

/* The same of a morph target of the primitive. */
nt_status nt_reread_target(nt_reread *model, size_t mesh, size_t primitive, size_t target,
	const char *name, nt_reread_array *array, nt_error *error);

/* The KHR_draco_mesh_compression block of a primitive; false: it has none. *bytes NULL: it is not inside of a
 * buffer. */
bool nt_reread_block(nt_reread *model, size_t mesh, size_t primitive, const unsigned char **bytes,
	size_t *size);

/* The id that an attribute has in the block; false: it is not in it. */
bool nt_reread_block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name, uint32_t *id);

#ifdef __cplusplus
}
#endif
#endif
