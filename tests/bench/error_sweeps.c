/* SPDX-License-Identifier: MIT */
/* See error_sweeps.h. */
#include "error_sweeps.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include "chart.h"
#include "error_meshes.h"
#include "measure.h"

/* Convergence: error against the analytic dP/du over resolutions. */

enum { LEVELS = 8, SUMMED = 4 };
static const char *const summed_names[SUMMED] = {"mikktspace (angle, float)", "robust (angle, double)", "area",
	"lengyel"};
static const nmtan_method summed_methods[SUMMED] = {NMTAN_METHOD_MIKKTSPACE, NMTAN_METHOD_ROBUST,
	NMTAN_METHOD_AREA, NMTAN_METHOD_LENGYEL};

static void judge_level(uint32_t cells, double median[SUMMED], double worst[SUMMED])
{
	measure_pool pools[SUMMED] = {{0}};
	for (int s = 0; s < NT_SURFACE_COUNT; s++) {
		nt_owned mesh = nt_surface_grid((nt_surface)s, cells, cells, 0.25, cells);
		float (*tangents)[4] = measure_room(mesh.corner_count, sizeof *tangents);
		for (int m = 0; m < SUMMED; m++) {
			const nmtan_options options = {.struct_bytes = sizeof options,
				.method = summed_methods[m]};
			const nmtan_output output = {.struct_bytes = sizeof output,
				.tangents = &tangents[0][0]};
			if (nmtan_tangents(&mesh.mesh, &options, &output, NULL))
				exit(3);
			/* large meshes by a sample */
			const size_t step = mesh.corner_count / 100000 * 2 + 1;
			for (size_t c = 0; c < mesh.corner_count; c += step)
				measure_pool_add(&pools[m], measure_degrees(tangents[c], mesh.truth[mesh.indices[c]]));
		}
		free(tangents);
		nt_owned_free(&mesh);
	}
	for (int m = 0; m < SUMMED; m++) {
		measure_pool_finish(&pools[m]);
		median[m] = pools[m].median;
		worst[m] = pools[m].worst;
	}
}

void sweep_convergence(const char *output, FILE *md)
{
	double cells[LEVELS], median[SUMMED][LEVELS], worst[SUMMED][LEVELS];
	FILE *csv = measure_open(output, "convergence.csv", "w");
	fprintf(csv, "cells,method,median_degrees,worst_degrees\n");
	for (int l = 0; l < LEVELS; l++) {
		double med[SUMMED], wor[SUMMED];
		cells[l] = 8 << l;
		judge_level((uint32_t)cells[l], med, wor);
		for (int m = 0; m < SUMMED; m++) {
			median[m][l] = med[m];
			worst[m][l] = wor[m];
			fprintf(csv, "%g,%s,%.5g,%.5g\n", cells[l], summed_names[m], med[m], wor[m]);
		}
	}
	fclose(csv);
	fprintf(md, "\n## Convergence to the analytic dP/du\n\nSphere, torus, twisted strip, sheared saddle and noise, "
		"vertices moved by up to a quarter of a cell; median / worst degrees. The order is the slope of the "
		"median from 16 to 128 cells.\n\n| cells |");
	for (int l = 0; l < LEVELS; l++)
		fprintf(md, " %g |", cells[l]);
	fprintf(md, " order |\n|---|");
	for (int l = 0; l <= LEVELS; l++)
		fprintf(md, "---|");
	chart_series series[SUMMED];
	for (int m = 0; m < SUMMED; m++) {
		fprintf(md, "\n| %s |", summed_names[m]);
		for (int l = 0; l < LEVELS; l++)
			fprintf(md, " %.2g / %.2g |", median[m][l], worst[m][l]);
		fprintf(md, " %.2f |", log2(median[m][1] / median[m][4]) / 3);
		series[m] = (chart_series){summed_names[m], cells, median[m], LEVELS};
	}
	fprintf(md, "\n");
	char path[512];
	snprintf(path, sizeof path, "%s/convergence.svg", output);
	const chart c = {.title = "Convergence to the analytic dP/du", .subtitle = "median over five surfaces",
		.x_label = "cells along a side", .y_label = "degrees", .log_x = true, .log_y = true, .series = series,
		.series_count = SUMMED};
	if (!chart_write(path, &c))
		exit(2);
	printf("bench: convergence\n");
}

