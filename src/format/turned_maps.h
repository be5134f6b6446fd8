/* SPDX-License-Identifier: MIT */
/*
 * Normal maps of a glTF whose green points down are turned, and height maps in their place become normal maps.
 */
#ifndef NT_FORMAT_TURNED_MAPS_H
#define NT_FORMAT_TURNED_MAPS_H

#include "gltf/turned_images.h"
#include "image/conversion.h"
#include "scene/scene.h"

typedef struct nt_turning {
	nt_flip flip;        /* of those that are normal maps */
	const bool *images;  /* [image_count] whose green may be turned; NULL: all */
	size_t image_count;
	bool heights;        /* grey images are height maps */
	double height;       /* see image/heights.h */
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
