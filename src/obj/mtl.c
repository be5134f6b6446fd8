/* SPDX-License-Identifier: MIT */
/*
 * MTL: the statements of a library, and what those of a newmtl come to together in glTF's terms. The man page has
 * that as a table (MATERIALS OF AN OBJ). A damaged statement is a finding with its line, and loses no mesh. Words are
 * taken in any case, as exporters write map_Bump, map_bump and Map_Bump. Maps that have no place in a glTF are named.
 *
 * Ns is the exponent n of Blinn-Phong highlights. A microfacet distribution of the same width has
 * alpha^2 = 2 / (n + 2) (Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces, section 5.2), and
 * glTF's alpha is the roughness squared: roughness = (2 / (n + 2))^(1/4). Blender from 3.2 on writes
 * Ns = 1000 (1 - roughness)^2 instead and puts maps of the roughness and of metal into map_Ns and map_refl; its
 * libraries say who wrote them, so that it is taken back. Numbers beside maps are what Blender's maps replace;
 * elsewhere a map is multiplied by its number, as map_Kd is by Kd.
 *
 * Exporters write 0 for what they do not mean: d 0 (Tr 1), which would make all of it invisible, and 0 for the number
 * of a map, which would make the map invisible. Both become 1, as in obj2gltf.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include "ext/linked.h"

/* Numbers that agree but for being rounded in the text. */
static const float SAME_NUMBER = 0.01f;

/* The exponent that white means in a map_Ns without Ns: the largest that programs write. */
static const float LARGEST_NS = 1000;

/* MTL has no roughness of sheen; Blender's is this where nobody says another. */
static const float SHEEN_ROUGHNESS = 0.5f;

/* Statements that are not used are told one by one up to so many: thousands of materials that say the same are one. */
enum { NAMED_FINDINGS_MOST = 1000 };

/* Colours come first: they have three numbers. */
typedef enum mtl_value {
	MTL_KA, MTL_KD, MTL_KE, MTL_KS, MTL_TF, MTL_COLOR_COUNT,
	MTL_D = MTL_COLOR_COUNT, MTL_TR, MTL_NS, MTL_NI, MTL_ILLUM, MTL_PR, MTL_PM, MTL_PS, MTL_PC, MTL_PCR, MTL_ANISO,
	MTL_ANISOR, MTL_VALUE_COUNT
} mtl_value;

/* ORM, RMA: one image of occlusion, roughness and metallic in the order of the letters. */
typedef enum mtl_map {
	MTL_MAP_KD, MTL_MAP_KA, MTL_MAP_KE, MTL_MAP_D, MTL_MAP_TR, MTL_MAP_KS, MTL_MAP_NS, MTL_MAP_PR, MTL_MAP_PM,
	MTL_MAP_PS, MTL_MAP_PC, MTL_MAP_PCR, MTL_MAP_AO, MTL_MAP_ORM, MTL_MAP_RMA, MTL_MAP_REFL, MTL_MAP_NORM,
	MTL_MAP_BUMP, MTL_MAP_COUNT
} mtl_map;

typedef struct stated_map {
	nt_map map;       /* of which name NULL: nothing is said */
	const char *word; /* the statement's, as it is spelled */
	float scale;      /* -bm, 1 if there is none */
	bool turbulent;   /* -t distorts the texture: not carried over */
} stated_map;

typedef struct reader {
	nt_scene *scene;
	const char *path;
	nt_mtl *mtl;
	nt_error *error;
	bool any_blender; /* the library says that Blender wrote it */
	bool blender;     /* the library says that Blender 3.2 or later wrote it */
	size_t line;
	const char *word; /* the statement's first word */
	size_t word_length;
	const char *text, *end; /* what follows it, without blanks around it */

	/* The last newmtl, NULL: none yet; and what its lines say. The last statement of a kind counts. */
	nt_material *m;
	struct {
		struct {
			float value[3];
			size_t line; /* 0: nothing is said */
		} values[MTL_VALUE_COUNT];
		stated_map maps[MTL_MAP_COUNT];
	} said;
} reader;

