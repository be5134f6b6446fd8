/* SPDX-License-Identifier: MIT */
/*
 * sRGB and linear light. OBJ and PLY have colours as they are shown, sRGB; scenes and glTF linear ones. IEC 61966-2-1:
 *
 *     linear = c / 12.92 for c <= 0.04045, else ((c + 0.055) / 1.055)^2.4
 */
#ifndef NT_SCENE_SRGB_H
#define NT_SCENE_SRGB_H

#include "scene/scene.h"

/* The linear values of bytes, which most colours are. */
typedef struct nt_srgb {
	float linear[256];
} nt_srgb;

void nt_srgb_init(nt_srgb *srgb);

/* Both ways. Finite values stay finite, at most FLT_MAX either way; others stay as they are. */
float nt_linear_from_srgb(const nt_srgb *srgb, float value);
float nt_srgb_from_linear(float value);

/* The byte that has exactly this linear value; -1: none. */
int nt_srgb_byte(const nt_srgb *srgb, float linear);

/* Makes a colour white that is not finite; whether it was such a one. */
bool nt_color_mend(float color[4]);

/* Makes linear colours of a mesh's [count][4]; alpha stays. Colours that are not finite become white, and a finding. */
void nt_linearise(nt_scene *scene, nt_mesh *mesh, size_t count);

#endif
