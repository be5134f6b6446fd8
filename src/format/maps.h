/* SPDX-License-Identifier: MIT */
/*
 * Normal maps of a scene: looked at for the report, and turned around.
 */
#ifndef NT_FORMAT_MAPS_H
#define NT_FORMAT_MAPS_H

#include "file/input.h"
#include "gltf/document.h"
#include "gltf/edit/edit.h"
#include "image/textures.h"
#include "scene/scene.h"

/* ---- the image file of a mesh's normal map or base colour, for the report: normal_map.c ---- */

/* Its pictures, and what a normal map itself says. Nothing else needs it, so nothing that is wrong with it is an error.
 * Exhausted memory and faults of the system are errors all the same. */

typedef struct nt_normal_map {
	const unsigned char *bytes;
	size_t size;
	nt_image_type type;
	uint32_t image;         /* of a glTF: its number */
	bool turnable;          /* --flip-green turns it: a PNG or JPEG, of a glTF without another form beside it */
	uint64_t identity[2];   /* which image it is: equal for two meshes that share it */
	nt_file file;           /* owned, where it is a file */
	char *path;             /* the same */
	unsigned char *decoded; /* owned, where it is a data URI */
} nt_normal_map;

/* Finds and opens it: the first material with one, files inside the document's folder only (of an OBJ as
 * image/textures.h has it).
 *
 *   slot      NT_SLOT_NORMAL, NT_SLOT_CLEARCOAT_NORMAL, which only glTF has, or 0: the base colour, if it has the
 *             texture coordinates of mesh->texcoord_set
 *   searched  where an OBJ's is looked for besides: its folders and allow_outside count; NULL: nowhere
 *
 * Returns NT_OK, with map->bytes NULL when there is none, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_normal_map_open(nt_normal_map *map, const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot,
	const nt_image_places *searched, nt_error *error);
void nt_normal_map_close(nt_normal_map *map);

/* The same of the map that a material names. */
nt_status nt_normal_map_open_named(nt_normal_map *map, const nt_scene *scene, const nt_material *material,
	enum nt_slot slot, const nt_image_places *searched, nt_error *error);

/* The image of base colours that everything has which a PLY of the scene shows with texture coordinates, which lie as
 * the image does. map->bytes are NULL where there is none; *obstacle says why if some of it has one, else it is NULL.
 * Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_color_image_open(nt_normal_map *map, const char **obstacle, const nt_scene *scene,
	const nt_image_places *searched, nt_error *error);

/* The same as nt_normal_map_open() of an image of a glTF by its number. */
nt_status nt_normal_map_open_image(nt_normal_map *map, nt_gltf *document, size_t image, nt_error *error);

/* Images of a glTF are those of the source from now on, whatever an edit makes of the document. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_normal_map_keep_uris(nt_scene *scene, nt_error *error);

/* The place at which the map of a slot is looked up, at texture coordinates whose v points down: u' = t[0] u + t[1] v
 * + t[2], v' = t[3] u + t[4] v + t[5]. A member that is missing or is no number moves nothing. */
void nt_normal_map_transform(const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot, float t[6]);

/* The map of a slot in the first material of a mesh of an OBJ that names one; NULL: none. */
const nt_map *nt_normal_map_named(const nt_scene *scene, const nt_mesh *mesh, enum nt_slot slot);

/* A finding about each image of a glTF that is not to be written whose file cannot be read. */
nt_status nt_look_for_images(nt_scene *scene, nt_error *error);

/* ---- normal maps of a glTF whose green points down, and height maps in their place: turned_maps.c ---- */

typedef struct nt_turning {
	nt_flip flip;        /* of those that are normal maps */
	const bool *images;  /* [image_count] whose green may be turned; NULL: all */
	size_t image_count;
	bool heights;        /* grey images are height maps */
	double height;       /* see nt_heights_to_normals() */
	uint64_t max_pixels; /* see nt_check_pixels() */
	unsigned threads;
} nt_turning;

/*
 * Makes the images, and has the document refer to them: an image that something else uses, too, gets a copy, and so
 * does its texture. Each image that is flipped, or cannot be, is a finding.
 *
 *   scene   of a glTF that is about to be written, with its document
 *   turned  receives the images; nt_turned_maps_free() after failure, too
 *
 * Returns NT_OK, NT_ERROR_IO, NT_ERROR_MEMORY, NT_ERROR_MODULE or NT_ERROR_LIMIT.
 */
nt_status nt_turned_maps_make(nt_scene *scene, const nt_turning *how, nt_turned_images *turned, nt_error *error);
void nt_turned_maps_free(nt_turned_images *turned);

#endif
