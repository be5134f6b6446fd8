/* SPDX-License-Identifier: MIT */
/*
 * The images of one output: each file is looked at once, each result made once, however many materials request it.
 * Knows files and pixels, no materials.
 *
 * First all requests are made, then everything is made at once (nt_textures_make), which may run beside other work,
 * then the results are there. An image that the output can have as it is stays a file and is not decoded.
 */
#ifndef NT_IMAGE_TEXTURES_H
#define NT_IMAGE_TEXTURES_H

#include <stdbool.h>
#include "base/text.h"
#include "file/input.h"
#include "image/image.h"

/* ---- the file of a name in a material: find.c ---- */

/* Names may be paths of another machine, of a system without case, or of a folder that was moved. Unless the user
 * allows it, files outside of the folders that are listed below are not found, also not through a symbolic link, and
 * nobody looks whether they are there. */

/* Places to search. */
typedef struct nt_image_places {
	const char *document;       /* the file that has the name (MTL): names are relative to its folder */
	const char *input;          /* the file that has the document (OBJ); NULL: none */
	const char *const *folders; /* [folder_count] of the user's choice */
	size_t folder_count;
	const char *root;           /* a folder of the user's in and below which images may be; NULL: none */
	bool confined;              /* neither there nor in the folder above the input's */
	bool allow_outside;         /* anywhere */
	bool given;                 /* names are paths of the user's, and nothing else is looked for */
} nt_image_places;

typedef enum nt_image_found {
	NT_IMAGE_FOUND,           /* as it is named */
	NT_IMAGE_FOUND_ELSEWHERE, /* by a part of its name, in another folder, or in another case */
	NT_IMAGE_MISSING,
	NT_IMAGE_OUTSIDE          /* where nobody may look */
} nt_image_found;

/*
 * Looks for a file in this order; the first that exists is it.
 *
 * 1. the name as it is, from the document's folder
 * 2. in the document's folder, the input's and `folders`, in this order: the name's last parts, as many as lead to a
 *    file (of C:\art\tex\n.png: art/tex/n.png, tex/n.png, n.png)
 * 3. both without regard to case (of ASCII); of several files the first in the order of bytes
 *
 * A file counts if its real path is in or below the folder where the name is looked for, `root`, or the folder above
 * the input's; there it has to be an image by its content, since all else that lies there is not told from what does
 * not. The root of the file system is neither.
 *
 *   path   appended: absolute, links kept; of what is missing, where it would be by the document
 *   found  receives how it was found
 *
 * Returns NT_OK, also for what is not found, NT_ERROR_IO or NT_ERROR_MEMORY.
 */
nt_status nt_image_find(const nt_image_places *places, const char *name, nt_buffer *path, nt_image_found *found,
	nt_error *error);

/* ---- one image of an output, from files: conversion.c ---- */

/* As it is, converted, a height map made a normal map, green turned around, or put together of channels of several.
 * Knows bytes and pixels; which files there are is textures.c's. */

/* Normal maps whose green points down get it turned around. */
typedef enum nt_flip {
	NT_FLIP_OFF,
	NT_FLIP_AUTO, /* where nt_examine_image() is sure */
	NT_FLIP_ON    /* all of them */
} nt_flip;

/* One channel of what is put together, in the order red, green, blue, alpha. */
typedef struct nt_conversion_channel {
	bool used;           /* somebody samples it */
	uint32_t source;     /* number of the image; UINT32_MAX: none, it is white */
	nt_channel_map map;
} nt_conversion_channel;

typedef struct nt_conversion {
	nt_conversion_channel channels[4]; /* without `packed` the source of the first is the image; with `heights` its
	                              map is applied */
	bool packed;
	bool png;        /* the result is a PNG, whatever the file is */
	nt_flip flip;
	bool heights;
	double height;   /* these two only with heights; clamp with packed, too */
	bool clamp;
	const char *suffix; /* of the name of what is made; only with packed */
} nt_conversion;

/* The result. */
typedef struct nt_converted {
	bool made;            /* a PNG; else the file of the first channel is the result */
	unsigned char *bytes; /* of it, in a malloc'ed block; NULL: nothing was made, or it was only judged */
	size_t size;
	bool flipped;
	nt_alpha_mode alpha;
	unsigned damaged;     /* bits: channels whose image cannot be decoded, which are white */
} nt_converted;

/* All of it that makes a difference: equal conversions have equal keys. */
enum { NT_CONVERSION_KEY = 6 + 4 * 7 };
void nt_conversion_key(const nt_conversion *how, double key[NT_CONVERSION_KEY]);

/* Whether it takes decoding at all. */
bool nt_conversion_decodes(const nt_conversion *how);

/* Whether packed channels are those of one image in their order, as they are. */
bool nt_conversion_is_identity(const nt_conversion *how);

/* Makes one of conversions of which the results differ in what their pixels are alone. */
void nt_conversion_simplify(nt_conversion *how);

/*
 * Makes it.
 *
 *   files  [4] of the channels, where they have a source; equal sources have equal files
 *   judged_only  no pixels are made but those that show what it comes to
 *
 * Returns NT_OK, also with damaged channels, as long as one that is used is left (the error says what is wrong with the
 * last of them), or what nt_image_decode() and nt_encode_png() do.
 */
nt_status nt_conversion_make(const nt_conversion *how, const nt_file *const files[4], bool judged_only,
	nt_converted *made, nt_error *error);

