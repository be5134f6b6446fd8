/* SPDX-License-Identifier: MIT */
/*
 * The table of formats: who reads and who writes what. A format is found by content first, then by the
 * name's extension.
 */
#ifndef NT_IO_FORMAT_H
#define NT_IO_FORMAT_H

#include "io/file.h"
#include "scene/scene.h"

/* TANGENT of the morph targets of primitives that get tangents. */
typedef enum nt_morph_choice {
	NT_MORPH_BAKE, /* what to add to the base's, by a solve of the mesh as the target moves it */
	NT_MORPH_KEEP, /* as the source has it, or has it not */
	NT_MORPH_DROP  /* none */
} nt_morph_choice;

/* How tangents of glTF are stored, where Draco does not. */
typedef enum nt_precision {
	NT_PRECISION_FLOAT,
	NT_PRECISION_SHORT, /* normalized integers: KHR_mesh_quantization */
	NT_PRECISION_BYTE
} nt_precision;

typedef struct nt_read_options {
	int texcoord_set;   /* -1: the set that the material's slot asks for; else TEXCOORD_n */
	bool allow_outside; /* URIs may leave the folder of the input */
	bool world;         /* the output is one mesh in the world: instances and colours are wanted too */
	nt_morph_choice morphs; /* targets are loaded where they are to be baked */
	unsigned threads;
} nt_read_options;

/* External buffers of a glTF input that nothing changed; changed ones are always written anew: beside a .gltf; in a
 * .glb, the first as BIN chunk, the others beside it where it is to have files. */
typedef enum nt_buffers {
	NT_BUFFERS_DEFAULT, /* EMBED where a .gltf becomes a .glb, else LINK */
	NT_BUFFERS_LINK,    /* the files where they are */
	NT_BUFFERS_COPY,    /* beside the output */
	NT_BUFFERS_EMBED    /* data URIs, of a .glb the first one as BIN chunk: the same as nt_write_options.embed */
} nt_buffers;

/* NONE: for new documents; a document that is patched keeps its images. */
typedef enum nt_images { NT_IMAGES_DEFAULT, NT_IMAGES_LINK, NT_IMAGES_EMBED, NT_IMAGES_COPY,
	NT_IMAGES_NONE } nt_images;

/* What happens to glTF primitives that get tangents. */
typedef enum nt_draco_choice {
	NT_DRACO_KEEP, /* compressed ones are compressed again, with the source's method and quantization */
	NT_DRACO_OFF,  /* all are written plain */
	NT_DRACO_AS_SEQUENTIAL, /* all are compressed, plain ones too */
	NT_DRACO_AS_EDGEBREAKER
} nt_draco_choice;

/* Quantization of what was not quantized before, in bits: at most as many as ext/draco.h encodes. */
enum { NT_DRACO_MOST_BITS = 24 };
typedef enum nt_draco_bits {
	NT_DRACO_BITS_POSITION,
	NT_DRACO_BITS_NORMAL,
	NT_DRACO_BITS_TEXCOORD,
	NT_DRACO_BITS_TANGENT,
	NT_DRACO_BITS_COUNT
} nt_draco_bits;

typedef struct nt_write_options {
	nt_format format;   /* of the output */
	const char *path;   /* of the output, "-" for standard output */
	bool embed;         /* .gltf: buffers as data URIs */
	bool bitangents;
	nt_images images;
	nt_buffers buffers;
	nt_draco_choice draco;
	nt_morph_choice morphs;
	int draco_bits[NT_DRACO_BITS_COUNT]; /* 0: the default */
	nt_precision precision;
	bool allow_outside;
} nt_write_options;

/* One row of the table. Functions that a format does not have are NULL. */
typedef struct nt_format_entry {
	nt_format format;
	const char *name;       /* as --output-format spells it */
	const char *extensions; /* ".gltf"; several separated by spaces */
	/* Whether these bytes are this format; called with the whole input. */
	bool (*recognise)(const unsigned char *bytes, size_t size);
	/* Describes the meshes of scene->bytes (and loads them, where that is one step). */
	nt_status (*open)(nt_scene *scene, const nt_read_options *options, nt_error *error);
	/* After the decisions: sets same_as of meshes that will be solved and have the geometry of an earlier one;
	 * NULL: no two have the same. */
	nt_status (*find_same)(nt_scene *scene, const nt_read_options *options, nt_error *error);
	/* Brings the geometry of one mesh; NULL: open did. */
	nt_status (*load)(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
		nt_error *error);
	/* Stores the annotated scene. Any scene may come; a scene of the same format carries its
	 * source document. */
	nt_status (*write)(nt_scene *scene, const nt_write_options *options, nt_output *output,
		nt_error *error);
} nt_format_entry;

/* The entry of a format; NULL for NT_FORMAT_UNKNOWN. */
const nt_format_entry *nt_format_find(nt_format format);

/* The entry for an input: by content, then by name. NULL when nothing fits. */
const nt_format_entry *nt_format_of_input(const unsigned char *bytes, size_t size, const char *path);

/* The entry whose extension the path ends in, in any case; NULL: none. */
const nt_format_entry *nt_format_of_path(const char *path);

/* The formats' own functions, for the table. */
bool nt_obj_recognise(const unsigned char *bytes, size_t size);
nt_status nt_obj_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

bool nt_ply_recognise(const unsigned char *bytes, size_t size);
nt_status nt_ply_open(nt_scene *scene, const nt_read_options *options, nt_error *error);
nt_status nt_ply_write(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

bool nt_drc_recognise(const unsigned char *bytes, size_t size);
nt_status nt_drc_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

bool nt_gltf_recognise(const unsigned char *bytes, size_t size);
bool nt_glb_recognise(const unsigned char *bytes, size_t size);
nt_status nt_gltf_open(nt_scene *scene, const nt_read_options *options, nt_error *error);
nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error);
nt_status nt_gltf_load(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
	nt_error *error);
/* glTF from glTF: a patch of the document. */
nt_status nt_gltf_patch(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);
/* glTF from anything else: a new document. */
nt_status nt_gltf_compose(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error);

#endif
