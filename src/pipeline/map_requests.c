/* SPDX-License-Identifier: MIT */
/*
 * From maps to images: see map_requests.h. glTF has alpha beside the base colour, roughness and metallic (green and
 * blue) in one image, in which occlusion (red) may be, too, and so may clearcoat (red) and its roughness (green).
 */
#include "pipeline/map_requests.h"

#include <string.h>

double nt_bump_height(const nt_settings *settings)
{
	return settings->bump_height > 0 ? settings->bump_height : 1.0 / 64;
}

static bool has(const nt_map *map)
{
	return map->name && *map->name;
}

static nt_channel_map channel_map(const nt_map *map, nt_channel otherwise)
{
	const char *letters = "rgbml", *letter = map->channel ? strchr(letters, map->channel) : NULL;
	return (nt_channel_map){.channel = letter ? (nt_channel)(letter - letters) : otherwise, .base = map->base,
		.gain = map->gain, .exponent = map->exponent};
}

/* A channel of numbers. */
static void put_number(nt_map_request *w, int channel, nt_map *map, nt_channel otherwise)
{
	w->maps[channel] = map;
	w->what.channels[channel] = (nt_texture_channel){true, map->name, map->given, channel_map(map, otherwise)};
}

/* A channel without a map is white where somebody samples it. */
static void put_white(nt_map_request *w, int channel, bool used)
{
	w->what.channels[channel].used |= used;
}

/* Red, green and blue of a map of colours. */
static void put_colors(nt_map_request *w, nt_map *map)
{
	for (int k = 0; k < 3; k++) {
		w->what.channels[k] = (nt_texture_channel){true, map->name, map->given,
			channel_map(map, (nt_channel)k)};
		w->what.channels[k].map.channel = (nt_channel)k;
	}
	w->maps[0] = map;
}

/* ---- requests ---- */

static nt_map_request *begin(nt_map_request *requests, size_t *count, nt_texture_kind kind, const char *suffix)
{
	nt_map_request *w = &requests[(*count)++];
	*w = (nt_map_request){.what = {.kind = kind, .suffix = suffix}};
	return w;
}

/* Maps of one image lie at one place; the first of them says where, and others that do not are left out. */
static bool fits(const nt_map *map, const nt_map *first)
{
	const nt_placement *a = &map->placement, *b = &first->placement;
	return has(map) && (!has(first) || (a->clamp == b->clamp && a->moved == b->moved &&
		(!a->moved || (memcmp(a->scale, b->scale, sizeof a->scale) == 0 &&
			memcmp(a->offset, b->offset, sizeof a->offset) == 0))));
}

static void request_colors(nt_map *colors, nt_map *alpha, nt_map_request *requests, size_t *count)
{
	const bool with_alpha = alpha && fits(alpha, colors),
		packed = with_alpha || (has(colors) && !nt_map_is_plain(colors));
	if (!packed && !has(colors))
		return;
	nt_map_request *w = begin(requests, count, packed ? NT_TEXTURE_PACKED : NT_TEXTURE_COLOR,
		with_alpha ? "-alpha" : "-adjusted");
	if (has(colors))
		put_colors(w, colors);
	if (with_alpha)
		put_number(w, 3, alpha, NT_CHANNEL_OPACITY);
	for (int k = 0; k < 3 && packed; k++)
		put_white(w, k, true);
	w->what.clamp = (has(colors) ? colors : alpha)->placement.clamp;
}

/* Maps of numbers, in channels from `first` on. */
static nt_map_request *request_numbers(nt_map *const maps[], int first, int map_count, const char *suffix,
	nt_map_request *requests, size_t *count)
{
	nt_map_request *w = begin(requests, count, NT_TEXTURE_PACKED, suffix);
	for (int k = 0; k < map_count; k++)
		if (has(maps[k]))
			put_number(w, first + k, maps[k], NT_CHANNEL_LUMINANCE);
	for (int k = map_count; k-- > 0;)
		w->what.clamp = has(maps[k]) ? maps[k]->placement.clamp : w->what.clamp;
	return w;
}

