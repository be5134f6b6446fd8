/* SPDX-License-Identifier: MIT */
/* See models.h. */
#include "models.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "measure.h"
#include "ply/ply.h"

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
	FILE *file = fopen(path, "rb");
	struct stat info = {0};
	if (!file || fstat(fileno(file), &info) != 0)
		info.st_size = 0;
	unsigned char *bytes = measure_room((size_t)info.st_size, 1);
	nt_scene scene;
	nt_error error;
	nt_scene_init(&scene, path);
	scene.bytes = bytes;
	scene.byte_count = file ? fread(bytes, 1, (size_t)info.st_size, file) : 0;
	if (file)
		fclose(file);
	nt_error_clear(&error);
	const nt_read_options options = {.texcoord_set = -1, .threads = 1};
	if (nt_ply_open(&scene, &options, &error) || scene.mesh_count != 1) {
		fprintf(stderr, "bench: %s is no PLY that nmtan wrote\n", path);
		exit(3);
	}
	const nt_mesh *mesh = scene.meshes;
	nt_owned o = nt_owned_make(mesh->vertex_count, nt_mesh_triangle_count(mesh));
	uint32_t *to = o.indices;
	const uint32_t *face = mesh->indices;
	for (size_t f = 0; f < mesh->face_count; f++) {
		const size_t corners = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		for (size_t k = 2; k < corners; k++, to += 3)
			memcpy(to, (uint32_t[3]){face[0], face[k - 1], face[k]}, 3 * sizeof *to);
		face += corners;
	}
	memcpy(o.positions, mesh->positions, mesh->vertex_count * sizeof *o.positions);
	if (mesh->normals)
		memcpy(o.normals, mesh->normals, mesh->vertex_count * sizeof *o.normals);
	else
		make_normals(&o);
	if (mesh->texcoords)
		memcpy(o.texcoords, mesh->texcoords, mesh->vertex_count * sizeof *o.texcoords);
	else
		project(&o);
	if (tangents) {
		*tangents = mesh->tangents ? measure_room(mesh->vertex_count, sizeof **tangents) : NULL;
		if (mesh->tangents)
			memcpy(*tangents, mesh->tangents, mesh->vertex_count * sizeof **tangents);
	}
	nt_scene_free(&scene);
	free(bytes);
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
