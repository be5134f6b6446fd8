/* SPDX-License-Identifier: MIT */
/*
 * What the lines of a newmtl say, before it is known what they come to together.
 */
#ifndef NT_OBJ_MTL_VALUES_H
#define NT_OBJ_MTL_VALUES_H

#include "scene/scene.h"

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
	bool blender; /* the library says that Blender 3.2 or later wrote it */
} mtl_values;

/*
 * Makes glTF's terms of what was said: see mtl_settle.c. `m` has its name and place and is otherwise
 * nt_mtl_default(). What is contradictory, doubtful or lost is a finding.
 */
void nt_mtl_settle(const mtl_values *said, nt_scene *scene, nt_material *m);

/* Adds a finding; material: its name, NULL: of none. */
void nt_mtl_find(nt_scene *scene, nt_code code, const char *path, size_t line, const char *material,
	const char *detail);

#endif