NT_PRINTF(4, 5)
static void find(const reader *r, nt_code code, size_t line, const char *format, ...)
{
	nt_place place = nt_line_place(r->path, line);
	const bool named = r->scene->findings.count < NAMED_FINDINGS_MOST;
	char detail[256] = "";
	va_list arguments;
	va_start(arguments, format);
	if (named)
		nt_utf8_format(detail, sizeof detail, format, arguments);
	va_end(arguments);
	if (named && r->m && code != NT_CODE_STATEMENT_IGNORED)
		snprintf(place.object, sizeof place.object, "material \"%.*s\"", NT_CUT(200, r->m->name));
	nt_finding_add(&r->scene->findings, code, &place, 1, "MTL: %s", detail);
}

/* The statement is not used; what: of it. */
static void lose(const reader *r, nt_code code, const char *what)
{
	find(r, code, r->line, "%s%.*s", what, NT_CUT_OF(64, r->word_length, r->word));
}

/* ---- numbers ---- */

typedef struct word {
	const char *begin, *end;
} word;

/* The word at or behind p; empty at the end. */
static word next_word(const char *p, const char *end)
{
	while (p < end && is_blank(*p))
		p++;
	word w = {p, p};
	while (w.end < end && !is_blank(*w.end))
		w.end++;
	return w;
}

/* Fails with "found WORD, expected EXPECTED" at a line of the MTL. */
static nt_status fail_expected(const reader *r, const char *found, const char *expected)
{
	const word w = next_word(found, r->end);
	const size_t length = (size_t)(w.end - w.begin);
	if (length)
		nt_fail_line(r->error, NT_ERROR_INPUT, r->line, "found \"%.*s\", expected %s",
			NT_CUT_OF(64, length, w.begin), expected);
	else
		nt_fail_line(r->error, NT_ERROR_INPUT, r->line, "found the end of the line, expected %s", expected);
	return nt_error_in_file(r->error, r->path);
}

static bool begins_with(const reader *r, const char *name)
{
	const size_t length = strlen(name);
	return (size_t)(r->end - r->text) > length && strncmp(r->text, name, length) == 0 && is_blank(r->text[length]);
}

/* A number, or the three of a colour, of which one stands for all. */
static nt_status read_value(reader *r, mtl_value which)
{
	const int most = which < MTL_COLOR_COUNT ? 3 : 1;
	const char *p = r->text;
	float numbers[3];
	int count = 0;
	/* neither is RGB */
	if (most == 3 && (begins_with(r, "spectral") || begins_with(r, "xyz"))) {
		lose(r, NT_CODE_STATEMENT_IGNORED, "");
		return NT_OK;
	}
	if (most == 1 && begins_with(r, "-halo"))
		for (p += strlen("-halo"); is_blank(*p);)
			p++;
	for (; count < most && p < r->end; count++) {
		const char *begin = p;
		p = nt_read_float(p, r->end, &numbers[count]);
		if (!p || (p < r->end && !is_blank(*p)) || !isfinite(numbers[count]))
			return fail_expected(r, begin, "a finite number");
		while (p < r->end && is_blank(*p))
			p++;
	}
	if (count != 1 && count != most)
		return fail_expected(r, r->end, most == 1 ? "a number" : "3 numbers, or one for all");
	const word behind = next_word(p, r->end);
	const size_t length = (size_t)(behind.end - behind.begin);
	if (length && *behind.begin != '#')
		find(r, NT_CODE_STATEMENT_IGNORED, r->line, "\"%.*s\" behind the numbers of %.*s",
			NT_CUT_OF(64, length, behind.begin),
			NT_CUT_OF(64, r->word_length, r->word));
	for (int k = 0; k < most; k++)
		r->said.values[which].value[k] = most == 1 ? numbers[0] : fmaxf(numbers[count == 3 ? k : 0], 0);
	r->said.values[which].line = r->line;
	return NT_OK;
}

/* ---- maps: options, each with its arguments, and a file name that may have blanks ---- */

/* Treatment of an option's arguments. */
enum use { NOTHING, BUMP_SCALE, CHANNEL, CLAMP, OFFSET, RANGE, SCALE, TURBULENCE };

