/* SPDX-License-Identifier: MIT */
/*
 * The UV layout of a mesh as SVG: blue unmirrored, red mirrored and hatched (for readers who do not tell
 * the two apart), grey degenerate, seams thick with their number on both islands, over the grid of tiles (UDIM).
 *
 * The picture is as an image editor shows the texture: u to the right, the top of the image above. Colours
 * are given by classes with a style of their own inside, so that a page may restyle them. Triangles of a
 * kind are one path. A mesh of more than SHOWN_TRIANGLES is drawn by a part of them, and the picture says so.
 */
#include "report/render/writers.h"

#include <math.h>

enum { SHOWN_TRIANGLES = 20000, SHOWN_SEAM_EDGES = 5000, SHOWN_SEAM_LABELS = 200, MOST_TILES = 12 };

/* Units of the picture per unit of UV. */
static const double SCALE = 1000.0;

typedef struct canvas {
	nt_buffer *out;
	const nt_report_mesh *mesh;
	bool v_down;                   /* of the source */
	double minimum[2], maximum[2]; /* what is shown, in UV with v down */
	double factor;                 /* units per UV unit */
	double line;                   /* width of a thin line */
} canvas;

static double image_v(const canvas *c, double v)
{
	return c->v_down ? v : 1.0 - v;
}

static double x_of(const canvas *c, double u)
{
	return (u - c->minimum[0]) * c->factor;
}

static double y_of(const canvas *c, double v)
{
	return (image_v(c, v) - c->minimum[1]) * c->factor;
}

static bool is_drawn(const float *uv)
{
	return isfinite(uv[0]) && isfinite(uv[1]) && fabsf(uv[0]) < 1e6f && fabsf(uv[1]) < 1e6f;
}

/* All triangles and the tile 0-1, with a margin. */
static void measure(canvas *c)
{
	const nt_report_geometry *g = c->mesh->geometry;
	c->minimum[0] = c->minimum[1] = 0.0;
	c->maximum[0] = c->maximum[1] = 1.0;
	for (size_t i = 0; i < 3 * g->triangle_count; i++) {
		const float *uv = g->texcoords + 2 * (size_t)g->indices[i];
		if (!is_drawn(uv))
			continue;
		const double at[2] = {uv[0], image_v(c, uv[1])};
		for (int k = 0; k < 2; k++) {
			c->minimum[k] = fmin(c->minimum[k], at[k]);
			c->maximum[k] = fmax(c->maximum[k], at[k]);
		}
	}
	const double extent = fmax(c->maximum[0] - c->minimum[0], c->maximum[1] - c->minimum[1]);
	for (int k = 0; k < 2; k++) {
		c->minimum[k] -= 0.03 * extent;
		c->maximum[k] += 0.03 * extent;
	}
	c->factor = SCALE / (1.06 * extent);
	c->line = 1.0;
}

static void draw_triangles(const canvas *c, int orientation, const char *class_name)
{
	const nt_report_geometry *g = c->mesh->geometry;
	const size_t stride = (g->triangle_count + SHOWN_TRIANGLES - 1) / SHOWN_TRIANGLES;
	bool any = false;
	for (size_t t = 0; t < g->triangle_count; t += stride) {
		const float *uv[3];
		for (size_t k = 0; k < 3; k++)
			uv[k] = g->texcoords + 2 * (size_t)g->indices[3 * t + k];
		if (g->orientation[t] != orientation || !is_drawn(uv[0]) || !is_drawn(uv[1]) || !is_drawn(uv[2]))
			continue;
		if (!any)
			nt_buffer_format(c->out, "<path class=\"%s\" d=\"", class_name);
		any = true;
		for (int k = 0; k < 3; k++)
			nt_buffer_format(c->out, "%c%.1f %.1f", k ? 'L' : 'M', x_of(c, uv[k][0]), y_of(c, uv[k][1]));
		nt_buffer_text(c->out, "Z");
	}
	if (any)
		nt_buffer_text(c->out, "\"/>\n");
}

/* Tiles with their UDIM numbers: 1001 + u + 10 v, v counted upwards; defined for u 0..9 and v >= 0. */
static void draw_grid(const canvas *c)
{
	const int u0 = (int)floor(c->minimum[0]), u1 = (int)ceil(c->maximum[0]);
	const int v0 = (int)floor(c->minimum[1]), v1 = (int)ceil(c->maximum[1]);
	if (u1 - u0 > MOST_TILES || v1 - v0 > MOST_TILES)
		return;
	const double width = (c->maximum[0] - c->minimum[0]) * c->factor;
	const double height = (c->maximum[1] - c->minimum[1]) * c->factor;
	nt_buffer_text(c->out, "<path class=\"grid\" d=\"");
	for (int u = u0; u <= u1; u++)
		nt_buffer_format(c->out, "M%.1f 0V%.1f", x_of(c, u), height);
	for (int v = v0; v <= v1; v++)
		nt_buffer_format(c->out, "M0 %.1fH%.1f", (v - c->minimum[1]) * c->factor, width);
	nt_buffer_text(c->out, "\"/>\n");
	nt_buffer_format(c->out, "<rect class=\"tile\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/>\n",
		x_of(c, 0.0), (0.0 - c->minimum[1]) * c->factor, c->factor, c->factor);
	for (int u = u0; u < u1; u++) {
		for (int v = v0; v < v1; v++) {
			const int up = -v; /* image v 0..1 is the tile at the bottom, v 0..1 upwards */
			const bool seen = u + 0.5 < c->maximum[0] && u + 0.5 > c->minimum[0] &&
				v + 0.5 < c->maximum[1] && v + 0.5 > c->minimum[1];
			if (seen && u >= 0 && u <= 9 && up >= 0)
				nt_buffer_format(c->out, "<text class=\"udim\" x=\"%.1f\" y=\"%.1f\">%d</text>\n",
					x_of(c, u) + 6.0, (v + 1 - c->minimum[1]) * c->factor - 6.0,
					1001 + u + 10 * up);
		}
	}
}

