/* SPDX-License-Identifier: MIT */
/* See soup.h. Small meshes: nothing here is fast. */
#include "soup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void *zeroed(size_t count, size_t size)
{
	void *block = calloc(count ? count : 1, size);
	if (!block)
		abort();
	return block;
}

soup soup_make(size_t face_count, size_t corner_count)
{
	return (soup){face_count, corner_count, zeroed(face_count, 1),
		zeroed(corner_count, 3 * sizeof(float)), zeroed(corner_count, 3 * sizeof(float)),
		zeroed(corner_count, 2 * sizeof(float))};
}

void soup_free(soup *s)
{
	free(s->sizes);
	free(s->positions);
	free(s->normals);
	free(s->texcoords);
	*s = (soup){0};
}

static void copy_corner(soup *to, size_t at, const soup *from, size_t corner)
{
	memcpy(to->positions[at], from->positions[corner], sizeof *to->positions);
	memcpy(to->normals[at], from->normals[corner], sizeof *to->normals);
	memcpy(to->texcoords[at], from->texcoords[corner], sizeof *to->texcoords);
}

soup soup_select(const soup *s, const bool *keep)
{
	soup r = soup_make(s->face_count, s->corner_count);
	r.face_count = r.corner_count = 0;
	for (size_t f = 0, first = 0; f < s->face_count; first += s->sizes[f++]) {
		if (!keep[f])
			continue;
		r.sizes[r.face_count++] = s->sizes[f];
		for (size_t k = 0; k < s->sizes[f]; k++)
			copy_corner(&r, r.corner_count++, s, first + k);
	}
	return r;
}

soup soup_copy(const soup *from)
{
	bool *all = zeroed(from->face_count, 1);
	memset(all, 1, from->face_count);
	const soup r = soup_select(from, all);
	free(all);
	return r;
}

soup soup_from_mesh(const nmtan_mesh *mesh, size_t most_faces)
{
	const size_t faces = mesh->face_count < most_faces ? mesh->face_count : most_faces;
	soup s = soup_make(faces, 4 * faces);
	size_t c = 0;
	for (size_t f = 0; f < faces; f++) {
		s.sizes[f] = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		for (size_t k = 0; k < s.sizes[f]; k++, c++) {
			const size_t v = mesh->indices ? mesh->indices[c] : c;
			memcpy(s.positions[c], mesh->positions + 3 * v, sizeof *s.positions);
			memcpy(s.normals[c], mesh->normals + 3 * v, sizeof *s.normals);
			memcpy(s.texcoords[c], mesh->texcoords + 2 * v, sizeof *s.texcoords);
		}
	}
	s.corner_count = c;
	return s;
}

nmtan_mesh soup_mesh(const soup *s)
{
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = s->face_count,
		.vertex_count = s->corner_count,
		.face_sizes = s->sizes, .positions = &s->positions[0][0], .normals = &s->normals[0][0],
		.texcoords = &s->texcoords[0][0]};
}

soup soup_random(uint64_t seed)
{
	enum { POINTS = 14, NORMALS = 3, FACES = 40 };
	nt_random random = nt_random_seed(seed);
	float points[POINTS][3], normals[NORMALS][3], texcoords[POINTS][2];
	for (int i = 0; i < POINTS; i++)
		for (int k = 0; k < 3; k++)
			points[i][k] = (float)(nt_random_real(&random) * 2 - 1);
	for (int i = 0; i < NORMALS; i++) {
		const double a = nt_random_real(&random) * 6.283, z = nt_random_real(&random);
		const double r = sqrt(1 - z * z);
		memcpy(normals[i], (float[3]){(float)(r * cos(a)), (float)(r * sin(a)), (float)z}, 12);
	}
	for (int i = 0; i < POINTS; i++)
		for (int k = 0; k < 2; k++)
			texcoords[i][k] = (float)nt_random_real(&random);
	soup s = soup_make(FACES, 4 * FACES);
	size_t c = 0;
	for (size_t f = 0; f < FACES; f++) {
		s.sizes[f] = nt_random_below(&random, 3) ? 3 : 4;
		const bool no_uv = nt_random_below(&random, 8) == 0;
		for (size_t k = 0; k < s.sizes[f]; k++, c++) {
			const uint32_t p = nt_random_below(&random, POINTS);
			memcpy(s.positions[c], points[p], sizeof *s.positions);
			memcpy(s.normals[c], normals[p % NORMALS], sizeof *s.normals);
			memcpy(s.texcoords[c], texcoords[no_uv ? 0 : p], sizeof *s.texcoords);
		}
	}
	s.corner_count = c;
	return s;
}

/* OBJ */

typedef struct float_list {
	float (*rows)[3];
	size_t count, capacity;
} float_list;

static void append(float_list *list, const char *text)
{
	if (list->count == list->capacity) {
		list->capacity = list->capacity ? 2 * list->capacity : 256;
		list->rows = realloc(list->rows, list->capacity * sizeof *list->rows);
		if (!list->rows)
			abort();
	}
	char *end = (char *)(uintptr_t)text;
	for (int k = 0; k < 3; k++)
		list->rows[list->count][k] = strtof(end, &end);
	list->count++;
}