static const struct {
	const char *name;
	int least, most; /* arguments */
	enum use use;
} options[] = {
	{"-blendu", 1, 1, NOTHING}, {"-blendv", 1, 1, NOTHING}, {"-boost", 1, 1, NOTHING}, {"-bm", 1, 1, BUMP_SCALE},
	{"-cc", 1, 1, NOTHING}, {"-clamp", 1, 1, CLAMP}, {"-colorspace", 1, 1, NOTHING},
	{"-imfchan", 1, 1, CHANNEL}, {"-mm", 2, 2, RANGE}, {"-o", 1, 3, OFFSET}, {"-s", 1, 3, SCALE},
	{"-t", 1, 3, TURBULENCE}, {"-texres", 1, 1, NOTHING}, {"-type", 1, 1, NOTHING},
};
enum { OPTION_COUNT = sizeof options / sizeof options[0] };

static bool is_word(word w, const char *text)
{
	return strlen(text) == (size_t)(w.end - w.begin) && memcmp(text, w.begin, strlen(text)) == 0;
}

static bool is_number(word w, float *value)
{
	return w.begin < w.end && nt_read_float(w.begin, w.end, value) == w.end && isfinite(*value);
}

/* Argument i of an option is this number. A third one is of textures with depth, which images are not. */
static void use_number(enum use use, int i, float value, stated_map *to)
{
	nt_placement *p = &to->map.placement;
	if (use == BUMP_SCALE)
		to->scale = value;
	if (use == RANGE)
		*(i ? &to->map.gain : &to->map.base) = value;
	if (use == TURBULENCE)
		to->turbulent = to->turbulent || value != 0;
	if ((use != SCALE && use != OFFSET) || i == 2)
		return;
	if (!p->moved)
		p->scale[0] = p->scale[1] = 1;
	p->moved = true;
	(use == SCALE ? p->scale : p->offset)[i] = value;
}

/* Uses an argument. Returns what it should be if it cannot. */
static const char *use_argument(enum use use, int i, word argument, stated_map *to)
{
	const bool one_letter = argument.end - argument.begin == 1;
	float value = 0;
	if (use == CLAMP) {
		const bool on = argument.end - argument.begin == 2 && strncasecmp(argument.begin, "on", 2) == 0;
		const bool off = argument.end - argument.begin == 3 && strncasecmp(argument.begin, "off", 3) == 0;
		to->map.placement.clamp = on;
		return on || off ? NULL : "on or off";
	}
	if (use == CHANNEL) {
		if (!one_letter || !strchr("rgbmlz", *argument.begin))
			return "r, g, b, m, l or z";
		to->map.channel = *argument.begin;
		return NULL;
	}
	if (use == NOTHING)
		return NULL;
	if (!is_number(argument, &value))
		return "a finite number";
	use_number(use, i, value, to);
	return NULL;
}

/* Takes an option's arguments. Arguments beyond the least have to be numbers and must leave a word, which
 * is the file name. Returns where the next word may begin. */
static const char *take_arguments(const reader *r, size_t option, const char *p, stated_map *to)
{
	for (int i = 0; i < options[option].most; i++) {
		const word argument = next_word(p, r->end), behind = next_word(argument.end, r->end);
		float value = 0;
		if (i >= options[option].least && (!is_number(argument, &value) || behind.begin == behind.end))
			break;
		const char *expected = use_argument(options[option].use, i, argument, to);
		const size_t length = (size_t)(argument.end - argument.begin);
		if (expected && length)
			find(r, NT_CODE_MATERIAL_LOST, r->line, "%s of %.*s: found \"%.*s\", expected %s",
				options[option].name, NT_CUT_OF(64, r->word_length, r->word),
				NT_CUT_OF(64, length, argument.begin), expected);
		p = argument.end;
	}
	return p;
}

/* Cuts "-bm 0.5" off the end of the name: some exporters put it there. */
static word take_trailing_scale(word name, stated_map *to)
{
	const char *p = name.end;
	while (p > name.begin && !is_blank(p[-1]))
		p--;
	const word last = {p, name.end};
	while (p > name.begin && is_blank(p[-1]))
		p--;
	float value;
	if (p - name.begin < 5 || memcmp(p - 3, "-bm", 3) != 0 || !is_blank(p[-4]) || !is_number(last, &value))
		return name;
	to->scale = value;
	for (p -= 3; p > name.begin && is_blank(p[-1]);)
		p--;
	return (word){name.begin, p};
}

