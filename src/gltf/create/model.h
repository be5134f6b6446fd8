/* SPDX-License-Identifier: MIT */
/*
 * Parts of a new glTF document: its JSON, of one buffer and one scene; primitives; images and materials.
 *
 * Additions to the JSON return the index of what they added; when memory is exhausted nt_model_json() says so. The
 * bytes of buffers and images are the caller's. Texts may be any bytes: what is not UTF-8 is taken as Latin-1, which is
 * what old files have. NULL and "" mean no name. Floats are written with the fewest digits that give them back.
 */
#ifndef NT_GLTF_CREATE_MODEL_H
#define NT_GLTF_CREATE_MODEL_H

#include "base/buffer.h"
#include "base/error.h"
#include "ext/gltf_numbers.h"
#include "file/output.h"
#include "image/pack.h"
#include "scene/scene.h"

/* ---- the JSON: model.c ---- */

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

/* ---- primitives: primitive.c ---- */

typedef struct nt_new_primitive {
	const nt_mesh *mesh;
	uint32_t material;        /* of the scene, or NT_NONE */
	uint32_t group;           /* of the mesh */
	size_t vertex_count;
	const uint32_t *vertices; /* [vertex_count] vertex of the mesh after its split; NULL: all, in order */
	size_t index_count;       /* 0 with indices NULL: every three vertices are a triangle */
	const uint32_t *indices;  /* [index_count] below vertex_count */
} nt_new_primitive;

typedef struct nt_new_primitives {
	nt_new_primitive *items;
	size_t count;
} nt_new_primitives;

/* The new primitives of a mesh, for those of its primitives that have faces, in their order. New strings live in the
 * arena. Returns NT_OK, NT_ERROR_MEMORY, NT_ERROR_TOO_LARGE or NT_ERROR_INTERNAL. */
nt_status nt_new_primitives_make(const nt_mesh *mesh, nt_arena *arena, nt_new_primitives *made,
	nt_error *error);

/* The attributes of a primitive that can be written. */
typedef enum nt_attribute {
	NT_ATTRIBUTE_POSITION,
	NT_ATTRIBUTE_NORMAL,
	NT_ATTRIBUTE_TANGENT,
	NT_ATTRIBUTE_TEXCOORD,  /* v down */
	NT_ATTRIBUTE_COLOR,
	NT_ATTRIBUTE_BITANGENT, /* cross(N, T) * w */
	NT_ATTRIBUTE_COUNT
} nt_attribute;

/* Name of the glTF attribute and floats per vertex. */
const char *nt_attribute_name(nt_attribute attribute);
int nt_attribute_width(nt_attribute attribute);

/* Whether the primitive has it. Tangents need normals, as glTF wants it. */
bool nt_new_primitive_has(const nt_new_primitive *primitive, nt_attribute attribute);

/* Smallest and largest coordinates of the positions, finite whatever they are. */
void nt_new_primitive_bounds(const nt_new_primitive *primitive, float min[3], float max[3]);

/* The component type of the indices: NT_GLTF_USHORT where that will do, else NT_GLTF_UINT. */
uint32_t nt_new_primitive_index_type(const nt_new_primitive *primitive);

/* The destination of a primitive's bytes. */
typedef nt_status (*nt_byte_writer)(void *user, const void *bytes, size_t size, nt_error *error);

/* Writes one attribute, or the indices, in blocks: straight from the mesh where it has them as they are
 * written. */
nt_status nt_new_primitive_write_attribute(const nt_new_primitive *primitive, nt_attribute attribute,
	nt_byte_writer write, void *user, nt_error *error);
nt_status nt_new_primitive_write_indices(const nt_new_primitive *primitive, nt_byte_writer write, void *user,
	nt_error *error);

/* ---- images: images.c ---- */

typedef struct nt_image_set nt_image_set;

/* A set for one output. options->textures may be NULL: there are no images. Returns NT_OK, NT_ERROR_IO when the
 * output's folder is missing, or NT_ERROR_MEMORY. */
nt_status nt_image_set_create(nt_image_set **set, const nt_write_options *options, nt_error *error);

/* NULL is allowed. */
void nt_image_set_free(nt_image_set *set);

/* Says that the document uses the image that the request of a material's map led to, and protects its file from the
 * output. NT_NONE and images without result are passed over. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_image_set_use(nt_image_set *set, const nt_material *material, const nt_map *map, nt_output *output,
	nt_error *error);

/* Adds what is used to the document: images and textures. Images that are embedded get their place at *buffer_size and
 * move it on. Others that need a file of their own are written: what was made, what is to be copied, and by default
 * what is outside of the output's folder. A link that leaves it is a finding of the scene. After all uses, once. */
nt_status nt_image_set_add(nt_image_set *set, nt_scene *scene, nt_model *model, uint64_t *buffer_size,
	nt_output *output, nt_error *error);

/* The effect of alpha of a request's image, if the request is for alpha. */
nt_alpha_mode nt_image_set_alpha(const nt_image_set *set, uint32_t request);

/* The document's texture for a map, and where it lies. */
nt_model_use nt_image_set_texture(const nt_image_set *set, const nt_map *map);

/* The number of the first embedded image from `from` on, in the order of their places; UINT32_MAX: there is none. */
uint32_t nt_image_set_embedded(const nt_image_set *set, uint32_t from);

/* That image: opened, with the place it has in the buffer. Returns NT_OK or NT_ERROR_IO, also when
 * the file is not what it was. */
nt_status nt_image_set_open(const nt_image_set *set, uint32_t number, nt_file *file,
	uint64_t *offset, nt_error *error);
void nt_image_set_close(const nt_image_set *set, uint32_t number, nt_file *file);

/* ---- materials: material.c ---- */

/* Says that the document uses the images of a material. Returns what nt_image_set_use() does. */
nt_status nt_new_material_use(const nt_material *material, nt_image_set *images, nt_output *output, nt_error *error);

/* Adds it to the document, after the images. images: NULL: without textures and what else takes texture coordinates.
 * Returns its number. */
uint32_t nt_new_material_add(const nt_material *material, const nt_image_set *images, nt_model *model);

#endif
