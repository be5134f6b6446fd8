/* SPDX-License-Identifier: MIT */
/*
 * MTL: the lines of a library. What is damaged is an error with its line, as in the OBJ itself.
 *
 * Words are taken in any case, as exporters write map_Bump, map_bump and Map_Bump. Of several
 * normal maps `norm` and `map_Kn` come before the bump maps, whatever their order. What the older
 * lighting model has and glTF has not (Ka, Ks, Ns, Ni, illum ...) is passed over without a word: every
 * file has it. Maps and layers that are lost are named.
 */
#include "obj/mtl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/name_table.h"
#include "ext/number.h"
#include "obj/mtl_map.h"

typedef struct reader {
	nt_scene *scene;
	const char *path;
	nt_mtl *mtl;
	size_t line;
	const char *word;      /* the statement's first word */
	size_t word_length;
	const char *text, *end; /* what follows it, without blanks around it */
	nt_error *error;
} reader;

/* Files of nonsense have as many different words as lines: beyond this many findings they are one. */
enum { NAMED_FINDINGS_MOST = 1000 };

static void add_finding(const reader *r, nt_code code, const char *detail, const char *what)
{
	if (r->scene->findings.count > NAMED_FINDINGS_MOST)
		what = "";
	nt_place place;
	nt_place_clear(&place);
	strncpy(place.file, r->path, sizeof place.file - 1);
	place.line = r->line;
	nt_finding_add(&r->scene->findings, code, &place, 1, "%s%.*s", detail,
		(int)(*what ? r->word_length < 64 ? r->word_length : 64 : 0), what);
}

static void ignore(const reader *r)
{
	add_finding(r, NT_CODE_STATEMENT_IGNORED, "MTL: ", r->word);
}

/* Of what would be seen. */
static void lose(const reader *r)
{
	add_finding(r, NT_CODE_MATERIAL_LOST, "MTL: ", r->word);
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

static float clamp_unit(float value)
{
	return value < 0 ? 0 : value > 1 ? 1 : value;
}

static bool begins_with(const reader *r, const char *word)
{
	const size_t length = strlen(word);
	return (size_t)(r->end - r->text) > length && strncmp(r->text, word, length) == 0 &&
		is_blank(r->text[length]);
}

/* r g b, or one number for all three. "spectral" and "xyz" are not RGB and not carried over. */
static nt_status read_color(const reader *r, float color[3], bool unit)
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
	for (int k = 0; k < 3; k++) {
		const float value = fmaxf(numbers[count == 3 ? k : 0], 0);
		color[k] = unit ? clamp_unit(value) : value;
	}
	return NT_OK;
}

static nt_status read_factor(const reader *r, float *factor, bool inverse)
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
	*factor = clamp_unit(inverse ? 1 - value : value);
	return NT_OK;
}

/* A map: its options, then its file name. */
static nt_status read_map(reader *r, nt_map *map, float *scale)
{
	nt_mtl_map read;
	nt_mtl_map_read(r->text, r->end, &read);
	if (read.name_begin == read.name_end)
		return NT_OK; /* "map_Kd" alone: exporters write it for "none" */
	if (read.transformed)
		add_finding(r, NT_CODE_MATERIAL_LOST, "MTL: -o, -s or -t of ", r->word);
	if (scale)
		*scale = read.bump_scale;
	char *name = nt_mtl_map_name(&r->scene->arena, &read);
	if (!name)
		return nt_fail_memory(r->error);
	map->name = name;
	return NT_OK;
}

/* A map that has no place in a glTF; without a name it is none. */
static void lose_map(const reader *r)
{
	nt_mtl_map read;
	nt_mtl_map_read(r->text, r->end, &read);
	if (read.name_begin != read.name_end)
		lose(r);
}

/* Sheen, clearcoat, anisotropy: of strength 0, as exporters write them, they are none. */
static void lose_layer(const reader *r)
{
	float strength;
	if (nt_read_float(r->text, r->end, &strength) && strength != 0)
		lose(r);
}

/* ---- statements ---- */

enum action {
	BASE_COLOR, EMISSIVE, OPACITY, TRANSPARENCY, ROUGHNESS, METALLIC, BASE_COLOR_MAP, EMISSIVE_MAP,
	NORMAL_MAP, BUMP_MAP, LAYER, LOST_MAP, PASS_OVER
};

static const struct {
	const char *word;
	enum action action;
} statements[] = {
	{"Kd", BASE_COLOR}, {"Ke", EMISSIVE}, {"d", OPACITY}, {"Tr", TRANSPARENCY}, {"Pr", ROUGHNESS},
	{"Pm", METALLIC}, {"map_Kd", BASE_COLOR_MAP}, {"map_Ke", EMISSIVE_MAP}, {"norm", NORMAL_MAP},
	{"map_Kn", NORMAL_MAP}, {"map_Bump", BUMP_MAP}, {"bump", BUMP_MAP}, {"Ka", PASS_OVER},
	{"Ks", PASS_OVER}, {"Ns", PASS_OVER}, {"Ni", PASS_OVER}, {"Tf", PASS_OVER}, {"Km", PASS_OVER},
	{"illum", PASS_OVER}, {"sharpness", PASS_OVER}, {"Ps", LAYER}, {"Pc", LAYER},
	{"Pcr", PASS_OVER}, {"aniso", LAYER}, {"anisor", PASS_OVER}, {"map_aat", PASS_OVER},
	{"map_Ka", PASS_OVER}, {"disp", LOST_MAP}, {"decal", LOST_MAP}, {"refl", LOST_MAP},
};
enum { STATEMENT_COUNT = sizeof statements / sizeof statements[0] };

static nt_status read_property(reader *r, nt_mtl_definition *d, enum action action)
{
	nt_material *m = &d->material;
	switch (action) {
	case BASE_COLOR:
		return read_color(r, m->base_color, true);
	case EMISSIVE:
		return read_color(r, m->emissive, false);
	case OPACITY:
	case TRANSPARENCY:
		return read_factor(r, &m->base_color[3], action == TRANSPARENCY);
	case ROUGHNESS:
		return read_factor(r, &m->roughness, false);
	case METALLIC:
		return read_factor(r, &m->metallic, false);
	case BASE_COLOR_MAP:
		return read_map(r, &m->base_color_map, NULL);
	case EMISSIVE_MAP:
		return read_map(r, &m->emissive_map, NULL);
	case NORMAL_MAP:
		m->bump = NULL;
		return read_map(r, &m->normal_map, &m->normal_scale);
	case BUMP_MAP:
		if (m->normal_map.name && !m->bump)
			break;
		m->bump_line = r->line;
		m->bump = nt_arena_text(&r->scene->arena, r->word, r->word_length);
		if (!m->bump)
			return nt_fail_memory(r->error);
		return read_map(r, &m->normal_map, &m->normal_scale);
	case LAYER:
		lose_layer(r);
		break;
	case LOST_MAP:
		lose_map(r);
		break;
	case PASS_OVER:
		break;
	}
	return NT_OK;
}

nt_material nt_mtl_default(const char *name)
{
	return (nt_material){
		.name = name,
		.base_color = {1, 1, 1, 1},
		.roughness = 1,
		.normal_scale = 1,
	};
}

static nt_status begin_material(reader *r)
{
	nt_mtl *mtl = r->mtl;
	const size_t length = (size_t)(r->end - r->text);
	const char *raw_name = nt_arena_text(&r->scene->arena, r->text, length);
	const char *name = nt_utf8_text(&r->scene->arena, r->text, length);
	if (!raw_name || !name ||
		!nt_grow((void **)&mtl->definitions, &mtl->capacity, mtl->count + 1,
			sizeof *mtl->definitions))
		return nt_fail_memory(r->error);
	nt_mtl_definition *d = &mtl->definitions[mtl->count++];
	*d = (nt_mtl_definition){nt_mtl_default(name), raw_name, length};
	d->material.library = r->path;
	d->material.line = r->line;
	return NT_OK;
}

/* first: definitions before it are of other files. */
static nt_status read_statement(reader *r, size_t first)
{
	if (r->word_length == 6 && strncasecmp(r->word, "newmtl", 6) == 0)
		return begin_material(r);
	for (size_t i = 0; i < STATEMENT_COUNT; i++)
		if (strlen(statements[i].word) == r->word_length &&
			strncasecmp(statements[i].word, r->word, r->word_length) == 0) {
			if (r->mtl->count == first)
				break;
			return read_property(r, &r->mtl->definitions[r->mtl->count - 1],
				statements[i].action);
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
	const size_t first = mtl->count;
	reader r = {.scene = scene, .path = path, .mtl = mtl, .line = 1, .error = error};
	const char *p = (const char *)bytes, *const end = p + size;
	if (memchr(bytes, '\0', size)) {
		nt_fail(error, NT_ERROR_INPUT, "a byte 0 in it, expected a material library in text");
		return nt_error_in_file(error, path);
	}
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
		if (r.word_length && r.word[0] != '#') {
			const nt_status status = read_statement(&r, first);
			if (status)
				return status;
		}
		p = line_end + 1;
		if (line_end < end && *line_end == '\r' && p < end && *p == '\n')
			p++;
		r.line++;
	}
	return NT_OK;
}

void nt_mtl_free(nt_mtl *mtl)
{
	free(mtl->definitions);
	*mtl = (nt_mtl){0};
}
