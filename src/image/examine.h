/* SPDX-License-Identifier: MIT */
/*
 * Evidence in a normal map: which way its green points, and what is wrong with it.
 */
#ifndef NT_IMAGE_EXAMINE_H
#define NT_IMAGE_EXAMINE_H

#include "ext/codec/pixels.h"

typedef enum nt_green {
	NT_GREEN_UNKNOWN, /* too little to tell by */
	NT_GREEN_UP,      /* as glTF has it */
	NT_GREEN_DOWN,
	NT_GREEN_MIXED    /* down in places, or at some sizes of detail alone */
} nt_green;

/* The map is looked at in so many columns, and rows, of blocks. */
enum { NT_GREEN_BLOCKS = 12 };

typedef struct nt_normal_facts {
	nt_green green;
	double correlation; /* of dp/dv and dq/du, from -1 to 1: see examine.c */
	double agreement;   /* share of the blocks, by weight, whose sign is that of the correlation; 0 without any */
	int8_t votes[NT_GREEN_BLOCKS * NT_GREEN_BLOCKS]; /* row by row from the top: the same of each block, over all
	                                                    sizes, in percent; 0: it has nothing to tell */
	size_t blocks_up, blocks_down; /* with votes of 20 % and more */
	double not_unit;    /* share of the pixels whose length is more than a tenth from 1 */
	double blue_below;  /* share of the pixels that point into the surface */
	double banded;      /* share of the sloped pixels that lie in steps of one level: an 8-bit map of a
	                       smooth surface */
	bool constant, tilted; /* all pixels are alike; they are not those of a flat surface */
	bool object_space;  /* unit vectors into all directions */
	bool heights;       /* grey pixels alone: a height map, of which nothing else is told */
	bool srgb;          /* the file says that its samples are sRGB */
	bool lossy;         /* its compression is */
} nt_normal_facts;

/* Decodes an image and examines it. Returns what nt_image_decode() does. */
nt_status nt_examine_image(const unsigned char *bytes, size_t size, nt_normal_facts *facts, nt_error *error);

/* Examines RGB or RGBA, of which pixels without alpha do not count; of other images all is zero. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_examine_normals(const nt_pixels *pixels, nt_normal_facts *facts, nt_error *error);

#endif
