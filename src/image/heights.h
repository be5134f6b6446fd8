/* SPDX-License-Identifier: MIT */
/*
 * Height maps to tangent-space normal maps, as glTF has them: green up.
 */
#ifndef NT_IMAGE_HEIGHTS_H
#define NT_IMAGE_HEIGHTS_H

#include "ext/codec/pixels.h"

/*
 * Makes the normals of a surface. With h from 0 (black) to 1 (white), x to the right and y down in pixels, and
 * s = height * width, by central differences
 *
 *     n = (-s (h(x+1, y) - h(x-1, y)) / 2, s (h(x, y+1) - h(x, y-1)) / 2, 1), normalized; colour = (n + 1) / 2
 *
 * which is exact for planes and paraboloids. Pixels are square.
 *
 *   heights  of one channel, which is taken as it is, not as sRGB
 *   height   of white over black, as a share of the image's width; finite, also 0 or negative
 *   clamp    beyond a border its own pixels go on; else the opposite border's follow, as repeating samplers do
 *   normals  receives RGB of the same size and bits
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_heights_to_normals(const nt_pixels *heights, double height, bool clamp, nt_pixels *normals,
	nt_error *error);

#endif
