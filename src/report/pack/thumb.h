/* SPDX-License-Identifier: MIT */
/*
 * The outlines of a mesh's UV islands, and the mesh itself, small: for a list of many meshes.
 */
#ifndef NT_REPORT_PACK_THUMB_H
#define NT_REPORT_PACK_THUMB_H

#include "report/report.h"

/* The range of a thumbnail's points: 0 to these, y pointing down. */
enum { NT_THUMB_WIDTH = 208, NT_THUMB_HEIGHT = 144 };

/* Appends the islands of a mesh to two SVG paths, unmirrored and mirrored, to be filled by the rule that counts
 * windings. A layout of very many points has only the first few thousand. v_down: of the texture coordinates.
 * Nothing where there are none. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_thumb(const nt_report_geometry *geometry, bool v_down, nt_buffer paths[2]);

/* The pixels of a picture of a mesh. */
enum { NT_MODEL_WIDTH = 112, NT_MODEL_HEIGHT = 80 };

/* Draws a mesh from where the page first looks at it: a byte for each pixel, rows from the top, 0 where nothing is,
 * else 1 (dark) to 255; appended, deflated. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_thumb_model(const nt_report_geometry *geometry, nt_buffer *out);

#endif
