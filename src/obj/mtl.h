/* SPDX-License-Identifier: MIT */
/*
 * MTL, the material libraries of OBJ files.
 */
#ifndef NT_OBJ_MTL_H
#define NT_OBJ_MTL_H

#include <string.h>
#include "base/hash_index.h"
#include "scene/scene.h"

/* One newmtl. */
typedef struct nt_mtl_definition {
	nt_material material;
	const char *raw_name;   /* as the file spells it, for comparing with usemtl; not converted */
	size_t raw_length;
} nt_mtl_definition;

/* The definitions of all libraries, in order. Texts belong to the scene's arena, the caller
 * frees the array. */
typedef struct nt_mtl {
	nt_mtl_definition *definitions;
	size_t count, capacity;
	bool incomplete; /* a library could not be read */
	/* which files have been read: each is, once, by however many names it is named */
	struct nt_mtl_file {
		uint64_t device, inode;
	} *files;
	size_t file_count, file_capacity;
	nt_hash_index file_index;
} nt_mtl;

/*
 * Reads the libraries of one mtllib statement: one file name, blanks allowed, or several. A library that cannot be
 * read, or lies outside the folder of scene->path without options->allow_outside, is a finding.
 *
 *   names, length   what follows "mtllib"
 *   line            of the statement
 *
 * Returns NT_OK, NT_ERROR_INPUT (a number that is none, with the library's line) or
 * NT_ERROR_MEMORY.
 */
nt_status nt_mtl_read(nt_scene *scene, const char *names, size_t length, size_t line,
	const nt_read_options *options, nt_mtl *mtl, nt_error *error);

/* Reads definitions from bytes; `path` names them in findings and materials and has to live as long as
 * the scene. The same statuses. */
nt_status nt_mtl_parse(nt_scene *scene, const char *path, const unsigned char *bytes, size_t size,
	nt_mtl *mtl, nt_error *error);

void nt_mtl_free(nt_mtl *mtl);

/* ---- a map statement: options, each with its number of arguments, and a file name that may have blanks ---- */

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

/* A file name with `\` as `/` and without quotes; NULL: out of memory. */
char *nt_mtl_file_name(nt_arena *arena, const char *text, const char *end);

/* ---- what the lines of a newmtl say, before it is known what they come to together ---- */

typedef enum mtl_number {
	MTL_D, MTL_TR, MTL_NS, MTL_NI, MTL_ILLUM, MTL_PR, MTL_PM, MTL_PS, MTL_PC, MTL_PCR, MTL_ANISO, MTL_ANISOR,
	MTL_NUMBER_COUNT
} mtl_number;

typedef enum mtl_color { MTL_KA, MTL_KD, MTL_KE, MTL_KS, MTL_TF, MTL_COLOR_COUNT } mtl_color;

/* ORM, RMA: one image of occlusion, roughness and metallic in the order of the letters. */
typedef enum mtl_map {
	MTL_MAP_KD, MTL_MAP_KA, MTL_MAP_KE, MTL_MAP_D, MTL_MAP_TR, MTL_MAP_KS, MTL_MAP_NS, MTL_MAP_PR,
	MTL_MAP_PM, MTL_MAP_PS,
	MTL_MAP_PC, MTL_MAP_PCR, MTL_MAP_AO, MTL_MAP_ORM, MTL_MAP_RMA, MTL_MAP_REFL, MTL_MAP_NORM, MTL_MAP_BUMP,
	MTL_MAP_COUNT
} mtl_map;

/* The last statement of a kind counts. */
typedef struct mtl_values {
	struct {
		float value;
		size_t line; /* 0: nothing is said */
	} numbers[MTL_NUMBER_COUNT];
	struct {
		float value[3];
		size_t line;
	} colors[MTL_COLOR_COUNT];
	struct {
		nt_map map;       /* of which name NULL: nothing is said */
		const char *word; /* the statement's, as it is spelled */
		float scale;      /* -bm */
	} maps[MTL_MAP_COUNT];
	bool any_blender; /* the library says that Blender wrote it */
	bool blender; /* the library says that Blender 3.2 or later wrote it */
} mtl_values;

/*
 * Makes glTF's terms of what was said: see mtl_settle.c. `m` has its name and place and is otherwise
 * nt_material_default(). Each contradictory, doubtful or lost statement is a finding.
 */
void nt_mtl_settle(const mtl_values *said, nt_scene *scene, nt_material *m);

/* Adds a finding; material: its name, NULL: of none. */
void nt_mtl_find(nt_scene *scene, nt_code code, const char *path, size_t line, const char *material,
	const char *detail);

#endif
