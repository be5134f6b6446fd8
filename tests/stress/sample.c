/* SPDX-License-Identifier: MIT */
/* See sample.h. */
#include "sample.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 40 };

static void print_floats(FILE *to, const float *values, size_t count)
{
	for (size_t i = 0; i < count; i++)
		fprintf(to, "%a ", (double)values[i]);
}

void sample_triangles(const nt_owned *mesh, FILE *to)
{
	if (mesh->face_sizes)
		return;
	const size_t step = mesh->mesh.face_count / SAMPLES + 1;
	for (size_t f = 0; f < mesh->mesh.face_count; f += step) {
		float p[3][3], n[3][3], t[3][2], tangents[3][4];
		for (size_t k = 0; k < 3; k++) {
			const uint32_t v = mesh->indices[3 * f + k];
			memcpy(p[k], mesh->positions[v], sizeof p[k]);
			memcpy(n[k], mesh->normals[v], sizeof n[k]);
			memcpy(t[k], mesh->texcoords[v], sizeof t[k]);
		}
		const nmtan_mesh one = {.struct_bytes = sizeof one, .face_count = 1, .vertex_count = 3,
			.positions = &p[0][0],
			.normals = &n[0][0], .texcoords = &t[0][0]};
		const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
		if (nmtan_tangents(&one, &options, &output, NULL))
			continue;
		for (int k = 0; k < 3; k++) {
			print_floats(to, p[k], 3);
			print_floats(to, n[k], 3);
			print_floats(to, t[k], 2);
		}
		fprintf(to, "%d ", nmtan_orientation(t[0], t[1], t[2]));
		print_floats(to, &tangents[0][0], 12);
		fprintf(to, "\n");
	}
}
