/* SPDX-License-Identifier: MIT */
/*
 * The parts of make bench that go over a range of meshes of one kind, each a table in Markdown and CSV and a
 * chart: how fast methods converge to the analytic dP/du, and how far thin bevels tilt the plane beside them.
 */
#ifndef NT_ERROR_SWEEPS_H
#define NT_ERROR_SWEEPS_H

#include <stdio.h>

/* Both write to files in the folder `output` and to md. */
void sweep_convergence(const char *output, FILE *md);
void sweep_bevels(const char *output, FILE *md);

#endif
