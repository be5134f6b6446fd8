/* SPDX-License-Identifier: MIT */
/*
 * Which meshes get tangents. The rules for glTF are those of the specification and its extensions.
 */
#ifndef NT_SCENE_SELECT_H
#define NT_SCENE_SELECT_H

#include "scene/scene.h"

typedef enum nt_only { NT_ONLY_AUTO, NT_ONLY_NEEDED, NT_ONLY_ALL } nt_only;
typedef enum nt_existing { NT_EXISTING_KEEP, NT_EXISTING_REPAIR, NT_EXISTING_REPLACE, NT_EXISTING_DROP } nt_existing;

/* Sets the decision of every mesh of the scene; findings name the meshes that need tangents and cannot have them.
 * `make_normals`: normals that lack will be made. */
void nt_select(nt_scene *scene, nt_only only, nt_existing existing, bool make_normals);

/* A few words why a mesh was or was not solved: "no material of it uses tangents". */
const char *nt_decision_text(nt_decision decision);

#endif
