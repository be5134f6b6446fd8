/* SPDX-License-Identifier: MIT */
/*
 * Parts of a new glTF document: an empty one to which views, accessors, images, materials, meshes and nodes are added;
 * primitives.
 *
 * Additions return the number of what they added; when memory is exhausted nt_model_finish() says so. Members come in
 * alphabetical order, "buffers" last. Texts may be any bytes: what is not UTF-8 is taken as Latin-1, which is what old
 * files have. NULL and "" mean no name.
 */
#ifndef NT_GLTF_CREATE_MODEL_H
#define NT_GLTF_CREATE_MODEL_H

#include "base/text.h"
#include "ext/gltf_numbers.h"
#include "file/output.h"
#include "gltf/bytes/bytes.h"
#include "image/image.h"
#include "scene/scene.h"

/* ---- the document: model.c ---- */

/* No index: an optional reference that is absent. */
#define NT_MODEL_NONE UINT32_MAX

/* Elements of arrays that are text, in the order of the document. */
typedef enum nt_model_list {
	NT_MODEL_ACCESSORS,
	NT_MODEL_VIEWS,
	NT_MODEL_MESHES,
	NT_MODEL_NODES,
	NT_MODEL_ROOTS, /* nodes of the scene */
	NT_MODEL_LISTS  /* how many */
} nt_model_list;

typedef struct nt_model {
	nt_gltf *document;
	nt_json *json;
	nt_buffer_edits edits;
	nt_buffer lists[NT_MODEL_LISTS];
	uint32_t counts[NT_MODEL_LISTS];
	bool in_mesh; /* the last mesh has no end yet */
	uint32_t buffer;
	uint64_t buffer_size;
	bool failed; /* memory was exhausted */
} nt_model;

/* Returns NT_OK or NT_ERROR_MEMORY; to be freed in either case. */
nt_status nt_model_create(nt_model *model, nt_error *error);
void nt_model_free(nt_model *model);

/* Adds an element to an array of the root that is no list. */
nt_json_value *nt_model_append(nt_model *model, const char *array, uint32_t *number);

/* Members. An index that is NT_MODEL_NONE and an empty name are not written. */
void nt_model_put_index(nt_model *model, nt_json_value *object, const char *key, uint32_t index);
void nt_model_put_string(nt_model *model, nt_json_value *object, const char *key, const char *text);
void nt_model_put_floats(nt_model *model, nt_json_value *object, const char *key, const float *values, size_t count);

/* A view of `length` bytes, not 0, which `write` writes into the buffer. */
uint32_t nt_model_view(nt_model *model, uint64_t length, int target, nt_view_writer write, const void *user);

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

/* A texture of an image. clamp: with a sampler that goes on with the border, else the image repeats. extension: NULL,
 * or the one through which the image is referred to and that the document then requires: "KHR_texture_basisu" or
 * "EXT_texture_webp". */
uint32_t nt_model_texture(nt_model *model, uint32_t image, bool clamp, const char *extension);

/* Lists an extension as used and required. */
void nt_model_require(nt_model *model, const char *extension);

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
void nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double translation[3]);

/* After all additions: takes arrays out that are empty, and leaves the text of lists to nt_gltf_save(). Returns NT_OK
 * or NT_ERROR_MEMORY, also for an addition that failed. */
nt_status nt_model_finish(nt_model *model, nt_error *error);

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

/* Writes one attribute, or the indices, in blocks: straight from the mesh where it has them as they are written.
 * precision: of tangents; what integers do to them is added to the cost. */
nt_status nt_new_primitive_write_attribute(const nt_new_primitive *primitive, nt_attribute attribute,
	nt_precision precision, nt_rounding *cost, const nt_byte_target *to, nt_error *error);
nt_status nt_new_primitive_write_indices(const nt_new_primitive *primitive, const nt_byte_target *to, nt_error *error);

/* ---- images: images.c ---- */

typedef struct nt_image_set nt_image_set;

/* A set for one output. options->textures may be NULL: there are no images. Returns NT_OK, NT_ERROR_IO when the
 * output's folder is missing, or NT_ERROR_MEMORY. */
nt_status nt_image_set_create(nt_image_set **set, const nt_write_options *options, nt_error *error);

/* NULL is allowed. */
void nt_image_set_free(nt_image_set *set);

/* Says that the document uses the image that the request of a material's map led to. NT_NONE and images without result
 * are passed over. */
void nt_image_set_use(nt_image_set *set, const nt_material *material, const nt_map *map);

/* Adds what is used to the document: images and textures. An embedded one is opened when the buffer is written, so that
 * the set has to live until then. Others that need a file of their own are written: what was made, what is to be
 * copied, and by default what is outside of the output's folder. A link that leaves it is a finding of the scene. After
 * all uses, once. */
nt_status nt_image_set_add(nt_image_set *set, nt_scene *scene, nt_model *model, nt_output *output, nt_error *error);

/* The effect of alpha of a request's image, if the request is for alpha. */
nt_alpha_mode nt_image_set_alpha(const nt_image_set *set, uint32_t request);

/* How a material uses a texture. */
typedef struct nt_model_use {
	uint32_t texture; /* or NT_MODEL_NONE */
	bool moved;       /* KHR_texture_transform: sampled at scale * uv + offset, v down */
	float scale[2], offset[2];
} nt_model_use;

/* The document's texture for a map, and where it lies. */
nt_model_use nt_image_set_texture(const nt_image_set *set, const nt_map *map);

/* ---- materials: material.c ---- */

/* Says that the document uses the images of a material. */
void nt_new_material_use(const nt_material *material, nt_image_set *images);

/* Adds it to the document, after the images; its extensions are listed as used. images: NULL: without textures and what
 * else takes texture coordinates. Returns its number. */
uint32_t nt_new_material_add(const nt_material *material, const nt_image_set *images, nt_model *model);

#endif
