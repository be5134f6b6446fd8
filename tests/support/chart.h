/* SPDX-License-Identifier: MIT */
/*
 * Charts as small SVG files: lines or points over linear or logarithmic axes.
 */
#ifndef NT_CHART_H
#define NT_CHART_H

#include <stdbool.h>
#include <stddef.h>

typedef struct chart_series {
	const char *name;
	const double *x, *y; /* [count]; a value that is not finite, or not positive on a logarithmic axis,
	                        leaves a gap */
	size_t count;
} chart_series;

typedef struct chart {
	const char *title, *subtitle, *x_label, *y_label;
	bool log_x, log_y;
	bool points;              /* no lines; each series is a group of marks */
	const char *const *marks; /* for points: what each one of a series is, [count]; may be NULL */
	const chart_series *series;
	size_t series_count;
} chart;

/* False where the file cannot be written. */
bool chart_write(const char *path, const chart *c);

#endif
