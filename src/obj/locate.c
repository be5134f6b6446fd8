/* SPDX-License-Identifier: MIT */
/*
 * Finds the line of a face in the text. Nothing is kept of a face's line while the file is read: only errors and
 * reports ask for it, and for a few faces. Their chunks are read again, by the same parser, as far as the face.
 * For that, 32 bytes of each chunk and 8 of each mesh outlive the reader.
 */
#include "obj/parts.h"

#include <stdlib.h>
#include <string.h>

/* Lines of the input, and what comes before them in the file. */
typedef struct stretch {
	const char *begin, *end;
	size_t first_face, first_line;
} stretch;

/* Data that the reader leaves in the scene. */
typedef struct places {
	stretch *stretches;
	size_t stretch_count;
	size_t *mesh_faces; /* [mesh_count] first face of each mesh */
} places;

size_t obj_face_line(const obj_file *file, size_t face, obj_corner *before)
{
	size_t c = 0;
	while (c + 1 < file->chunk_count && file->chunks[c + 1].first_face <= face)
		c++;
	const obj_chunk *chunk = &file->chunks[c];
	obj_chunk again = obj_chunk_of(chunk->begin, chunk->end);
	const nt_status status = obj_read_lines(&again, face - chunk->first_face);
	*before = (obj_corner){(uint32_t)again.rows[OBJ_V].count, (uint32_t)again.rows[OBJ_VT].count,
		(uint32_t)again.rows[OBJ_VN].count};
	obj_chunk_free(&again);
	return status ? 0 : chunk->first_line + again.statement_line + 1;
}

/* The words behind "f" as far as there is room for whole ones, one blank between two. */
static const char *copy_corners(const char *p, nt_arena *arena)
{
	char words[512];
	size_t length = 0;
	for (;;) {
		while (!is_word_end(p) && *p != '#')
			p++;
		while (is_blank(*p) || joins_lines(p))
			p = is_blank(*p) ? p + 1 : behind_line_end(p + 1);
		if (is_line_end(*p) || *p == '#')
			return nt_arena_text(arena, words, length);
		size_t size = 0;
		while (!is_word_end(p + size) && p[size] != '#')
			size++;
		if (length + size + sizeof " ..." > sizeof words) {
			memcpy(words + length, " ...", 4);
			return nt_arena_text(arena, words, length + 4);
		}
		if (length)
			words[length++] = ' ';
		memcpy(words + length, p, size);
		length += size;
	}
}

/* The number of a face in the file. */
static size_t number_of(const places *kept, const nt_face_place *face)
{
	return kept->mesh_faces[face->mesh] + face->face;
}

/* Locates faces of one chunk. */
static nt_status locate_in(const places *kept, const stretch *lines, const char *begin, const char *end,
	nt_face_place *faces, size_t count, nt_arena *arena)
{
	obj_chunk again = obj_chunk_of(begin, end);
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++) {
		const size_t face = number_of(kept, &faces[i]) - lines->first_face;
		status = obj_read_lines(&again, face);
		if (status)
			break;
		faces[i].line = lines->first_line + again.statement_line + 1;
		faces[i].corners = copy_corners(again.statement, arena);
		if (!faces[i].corners)
			status = NT_ERROR_MEMORY;
	}
	obj_chunk_free(&again);
	return status;
}

/* For nt_scene.locate_faces. */
static nt_status locate_faces(const nt_scene *scene, nt_face_place *faces, size_t count, nt_arena *arena)
{
	const places *kept = scene->source;
	nt_status status = NT_OK;
	size_t s = 0;
	for (size_t i = 0, next; i < count && !status; i = next) {
		while (s + 1 < kept->stretch_count &&
			kept->stretches[s + 1].first_face <= number_of(kept, &faces[i]))
			s++;
		const stretch *lines = &kept->stretches[s];
		const bool last = s + 1 == kept->stretch_count;
		for (next = i + 1; next < count; next++)
			if (!last && number_of(kept, &faces[next]) >= lines[1].first_face)
				break;
		const char *end = lines->end;
		char *copy = last ? obj_copy_padded(lines->begin, lines->end, &end) : NULL;
		status = last && !copy ? NT_ERROR_MEMORY
			: locate_in(kept, lines, last ? copy : lines->begin, end, faces + i, next - i, arena);
		free(copy);
	}
	return status;
}

bool obj_keep_places(const obj_file *file)
{
	nt_scene *scene = file->scene;
	places *kept = nt_arena_alloc(&scene->arena, 1, sizeof *kept);
	stretch *stretches = nt_arena_alloc(&scene->arena, file->chunk_count, sizeof *stretches);
	size_t *mesh_faces = nt_arena_alloc(&scene->arena, file->mesh_count, sizeof *mesh_faces);
	if (!kept || !stretches || !mesh_faces)
		return false;
	for (size_t c = 0; c < file->chunk_count; c++) {
		const obj_chunk *chunk = &file->chunks[c];
		stretches[c] = (stretch){chunk->begin, chunk->end, chunk->first_face, chunk->first_line};
	}
	stretches[file->chunk_count - 1].begin = file->tail_begin;
	stretches[file->chunk_count - 1].end = file->tail_end;
	for (size_t m = 0; m < file->mesh_count; m++)
		mesh_faces[m] = file->meshes[m].face;
	*kept = (places){stretches, file->chunk_count, mesh_faces};
	scene->source = kept;
	scene->locate_faces = locate_faces;
	return true;
}