/* Reads what follows the statement's word; the file name is returned, empty if there is none. An option that is not
 * known begins it: names may begin with a dash. */
static word read_options(const reader *r, stated_map *to)
{
	*to = (stated_map){.map = nt_map_of(NULL), .scale = 1};
	word w = next_word(r->text, r->end);
	for (size_t i = 0; i < OPTION_COUNT;)
		if (is_word(w, options[i].name)) {
			w = next_word(take_arguments(r, i, w.end, to), r->end);
			i = 0;
		} else {
			i++;
		}
	nt_placement *p = &to->map.placement;
	p->moved = p->moved && (p->scale[0] != 1 || p->scale[1] != 1 || p->offset[0] != 0 || p->offset[1] != 0);
	return take_trailing_scale((word){w.begin, r->end}, to);
}

char *nt_mtl_file_name(nt_arena *arena, const char *text, const char *end)
{
	if (end - text >= 2 && text[0] == '"' && end[-1] == '"') {
		text++;
		end--;
	}
	char *name = nt_arena_text(arena, text, (size_t)(end - text));
	for (char *p = name; p && *p; p++)
		if (*p == '\\')
			*p = '/';
	return name;
}

/* A map; MTL_MAP_COUNT: one that has no place in a glTF. "map_Kd" alone and "" are none: exporters write them. */
static nt_status read_map(reader *r, mtl_map which)
{
	stated_map read;
	const word file = read_options(r, &read);
	if (file.begin == file.end)
		return NT_OK;
	if (which == MTL_MAP_COUNT) {
		lose(r, NT_CODE_MATERIAL_LOST, "");
		return NT_OK;
	}
	if (read.turbulent)
		lose(r, NT_CODE_MATERIAL_LOST, "-t of ");
	if (read.map.channel == 'z') {
		lose(r, NT_CODE_MATERIAL_LOST, "-imfchan z of ");
		read.map.channel = 0;
	}
	read.map.name = nt_mtl_file_name(&r->scene->arena, file.begin, file.end);
	read.map.line = r->line;
	read.word = nt_arena_text(&r->scene->arena, r->word, r->word_length);
	if (!read.map.name || !read.word)
		return nt_fail_memory(r->error);
	if (!*read.map.name)
		return NT_OK;
	/* Substance Painter writes heights as bump and normals as map_Bump */
	const stated_map *earlier = &r->said.maps[which];
	if (earlier->map.name && strcmp(earlier->map.name, read.map.name) != 0)
		find(r, NT_CODE_MATERIAL_LOST, earlier->map.line, "%.*s, replaced by a later %.*s",
			NT_CUT(64, earlier->word), NT_CUT(64, read.word));
	r->said.maps[which] = read;
	return NT_OK;
}

/* ---- what the statements of a material come to ---- */

static bool has(const reader *r, mtl_value which)
{
	return r->said.values[which].line != 0;
}

static float number(const reader *r, mtl_value which)
{
	return r->said.values[which].value[0];
}

/* The stated number, from 0 to 1; else `otherwise`. */
static float unit(const reader *r, mtl_value which, float otherwise)
{
	const float value = number(r, which);
	return !has(r, which) ? otherwise : value < 0 ? 0 : value > 1 ? 1 : value;
}

static bool is_black(const float color[3])
{
	return color[0] == 0 && color[1] == 0 && color[2] == 0;
}

static bool is_said_black(const reader *r, mtl_value which)
{
	return has(r, which) && is_black(r->said.values[which].value);
}

static bool has_map(const reader *r, mtl_map which)
{
	return r->said.maps[which].map.name != NULL;
}

static void lose_map(const reader *r, mtl_map which, const char *why)
{
	if (has_map(r, which))
		find(r, NT_CODE_MATERIAL_LOST, r->said.maps[which].map.line, "%s%s", r->said.maps[which].word, why);
}

