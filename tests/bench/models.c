/* SPDX-License-Identifier: MIT */
/* See models.h. */
#include "models.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "measure.h"

/* PLY */

enum { MOST_PROPERTIES = 32 };

/* Vertices of float properties, a face of one list "uchar int". */
typedef struct ply {
	size_t vertex_count, face_count, property_count;
	char properties[MOST_PROPERTIES][32];
	float *rows; /* [vertex_count][property_count] */
} ply;

static void fail(const char *path)
{
	fprintf(stderr, "bench: %s is no PLY that nmtan wrote\n", path);
	exit(3);
}

static ply read_header(FILE *f, const char *path)
{
	ply p = {0};
	char line[256], name[32];
	bool binary = false;
	while (fgets(line, sizeof line, f) && strcmp(line, "end_header\n") != 0) {
		binary = binary || strcmp(line, "format binary_little_endian 1.0\n") == 0;
		if (sscanf(line, "element vertex %zu", &p.vertex_count) == 1 ||
			sscanf(line, "element face %zu", &p.face_count) == 1)
			continue;
		if (sscanf(line, "property float %31s", name) == 1 && p.property_count < MOST_PROPERTIES)
			strcpy(p.properties[p.property_count++], name);
		else if (strncmp(line, "property uchar", 14) == 0) /* colours */
			fail(path);
	}
	if (!binary || p.vertex_count == 0)
		fail(path);
	return p;
}

/* Copies `width` properties from the one of that name on; false: there is none. */
static bool pick(const ply *p, const char *name, size_t width, float *to)
{
	size_t at = 0;
	while (at < p->property_count && strcmp(p->properties[at], name) != 0)
		at++;
	if (at + width > p->property_count)
		return false;
	for (size_t v = 0; v < p->vertex_count; v++)
		memcpy(to + width * v, p->rows + p->property_count * v + at, width * sizeof *to);
	return true;
}

static uint32_t *read_faces(FILE *f, const ply *p, const char *path, size_t *corner_count)
{
	uint32_t *indices = measure_room(6 * p->face_count, sizeof *indices), *to = indices;
	for (size_t i = 0; i < p->face_count; i++) {
		const int size = fgetc(f);
		uint32_t v[4];
		if (size < 3 || size > 4 || fread(v, sizeof *v, (size_t)size, f) != (size_t)size)
			fail(path);
		for (int k = 0; k < size; k++)
			if (v[k] >= p->vertex_count)
				fail(path);
		for (int k = 2; k < size; k++, to += 3)
			memcpy(to, (uint32_t[3]){v[0], v[k - 1], v[k]}, 3 * sizeof *to);
	}
	*corner_count = (size_t)(to - indices);
	return indices;
}

/* Normals by area, around vertices of one position each as the file has them. */
static void make_normals(nt_owned *o)
{
	double (*sums)[3] = measure_room(o->mesh.vertex_count, sizeof *sums);
	for (size_t c = 0; c < o->corner_count; c += 3) {
		const float *p[3];
		for (size_t k = 0; k < 3; k++)
			p[k] = o->positions[o->indices[c + k]];
		for (int i = 0; i < 3; i++) {
			const int x = (i + 1) % 3, y = (i + 2) % 3;
			const double n = ((double)p[1][x] - p[0][x]) * ((double)p[2][y] - p[0][y]) -
					 ((double)p[1][y] - p[0][y]) * ((double)p[2][x] - p[0][x]);
			for (size_t k = 0; k < 3; k++)
				sums[o->indices[c + k]][i] += n;
		}
	}
	for (size_t v = 0; v < o->mesh.vertex_count; v++) {
		const double length = sqrt(sums[v][0] * sums[v][0] + sums[v][1] * sums[v][1] + sums[v][2] * sums[v][2]);
		for (int i = 0; i < 3; i++)
			o->normals[v][i] = (float)(length > 0 ? sums[v][i] / length : i == 2);
	}
	free(sums);
}

/* Normals of unit length, as bakers have them; zero ones stay. */
static void make_unit(nt_owned *o)
{
	for (size_t v = 0; v < o->mesh.vertex_count; v++) {
		float *n = o->normals[v];
		const double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
		for (int i = 0; i < 3 && length > 0; i++)
			n[i] = (float)(n[i] / length);
	}
}

