/* SPDX-License-Identifier: MIT */
/*
 * Which meshes get tangents. The rules for glTF are those of the specification and its extensions.
 */
#ifndef NT_SCENE_SELECT_H
#define NT_SCENE_SELECT_H

#include "scene/scene.h"

typedef enum nt_only { NT_ONLY_AUTO, NT_ONLY_NEEDED, NT_ONLY_ALL } nt_only;
typedef enum nt_existing { NT_EXISTING_KEEP, NT_EXISTING_REPAIR, NT_EXISTING_REPLACE, NT_EXISTING_DROP } nt_existing;

/* Which meshes get normals that are made. */
typedef enum nt_making_normals {
	NT_MAKING_NONE,
	NT_MAKING_MISSING,     /* those that get tangents, and lack them */
	NT_MAKING_ALL_MISSING, /* of a glTF, also those that get no tangents; other formats load these in any case */
	NT_MAKING_ALL          /* the same, and those that have some get others */
} nt_making_normals;

/* Sets the decision of every mesh of the scene; findings name the meshes that need tangents and cannot have them. */
void nt_select(nt_scene *scene, nt_only only, nt_existing existing, nt_making_normals normals);

/* A few words why a mesh was or was not solved: "no material of it uses tangents". */
const char *nt_decision_text(nt_decision decision);

#endif