static void request_reflection(nt_material *m, nt_map_request *requests, size_t *count)
{
	nt_map none = {0}, *roughness = &m->roughness_map, *occlusion = &m->occlusion_map;
	nt_map *metallic = fits(&m->metallic_map, roughness) ? &m->metallic_map : &none;
	const nt_map *leader = has(roughness) ? roughness : metallic;
	const bool together = has(leader) && fits(occlusion, leader);
	if (has(occlusion) && !together)
		request_numbers(&occlusion, 0, 1, "-occlusion", requests, count);
	if (!has(leader))
		return;
	nt_map *const maps[] = {together ? occlusion : &none, roughness, metallic};
	nt_map_request *w = request_numbers(maps, 0, 3, "-orm", requests, count);
	/* a factor of 0 leaves nothing of a channel */
	put_white(w, 1, m->roughness > 0);
	put_white(w, 2, m->metallic > 0);
}

static void request_layers(nt_material *m, nt_map_request *requests, size_t *count)
{
	nt_map *const coat[] = {&m->clearcoat_map, &m->clearcoat_roughness_map};
	if (has(coat[0]) && fits(coat[1], coat[0])) {
		request_numbers(coat, 0, 2, "-clearcoat", requests, count);
	} else {
		for (int k = 0; k < 2; k++)
			if (has(coat[k]))
				request_numbers(&coat[k], k, 1, "-clearcoat", requests, count);
	}
	if (has(&m->sheen_map)) {
		nt_map *const sheen[] = {&m->sheen_map, &m->sheen_map, &m->sheen_map};
		nt_map_request *w = request_numbers(sheen, 0, 3, "-sheen", requests, count);
		for (int k = 0; k < 3; k++)
			w->what.channels[k].map.srgb = true;
	}
}

/* A channel that is named is a height map's. */
static nt_texture_kind kind_of_normals(const nt_material *m, nt_bump bump)
{
	const char channel = m->normal_map.channel;
	if (bump == NT_BUMP_AUTO)
		return channel && channel != 'l' ? NT_TEXTURE_HEIGHTS : NT_TEXTURE_NORMALS_OR_HEIGHTS;
	return m->bump && bump == NT_BUMP_HEIGHT ? NT_TEXTURE_HEIGHTS : NT_TEXTURE_NORMALS;
}

static void request_normals(nt_material *m, const nt_settings *settings, nt_map_request *requests, size_t *count)
{
	if (!has(&m->normal_map) || (m->bump && settings->bump == NT_BUMP_IGNORE))
		return;
	nt_map_request *w = begin(requests, count, kind_of_normals(m, settings->bump), NULL);
	put_number(w, 0, &m->normal_map, NT_CHANNEL_LUMINANCE);
	w->what.clamp = m->normal_map.placement.clamp;
	w->what.height = nt_bump_height(settings) * m->normal_scale;
}

size_t nt_map_requests(nt_material *m, const nt_settings *settings, nt_map_request requests[NT_MATERIAL_MAPS])
{
	size_t count = 0;
	request_colors(&m->base_color_map, &m->alpha_map, requests, &count);
	request_colors(&m->emissive_map, NULL, requests, &count);
	request_reflection(m, requests, &count);
	request_layers(m, requests, &count);
	request_normals(m, settings, requests, &count);
	return count;
}

void nt_map_request_settle(nt_material *m, const nt_map_request *w, unsigned lost)
{
	for (int k = 0; k < 4; k++)
		if (w->maps[k] && lost >> k & 1)
			w->maps[k]->request = NT_NONE;
	if (m->clearcoat == 0 && m->clearcoat_map.request == NT_NONE)
		m->clearcoat_roughness_map.request = NT_NONE;
}
