/* SPDX-License-Identifier: MIT */
/*
 * MTL, the material libraries of OBJ files.
 */
#ifndef NT_OBJ_MTL_H
#define NT_OBJ_MTL_H

#include "scene/scene.h"

/* One newmtl. */
typedef struct nt_mtl_definition {
	nt_material material;
	const char *raw_name;   /* as the file spells it, for comparing with usemtl; not converted */
	size_t raw_length;
} nt_mtl_definition;

/* The definitions of all libraries, in order. Texts belong to the scene's arena, the array to whoever
 * frees it. */
typedef struct nt_mtl {
	nt_mtl_definition *definitions;
	size_t count, capacity;
	bool incomplete; /* a library could not be read */
} nt_mtl;

/* A material as it is where nothing is said about it. */
nt_material nt_mtl_default(const char *name);

/*
 * Reads the libraries of one mtllib statement: one file name, blanks allowed, or several. What cannot be
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

#endif