/* A map of colours. */
static void take_color_map(const reader *r, mtl_map which, nt_map *map)
{
	*map = r->said.maps[which].map;
	if (map->channel)
		find(r, NT_CODE_MATERIAL_LOST, map->line, "-imfchan of %s", r->said.maps[which].word);
	map->channel = 0;
}

/* A map of numbers, of which a + b v is wanted. */
static void take_map(const reader *r, mtl_map which, float a, float b, nt_map *map)
{
	*map = r->said.maps[which].map;
	map->base = a + b * map->base;
	map->gain *= b;
	map->factor = 1;
}

/* Maps that are taken as they are, in this order: the first for its purpose counts. */
#define MAP_AT(name) ((offsetof(nt_material, name) - offsetof(nt_material, maps)) / sizeof(nt_map))
static const struct {
	mtl_map from;
	size_t to;        /* number in nt_material.maps */
	mtl_value scale;  /* the number that a map is multiplied by; MTL_VALUE_COUNT: none */
	char channel;     /* of an image that has several things; 0: as the statement says */
} taken[] = {
	{MTL_MAP_PR, MAP_AT(roughness_map), MTL_PR, 0},
	{MTL_MAP_PM, MAP_AT(metallic_map), MTL_PM, 0},
	{MTL_MAP_AO, MAP_AT(occlusion_map), MTL_VALUE_COUNT, 0},
	{MTL_MAP_ORM, MAP_AT(occlusion_map), MTL_VALUE_COUNT, 'r'},
	{MTL_MAP_ORM, MAP_AT(roughness_map), MTL_PR, 'g'},
	{MTL_MAP_ORM, MAP_AT(metallic_map), MTL_PM, 'b'},
	{MTL_MAP_RMA, MAP_AT(occlusion_map), MTL_VALUE_COUNT, 'b'},
	{MTL_MAP_RMA, MAP_AT(roughness_map), MTL_PR, 'r'},
	{MTL_MAP_RMA, MAP_AT(metallic_map), MTL_PM, 'g'},
	{MTL_MAP_REFL, MAP_AT(metallic_map), MTL_VALUE_COUNT, 0}, /* Blender's */
	{MTL_MAP_PC, MAP_AT(clearcoat_map), MTL_PC, 0},
	{MTL_MAP_PCR, MAP_AT(clearcoat_roughness_map), MTL_PCR, 0}, /* of a clearcoat that is there */
	{MTL_MAP_PS, MAP_AT(sheen_map), MTL_PS, 0},
};

static void take_maps(const reader *r)
{
	nt_material *m = r->m;
	const bool coated = m->clearcoat > 0 || has_map(r, MTL_MAP_PC);
	for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
		const mtl_map from = taken[i].from;
		const mtl_value scale = taken[i].scale;
		nt_map *map = &m->maps[taken[i].to];
		const bool meant = from == MTL_MAP_REFL ? r->blender : from == MTL_MAP_PCR ? coated : true;
		if (map->name || !has_map(r, from) || !meant)
			continue;
		take_map(r, from, 0, 1, map);
		if (taken[i].channel)
			map->channel = taken[i].channel;
		if (scale != MTL_VALUE_COUNT && !r->blender && unit(r, scale, 0) != 0)
			map->factor = unit(r, scale, 0);
	}
}

static void settle_colors(const reader *r)
{
	nt_material *m = r->m;
	for (int k = 0; k < 3; k++) {
		if (has(r, MTL_KD))
			m->base_color[k] = fminf(r->said.values[MTL_KD].value[k], 1);
		m->emissive[k] = r->said.values[MTL_KE].value[k];
	}
	take_color_map(r, MTL_MAP_KD, &m->base_color_map);
	take_color_map(r, MTL_MAP_KE, &m->emissive_map);
	if (m->base_color_map.name && is_black(m->base_color))
		find(r, NT_CODE_MATERIAL_DOUBTFUL, r->said.values[MTL_KD].line,
			"black Kd beside a map: the map counts");
	const char *ambient = r->said.maps[MTL_MAP_KA].map.name, *color = m->base_color_map.name;
	if (ambient && !is_said_black(r, MTL_KA) && !(color && strcmp(ambient, color) == 0))
		lose_map(r, MTL_MAP_KA, "");
}

static void settle_alpha(const reader *r)
{
	nt_material *m = r->m;
	const mtl_value which = has(r, MTL_D) ? MTL_D : MTL_TR;
	const size_t line = r->said.values[which].line;
	const float rest = 1 - unit(r, MTL_TR, 0);
	float alpha = unit(r, MTL_D, rest);
	if (has(r, MTL_D) && has(r, MTL_TR) && fabsf(alpha - rest) > SAME_NUMBER)
		find(r, NT_CODE_MATERIAL_DOUBTFUL, line, "d %g and Tr %g are different: d counts",
			(double)number(r, MTL_D), (double)number(r, MTL_TR));
	if (alpha == 0) {
		find(r, NT_CODE_MATERIAL_DOUBTFUL, line, "%s makes it invisible: taken as opaque",
			which == MTL_D ? "d 0" : "Tr 1");
		alpha = 1;
	}
	m->base_color[3] = alpha;
	if (has_map(r, MTL_MAP_D))
		take_map(r, MTL_MAP_D, 0, 1, &m->alpha_map);
	else if (has_map(r, MTL_MAP_TR))
		take_map(r, MTL_MAP_TR, 1, -1, &m->alpha_map);
	m->alpha_map.factor = r->blender ? 1 : alpha;
}

/* Whether there are highlights: the illumination models 0 and 1 have none, nor has black Ks. Blender means nothing by
 * either. */
static bool shines(const reader *r)
{
	const bool model = has(r, MTL_ILLUM) && number(r, MTL_ILLUM) < 2;
	return has(r, MTL_NS) && (r->blender || (!model && !is_said_black(r, MTL_KS)));
}

static float roughness_of_ns(const reader *r)
{
	const float n = number(r, MTL_NS);
	if (!shines(r) || !(n > 0))
		return 1;
	if (r->blender)
		return n < 1000 ? 1 - sqrtf(n / 1000) : 0;
	return (float)sqrt(sqrt(2 / ((double)n + 2)));
}

static void settle_reflection(const reader *r)
{
	nt_material *m = r->m;
	nt_map *map = &m->roughness_map;
	m->metallic = unit(r, MTL_PM, 0);
	m->roughness = unit(r, MTL_PR, roughness_of_ns(r));
	m->clearcoat = unit(r, MTL_PC, 0);
	m->clearcoat_roughness = unit(r, MTL_PCR, 0);
	m->sheen = unit(r, MTL_PS, 0);
	m->sheen_roughness = SHEEN_ROUGHNESS;
	m->anisotropy = unit(r, MTL_ANISO, 0);
	/* whole turns change nothing, and many would not be a float */
	m->anisotropy_rotation = (float)(2 * 3.14159265358979323846 * fmod((double)number(r, MTL_ANISOR), 1));
	take_maps(r);
	/* the maps of highlights, if no statement says what the roughness is */
	const bool open = !has(r, MTL_PR) && !map->name;
	if (open && has_map(r, MTL_MAP_NS)) {
		take_map(r, MTL_MAP_NS, 0, 1, map);
		map->exponent = r->blender ? 0 : number(r, MTL_NS) > 0 ? number(r, MTL_NS) : LARGEST_NS;
	} else if (open && has_map(r, MTL_MAP_KS) && shines(r)) {
		/* white shines as Ns says, black not at all */
		take_map(r, MTL_MAP_KS, 1, m->roughness - 1, map);
	}
	if (has_map(r, MTL_MAP_ORM))
		lose_map(r, MTL_MAP_RMA, " beside map_ORM");
	if (r->said.maps[MTL_MAP_REFL].map.line != m->metallic_map.line)
		lose_map(r, MTL_MAP_REFL, "");
	for (mtl_map which = MTL_MAP_KS; which <= MTL_MAP_NS; which++)
		if (r->said.maps[which].map.line != map->line)
			lose_map(r, which, "");
}

