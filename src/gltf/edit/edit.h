/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: see plan.c and edit.c.
 */
#ifndef NT_GLTF_EDIT_EDIT_H
#define NT_GLTF_EDIT_EDIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "file/output.h"
#include "gltf/bytes/bytes.h"
#include "scene/scene.h"

/* Writes the source document with tangents put in, and nothing else changed. */
nt_status nt_gltf_edit(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

/* Makes the plan: after the decisions, before anything is loaded. */
nt_status nt_gltf_plan(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* Merges the split of a pooled mesh, in the order of the scene's meshes, with those of its pool before it: a vertex of
 * the source becomes one for each tangent (and made normal) that any of them wants. The mesh is `merged` then; what it
 * holds is not asked for again. */
nt_status nt_gltf_merge(nt_scene *scene, nt_mesh *mesh, nt_error *error);

/* draco_plan.c, for plan.c: sets plan.quantized of meshes that an edit of the document with these options will compress
 * by Draco, and lays the grids of joins. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_find_quantized(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* ---- images that get other pixels ---- */

/* format/turned_maps.c makes them, images.c puts them into the document. */

typedef struct nt_turned_image {
	uint32_t image;       /* of the document as it is now */
	bool replaces;        /* nobody needs the old pixels; else it is a copy of an image that others use */
	const char *suffix;   /* of the name of a file */
	unsigned char *bytes; /* [size] a PNG, malloc'ed */
	size_t size;
} nt_turned_image;

typedef struct nt_turned_images {
	nt_turned_image *items; /* [count] */
	size_t count, capacity;
} nt_turned_images;

/* ---- images of an edited document, and references to files: images.c ---- */

/* The destination of an edited document. */
typedef struct nt_gltf_output {
	const nt_write_options *options;
	nt_output *set;          /* of files */
	const char *link_prefix; /* from the output's folder to the input's, percent-encoded; "" */
	bool is_stream;          /* there can be no files beside it */
} nt_gltf_output;

/* Files that were read and are still to be written. */
typedef struct nt_open_images {
	nt_file *files; /* [count] */
	size_t count, capacity;
} nt_open_images;

/* The meaning of the images option for this output of a document. The default is LINK where the output's folder has the
 * file, and COPY elsewhere. */
nt_images nt_gltf_images_choice(const nt_write_options *options, const nt_gltf *document);

/* Links, embeds or copies the document's images, as the options say. images: empty; what is open in it must
 * stay so while the edits live. */
nt_status nt_gltf_move_images(nt_scene *scene, nt_buffer_edits *edits, const nt_gltf_output *output,
	nt_open_images *images, nt_error *error);

/* A finding about each image whose file cannot be read. Linked: images stay the files that they are; nothing is said
 * of those that lie outside, which are not looked at. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_look_for_images(nt_scene *scene, bool linked, nt_error *error);

void nt_open_images_close(nt_open_images *images);

/* The text of an external reference: neither a data URI nor anything else than a string. NULL: none. */
const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length);

/* The way from the folder of one file to the folder of another as a URI: "../other/"; "" where they are
 * the same or cannot be found. "-" is a file of the current folder. */
nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error);

/* Whether the uri of a buffer or an image, with a prefix before it, leads out of the output's folder. Not
 * where there is no prefix: it means then what it means in the input. */
bool nt_gltf_link_leaves(const nt_json_value *object, const char *prefix);

/* Puts the prefix before the uri of a buffer or an image, where that is relative. */
nt_status nt_gltf_link(nt_json *json, nt_json_value *object, const char *prefix, nt_error *error);

/* A finding about an element of "buffers" or "images". */
void nt_gltf_tell(nt_scene *scene, const char *array, size_t index, nt_code code, const char *text);

#endif
