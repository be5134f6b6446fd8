/* SPDX-License-Identifier: MIT */
/*
 * Where a face stands in an OBJ file: the scene keeps no line numbers, since hardly anybody needs them.
 * The few faces that the report shows are looked up by counting `f` statements through the text again.
 *
 * Meshes follow each other in the file, so the number of a face in the file is its number in the mesh
 * plus the polygons of the meshes before.
 */
#include "report/judge.h"

#include <stdlib.h>
#include <string.h>

typedef struct wanted {
	size_t polygon; /* in the file */
	nt_spot *spot;
} wanted;

static size_t polygon_count(const nt_mesh *mesh)
{
	if (!mesh->face_polygon || mesh->face_count == 0)
		return mesh->face_count;
	return (size_t)mesh->face_polygon[mesh->face_count - 1] + 1;
}

static int by_polygon(const void *a, const void *b)
{
	const wanted *x = a, *y = b;
	return x->polygon < y->polygon ? -1 : x->polygon > y->polygon;
}

/* The faces to look for, ascending; NULL when memory is exhausted. */
static wanted *list_wanted(nt_report *report, const nt_scene *scene, size_t *count)
{
	size_t *begin = nt_calloc(scene->mesh_count + 1, sizeof *begin);
	wanted *list = nt_alloc(report->issue_count * NT_SPOT_COUNT + 1, sizeof *list);
	*count = 0;
	if (!begin || !list) {
		free(begin);
		free(list);
		return NULL;
	}
	for (size_t i = 0; i < scene->mesh_count; i++)
		begin[i + 1] = begin[i] + polygon_count(&scene->meshes[i]);
	for (size_t i = 0; i < report->issue_count; i++) {
		nt_issue *issue = &report->issues[i];
		for (unsigned k = 0; k < issue->spot_count && issue->mesh != NT_NONE; k++)
			if (issue->spots[k].face != NT_NONE)
				list[(*count)++] = (wanted){begin[issue->mesh] + issue->spots[k].face,
					&issue->spots[k]};
	}
	free(begin);
	qsort(list, *count, sizeof *list, by_polygon);
	return list;
}

static bool is_blank(char c)
{
	return c == ' ' || c == '\t' || c == '\r' || c == '\\';
}

/* The words behind `f`, separated by one space; a line that ends in a backslash goes on. */
static const char *copy_words(nt_arena *arena, const char *p, const char *end)
{
	char words[512];
	size_t length = 0;
	bool gap = false;
	for (; p < end && length + 2 < sizeof words; p++) {
		if (*p == '\n' && p[-1] != '\\' && !(p[-1] == '\r' && p[-2] == '\\'))
			break;
		if (*p == '#')
			break;
		if (is_blank(*p) || *p == '\n') {
			gap = true;
			continue;
		}
		if (gap && length)
			words[length++] = ' ';
		gap = false;
		words[length++] = *p;
	}
	return nt_arena_text(arena, words, length);
}

/* Whether the line that begins here is continued by the next. */
static bool goes_on(const char *line, const char *newline)
{
	const char *last = newline;
	while (last > line && last[-1] == '\r')
		last--;
	return last > line && last[-1] == '\\';
}

nt_status nt_obj_lines(nt_report *report, const nt_scene *scene)
{
	size_t count;
	wanted *list = list_wanted(report, scene, &count);
	if (!list)
		return NT_ERROR_MEMORY;
	const char *p = (const char *)scene->bytes, *end = p ? p + scene->byte_count : p;
	size_t next = 0, polygon = 0;
	nt_status status = NT_OK;
	bool continued = false;
	for (size_t line = 1; p < end && next < count && !status; line++) {
		const char *newline = memchr(p, '\n', (size_t)(end - p));
		const char *stop = newline ? newline : end;
		const char *word = p;
		while (word < stop && (*word == ' ' || *word == '\t'))
			word++;
		if (!continued && stop - word >= 2 && word[0] == 'f' && is_blank(word[1])) {
			const char *words = NULL;
			for (; next < count && list[next].polygon == polygon; next++) {
				if (!words)
					words = copy_words(&report->arena, word + 1, end);
				list[next].spot->line = line;
				list[next].spot->source = words;
				if (!words)
					status = NT_ERROR_MEMORY;
			}
			polygon++;
		}
		continued = goes_on(p, stop);
		p = stop + 1;
	}
	free(list);
	return status;
}