/* Thin bevels: how far the plane's tangents are tilted at the bevel's edge. */

enum { WIDTHS = 9, CELLS = 4, CELL_SIZES = 5 };

/* The tilt at a vertex of the edge, numbered from 0 to `cells`, of planes of size 1 in cells x cells quads. */
static double bevel_tilt(double width, uint32_t cells, uint32_t vertex, nmtan_method method)
{
	nt_owned mesh = bench_bevel(width, cells);
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
static void sweep_cells(FILE *csv, FILE *md)
{
	static const uint32_t cells[CELL_SIZES] = {1, 2, 4, 8, 16};
	static const char *const places[3] = {"first vertex", "in between", "last vertex"};
	const double width = 0.001;
	fprintf(md, "\n`area` at width %g, by the size of the cells: at the two ends of the edge, where one plane triangle "
		"meets two of the bevel or two meet one, and in between.\n\n| cells of |", width);
	for (int i = 0; i < CELL_SIZES; i++)
		fprintf(md, " %g |", 1.0 / cells[i]);
	fprintf(md, "\n|---|");
	for (int i = 0; i < CELL_SIZES; i++)
		fprintf(md, "---|");
	for (int place = 0; place < 3; place++) {
		fprintf(md, "\n| %s |", places[place]);
		for (int i = 0; i < CELL_SIZES; i++) {
			const uint32_t vertex = place == 0 ? 0 : place == 1 ? cells[i] / 2 : cells[i];
			if (place == 1 && cells[i] == 1) {
				fprintf(md, " - |");
				continue;
			}
			const double tilt = bevel_tilt(width, cells[i], vertex, NMTAN_METHOD_AREA);
			fprintf(md, " %.3g |", tilt);
			fprintf(csv, "%g,%g,area at the %s,%.5g\n", 1.0 / cells[i], width, places[place], tilt);
		}
	}
	fprintf(md, "\n");
}

void sweep_bevels(const char *output, FILE *md)
{
	static const double widths[WIDTHS] = {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1};
	double tilt[SUMMED][WIDTHS];
	FILE *csv = measure_open(output, "bevel.csv", "w");
	fprintf(csv, "cell,width,method,tilt_degrees\n");
	fprintf(md, "\n## Thin bevels\n\nTilt in degrees of the tangents of a plane beside a bevel of the given width whose "
		"texture is sheared by 4/3; cells of %g, vertices away from the ends of the edge.\n\n| width |", 1.0 / CELLS);
	for (int w = 0; w < WIDTHS; w++)
		fprintf(md, " %g |", widths[w]);
	fprintf(md, "\n|---|");
	for (int w = 0; w < WIDTHS; w++)
		fprintf(md, "---|");
	chart_series series[SUMMED];
	for (int m = 0; m < SUMMED; m++) {
		fprintf(md, "\n| %s |", summed_names[m]);
		for (int w = 0; w < WIDTHS; w++) {
			tilt[m][w] = bevel_tilt(widths[w], CELLS, CELLS / 2, summed_methods[m]);
			fprintf(md, " %.3g |", tilt[m][w]);
			fprintf(csv, "%g,%g,%s,%.5g\n", 1.0 / CELLS, widths[w], summed_names[m], tilt[m][w]);
		}
		series[m] = (chart_series){summed_names[m], widths, tilt[m], WIDTHS};
	}
	fprintf(md, "\n");
	sweep_cells(csv, md);
	fclose(csv);
	char path[512];
	snprintf(path, sizeof path, "%s/bevel.svg", output);
	const chart c = {.title = "Thin bevels tilt the plane beside them",
		.subtitle = "angle between the plane's tangent at the bevel's edge and its dP/du",
		.x_label = "width of the bevel (cells are 0.25)", .y_label = "degrees", .log_x = true, .log_y = true,
		.series = series, .series_count = SUMMED};
	if (!chart_write(path, &c))
		exit(2);
}
