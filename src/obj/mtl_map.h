/* SPDX-License-Identifier: MIT */
/*
 * A map statement of MTL: options, each with its number of arguments, and a file name that may have
 * blanks.
 */
#ifndef NT_OBJ_MTL_MAP_H
#define NT_OBJ_MTL_MAP_H

#include "scene/scene.h"

typedef struct nt_mtl_map {
	const char *name_begin, *name_end; /* the file name in the text; equal: there is none */
	float bump_scale;                  /* -bm, 1 where there is none */
	char channel;                      /* -imfchan: r, g, b, m, l or z; 0: none */
	float base, gain;                  /* -mm; 0 and 1 where there is none */
	nt_placement placement;            /* -s, -o, -clamp */
	bool turbulent;                    /* -t distorts the texture: not carried over */
} nt_mtl_map;

static inline bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}

/* Reads what follows the statement's word, without blanks around it. */
void nt_mtl_map_read(const char *text, const char *end, nt_mtl_map *map);

/* The file name with `\` as `/` and without quotes; NULL: out of memory. */
char *nt_mtl_map_name(nt_arena *arena, const nt_mtl_map *map);

#endif
