/* SPDX-License-Identifier: MIT */
/*
 * Small pictures of a mesh and of its layout, for a list of many.
 */
#ifndef NT_REPORT_PACK_THUMB_H
#define NT_REPORT_PACK_THUMB_H

#include "report/report.h"

/* Pixels. */
enum { NT_THUMB_WIDTH = 112, NT_THUMB_HEIGHT = 80 };

/* Appends, deflated, a byte for each pixel, rows from the top, 0 where nothing is: of a mesh, from where the page first
 * looks at it, 1 (dark) to 255. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_thumb_model(const nt_report_geometry *geometry, nt_buffer *out);

/* The same of its triangles in the texture, 1 for unmirrored ones and 2 for mirrored ones, which lie on those. v_down:
 * of the texture coordinates. Nothing if there are none. */
nt_status nt_thumb_layout(const nt_report_geometry *geometry, bool v_down, nt_buffer *out);

#endif
