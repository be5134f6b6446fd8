/* SPDX-License-Identifier: MIT */
/*
 * The table of formats: who reads and who writes what. A format is found by content first, then by the
 * name's extension.
 */
#ifndef NT_FORMAT_FORMAT_H
#define NT_FORMAT_FORMAT_H

#include "file/output.h"
#include "scene/format.h"
#include "scene/scene.h"

/* One row of the table. Functions that a format does not have are NULL. */
typedef struct nt_format_entry {
	nt_format format;
	const char *name;       /* as --output-format spells it */
	const char *extensions; /* ".gltf"; several separated by spaces */
	/* Whether these bytes are this format; called with the whole input. */
	bool (*recognise)(const unsigned char *bytes, size_t size);
	/* Describes the meshes of scene->bytes (and loads them, where that is one step). */
	nt_status (*open)(nt_scene *scene, const nt_read_options *options, nt_error *error);
	/* After the decisions: fills what nt_mesh says of the plan, and scene->joins. NULL: each mesh is by itself. */
	nt_status (*plan)(nt_scene *scene, const nt_read_options *options, nt_error *error);
	/* After that: several threads may load meshes that it leaves `ready`, as gltf/load.h says. needed:
	 * [mesh_count], which will be loaded. NULL: load() is for one thread. */
	nt_status (*prepare)(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);
	/* Brings the geometry of one mesh; NULL: open did. */
	nt_status (*load)(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
		nt_error *error);
	/* Merges the results of a pooled mesh with those of the meshes before it, for write(); NULL: none is pooled. */
	nt_status (*merge)(nt_scene *scene, nt_mesh *mesh, nt_error *error);
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

/* The format if no name says one: PLY for PLY, else GLB. */
const nt_format_entry *nt_format_unnamed(const nt_format_entry *reader);

/* Advice about a file that is not read, as in "FBX is not read: ...": by its first bytes, else by the name's ending;
 * NULL: it is none that is known. Static. */
const char *nt_foreign_advice(const unsigned char *bytes, size_t size, const char *path);

/* ---- Draco files (.drc): drc.c ---- */

bool nt_drc_recognise(const unsigned char *bytes, size_t size);

/* Describes and loads the mesh of scene->bytes. */
nt_status nt_drc_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif
