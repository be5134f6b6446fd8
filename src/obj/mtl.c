/* SPDX-License-Identifier: MIT */
/*
 * MTL: the lines of a library. A damaged statement is an error with its line, as in the OBJ itself.
 *
 * Words are taken in any case, as exporters write map_Bump, map_bump and Map_Bump. mtl_settle.c makes the result of a
 * material's statements. Maps that have no place in a glTF are named.
 */
#include "obj/mtl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/name_table.h"
#include "ext/number.h"

typedef struct reader {
	nt_scene *scene;
	const char *path;
	nt_mtl *mtl;
	nt_material *current; /* the last of mtl; NULL: nothing yet */
	mtl_values *said;     /* of it */
	size_t line;
	const char *word;      /* the statement's first word */
	size_t word_length;
	const char *text, *end; /* what follows it, without blanks around it */
	nt_error *error;
} reader;

/* The place of the statement. */
static void find(const reader *r, nt_code code, const char *detail)
{
	char text[256];
	snprintf(text, sizeof text, "MTL: %s%.*s", detail, (int)(r->word_length < 64 ? r->word_length : 64), r->word);
	const bool named = code == NT_CODE_MATERIAL_LOST && r->current;
	nt_mtl_find(r->scene, code, r->path, r->line, named ? r->current->name : NULL, text);
}

static void ignore(const reader *r)
{
	find(r, NT_CODE_STATEMENT_IGNORED, "");
}

/* Fails with "found WORD, expected EXPECTED" at a line of the MTL. */
static nt_status fail_expected(const reader *r, const char *found, const char *expected)
{
	size_t length = 0;
	while (found + length < r->end && !is_blank(found[length]) && length < 64)
		length++;
	if (length)
		nt_fail_line(r->error, NT_ERROR_INPUT, r->line, "found \"%.*s\", expected %s", (int)length,
			found, expected);
	else
		nt_fail_line(r->error, NT_ERROR_INPUT, r->line, "found the end of the line, expected %s",
			expected);
	return nt_error_in_file(r->error, r->path);
}

/* Numbers up to the end of the text, at most `most`; *count receives how many. */
static nt_status read_numbers(const reader *r, float *numbers, int most, int *count)
{
	const char *p = r->text;
	for (*count = 0; *count < most && p < r->end; ++*count) {
		const char *begin = p;
		p = nt_read_float(p, r->end, &numbers[*count]);
		if (!p || (p < r->end && !is_blank(*p)) || !isfinite(numbers[*count]))
			return fail_expected(r, begin, "a finite number");
		while (p < r->end && is_blank(*p))
			p++;
	}
	return NT_OK;
}

static bool begins_with(const reader *r, const char *word)
{
	const size_t length = strlen(word);
	return (size_t)(r->end - r->text) > length && strncmp(r->text, word, length) == 0 &&
		is_blank(r->text[length]);
}

/* r g b, or one number for all three. "spectral" and "xyz" are not RGB and not carried over. */
static nt_status read_color(const reader *r, mtl_color which)
{
	if (begins_with(r, "spectral") || begins_with(r, "xyz")) {
		ignore(r);
		return NT_OK;
	}
	float numbers[3];
	int count;
	const nt_status status = read_numbers(r, numbers, 3, &count);
	if (status)
		return status;
	if (count != 1 && count != 3)
		return fail_expected(r, r->end, "3 numbers, or one for all");
	for (int k = 0; k < 3; k++)
		r->said->colors[which].value[k] = fmaxf(numbers[count == 3 ? k : 0], 0);
	r->said->colors[which].line = r->line;
	return NT_OK;
}

static nt_status read_number(const reader *r, mtl_number which)
{
	reader at = *r;
	if (begins_with(r, "-halo"))
		for (at.text += strlen("-halo"); is_blank(*at.text);)
			at.text++;
	float value;
	int count;
	const nt_status status = read_numbers(&at, &value, 1, &count);
	if (status)
		return status;
	if (count != 1)
		return fail_expected(&at, at.end, "a number");
	r->said->numbers[which].value = value;
	r->said->numbers[which].line = r->line;
	return NT_OK;
}

/* If two maps for one purpose name different images, the first is lost: Substance Painter writes heights as bump
 * and normals as map_Bump. */
static void lose_earlier(const reader *r, mtl_map which, const char *name)
{
	const nt_map *earlier = &r->said->maps[which].map;
	if (!earlier->name || strcmp(earlier->name, name) == 0)
		return;
	char detail[160];
	snprintf(detail, sizeof detail, "%.64s, replaced by a later ", r->said->maps[which].word);
	reader at = *r;
	at.line = earlier->line;
	find(&at, NT_CODE_MATERIAL_LOST, detail);
}

/* A map: its options, then its file name. */
static nt_status read_map(const reader *r, mtl_map which)
{
	nt_mtl_map read;
	nt_mtl_map_read(r->text, r->end, &read);
	if (read.name_begin == read.name_end)
		return NT_OK; /* "map_Kd" alone: exporters write it for "none" */
	if (read.turbulent)
		find(r, NT_CODE_MATERIAL_LOST, "-t of ");
	if (read.channel == 'z') {
		find(r, NT_CODE_MATERIAL_LOST, "-imfchan z of ");
		read.channel = 0;
	}
	char *name = nt_mtl_file_name(&r->scene->arena, read.name_begin, read.name_end);
	char *word = nt_arena_text(&r->scene->arena, r->word, r->word_length);
	if (!name || !word)
		return nt_fail_memory(r->error);
	if (!*name)
		return NT_OK; /* "" is none, too */
	lose_earlier(r, which, name);
	r->said->maps[which].map = (nt_map){.name = name, .line = r->line, .placement = read.placement,
		.channel = read.channel, .base = read.base, .gain = read.gain};
	r->said->maps[which].word = word;
	r->said->maps[which].scale = read.bump_scale;
	return NT_OK;
}

/* A map that has no place in a glTF; without a name it is none. */
static void lose_map(const reader *r)
{
	nt_mtl_map read;
	nt_mtl_map_read(r->text, r->end, &read);
	if (read.name_begin != read.name_end)
		find(r, NT_CODE_MATERIAL_LOST, "");
}

/* ---- statements ---- */

enum action {
	NUMBER, COLOR,
	HINT_NUMBER, HINT_COLOR, /* without which a material can do: damaged ones are not used */
	MAP, LOST_MAP, PASS_OVER
};

/* Words of the specification, of its extension for PBR (exocortex.com, 2015), of Model I/O (map_roughness ...) and of
 * assimp (map_emissive ...). */
static const struct {
	const char *word;
	enum action action;
	int which;
} statements[] = {
	{"Ka", HINT_COLOR, MTL_KA}, {"Kd", COLOR, MTL_KD}, {"Ke", COLOR, MTL_KE}, {"Ks", HINT_COLOR, MTL_KS},
	{"Tf", HINT_COLOR, MTL_TF},
	{"d", NUMBER, MTL_D}, {"Tr", NUMBER, MTL_TR}, {"Pr", NUMBER, MTL_PR}, {"Pm", NUMBER, MTL_PM},
	{"Ns", HINT_NUMBER, MTL_NS}, {"Ni", HINT_NUMBER, MTL_NI}, {"illum", HINT_NUMBER, MTL_ILLUM},
	{"Ps", HINT_NUMBER, MTL_PS}, {"Pc", HINT_NUMBER, MTL_PC}, {"Pcr", HINT_NUMBER, MTL_PCR},
	{"aniso", HINT_NUMBER, MTL_ANISO}, {"anisor", HINT_NUMBER, MTL_ANISOR},
	{"map_Kd", MAP, MTL_MAP_KD}, {"map_Ka", MAP, MTL_MAP_KA}, {"map_Ke", MAP, MTL_MAP_KE},
	{"map_emissive", MAP, MTL_MAP_KE}, {"map_d", MAP, MTL_MAP_D}, {"map_Tr", MAP, MTL_MAP_TR},
	{"map_Ks", MAP, MTL_MAP_KS}, {"map_Ns", MAP, MTL_MAP_NS}, {"map_Pr", MAP, MTL_MAP_PR},
	{"map_roughness", MAP, MTL_MAP_PR}, {"map_Pm", MAP, MTL_MAP_PM}, {"map_metallic", MAP, MTL_MAP_PM},
	{"map_Ps", MAP, MTL_MAP_PS}, {"map_Pc", MAP, MTL_MAP_PC}, {"map_Pcr", MAP, MTL_MAP_PCR},
	{"map_ao", MAP, MTL_MAP_AO}, {"map_ORM", MAP, MTL_MAP_ORM}, {"map_RMA", MAP, MTL_MAP_RMA},
	{"refl", MAP, MTL_MAP_REFL}, {"map_refl", MAP, MTL_MAP_REFL}, {"norm", MAP, MTL_MAP_NORM},
	{"map_Kn", MAP, MTL_MAP_NORM}, {"map_tangentSpaceNormal", MAP, MTL_MAP_NORM}, {"map_Bump", MAP, MTL_MAP_BUMP},
	{"bump", MAP, MTL_MAP_BUMP}, {"map_aat", PASS_OVER, 0}, {"Km", PASS_OVER, 0},
	{"sharpness", PASS_OVER, 0}, {"disp", LOST_MAP, 0}, {"decal", LOST_MAP, 0},
};
enum { STATEMENT_COUNT = sizeof statements / sizeof statements[0] };

static nt_status read_property(const reader *r, enum action action, int which)
{
	nt_error unused;
	reader hint = *r;
	hint.error = &unused;
	switch (action) {
	case COLOR:
		return read_color(r, (mtl_color)which);
	case NUMBER:
		return read_number(r, (mtl_number)which);
	case HINT_COLOR:
		if (read_color(&hint, (mtl_color)which))
			ignore(r);
		break;
	case HINT_NUMBER:
		if (read_number(&hint, (mtl_number)which))
			ignore(r);
		break;
	case MAP:
		return read_map(r, (mtl_map)which);
	case LOST_MAP:
		lose_map(r);
		break;
	case PASS_OVER:
		break;
	}
	return NT_OK;
}

/* The statements of a material are all there. */
static void end_material(reader *r)
{
	if (r->current)
		nt_mtl_settle(r->said, r->scene, r->current);
	const bool blender = r->said->blender, any_blender = r->said->any_blender;
	memset(r->said, 0, sizeof *r->said);
	r->said->blender = blender;
	r->said->any_blender = any_blender;
}

static nt_status begin_material(reader *r)
{
	end_material(r);
	nt_mtl *mtl = r->mtl;
	const size_t length = (size_t)(r->end - r->text);
	const char *raw_name = nt_arena_text(&r->scene->arena, r->text, length);
	const char *name = nt_utf8_text(&r->scene->arena, r->text, length);
	if (!raw_name || !name ||
		!nt_grow((void **)&mtl->definitions, &mtl->capacity, mtl->count + 1,
			sizeof *mtl->definitions))
		return nt_fail_memory(r->error);
	nt_mtl_definition *d = &mtl->definitions[mtl->count++];
	*d = (nt_mtl_definition){nt_material_default(name), raw_name, length};
	d->material.library = r->path;
	d->material.line = r->line;
	r->current = &d->material;
	return NT_OK;
}

static nt_status read_statement(reader *r)
{
	if (r->word_length == 6 && strncasecmp(r->word, "newmtl", 6) == 0)
		return begin_material(r);
	for (size_t i = 0; i < STATEMENT_COUNT; i++)
		if (strlen(statements[i].word) == r->word_length &&
			strncasecmp(statements[i].word, r->word, r->word_length) == 0) {
			if (!r->current)
				break;
			return read_property(r, statements[i].action, statements[i].which);
		}
	if (r->word_length > 4 && strncasecmp(r->word, "map_", 4) == 0)
		lose_map(r);
	else
		ignore(r);
	return NT_OK;
}

nt_status nt_mtl_parse(nt_scene *scene, const char *path, const unsigned char *bytes, size_t size,
	nt_mtl *mtl, nt_error *error)
{
	mtl_values said = {0};
	reader r = {.scene = scene, .path = path, .mtl = mtl, .said = &said, .line = 1, .error = error};
	const char *p = (const char *)bytes, *const end = p + size;
	if (memchr(bytes, '\0', size))
		return nt_fail_file(error, NT_ERROR_INPUT, path, "a byte 0 in it, expected a material library in text");
	if (size >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0)
		p += 3;
	while (p < end) {
		const char *line_end = p;
		while (line_end < end && *line_end != '\n' && *line_end != '\r')
			line_end++;
		while (p < line_end && is_blank(*p))
			p++;
		r.word = p;
		while (p < line_end && !is_blank(*p))
			p++;
		r.word_length = (size_t)(p - r.word);
		while (p < line_end && is_blank(*p))
			p++;
		r.text = p;
		r.end = line_end;
		while (r.end > r.text && is_blank(r.end[-1]))
			r.end--;
		const bool comment = r.word_length && r.word[0] == '#';
		const nt_status status = r.word_length && !comment ? read_statement(&r) : NT_OK;
		if (status)
			return status;
		/* "# Blender 3.2.1 MTL File: ...": see mtl_settle.c. Older ones have no number there. */
		if (comment && r.end - r.text > 8 && memcmp(r.text, "Blender ", 8) == 0) {
			r.said->any_blender = true;
			r.said->blender |= r.text[8] >= '0' && r.text[8] <= '9';
		}
		p = line_end + 1;
		if (line_end < end && *line_end == '\r' && p < end && *p == '\n')
			p++;
		r.line++;
	}
	end_material(&r);
	return NT_OK;
}

void nt_mtl_free(nt_mtl *mtl)
{
	free(mtl->definitions);
	free(mtl->files);
	nt_hash_index_free(&mtl->file_index);
	*mtl = (nt_mtl){0};
}
