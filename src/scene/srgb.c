/* SPDX-License-Identifier: MIT */
/*
 * sRGB and linear light: see srgb.h.
 */
#include "scene/srgb.h"

#include <float.h>
#include <math.h>

/* What is finite but no float becomes the largest one of its sign. */
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

void nt_linearise(float *colors, size_t count)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	for (size_t i = 0; i < count; i++)
		for (int k = 0; k < 3; k++)
			colors[4 * i + (size_t)k] = nt_linear_from_srgb(&srgb, colors[4 * i + (size_t)k]);
}