static double bounds(const nt_owned *o, float low[3])
{
	double size = 0;
	for (int i = 0; i < 3; i++) {
		float high = low[i] = o->positions[0][i];
		for (size_t v = 1; v < o->mesh.vertex_count; v++) {
			low[i] = fminf(low[i], o->positions[v][i]);
			high = fmaxf(high, o->positions[v][i]);
		}
		size = fmax(size, (double)high - low[i]);
	}
	return size;
}

static void project(nt_owned *o)
{
	float low[3];
	const double size = bounds(o, low);
	for (size_t v = 0; v < o->mesh.vertex_count; v++)
		for (int i = 0; i < 2; i++)
			o->texcoords[v][i] = (float)(((double)o->positions[v][i] - low[i]) / (size > 0 ? size : 1));
}

nt_owned model_read_ply(const char *path, float (**tangents)[4])
{
	FILE *f = fopen(path, "rb");
	if (!f)
		fail(path);
	ply p = read_header(f, path);
	p.rows = measure_room(p.vertex_count * p.property_count, sizeof *p.rows);
	if (fread(p.rows, sizeof *p.rows * p.property_count, p.vertex_count, f) != p.vertex_count)
		fail(path);
	size_t corner_count;
	uint32_t *indices = read_faces(f, &p, path, &corner_count);
	fclose(f);
	nt_owned o = nt_owned_make(p.vertex_count, corner_count / 3);
	memcpy(o.indices, indices, corner_count * sizeof *indices);
	free(indices);
	if (!pick(&p, "x", 3, &o.positions[0][0]))
		fail(path);
	if (!pick(&p, "nx", 3, &o.normals[0][0]))
		make_normals(&o);
	if (!pick(&p, "s", 2, &o.texcoords[0][0]))
		project(&o);
	float (*rows)[4] = measure_room(p.vertex_count, sizeof *rows);
	if (!pick(&p, "tx", 4, &rows[0][0])) {
		free(rows);
		rows = NULL;
	}
	free(p.rows);
	if (tangents)
		*tangents = rows;
	else
		free(rows);
	return o;
}

/* Stand-ins */

/* A lumpy ball of about that many triangles. Texture coordinates are those of the ball or, `planar`, the projection to
 * x and y. */
static nt_owned stand_in(size_t triangles, bool planar)
{
	const uint32_t side = (uint32_t)sqrt((double)triangles / 2);
	nt_owned o = nt_surface_grid(NT_SPHERE, side, side, 0.4, 7);
	nt_random random = nt_random_seed(triangles);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		const float *p = o.positions[v];
		const float lump = 1 + 0.1f * sinf(7 * p[0] + 3 * p[2]) + 0.003f * (float)nt_random_real(&random);
		for (int i = 0; i < 3; i++)
			o.positions[v][i] *= lump;
	}
	make_normals(&o);
	if (planar)
		project(&o);
	return o;
}

size_t models_make(char *const *files, size_t count, model *models)
{
	size_t n = 0;
	for (; n < count && n < MODEL_MOST; n++) {
		const char *slash = strrchr(files[n], '/');
		snprintf(models[n].name, sizeof models[n].name, "%s", slash ? slash + 1 : files[n]);
		char *dot = strrchr(models[n].name, '.');
		if (dot)
			*dot = 0;
		models[n].mesh = model_read_ply(files[n], NULL);
	}
	if (n == 0) {
		static const struct {
			const char *name;
			size_t triangles;
			bool planar;
		} stand_ins[] = {{"stand-in 15 k", 15000, false}, {"stand-in 100 k, planar UVs", 100000, true},
			{"stand-in 120 k", 120000, false}};
		for (; n < sizeof stand_ins / sizeof *stand_ins; n++) {
			snprintf(models[n].name, sizeof models[n].name, "%s", stand_ins[n].name);
			models[n].mesh = stand_in(stand_ins[n].triangles, stand_ins[n].planar);
		}
	}
	for (size_t i = 0; i < n; i++) {
		float low[3];
		models[i].size = bounds(&models[i].mesh, low);
		make_unit(&models[i].mesh);
	}
	return n;
}

void models_free(model *models, size_t count)
{
	for (size_t i = 0; i < count; i++)
		nt_owned_free(&models[i].mesh);
}