/* ---- all of them: textures.c ---- */

/* Images that a new document gets from its materials. */
typedef enum nt_texture_choice {
	NT_TEXTURES_AUTO, /* what glTF does not carry becomes PNG */
	NT_TEXTURES_KEEP, /* what glTF does not carry is left out */
	NT_TEXTURES_PNG   /* what can be decoded becomes PNG */
} nt_texture_choice;

typedef struct nt_textures nt_textures;

typedef enum nt_texture_kind {
	NT_TEXTURE_COLOR,  /* or anything else that is no normal map */
	NT_TEXTURE_NORMALS,
	NT_TEXTURE_HEIGHTS, /* a height map, which becomes a normal map */
	NT_TEXTURE_NORMALS_OR_HEIGHTS, /* heights if its pixels are grey */
	NT_TEXTURE_PACKED  /* channels of several images */
} nt_texture_kind;

/* A channel of what is put together. */
typedef struct nt_texture_channel {
	bool used;          /* somebody samples it */
	const char *name;   /* of the image; NULL: it is white */
	bool given;         /* a path of the user's */
	nt_channel_map map;
} nt_texture_channel;

/* The kind of an image, and its use. */
typedef struct nt_texture_request {
	nt_texture_kind kind;
	nt_texture_channel channels[4]; /* red, green, blue, alpha; if not packed the first alone, of which the map
	                                   counts for heights */
	double height;      /* of heights: see nt_heights_to_normals() */
	bool clamp;         /* of heights and what is packed */
	const char *suffix; /* of the name of what is packed; stays */
} nt_texture_request;

typedef struct nt_texture_rules {
	nt_texture_choice choice;
	nt_flip flip;
	unsigned threads;
	uint64_t max_pixels; /* that are decoded and made; 0: as nt_check_pixels() has it */
	bool judged_only;    /* nobody takes the bytes: images are decoded to see what becomes of them, and not made */
} nt_texture_rules;

/* A file that was requested. */
typedef struct nt_texture_source {
	uint32_t number;      /* of all that were requested, from 0 */
	const char *path;     /* absolute: the file, or where it would be */
	nt_image_found found;
	const char *obstacle; /* why a file that is there counts as missing; NULL: it does not */
	nt_image_type type;   /* of the file; of a missing one, by its name */
	nt_file identity;     /* of the file, closed: size, device and inode */
	uint64_t pixels;      /* as the file's header says, or as a decoder goes over them; 0: not known */
} nt_texture_source;

/* One result. Texts and bytes belong to the textures. */
typedef struct nt_texture {
	const nt_texture_source *sources[4]; /* [source_count] that it was made of; the first is it where nothing was
	                                        made */
	size_t source_count;
	nt_image_type type;        /* of the result; NT_IMAGE_OTHER: there is none */
	bool from_heights;         /* a height map became a normal map */
	bool flipped;              /* of a normal map green was turned around */
	bool packed;               /* of channels */
	nt_alpha_mode alpha;       /* of what is packed with alpha */
	unsigned lost;             /* bits: channels of what is packed whose image is not there or damaged */
	unsigned damaged;          /* of these, damaged ones */
	const char *name;          /* what a file of it is called */
	bool made;                 /* a PNG; else the first source is the result */
	const unsigned char *bytes; /* [size] of what was made; NULL: nothing, or it is only judged */
	bool mapped;                /* bytes are in a file */
	size_t size;
	const char *failure;       /* why something was not decoded; NULL: it was, or did not have to be */
} nt_texture;

/* beside: a path, which stays; large PNGs wait in files without a name beside it. NULL: in memory. Returns NULL when
 * memory is exhausted. */
nt_textures *nt_textures_create(const char *beside);
void nt_textures_free(nt_textures *textures); /* NULL is allowed */

/* Requests an image of names in a material. Returns NT_OK, also for what is not found, NT_ERROR_IO or
 * NT_ERROR_MEMORY. */
nt_status nt_textures_request(nt_textures *textures, const nt_image_places *places, const nt_texture_request *request,
	uint32_t *number, nt_error *error);

/* How many requests there are. */
size_t nt_textures_requests(const nt_textures *textures);

/* Makes the results. An image that cannot be decoded is no failure, but one without result, or as it is where glTF
 * carries it. Returns NT_OK, NT_ERROR_IO, also when a file is not what it was, NT_ERROR_MEMORY or, before anything is
 * decoded or made that would be too much, NT_ERROR_LIMIT. */
nt_status nt_textures_make(nt_textures *textures, const nt_texture_rules *rules, nt_error *error);

/* Pixels that this has decoded and made, and bytes of the files. */
uint64_t nt_textures_pixels(const nt_textures *textures, uint64_t *bytes);

/* The results, none before they are made; several requests may have one, and of results that are the same file one
 * stands for all. */
size_t nt_textures_count(const nt_textures *textures);
const nt_texture *nt_textures_at(const nt_textures *textures, size_t result);
size_t nt_textures_result(const nt_textures *textures, uint32_t request);

/* Releases the pages of a result that is in a file; they come back when they are read. */
void nt_texture_release_pages(const nt_texture *texture);

/* The outcome of a request: what was lost, what its alpha does. */
const nt_texture *nt_textures_of(const nt_textures *textures, uint32_t request);

/* The file that a channel of a request led to, which has a name. */
const nt_texture_source *nt_textures_source(const nt_textures *textures, uint32_t request, int channel);

#endif
