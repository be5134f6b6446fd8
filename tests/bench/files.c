/* SPDX-License-Identifier: MIT */
/* See files.h. */
#include "files.h"

#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "measure.h"
#include "models.h"

extern char **environ;

enum { GLB_MAGIC = 0x46546c67 };

shading shading_make(const nt_owned *mesh)
{
	return (shading){measure_room(mesh->corner_count, 16), measure_room(mesh->corner_count, 12),
		measure_room(mesh->mesh.face_count, sizeof(bool)), 0};
}

void shading_free(shading *s)
{
	free(s->tangents);
	free(s->normals);
	free(s->there);
	*s = (shading){0};
}

static FILE *create(const char *path)
{
	FILE *f = fopen(path, "wb");
	if (!f) {
		fprintf(stderr, "bench: cannot write %s\n", path);
		exit(2);
	}
	return f;
}

static void finish(FILE *f, const char *path)
{
	const bool failed = ferror(f);
	if (fclose(f) || failed) {
		fprintf(stderr, "bench: cannot write %s\n", path);
		exit(2);
	}
}

void files_write_mesh(const char *path, const nt_owned *mesh)
{
	FILE *f = create(path);
	const uint32_t head[2] = {(uint32_t)mesh->mesh.vertex_count, (uint32_t)mesh->corner_count};
	fwrite(head, 4, 2, f);
	fwrite(mesh->positions, 12, head[0], f);
	fwrite(mesh->normals, 12, head[0], f);
	fwrite(mesh->texcoords, 8, head[0], f);
	fwrite(mesh->indices, 4, head[1], f);
	finish(f, path);
}

/* The document of a mesh; positions need their bounds. */
static int print_document(const nt_owned *mesh, char *text, size_t size)
{
	float low[3], high[3];
	for (int i = 0; i < 3; i++) {
		low[i] = high[i] = mesh->positions[0][i];
		for (size_t v = 1; v < mesh->mesh.vertex_count; v++) {
			low[i] = fminf(low[i], mesh->positions[v][i]);
			high[i] = fmaxf(high[i], mesh->positions[v][i]);
		}
	}
	const size_t n = mesh->mesh.vertex_count, corners = mesh->corner_count;
	return snprintf(text, size,
		"{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
		"\"images\":[{\"uri\":\"data:image/png;base64,"
		"iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==\"}],"
		"\"textures\":[{\"source\":0}],\"materials\":[{\"normalTexture\":{\"index\":0}}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
		"\"indices\":3,\"material\":0}]}],\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,"
		"\"byteLength\":%zu,\"target\":34962},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,"
		"\"target\":34962},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34962},"
		"{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34963}],"
		"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\","
		"\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},{\"bufferView\":1,\"componentType\":5126,"
		"\"count\":%zu,\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5126,\"count\":%zu,"
		"\"type\":\"VEC2\"},{\"bufferView\":3,\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"}]}",
		32 * n + 4 * corners, 12 * n, 12 * n, 12 * n, 24 * n, 8 * n, 32 * n, 4 * corners, n, (double)low[0],
		(double)low[1], (double)low[2], (double)high[0], (double)high[1], (double)high[2], n, n, corners);
}

void files_write_glb(const char *path, const nt_owned *mesh)
{
	char text[4096];
	const uint32_t length = (uint32_t)print_document(mesh, text, sizeof text), padded = (length + 3) & ~3u;
	memset(text + length, ' ', padded - length);
	const size_t n = mesh->mesh.vertex_count;
	const uint32_t bytes = (uint32_t)(32 * n + 4 * mesh->corner_count);
	FILE *f = create(path);
	fwrite((uint32_t[5]){GLB_MAGIC, 2, 28 + padded + bytes, padded, 0x4e4f534a}, 4, 5, f);
	fwrite(text, 1, padded, f);
	fwrite((uint32_t[2]){bytes, 0x004e4942}, 4, 2, f);
	fwrite(mesh->positions, 12, n, f);
	fwrite(mesh->normals, 12, n, f);
	for (size_t v = 0; v < n; v++)
		fwrite((float[2]){mesh->texcoords[v][0], -mesh->texcoords[v][1]}, 8, 1, f);
	fwrite(mesh->indices, 4, mesh->corner_count, f);
	finish(f, path);
}

double files_run(const char *const *arguments)
{
	posix_spawn_file_actions_t actions;
	posix_spawn_file_actions_init(&actions);
	posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
	posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
	pid_t child;
	const double start = measure_seconds();
	int status = 0;
	const bool ran = posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ) == 0 &&
			 waitpid(child, &status, 0) == child;
	posix_spawn_file_actions_destroy(&actions);
	return ran && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? measure_seconds() - start : -1;
}

/* Triangles by their positions */

/* A tool's result, with a table of its triangles by the cell of a grid that has their middle. */
typedef struct result {
	nt_owned mesh;
	float (*tangents)[4];
	double cell;            /* its side */
	uint32_t *first, *next; /* triangle + 1; 0 ends a chain */
	size_t mask;
} result;

static const float *corner_position(const nt_owned *mesh, size_t corner)
{
	return mesh->positions[mesh->indices[corner]];
}

