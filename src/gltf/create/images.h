/* SPDX-License-Identifier: MIT */
/*
 * The images and materials of a new glTF document. Each result that its materials use (image/textures.h) is linked,
 * copied or embedded. An image that was made has no file yet: if others are linked, it is written beside the output.
 * An image that several materials use is one image, and a texture for each of its samplers.
 */
#ifndef NT_GLTF_CREATE_IMAGES_H
#define NT_GLTF_CREATE_IMAGES_H

#include "file/output.h"
#include "gltf/create/model.h"
#include "scene/scene.h"

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
