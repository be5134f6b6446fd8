/* SPDX-License-Identifier: MIT */
/*
 * Options come first by the format, "-bm 0.5 name.png"; some exporters put -bm behind the name. An
 * option that is not known begins the file name: names may begin with a dash.
 */
#include "obj/mtl.h"

#include <math.h>
#include <string.h>
#include <strings.h>
#include "ext/number.h"

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

static bool is_number(word w, float *value)
{
	return w.begin < w.end && nt_read_float(w.begin, w.end, value) == w.end && isfinite(*value);
}

static size_t find_option(word w)
{
	size_t i = 0;
	const size_t length = (size_t)(w.end - w.begin);
	while (i < OPTION_COUNT &&
		(strlen(options[i].name) != length || memcmp(options[i].name, w.begin, length) != 0))
		i++;
	return i;
}

/* Argument i of an option is this number. A third one is of textures with depth, which images are not. */
static void use_number(enum use use, int i, float value, nt_mtl_map *map)
{
	nt_placement *p = &map->placement;
	if (use == BUMP_SCALE)
		map->bump_scale = value;
	if (use == RANGE)
		*(i ? &map->gain : &map->base) = value;
	if (use == TURBULENCE)
		map->turbulent = map->turbulent || value != 0;
	if ((use != SCALE && use != OFFSET) || i == 2)
		return;
	if (!p->moved)
		p->scale[0] = p->scale[1] = 1;
	p->moved = true;
	(use == SCALE ? p->scale : p->offset)[i] = value;
}

/* Takes an option's arguments. Arguments beyond the least have to be numbers and must leave a word, which
 * is the file name. Returns where the next word may begin. */
static const char *take_arguments(size_t option, const char *p, const char *end, nt_mtl_map *map)
{
	for (int i = 0; i < options[option].most; i++) {
		const word argument = next_word(p, end);
		const word behind = next_word(argument.end, end);
		float value = 0;
		const bool number = is_number(argument, &value);
		if (i >= options[option].least && (!number || behind.begin == behind.end))
			break;
		if (number)
			use_number(options[option].use, i, value, map);
		else if (options[option].use == CLAMP)
			map->placement.clamp =
				argument.end - argument.begin == 2 && strncasecmp(argument.begin, "on", 2) == 0;
		else if (options[option].use == CHANNEL && argument.end - argument.begin == 1 &&
			strchr("rgbmlz", *argument.begin))
			map->channel = *argument.begin;
		p = argument.end;
	}
	return p;
}

/* Cuts "-bm 0.5" off the end of the name. */
static void take_trailing_scale(nt_mtl_map *map)
{
	const char *p = map->name_end;
	while (p > map->name_begin && !is_blank(p[-1]))
		p--;
	const word last = {p, map->name_end};
	while (p > map->name_begin && is_blank(p[-1]))
		p--;
	if (p - map->name_begin < 5 || memcmp(p - 3, "-bm", 3) != 0 || !is_blank(p[-4]))
		return;
	float value;
	if (!is_number(last, &value))
		return;
	map->bump_scale = value;
	for (p -= 3; p > map->name_begin && is_blank(p[-1]); p--)
		;
	map->name_end = p;
}

void nt_mtl_map_read(const char *text, const char *end, nt_mtl_map *map)
{
	*map = (nt_mtl_map){.bump_scale = 1, .gain = 1};
	word w = next_word(text, end);
	for (size_t option; (option = find_option(w)) < OPTION_COUNT;)
		w = next_word(take_arguments(option, w.end, end, map), end);
	map->name_begin = w.begin;
	map->name_end = end;
	take_trailing_scale(map);
	nt_placement *p = &map->placement;
	p->moved = p->moved && (p->scale[0] != 1 || p->scale[1] != 1 || p->offset[0] != 0 || p->offset[1] != 0);
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