static void find_cell(const nt_owned *mesh, size_t triangle, double side, int64_t cell[3])
{
	for (int i = 0; i < 3; i++) {
		double sum = 0;
		for (size_t k = 0; k < 3; k++)
			sum += corner_position(mesh, 3 * triangle + k)[i];
		cell[i] = (int64_t)floor(sum / 3 / side);
	}
}

static size_t hash_cell(const int64_t cell[3], size_t mask)
{
	uint64_t h = 0;
	for (int i = 0; i < 3; i++)
		h = (h ^ (uint64_t)cell[i]) * 0x9e3779b97f4a7c15u;
	return (size_t)(h >> 24) & mask;
}

static void make_table(result *r)
{
	size_t size = 1024;
	while (size < 2 * r->mesh.mesh.face_count)
		size *= 2;
	r->mask = size - 1;
	r->first = measure_room(size, sizeof *r->first);
	r->next = measure_room(r->mesh.mesh.face_count, sizeof *r->next);
	for (size_t t = 0; t < r->mesh.mesh.face_count; t++) {
		int64_t cell[3];
		find_cell(&r->mesh, t, r->cell, cell);
		uint32_t *at = &r->first[hash_cell(cell, r->mask)];
		r->next[t] = *at;
		*at = (uint32_t)t + 1;
	}
}

/* How far corner k of a triangle is from corner (k + turn) of another, at most, along an axis. */
static double triangle_distance(const nt_owned *mesh, size_t triangle, const nt_owned *other_mesh, size_t other,
	size_t turn)
{
	double most = 0;
	for (size_t k = 0; k < 3; k++) {
		const float *a = corner_position(mesh, 3 * triangle + k);
		const float *b = corner_position(other_mesh, 3 * other + (k + turn) % 3);
		for (int i = 0; i < 3; i++)
			most = fmax(most, fabs((double)a[i] - b[i]));
	}
	return most;
}

/* The nearest triangle of the result, turned as it has to be; false: none is nearer than `most`, which is at most a
 * cell. */
static bool find_triangle(const nt_owned *mesh, size_t triangle, const result *r, double most, size_t *found,
	size_t *turn)
{
	int64_t middle[3];
	find_cell(mesh, triangle, r->cell, middle);
	double nearest = INFINITY;
	for (int n = 0; n < 27; n++) {
		const int64_t cell[3] = {middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1};
		for (uint32_t at = r->first[hash_cell(cell, r->mask)]; at; at = r->next[at - 1]) {
			for (size_t k = 0; k < 3; k++) {
				const double distance = triangle_distance(mesh, triangle, &r->mesh, at - 1, k);
				if (distance < nearest) {
					nearest = distance;
					*found = at - 1;
					*turn = k;
				}
			}
		}
	}
	return nearest <= most;
}

static bool in_order(const nt_owned *mesh, const nt_owned *other, double most)
{
	bool same = mesh->corner_count == other->corner_count;
	for (size_t t = 0; same && t < mesh->mesh.face_count; t++)
		same = triangle_distance(mesh, t, other, t, 0) <= most;
	return same;
}

static void take(const nt_owned *mesh, result *r, double most, shading *to)
{
	const bool ordered = in_order(mesh, &r->mesh, most);
	if (!ordered)
		make_table(r);
	to->missing = 0;
	for (size_t t = 0; t < mesh->mesh.face_count; t++) {
		size_t found = t, turn = 0;
		to->there[t] = ordered || find_triangle(mesh, t, r, most, &found, &turn);
		to->missing += !to->there[t];
		for (size_t k = 0; k < 3 && to->there[t]; k++) {
			const uint32_t v = r->mesh.indices[3 * found + (k + turn) % 3];
			memcpy(to->tangents[3 * t + k], r->tangents[v], 16);
			memcpy(to->normals[3 * t + k], r->mesh.normals[v], 12);
		}
	}
}

/* Whether the document of a GLB speaks of tangents. Files that nmtan reads must have them: it would make them, and a
 * tool that did nothing would be given nmtan's own. */
static bool has_tangents(const char *glb)
{
	uint32_t head[5] = {0};
	FILE *f = fopen(glb, "rb");
	if (!f || fread(head, 4, 5, f) != 5 || head[0] != (uint32_t)GLB_MAGIC) {
		if (f)
			fclose(f);
		return false;
	}
	char *document = measure_room((size_t)head[3] + 1, 1);
	const bool found = fread(document, 1, head[3], f) == head[3] && strstr(document, "\"TANGENT\"");
	free(document);
	fclose(f);
	return found;
}

bool files_read_shading(const char *nmtan, const char *glb, const nt_owned *mesh, double size, shading *to)
{
	char ply[512];
	snprintf(ply, sizeof ply, "%s.ply", glb);
	if (!has_tangents(glb) ||
		files_run((const char *const[]){nmtan, "--existing=keep", "--only=needed", glb, ply, NULL}) < 0)
		return false;
	result r = {.cell = size / 2048};
	r.mesh = model_read_ply(ply, &r.tangents);
	remove(ply);
	const bool has = r.tangents != NULL;
	if (has)
		take(mesh, &r, size / 4096, to);
	nt_owned_free(&r.mesh);
	free(r.tangents);
	free(r.first);
	free(r.next);
	return has;
}