/* Ni 1 (and 0) is what programs write that know no refraction. */
static void settle_refraction(const reader *r)
{
	const float ni = number(r, MTL_NI), *filter = r->said.values[MTL_TF].value;
	if (ni > 1)
		r->m->ior = ni;
	else if (ni != 0 && ni < 1)
		find(r, NT_CODE_MATERIAL_DOUBTFUL, r->said.values[MTL_NI].line, "Ni %g is below 1: not used",
			(double)ni);
	if (filter[0] != filter[1] || filter[0] != filter[2])
		find(r, NT_CODE_MATERIAL_LOST, r->said.values[MTL_TF].line, "Tf");
}

/* Normal maps come before bump maps, whatever their order. */
static void settle_normals(const reader *r)
{
	nt_material *m = r->m;
	const stated_map *norm = &r->said.maps[MTL_MAP_NORM], *bump = &r->said.maps[MTL_MAP_BUMP];
	const stated_map *map = norm->map.name ? norm : bump;
	if (!map->map.name)
		return;
	m->normal_map = map->map;
	m->normal_scale = map->scale;
	if (map == bump)
		m->bump = bump->word;
	else if (bump->map.name && strcmp(bump->map.name, norm->map.name) != 0)
		find(r, NT_CODE_MATERIAL_LOST, bump->map.line, "%.*s, replaced by %.*s",
			NT_CUT(64, bump->word), NT_CUT(64, norm->word));
	m->bump_is_normal = r->any_blender;
}

/* The statements of a material are all there. */
static void end_material(reader *r)
{
	if (r->m) {
		settle_colors(r);
		settle_alpha(r);
		settle_reflection(r);
		settle_refraction(r);
		settle_normals(r);
	}
	memset(&r->said, 0, sizeof r->said);
}

/* ---- statements ---- */

/* A damaged value is not used. HINT: one without which a material can do, so that this is an info. */
enum action { VALUE, HINT, MAP, PASS_OVER };

/* Words of the specification, of its extension for PBR (exocortex.com, 2015), of Model I/O (map_roughness ...) and of
 * assimp (map_emissive ...). */
static const struct {
	const char *word;
	enum action action;
	int which;
} statements[] = {
	{"Ka", HINT, MTL_KA}, {"Kd", VALUE, MTL_KD}, {"Ke", VALUE, MTL_KE}, {"Ks", HINT, MTL_KS}, {"Tf", HINT, MTL_TF},
	{"d", VALUE, MTL_D}, {"Tr", VALUE, MTL_TR}, {"Pr", VALUE, MTL_PR}, {"Pm", VALUE, MTL_PM},
	{"Ns", HINT, MTL_NS}, {"Ni", HINT, MTL_NI}, {"illum", HINT, MTL_ILLUM},
	{"Ps", HINT, MTL_PS}, {"Pc", HINT, MTL_PC}, {"Pcr", HINT, MTL_PCR},
	{"aniso", HINT, MTL_ANISO}, {"anisor", HINT, MTL_ANISOR},
	{"map_Kd", MAP, MTL_MAP_KD}, {"map_Ka", MAP, MTL_MAP_KA}, {"map_Ke", MAP, MTL_MAP_KE},
	{"map_emissive", MAP, MTL_MAP_KE}, {"map_d", MAP, MTL_MAP_D}, {"map_Tr", MAP, MTL_MAP_TR},
	{"map_Ks", MAP, MTL_MAP_KS}, {"map_Ns", MAP, MTL_MAP_NS}, {"map_Pr", MAP, MTL_MAP_PR},
	{"map_roughness", MAP, MTL_MAP_PR}, {"map_Pm", MAP, MTL_MAP_PM}, {"map_metallic", MAP, MTL_MAP_PM},
	{"map_Ps", MAP, MTL_MAP_PS}, {"map_Pc", MAP, MTL_MAP_PC}, {"map_Pcr", MAP, MTL_MAP_PCR},
	{"map_ao", MAP, MTL_MAP_AO}, {"map_ORM", MAP, MTL_MAP_ORM}, {"map_RMA", MAP, MTL_MAP_RMA},
	{"refl", MAP, MTL_MAP_REFL}, {"map_refl", MAP, MTL_MAP_REFL}, {"norm", MAP, MTL_MAP_NORM},
	{"map_Kn", MAP, MTL_MAP_NORM}, {"map_tangentSpaceNormal", MAP, MTL_MAP_NORM}, {"map_Bump", MAP, MTL_MAP_BUMP},
	{"bump", MAP, MTL_MAP_BUMP}, {"disp", MAP, MTL_MAP_COUNT}, {"decal", MAP, MTL_MAP_COUNT},
	{"map_aat", PASS_OVER, 0}, {"Km", PASS_OVER, 0}, {"sharpness", PASS_OVER, 0},
};

