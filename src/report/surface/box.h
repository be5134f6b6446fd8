/* SPDX-License-Identifier: MIT */
/*
 * Boxes around positions. One that nothing is in has minimum > maximum.
 */
#ifndef NT_REPORT_BOX_H
#define NT_REPORT_BOX_H

#include <float.h>
#include <math.h>

typedef struct nt_box {
	float minimum[3], maximum[3];
} nt_box;

static inline nt_box nt_box_empty(void)
{
	return (nt_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

/* Coordinates that are not finite are passed over. */
static inline void nt_box_add(nt_box *box, const float *position)
{
	for (int i = 0; i < 3; i++) {
		const float x = position[i];
		if (x < box->minimum[i] && x >= -FLT_MAX)
			box->minimum[i] = x;
		if (x > box->maximum[i] && x <= FLT_MAX)
			box->maximum[i] = x;
	}
}

static inline void nt_box_join(nt_box *box, const nt_box *other)
{
	for (int i = 0; i < 3; i++) {
		box->minimum[i] = other->minimum[i] < box->minimum[i] ? other->minimum[i] : box->minimum[i];
		box->maximum[i] = other->maximum[i] > box->maximum[i] ? other->maximum[i] : box->maximum[i];
	}
}

/* The largest of its sides. */
static inline double nt_box_extent(const nt_box *box)
{
	double extent = 0.0;
	for (int i = 0; i < 3; i++)
		extent = fmax(extent, (double)box->maximum[i] - box->minimum[i]);
	return extent;
}

/* As nt_box_add() for ranges of texture coordinates; NaN is passed over. */
static inline void nt_range_add(float minimum[2], float maximum[2], const float *uv)
{
	for (int i = 0; i < 2; i++) {
		minimum[i] = uv[i] < minimum[i] ? uv[i] : minimum[i];
		maximum[i] = uv[i] > maximum[i] ? uv[i] : maximum[i];
	}
}

#endif