/* One side of a seam as a polyline; it is broken where the edges do not continue in UV. */
static void draw_seam_side(const canvas *c, const nt_seam *seam, size_t index, int side, size_t *budget)
{
	nt_buffer_format(c->out, "<path class=\"seam\" data-seam=\"%zu\" d=\"", index);
	const size_t kept = seam->edge_count < NT_SEAM_EDGES ? seam->edge_count : NT_SEAM_EDGES;
	for (size_t i = 0; i < kept && *budget > 0; i++, --*budget) {
		const float *a = seam->edges[i].texcoords[side][0], *b = seam->edges[i].texcoords[side][1];
		const float *before = i ? seam->edges[i - 1].texcoords[side][1] : NULL;
		if (!is_drawn(a) || !is_drawn(b))
			continue;
		if (!before || before[0] != a[0] || before[1] != a[1])
			nt_buffer_format(c->out, "M%.1f %.1f", x_of(c, a[0]), y_of(c, a[1]));
		nt_buffer_format(c->out, "L%.1f %.1f", x_of(c, b[0]), y_of(c, b[1]));
	}
	nt_buffer_text(c->out, "\"/>\n");
	const float *at = seam->edges[kept / 2].texcoords[side][0];
	if (index < SHOWN_SEAM_LABELS && is_drawn(at))
		nt_buffer_format(c->out, "<text class=\"number\" x=\"%.1f\" y=\"%.1f\">%zu</text>\n",
			x_of(c, at[0]) + (side ? 6.0 : -26.0), y_of(c, at[1]), index);
}

static void draw_seams(const canvas *c)
{
	size_t budget = SHOWN_SEAM_EDGES;
	for (size_t i = 0; i < c->mesh->seam_count && budget > 0; i++)
		for (int side = 0; side < 2; side++)
			draw_seam_side(c, &c->mesh->seams[i], i, side, &budget);
}

static const char style[] =
	"<style>.normal{fill:#4c8fd9;fill-opacity:.55;stroke:#1d4f8c;stroke-width:.6}"
	".mirrored{fill:#d9483b;fill-opacity:.6;stroke:#8c1d14;stroke-width:.6}"
	".hatch{fill:url(#hatch)}.degenerate{fill:#888;stroke:#777;stroke-width:2}"
	".seam{fill:none;stroke:#e0a000;stroke-width:5;stroke-linecap:round;stroke-linejoin:round}"
	".grid{fill:none;stroke:#8888;stroke-width:1}.tile{fill:none;stroke:#888;stroke-width:2}"
	"text{font:20px sans-serif}.udim{fill:#888}.number{fill:#000;stroke:#fff;stroke-width:5;"
	"paint-order:stroke;font-weight:bold}.note{fill:#888}</style>\n"
	"<pattern id=\"hatch\" width=\"10\" height=\"10\" patternUnits=\"userSpaceOnUse\" "
	"patternTransform=\"rotate(45)\"><path d=\"M0 0V10\" stroke=\"#5c0d08\" stroke-width=\"3\"/></pattern>\n";

bool nt_write_uv_svg(const nt_report *report, uint32_t mesh, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	if (!m->geometry || !m->geometry->texcoords)
		return false;
	canvas c = {.out = out, .mesh = m,
		.v_down = report->format == NT_FORMAT_GLTF || report->format == NT_FORMAT_GLB};
	measure(&c);
	const double width = (c.maximum[0] - c.minimum[0]) * c.factor;
	const double height = (c.maximum[1] - c.minimum[1]) * c.factor;
	nt_buffer_format(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.1f %.1f\" "
		"data-origin=\"%.9g %.9g\" data-factor=\"%.9g\" role=\"img\">\n<title>UV layout of ",
		width, height, c.minimum[0], c.minimum[1], c.factor);
	nt_put_label(report, mesh, nt_xml_text, out);
	nt_buffer_text(out, "</title>\n");
	nt_buffer_text(out, style);
	draw_grid(&c);
	draw_triangles(&c, 1, "normal");
	draw_triangles(&c, -1, "mirrored");
	draw_triangles(&c, -1, "hatch");
	draw_triangles(&c, 0, "degenerate");
	draw_seams(&c);
	if (m->geometry->triangle_count > SHOWN_TRIANGLES)
		nt_buffer_format(out, "<text class=\"note\" x=\"6\" y=\"22\">a sample: one of %zu triangles</text>\n",
			(m->geometry->triangle_count + SHOWN_TRIANGLES - 1) / SHOWN_TRIANGLES);
	nt_buffer_text(out, "</svg>\n");
	return true;
}