/* A one-based or negative index; false where there is no such row. */
static bool pick(const float_list *list, long index, float *to, size_t floats)
{
	const long at = index < 0 ? (long)list->count + index : index - 1;
	if (index == 0 || at < 0 || (size_t)at >= list->count)
		return false;
	memcpy(to, list->rows[at], floats * sizeof(float));
	return true;
}

static void set_flat_normal(soup *s, size_t first)
{
	double e[3], f[3], n[3], length = 0;
	for (int i = 0; i < 3; i++) {
		e[i] = (double)s->positions[first + 1][i] - s->positions[first][i];
		f[i] = (double)s->positions[first + 2][i] - s->positions[first][i];
	}
	for (int i = 0; i < 3; i++) {
		n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
		length += n[i] * n[i];
	}
	for (size_t k = 0; k < s->sizes[s->face_count]; k++)
		for (int i = 0; i < 3; i++)
			s->normals[first + k][i] = (float)(length > 0 ? n[i] / sqrt(length) : i == 2);
}

/* One face; left out where it is no triangle or quad or lacks texture coordinates. */
static void read_face(soup *s, const char *text, const float_list lists[3])
{
	const size_t first = s->corner_count;
	size_t size = 0;
	bool sound = true, has_normals = true;
	while (sound) {
		char *end;
		const long v = strtol(text, &end, 10);
		if (end == text)
			break;
		long t = 0, n = 0;
		if (*end == '/')
			t = strtol(end + 1, &end, 10);
		if (*end == '/')
			n = strtol(end + 1, &end, 10);
		text = end;
		sound = size < 4 && pick(&lists[0], v, s->positions[first + size], 3) &&
			pick(&lists[1], t, s->texcoords[first + size], 2);
		has_normals = sound && has_normals && pick(&lists[2], n, s->normals[first + size], 3);
		size++;
	}
	if (!sound || size < 3)
		return;
	s->sizes[s->face_count] = (uint8_t)size;
	if (!has_normals)
		set_flat_normal(s, first);
	s->face_count++;
	s->corner_count += size;
}

soup soup_read_obj(const char *path, size_t most_faces)
{
	soup s = soup_make(most_faces, 4 * most_faces + 4);
	s.face_count = s.corner_count = 0;
	float_list lists[3] = {{0}, {0}, {0}};
	FILE *f = fopen(path, "r");
	char line[1024];
	while (f && s.face_count < most_faces && fgets(line, sizeof line, f)) {
		if (line[0] == 'v' && line[1] == ' ')
			append(&lists[0], line + 2);
		else if (line[0] == 'v' && line[1] == 't')
			append(&lists[1], line + 3);
		else if (line[0] == 'v' && line[1] == 'n')
			append(&lists[2], line + 3);
		else if (line[0] == 'f' && line[1] == ' ')
			read_face(&s, line + 2, lists);
	}
	if (f)
		fclose(f);
	for (int i = 0; i < 3; i++)
		free(lists[i].rows);
	return s;
}

void soup_write_obj(const soup *s, FILE *to, const char *comment)
{
	fprintf(to, "# %s\n", comment);
	for (size_t c = 0; c < s->corner_count; c++) {
		const float *p = s->positions[c], *n = s->normals[c], *t = s->texcoords[c];
		fprintf(to, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\nvt %.9g %.9g\n", (double)p[0], (double)p[1],
			(double)p[2], (double)n[0], (double)n[1], (double)n[2], (double)t[0], (double)t[1]);
	}
	for (size_t f = 0, c = 1; f < s->face_count; f++) {
		fprintf(to, "f");
		for (size_t k = 0; k < s->sizes[f]; k++, c++)
			fprintf(to, " %zu/%zu/%zu", c, c, c);
		fprintf(to, "\n");
	}
}

/* Indexed */

static bool equal_corners(const soup *s, size_t a, size_t b)
{
	return memcmp(s->positions[a], s->positions[b], 12) == 0 &&
	       memcmp(s->normals[a], s->normals[b], 12) == 0 &&
	       memcmp(s->texcoords[a], s->texcoords[b], 8) == 0;
}

soup_indexed soup_index(const soup *s)
{
	soup_indexed r = {.indices = zeroed(s->corner_count, sizeof(uint32_t)),
		.positions = zeroed(s->corner_count, 12), .normals = zeroed(s->corner_count, 12),
		.texcoords = zeroed(s->corner_count, 8)};
	size_t *first = zeroed(s->corner_count, sizeof *first), count = 0; /* corner of each vertex */
	for (size_t c = 0; c < s->corner_count; c++) {
		size_t v = 0;
		while (v < count && !equal_corners(s, c, first[v]))
			v++;
		if (v == count) {
			first[count++] = c;
			memcpy(r.positions[v], s->positions[c], 12);
			memcpy(r.normals[v], s->normals[c], 12);
			memcpy(r.texcoords[v], s->texcoords[c], 8);
		}
		r.indices[c] = (uint32_t)v;
	}
	free(first);
	r.mesh = (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = s->face_count,
		.face_sizes = s->sizes, .vertex_count = count,
		.indices = r.indices, .positions = &r.positions[0][0], .normals = &r.normals[0][0],
		.texcoords = &r.texcoords[0][0]};
	return r;
}

void soup_indexed_free(soup_indexed *indexed)
{
	free(indexed->indices);
	free(indexed->positions);
	free(indexed->normals);
	free(indexed->texcoords);
	*indexed = (soup_indexed){0};
}
