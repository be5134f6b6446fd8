/* SPDX-License-Identifier: MIT */
/*
 * The colours of vertices that ZBrush writes as comments: "#MRGB" and 8 hexadecimal digits MMRRGGBB for each vertex, 64
 * vertices a line (ZBrush says so in its files; http://paulbourke.net/dataformats/obj/colour.html). MM is the mask of
 * sculpting, not opacity. The lines between two `v` are one block: n colours for the n vertices before it, so that a
 * file of several tools, each with its block, is read, too. If `v` have colours of their own, those count.
 *
 * Comments never fail a file: what is malformed is a finding with its line, and its vertices are white.
 */
#include "obj/parts.h"

#include <stdio.h>

/* The block that is under way, and the next colour that is given. */
typedef struct painter {
	obj_file *file;
	size_t line;         /* of the block, from 1; 0: none */
	size_t count;        /* its colours */
	size_t vertex;       /* `v` of the file before it */
	size_t before;       /* `v` before the last block */
	size_t chunk, color; /* of the chunk */
	bool mismatched;     /* some block was */
} painter;

static void doubt(const obj_file *file, size_t line, size_t count, const char *what)
{
	const nt_place place = nt_line_place(file->scene->path, line);
	nt_finding_add(&file->scene->findings, NT_CODE_COLORS_DOUBTFUL, &place, count, "%s", what);
}

static void check_count(painter *p)
{
	char what[80] = "#MRGB: and in other blocks";
	const size_t vertices = p->vertex - p->before;
	if (p->count == vertices)
		return;
	if (!p->mismatched)
		snprintf(what, sizeof what, "#MRGB: %zu colours for %zu vertices", p->count, vertices);
	p->mismatched = true;
	doubt(p->file, p->line, 1, what);
}

/* The colours of a chunk's vertices, white before any has one; NULL: out of memory. */
static float *colors_of(obj_chunk *chunk)
{
	const size_t count = chunk->rows[OBJ_V].count;
	if (chunk->colors || !(chunk->colors = nt_alloc(count, 4 * sizeof *chunk->colors)))
		return chunk->colors;
	for (size_t i = 0; i < 4 * count; i++)
		chunk->colors[i] = 1;
	return chunk->colors;
}

/* Gives the vertices before the block its colours. A file that is white all over has none: ZBrush writes that, too. */
static nt_status end_block(painter *p, nt_error *error)
{
	const size_t vertices = p->count < p->vertex ? p->count : p->vertex;
	check_count(p);
	for (size_t i = 0; i < p->count; i++) {
		for (; p->color == p->file->chunks[p->chunk].mrgb_count; p->chunk++)
			p->color = 0;
		const uint32_t color = p->file->chunks[p->chunk].mrgb[p->color++];
		const uint32_t number = (uint32_t)(p->vertex - vertices + i);
		if (i >= vertices || color == OBJ_WHITE)
			continue;
		p->file->has_colors = true;
		obj_chunk *chunk = &p->file->chunks[obj_find_row(p->file, OBJ_V, number) - p->file->chunks];
		float *colors = colors_of(chunk);
		if (!colors)
			return nt_fail_memory(error);
		for (int k = 0; k < 3; k++)
			colors[4 * (number - chunk->rows[OBJ_V].first) + (size_t)k] =
				(float)(color >> (16 - 8 * k) & 255) / 255;
	}
	p->before = p->vertex;
	p->line = p->count = 0;
	return NT_OK;
}

static nt_status take_line(painter *p, const obj_chunk *chunk, const obj_mrgb_line *line, nt_error *error)
{
	const size_t vertex = chunk->rows[OBJ_V].first + line->vertex, number = chunk->first_line + line->line + 1;
	const nt_status status = vertex != p->vertex ? end_block(p, error) : NT_OK;
	if (!p->line)
		p->line = number;
	p->vertex = vertex;
	p->count += line->count;
	if (!line->sound)
		doubt(p->file, number, 1, "#MRGB: found something else, expected 8 hexadecimal digits for each vertex");
	return status;
}

nt_status obj_join_colors(obj_file *file, nt_error *error)
{
	painter p = {.file = file};
	nt_status status = NT_OK;
	obj_count bad;
	obj_count_all(file, offsetof(obj_chunk, bad_colors), &bad);
	char what[64];
	snprintf(what, sizeof what, "%zu of v not finite", bad.count);
	if (bad.count)
		doubt(file, bad.line, bad.count, what);
	if (file->has_colors)
		return NT_OK;
	for (size_t c = 0; c < file->chunk_count && !status; c++)
		for (size_t i = 0; i < file->chunks[c].mrgb_line_count && !status; i++)
			status = take_line(&p, &file->chunks[c], &file->chunks[c].mrgb_lines[i], error);
	return status ? status : end_block(&p, error);
}
