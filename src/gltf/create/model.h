/* SPDX-License-Identifier: MIT */
/*
 * The JSON of a new glTF document: one buffer, one scene. Additions return the index of what they added; when memory
 * is exhausted nt_model_json() says so. The bytes of buffers and images are the caller's.
 *
 * Texts may be any bytes: what is not UTF-8 is taken as Latin-1, which is what old files have. NULL and ""
 * mean no name. Floats are written with the fewest digits that give them back.
 */
#ifndef NT_GLTF_CREATE_MODEL_H
#define NT_GLTF_CREATE_MODEL_H

#include "base/buffer.h"
#include "base/error.h"
#include "ext/gltf_numbers.h"
#include "file/output.h"
#include "image/pack.h"

/* No index: an optional reference that is absent. */
#define NT_MODEL_NONE UINT32_MAX

typedef struct nt_model nt_model;

/* An empty document with that asset.generator, plain ASCII that stays. NULL: memory is exhausted. */
nt_model *nt_model_create(const char *generator);

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
uint32_t nt_model_image_view(nt_model *model, const char *name, uint32_t view, const char *media_type);

/* A texture of an image. clamp: with a sampler that goes on with the border, else the image repeats. extension: NULL,
 * or the one through which the image is referred to and that the document then requires: "KHR_texture_basisu" or
 * "EXT_texture_webp"; the text stays. */
uint32_t nt_model_texture(nt_model *model, uint32_t image, bool clamp, const char *extension);

/* How a material uses a texture. */
typedef struct nt_model_use {
	uint32_t texture; /* or NT_MODEL_NONE */
	bool moved;       /* KHR_texture_transform: sampled at scale * uv + offset, v down */
	float scale[2], offset[2];
} nt_model_use;

/* A material; its extensions are listed as used. Textures may be NT_MODEL_NONE. */
typedef struct nt_model_material {
	const char *name;
	nt_alpha_mode alpha_mode;
	float base_color[4];
	float emissive[3];  /* above 1: KHR_materials_emissive_strength */
	float metallic, roughness;
	float normal_scale;
	float clearcoat, clearcoat_roughness; /* 0: without KHR_materials_clearcoat */
	float sheen, sheen_roughness;         /* of white; 0: without KHR_materials_sheen */
	float anisotropy, anisotropy_rotation; /* 0: without KHR_materials_anisotropy */
	float ior;                            /* 0: without KHR_materials_ior */
	nt_model_use base_color_texture, emissive_texture, normal_texture, metallic_roughness_texture,
		occlusion_texture;
	nt_model_use clearcoat_texture, clearcoat_roughness_texture, sheen_texture;
} nt_model_material;
uint32_t nt_model_add_material(nt_model *model, const nt_model_material *material);

/* A mesh, whose primitives must follow. */
uint32_t nt_model_mesh(nt_model *model, const char *name);

/* Triangles of the mesh that was added last. Attributes are written in the order in which they come. */
typedef struct nt_model_attribute {
	const char *name; /* POSITION ... */
	uint32_t accessor;
} nt_model_attribute;
void nt_model_primitive(nt_model *model, const nt_model_attribute *attributes, size_t attribute_count,
	uint32_t indices, uint32_t material);

/* A root node of the scene that shows a mesh. A translation of 0 0 0 is not written. */
uint32_t nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double translation[3]);

/* Lists an extension as used and required; the text stays. */
void nt_model_require(nt_model *model, const char *extension);

/* The document's text, in pieces that belong to the model: where the buffer is embedded its base64 goes between
 * those of the beginning and those of the end, else the end is no more than brackets. */
typedef struct nt_model_piece {
	const char *data;
	size_t size;
} nt_model_piece;

enum { NT_MODEL_MOST_PIECES = 32 };

typedef struct nt_model_text {
	nt_model_piece pieces[NT_MODEL_MOST_PIECES];
	size_t count, cut; /* cut: pieces of the beginning */
	size_t size;       /* all bytes */
	nt_buffer own;     /* of some pieces */
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
 * The document as compact JSON. Free the text before the model; nothing can be added in between.
 *
 *   buffer_length  bytes; 0: the document has no buffer
 *   file           of the buffer; NT_MODEL_FILE only
 *
 * Returns NT_OK, NT_ERROR_MEMORY, also for an addition that failed, or NT_ERROR_INTERNAL.
 */
nt_status nt_model_json(nt_model *model, uint64_t buffer_length, nt_model_buffer buffer,
	const nt_model_file *file, nt_model_text *text, nt_error *error);
void nt_model_text_free(nt_model_text *text);

/* Write the beginning and the end. */
nt_status nt_model_text_begin(const nt_model_text *text, nt_sink *sink, nt_error *error);
nt_status nt_model_text_end(const nt_model_text *text, nt_sink *sink, nt_error *error);

#endif
