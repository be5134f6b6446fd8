/* SPDX-License-Identifier: MIT */
/*
 * The images of one output: each file is looked at once, each result made once, however many materials wish for it.
 * Knows files and pixels, no materials.
 *
 * First all wishes are made, then everything is made at once (nt_textures_make), which may run beside other work,
 * then the results are there. An image that the output can have as it is stays a file and is not decoded.
 */
#ifndef NT_IMAGE_TEXTURES_H
#define NT_IMAGE_TEXTURES_H

#include "file/input.h"
#include "image/find.h"
#include "image/image.h"

/* Images that a new document gets from its materials. */
typedef enum nt_texture_choice {
	NT_TEXTURES_AUTO, /* what glTF does not carry becomes PNG */
	NT_TEXTURES_KEEP, /* what glTF does not carry is left out */
	NT_TEXTURES_PNG   /* what can be decoded becomes PNG */
} nt_texture_choice;

/* Normal maps whose green points down get it turned around. */
typedef enum nt_flip {
	NT_FLIP_OFF,
	NT_FLIP_AUTO, /* where image/examine.h is sure */
	NT_FLIP_ON    /* all of them */
} nt_flip;

typedef struct nt_textures nt_textures;

typedef enum nt_texture_kind {
	NT_TEXTURE_COLOR,  /* or anything else that is no normal map */
	NT_TEXTURE_NORMALS,
	NT_TEXTURE_HEIGHTS, /* a height map, which becomes a normal map */
	NT_TEXTURE_NORMALS_OR_HEIGHTS /* heights if its pixels are grey */
} nt_texture_kind;

/* What an image is, and how it is used. */
typedef struct nt_texture_wish {
	nt_texture_kind kind;
	double height; /* of heights: see image/heights.h */
	bool clamp;
} nt_texture_wish;

typedef struct nt_texture_rules {
	nt_texture_choice choice;
	nt_flip flip;
	unsigned threads;
} nt_texture_rules;

/* One result. Texts and bytes belong to the textures. */
typedef struct nt_texture {
	const char *path;          /* absolute: the file, or where it would be */
	nt_image_found found;
	nt_image_type source_type; /* of the file; of a missing one, by its name */
	nt_image_type type;        /* of the result; NT_IMAGE_OTHER: there is none */
	bool from_heights;         /* a height map became a normal map */
	bool flipped;              /* of a normal map green was turned around */
	nt_file identity;          /* of the file, closed: size, device and inode */
	const char *name;          /* what a file of it is called */
	const unsigned char *bytes; /* [size] of a PNG that was made; NULL: the file is the result */
	size_t size;
	const char *failure;       /* why it was not decoded; NULL: it was, or did not have to be */
} nt_texture;

/* NULL: out of memory. */
nt_textures *nt_textures_create(void);
void nt_textures_free(nt_textures *textures); /* NULL is allowed */

/* Wishes for the image of a name in a material. The same wish has the same number. Returns NT_OK, also for what is not
 * found, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_textures_wish(nt_textures *textures, const nt_image_places *places, const char *name,
	const nt_texture_wish *wish, uint32_t *number, nt_error *error);

/* Makes the results. An image that cannot be decoded is no failure, but one without result, or as it is where glTF
 * carries it. Returns NT_OK, NT_ERROR_IO, also when a file is not what it was, or NT_ERROR_MEMORY. */
nt_status nt_textures_make(nt_textures *textures, const nt_texture_rules *rules, nt_error *error);

/* The results; several wishes may have one. */
size_t nt_textures_count(const nt_textures *textures);
const nt_texture *nt_textures_at(const nt_textures *textures, size_t result);
size_t nt_textures_result(const nt_textures *textures, uint32_t wish);

#endif
