/* SPDX-License-Identifier: MIT */
/*
 * The images that are requested for the maps of a material: one image each, or one for those that glTF has in one.
 */
#ifndef NT_PIPELINE_MAP_REQUESTS_H
#define NT_PIPELINE_MAP_REQUESTS_H

#include "pipeline/settings.h"
#include "scene/scene.h"

typedef struct nt_map_request {
	nt_map *maps[4]; /* of the request's channels; of colours the first stands for three; NULL: none */
	nt_texture_request what;
} nt_map_request;

/* How far white is above black, as the settings or by default. */
double nt_bump_height(const nt_settings *settings);

/* Fills `requests` for the maps that a material has; returns how many there are. */
size_t nt_map_requests(nt_material *material, const nt_settings *settings, nt_map_request requests[NT_MATERIAL_MAPS]);

/* A map whose image is lost is none any more, nor is the roughness of a coat that there is not. lost: a bit for each
 * channel of the request. */
void nt_map_request_settle(nt_material *material, const nt_map_request *request, unsigned lost);

#endif