static nt_status begin_material(reader *r)
{
	end_material(r);
	nt_mtl *mtl = r->mtl;
	const size_t length = (size_t)(r->end - r->text);
	const char *raw_name = nt_arena_text(&r->scene->arena, r->text, length);
	const char *name = obj_utf8_text(&r->scene->arena, r->text, length);
	if (!raw_name || !name ||
		!nt_grow((void **)&mtl->definitions, &mtl->capacity, mtl->count + 1, sizeof *mtl->definitions))
		return nt_fail_memory(r->error);
	nt_mtl_definition *d = &mtl->definitions[mtl->count++];
	*d = (nt_mtl_definition){nt_material_default(name), raw_name, length};
	d->material.library = r->path;
	d->material.line = r->line;
	r->m = &d->material;
	return NT_OK;
}

static nt_status read_statement(reader *r)
{
	nt_error fault = {.status = NT_OK}, *error = r->error;
	if (r->word_length == 6 && strncasecmp(r->word, "newmtl", 6) == 0)
		return begin_material(r);
	for (size_t i = 0; r->m && i < sizeof statements / sizeof statements[0]; i++) {
		if (strlen(statements[i].word) != r->word_length ||
			strncasecmp(statements[i].word, r->word, r->word_length) != 0)
			continue;
		switch (statements[i].action) {
		case VALUE:
		case HINT:
			r->error = &fault;
			if (read_value(r, (mtl_value)statements[i].which) && statements[i].action == HINT)
				lose(r, NT_CODE_STATEMENT_IGNORED, "");
			else if (fault.status)
				find(r, NT_CODE_MATERIAL_LOST, r->line, "%s: %s", statements[i].word, fault.message);
			r->error = error;
			return NT_OK;
		case MAP:
			return read_map(r, (mtl_map)statements[i].which);
		case PASS_OVER:
			return NT_OK;
		}
	}
	if (r->word_length > 4 && strncasecmp(r->word, "map_", 4) == 0)
		return read_map(r, MTL_MAP_COUNT);
	lose(r, NT_CODE_STATEMENT_IGNORED, "");
	return NT_OK;
}

nt_status nt_mtl_parse(nt_scene *scene, const char *path, const unsigned char *bytes, size_t size, nt_mtl *mtl,
	nt_error *error)
{
	reader r = {.scene = scene, .path = path, .mtl = mtl, .line = 1, .error = error};
	const char *p = (const char *)bytes, *const end = p + size;
	if (size >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0)
		p += 3;
	while (p < end) {
		const char *line_end = p;
		while (line_end < end && *line_end != '\n' && *line_end != '\r')
			line_end++;
		const word first = next_word(p, line_end);
		r.word = first.begin;
		r.word_length = (size_t)(first.end - first.begin);
		r.text = next_word(first.end, line_end).begin;
		r.end = line_end;
		while (r.end > r.text && is_blank(r.end[-1]))
			r.end--;
		const bool comment = r.word_length && r.word[0] == '#';
		const nt_status status = r.word_length && !comment ? read_statement(&r) : NT_OK;
		if (status)
			return status;
		/* "# Blender 3.2.1 MTL File: ...". Older ones have no number there. */
		if (comment && r.end - r.text > 8 && memcmp(r.text, "Blender ", 8) == 0) {
			r.any_blender = true;
			r.blender |= r.text[8] >= '0' && r.text[8] <= '9';
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
	nt_key_set_free(&mtl->files);
	*mtl = (nt_mtl){0};
}
