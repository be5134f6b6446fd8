/* SPDX-License-Identifier: MIT */
/*
 * The formats by number, and what a user can ask of their readers and writers. The table of format/format.h, which
 * stands above them all, has their readers and writers.
 */
#ifndef NT_SCENE_FORMAT_H
#define NT_SCENE_FORMAT_H

#include <stdbool.h>

typedef enum nt_format {
	NT_FORMAT_UNKNOWN,
	NT_FORMAT_OBJ,
	NT_FORMAT_PLY,
	NT_FORMAT_GLTF,
	NT_FORMAT_GLB,
	NT_FORMAT_DRC
} nt_format;

/* Both of its containers: v points down there. */
static inline bool nt_format_is_gltf(nt_format format)
{
	return format == NT_FORMAT_GLTF || format == NT_FORMAT_GLB;
}

/* Which primitives of a glTF mesh are solved together. */
typedef enum nt_across {
	NT_ACROSS_PRIMITIVE, /* each by itself, as glTF defines tangents */
	NT_ACROSS_MESH       /* those with the same texture coordinates and texture transform, as bakers do */
} nt_across;

/* Which triangles of a glTF are solved as quads, whose halves they are. */
typedef enum nt_quads {
	NT_QUADS_AUTO, /* where FB_ngon_encoding says so, or else the tangents that are there */
	NT_QUADS_OFF,
	NT_QUADS_PAIRS /* each triangle with the next one where they have an edge in common */
} nt_quads;

/* Whose directions tangents follow if a material's texture transform turns or scales its coordinates. */
typedef enum nt_transform_choice {
	NT_TRANSFORM_BAKE, /* of the coordinates that a sampler sees */
	NT_TRANSFORM_KEEP  /* of those in the file: a renderer turns TANGENT itself */
} nt_transform_choice;

/* The origin that positions of OBJ and PLY are stored relative to: scene/values.h. */
typedef enum nt_origin_choice {
	NT_ORIGIN_AUTO, /* what float needs: nothing for most files */
	NT_ORIGIN_KEEP, /* nothing */
	NT_ORIGIN_GIVEN
} nt_origin_choice;

typedef struct nt_origin {
	nt_origin_choice choice;
	double at[3]; /* GIVEN: 0 0 0 is nothing, too */
	/* of a run: */
	bool to_ply;  /* the output is a PLY, or would be one of a PLY: that keeps a PLY's own numbers */
	bool keeps;   /* normals and tangents that are there stay */
} nt_origin;

/* TANGENT of the morph targets of primitives that get tangents. */
typedef enum nt_morph_choice {
	NT_MORPH_BAKE, /* what to add to the base's, by a solve of the mesh as the target moves it */
	NT_MORPH_KEEP, /* as the source has it, or has it not */
	NT_MORPH_DROP  /* none */
} nt_morph_choice;

/* How tangents of glTF are stored, where Draco does not. */
typedef enum nt_precision {
	NT_PRECISION_AUTO, /* as integers that are replaced, or normals that meshoptimizer packed; else float */
	NT_PRECISION_FLOAT,
	NT_PRECISION_SHORT, /* normalized integers: KHR_mesh_quantization */
	NT_PRECISION_BYTE
} nt_precision;

/* External buffers of a glTF input that nothing changed; changed ones are always written anew: beside a .gltf; in a
 * .glb, the first as BIN chunk, the others beside it where it is to have files. */
typedef enum nt_buffers {
	NT_BUFFERS_DEFAULT, /* EMBED where a .gltf becomes a .glb, else LINK */
	NT_BUFFERS_LINK,    /* the files where they are */
	NT_BUFFERS_COPY,    /* beside the output */
	NT_BUFFERS_EMBED    /* data URIs, of a .glb the first one as BIN chunk; new buffers of a .gltf too */
} nt_buffers;

/* Files that an input refers to outside its own folder. */
typedef enum nt_outside {
	NT_OUTSIDE_NO,
	NT_OUTSIDE_ROOT, /* images of the only OBJ of a run, one folder up */
	NT_OUTSIDE_YES
} nt_outside;

/* NONE: for new documents; a document that is edited keeps its images. */
typedef enum nt_images { NT_IMAGES_DEFAULT, NT_IMAGES_LINK, NT_IMAGES_EMBED, NT_IMAGES_COPY,
	NT_IMAGES_NONE } nt_images;

/* Treatment of glTF primitives that get tangents. */
typedef enum nt_draco_choice {
	NT_DRACO_KEEP, /* compressed ones are compressed again, with the source's method and quantization */
	NT_DRACO_OFF,  /* all are written plain */
	NT_DRACO_AS_SEQUENTIAL, /* all are compressed, plain ones too */
	NT_DRACO_AS_EDGEBREAKER
} nt_draco_choice;

/* Views that meshoptimizer packed, where they change, and new ones that go with them. */
typedef enum nt_meshopt_choice {
	NT_MESHOPT_KEEP, /* are packed by the same extension, mode and filter */
	NT_MESHOPT_OFF   /* are plain */
} nt_meshopt_choice;

/* Quantization of what was not quantized before, in bits: at most as many as ext/draco.h encodes. */
enum { NT_DRACO_MOST_BITS = 24 };
typedef enum nt_draco_bits {
	NT_DRACO_BITS_POSITION,
	NT_DRACO_BITS_NORMAL,
	NT_DRACO_BITS_TEXCOORD,
	NT_DRACO_BITS_TANGENT,
	NT_DRACO_BITS_COUNT
} nt_draco_bits;

/* Settings of readers and writers: the wishes of the user, which nt_settings has, and what a run adds to its copy. */
typedef struct nt_format_options {
	int texcoord_set;   /* -1: the set that the material's slot asks for; else TEXCOORD_n */
	nt_outside outside; /* URIs may leave the folder of the input if YES */
	nt_transform_choice transform;
	nt_origin origin;
	nt_across across;   /* MESH: meshes that contribute to others are loaded too */
	nt_morph_choice morphs; /* targets are loaded where they are to be baked */
	nt_draco_choice draco; /* what will be compressed is loaded as a decoder will have it */
	int draco_bits[NT_DRACO_BITS_COUNT]; /* 0: the default */
	bool bitangents;
	nt_images images;
	nt_buffers buffers;
	nt_precision precision;
	nt_meshopt_choice meshopt;
	bool weld;          /* of a glTF that is edited: equal vertices become one */
	unsigned threads;   /* 0: all */

	/* the rest is the run's */
	bool report;        /* meshes that get no tangents are loaded too, to be checked */

	/* once the output is known */
	bool world;         /* the output is one mesh in the world: instances and colours are wanted too */
	bool checks_kept;   /* kept tangents are checked against a solve with others */
	bool edits;         /* the output is the source's document, edited */
	bool only_results;  /* and nobody asks for geometry once it is solved */
	bool compresses;    /* and it gets compressed content that is not compressed in the source */

	/* when it is written */
	nt_format format;   /* of the output */
	const char *path;   /* of the output, "-" for standard output */
	const struct nt_turned_images *turned; /* of a glTF: gltf/edit/edit.h; NULL: none */
	const struct nt_textures *textures; /* of a new document's materials: image/textures.h; NULL: none */
	const struct nt_texture_file *texture_file; /* of a PLY: scene/scene.h; NULL: none */
} nt_format_options;

/* A reader's and a writer's, which differ in what the run has added. */
typedef nt_format_options nt_read_options, nt_write_options;

#endif
