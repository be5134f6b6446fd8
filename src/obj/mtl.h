/* SPDX-License-Identifier: MIT */
/*
 * MTL, the material libraries of OBJ files.
 */
#ifndef NT_OBJ_MTL_H
#define NT_OBJ_MTL_H

#include <string.h>
#include "base/name_table.h"
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
	bool incomplete;     /* a library could not be read */
	nt_name_table files; /* device and inode of those that have been: each is, once, by however many names */
} nt_mtl;

static inline bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}
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

/* Reads definitions from bytes; `path` names them in findings and materials and has to live as long as the scene. Each
 * contradictory, doubtful or lost statement is a finding. The same statuses. */
nt_status nt_mtl_parse(nt_scene *scene, const char *path, const unsigned char *bytes, size_t size, nt_mtl *mtl,
	nt_error *error);

void nt_mtl_free(nt_mtl *mtl);

/* A file name with `\` as `/` and without quotes; NULL: out of memory. */
char *nt_mtl_file_name(nt_arena *arena, const char *text, const char *end);

#endif
