/* SPDX-License-Identifier: MIT */
/*
 * The materials of a new glTF document, from those of the scene.
 */
#ifndef NT_GLTF_CREATE_MATERIAL_H
#define NT_GLTF_CREATE_MATERIAL_H

#include "gltf/create/images.h"
#include "scene/scene.h"

/* Says that the document uses the images of a material. Returns what nt_image_set_use() does. */
nt_status nt_new_material_use(const nt_material *material, nt_image_set *images, nt_output *output, nt_error *error);

/* Adds it to the document, after the images. images: NULL: without textures and what else takes texture coordinates.
 * Returns its number. */
uint32_t nt_new_material_add(const nt_material *material, const nt_image_set *images, nt_model *model);

#endif
