/* SPDX-License-Identifier: MIT */
/*
 * The images of a new glTF document: found on disk, told by content, and linked, copied or embedded. An
 * image that several materials use is one image and one texture.
 */
#ifndef NT_GLTF_CREATE_IMAGES_H
#define NT_GLTF_CREATE_IMAGES_H

#include "file/output.h"
#include "gltf/create/model.h"
#include "scene/scene.h"

typedef struct nt_image_set nt_image_set;

/* A set for one output. options->images may not be the default any more. Returns NT_OK,
 * NT_ERROR_IO when the output's folder is missing, or NT_ERROR_MEMORY. */
nt_status nt_image_set_create(nt_image_set **set, nt_scene *scene,
	const nt_write_options *options, nt_error *error);

/* NULL is allowed. */
void nt_image_set_free(nt_image_set *set);

/* Looks for the three images of a material and protects them from the output. What is missing or of a type that
 * glTF does not carry becomes a finding. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_image_set_find(nt_image_set *set, const nt_material *material, nt_output *output,
	nt_error *error);

/* Adds what was found to the document: images and textures. Images that are embedded get their place at
 * *buffer_size and move it on. Copies are written. After all finds, once. */
nt_status nt_image_set_add(nt_image_set *set, nt_model *model, uint64_t *buffer_size,
	nt_output *output, nt_error *error);

/* The document's texture for a name in a material; NT_MODEL_NONE: none. name may be NULL. */
uint32_t nt_image_set_texture(const nt_image_set *set, const nt_material *material,
	const char *name);

/* The embedded images in the order of their places. */
size_t nt_image_set_embedded_count(const nt_image_set *set);

/* One of them: opened, with the place it has in the buffer. Returns NT_OK or NT_ERROR_IO, also when
 * the file is not what it was. */
nt_status nt_image_set_open(const nt_image_set *set, size_t index, nt_file *file,
	uint64_t *offset, nt_error *error);

#endif
