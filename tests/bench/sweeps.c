/* SPDX-License-Identifier: MIT */
/*
 * How far thin bevels tilt the plane beside them, by each method and by the size of the cells: tables in Markdown.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "measure.h"
#include "surfaces.h"

enum { SUMMED = 4 };
static const char *const summed_names[SUMMED] = {"mikktspace (angle, float)", "robust (angle, double)", "area",
	"lengyel"};
static const nmtan_method summed_methods[SUMMED] = {NMTAN_METHOD_MIKKTSPACE, NMTAN_METHOD_ROBUST,
	NMTAN_METHOD_AREA, NMTAN_METHOD_LENGYEL};

/* Thin bevels: how far the plane's tangents are tilted at the bevel's edge. */

enum { WIDTHS = 9, CELLS = 4, CELL_SIZES = 5 };

static const double SHEAR = 4.0 / 3;

static void set_vertex(nt_owned *o, size_t v, const double p[3], const double n[3], double u, double w)
{
	for (int i = 0; i < 3; i++) {
		o->positions[v][i] = (float)p[i];
		o->normals[v][i] = (float)n[i];
	}
	o->texcoords[v][0] = (float)u;
	o->texcoords[v][1] = (float)w;
}

/*
 * Two planes at a right angle and a flat bevel of the given width between them, cells x cells quads on the
 * planes. u runs along the profile and v along the edge; on the bevel v is sheared by 4/3, as it is where
 * an atlas joins two islands, so that dP/du turns by atan(4/3 sqrt 2) = 62.1 degrees in the projection.
 * Vertices of the two edges carry the normals of the planes.
 */
static nt_owned make_bevel(double width, uint32_t cells)
{
	const uint32_t columns = 2 * cells + 1, rows = cells;
	nt_owned o = nt_owned_make((size_t)(columns + 1) * (rows + 1), (size_t)columns * rows * 2);
	const double down = width / sqrt(2);
	for (uint32_t y = 0; y <= rows; y++) {
		for (uint32_t x = 0; x <= columns; x++) {
			const size_t v = (size_t)y * (columns + 1) + x;
			const double along = (double)y / cells;
			if (x <= cells) {
				const double s = (double)x / cells;
				set_vertex(&o, v, (double[3]){s, along, 0}, (double[3]){0, 0, 1}, s, along);
				o.truth[v][0] = 1;
			} else {
				const double s = (double)(x - cells - 1) / cells;
				set_vertex(&o, v, (double[3]){1 + down, along, -down - s}, (double[3]){1, 0, 0},
					1 + width + s, along + SHEAR * width);
			}
		}
	}
	uint32_t *to = o.indices;
	for (uint32_t y = 0; y < rows; y++) {
		for (uint32_t x = 0; x < columns; x++) {
			const uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
			memcpy(to, (uint32_t[6]){a, b, c, a, c, d}, 6 * sizeof *to);
			to += 6;
		}
	}
	return o;
}

/* The tilt at a vertex of the edge, numbered from 0 to `cells`, of planes of size 1 in cells x cells quads. */
static double bevel_tilt(double width, uint32_t cells, uint32_t vertex, nmtan_method method)
{
	nt_owned mesh = make_bevel(width, cells);
	float (*tangents)[4] = measure_room(mesh.corner_count, sizeof *tangents);
	const nmtan_options options = {.struct_bytes = sizeof options, .method = method};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	if (nmtan_tangents(&mesh.mesh, &options, &output, NULL))
		exit(3);
	const uint32_t at = vertex * (2 * cells + 2) + cells;
	double tilt = NAN;
	for (size_t c = 0; c < mesh.corner_count; c++)
		if (mesh.indices[c] == at) /* all corners have one tangent */
			tilt = measure_degrees(tangents[c], mesh.truth[at]);
	free(tangents);
	nt_owned_free(&mesh);
	return tilt;
}

/* Area weights tilt in proportion to the bevel's width by the size of the cells beside it. */
static void sweep_cells(void)
{
	static const uint32_t cells[CELL_SIZES] = {1, 2, 4, 8, 16};
	static const char *const places[3] = {"first vertex", "in between", "last vertex"};
	const double width = 0.001;
	printf("\n`area` at width %g, by the size of the cells: at the two ends of the edge, where one plane triangle "
		"meets two of the bevel or two meet one, and in between.\n\n| cells of |", width);
	for (int i = 0; i < CELL_SIZES; i++)
		printf(" %g |", 1.0 / cells[i]);
	printf("\n|---|");
	for (int i = 0; i < CELL_SIZES; i++)
		printf("---|");
	for (int place = 0; place < 3; place++) {
		printf("\n| %s |", places[place]);
		for (int i = 0; i < CELL_SIZES; i++) {
			const uint32_t vertex = place == 0 ? 0 : place == 1 ? cells[i] / 2 : cells[i];
			if (place == 1 && cells[i] == 1) {
				printf(" - |");
				continue;
			}
			const double tilt = bevel_tilt(width, cells[i], vertex, NMTAN_METHOD_AREA);
			printf(" %.3g |", tilt);
		}
	}
	printf("\n");
}

static void sweep_bevels(void)
{
	static const double widths[WIDTHS] = {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1};
	printf("\nThin bevels: tilt in degrees of the tangents of a plane beside a bevel of the given width "
		"whose texture is sheared by 4/3; cells of %g, vertices away from the ends of the edge.\n\n| "
		"width |", 1.0 / CELLS);
	for (int w = 0; w < WIDTHS; w++)
		printf(" %g |", widths[w]);
	printf("\n|---|");
	for (int w = 0; w < WIDTHS; w++)
		printf("---|");
	for (int m = 0; m < SUMMED; m++) {
		printf("\n| %s |", summed_names[m]);
		for (int w = 0; w < WIDTHS; w++)
			printf(" %.3g |", bevel_tilt(widths[w], CELLS, CELLS / 2, summed_methods[m]));
	}
	printf("\n");
	sweep_cells();
}

int main(void)
{
	sweep_bevels();
	return 0;
}
