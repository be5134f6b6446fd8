/* SPDX-License-Identifier: MIT */
/*
 * What is wished for the maps of a material: one image each, or one for those that glTF has in one.
 */
#ifndef NT_PIPELINE_MAP_WISHES_H
#define NT_PIPELINE_MAP_WISHES_H

#include "pipeline/settings.h"
#include "scene/scene.h"

typedef struct nt_map_wish {
	nt_map *maps[4]; /* of the wish's channels; of colours the first stands for three; NULL: none */
	nt_texture_wish what;
} nt_map_wish;

/* Fills `wishes` for the maps that a material has; returns how many there are. */
size_t nt_map_wishes(nt_material *material, const nt_settings *settings, nt_map_wish wishes[NT_MATERIAL_MAPS]);

/* A map whose image is lost is none any more, nor is the roughness of a coat that there is not. lost: a bit for each
 * channel of the wish. */
void nt_map_wish_settle(nt_material *material, const nt_map_wish *wish, unsigned lost);

#endif
