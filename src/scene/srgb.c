/* SPDX-License-Identifier: MIT */
/*
 * sRGB and linear light: see values.h.
 */
#include "scene/values.h"

#include <float.h>
#include <math.h>

/* A finite value beyond floats becomes the largest one of its sign. */
static float saturated(double c)
{
	return (float)(isfinite(c) ? fmin(fmax(c, -FLT_MAX), FLT_MAX) : c);
}

static float linear_of(double c)
{
	return saturated(c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
}

void nt_srgb_init(nt_srgb *srgb)
{
	for (int i = 0; i < 256; i++)
		srgb->linear[i] = linear_of((float)i / 255.0f);
}

float nt_linear_from_srgb(const nt_srgb *srgb, float value)
{
	const float scaled = value * 255.0f;
	if (scaled >= 0.0f && scaled <= 255.0f && (float)(int)(scaled + 0.5f) / 255.0f == value)
		return srgb->linear[(int)(scaled + 0.5f)];
	return linear_of(value);
}

float nt_srgb_from_linear(float value)
{
	const double c = value;
	return saturated(c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055);
}

int nt_srgb_byte(const nt_srgb *srgb, float linear)
{
	int low = 0, high = 255;
	while (low < high) {
		const int middle = (low + high) / 2;
		if (srgb->linear[middle] < linear)
			low = middle + 1;
		else
			high = middle;
	}
	return srgb->linear[low] == linear ? low : -1;
}

bool nt_color_mend(float color[4])
{
	if (color[0] * 0 + color[1] * 0 + color[2] * 0 + color[3] * 0 == 0)
		return false;
	color[0] = color[1] = color[2] = color[3] = 1;
	return true;
}

void nt_linearise(nt_scene *scene, nt_mesh *mesh, size_t count)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	size_t bad = 0, first = 0;
	for (size_t i = 0; i < count; i++) {
		float *color = mesh->colors + 4 * i;
		if (nt_color_mend(color) && !bad++)
			first = i;
		for (int k = 0; k < 3; k++)
			color[k] = nt_linear_from_srgb(&srgb, color[k]);
	}
	if (bad)
		nt_finding_add(&scene->findings, NT_CODE_COLORS_DOUBTFUL, nt_mesh_place(mesh, &(nt_place){0}), bad,
			"%zu not finite, the first of vertex %zu", bad, first);
}
