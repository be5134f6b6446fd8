/* SPDX-License-Identifier: MIT */
/*
 * Some triangles of a mesh, each by itself, with the library's answers: for a judge who computes in
 * fractions (check_fractions.py).
 */
#ifndef NT_STRESS_SAMPLE_H
#define NT_STRESS_SAMPLE_H

#include <stdio.h>
#include "surfaces.h"

/* One line for each of at most 40 triangles: 24 hexadecimal floats (three times position, normal, uv), the
 * sign of nmtan_orientation(), the three tangents of --method=robust. Quads are left out. */
void sample_triangles(const nt_owned *mesh, FILE *to);

#endif
