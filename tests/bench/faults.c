/* SPDX-License-Identifier: MIT */
/* See faults.h. */
#include "faults.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "extremes.h"
#include "oracle128.h"

enum { MOST_CORNERS = 30000, LEVEL_STEP = 3 };

/* The same mesh with its texture mirrored. */
static nt_owned make_twin(const family *f, double level, uint64_t seed)
{
	nt_owned mesh = f->make(level, seed);
	for (size_t v = 0; v < mesh.mesh.vertex_count; v++)
		mesh.texcoords[v][0] = -mesh.texcoords[v][0];
	return mesh;
}

/* Real models stand elsewhere; what is denormal or not finite no tool promises to read. */
static bool is_left_out(const family *f)
{
	static const char *const names[] = {"public models", "denormal uvs", "denormal positions", "not finite"};
	bool out = false;
	for (size_t i = 0; i < sizeof names / sizeof *names; i++)
		out = out || strcmp(f->name, names[i]) == 0;
	return out;
}

size_t nasty_make(nt_owned *meshes)
{
	size_t n = 0;
	for (const family *f = families; f < families + family_count; f++) {
		if (is_left_out(f))
			continue;
		for (size_t l = 1; l < f->level_count && n + 2 <= NASTY_MOST; l += LEVEL_STEP) {
			meshes[n] = f->make(f->levels[l], l);
			if (meshes[n].face_sizes || meshes[n].corner_count > MOST_CORNERS) {
				nt_owned_free(&meshes[n]);
				continue;
			}
			meshes[n + 1] = make_twin(f, f->levels[l], l);
			n += 2;
		}
	}
	return n;
}

static double dot(const float *a, const float *b)
{
	return (double)a[0] * b[0] + (double)a[1] * b[1] + (double)a[2] * b[2];
}

void faults_add(const nt_owned *mesh, const float (*tangents)[4], faults *sum)
{
	sum->corners += mesh->corner_count;
	for (size_t c = 0; c < mesh->corner_count; c++) {
		const float *t = tangents[c], *n = mesh->normals[mesh->indices[c]];
		const double square = dot(t, t), normal = dot(n, n);
		sum->zero += !(fabs(sqrt(square) - 1) <= 2e-6);
		sum->leaning += normal > 0 && !(fabs(dot(t, n)) / sqrt(square * normal) <= (1 + 1.0 / 1024) / 1024);
	}
	for (size_t c = 0; c < mesh->corner_count; c += 3) {
		const uint32_t *v = mesh->indices + c;
		const int sign = oracle_sign(mesh->texcoords[v[0]], mesh->texcoords[v[1]], mesh->texcoords[v[2]]);
		const float w = tangents[c][3];
		sum->wrong += w != tangents[c + 1][3] || w != tangents[c + 2][3] || (sign != 0 && w != (float)sign);
	}
}

bool faults_add_files(const char *const *files, size_t count, faults *sum)
{
	char command[32768];
	size_t length = (size_t)snprintf(command, sizeof command, "node tests/support/answer.mjs frames");
	for (size_t i = 0; i < count && length < sizeof command; i++)
		length += (size_t)snprintf(command + length, sizeof command - length, " '%s'", files[i]);
	FILE *f = length < sizeof command ? popen(command, "r") : NULL;
	size_t corners, leaning, unit, w, mixed, wrong;
	while (f && fscanf(f, " corners %zu degree %*u lean %zu unit %zu w %zu mixed %zu wrong %zu", &corners,
		&leaning, &unit,
				&w, &mixed, &wrong) == 6) {
		sum->corners += corners;
		sum->wrong += mixed + wrong;
		sum->zero += unit;
		sum->leaning += leaning;
	}
	return f && pclose(f) == 0;
}
