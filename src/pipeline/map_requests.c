/* SPDX-License-Identifier: MIT */
/*
 * The images that are requested for the maps of a material: one image each, or one for those that glTF has in one. It
 * has alpha beside the base colour, roughness and metallic (green and blue) in one image, in which occlusion (red) may
 * be, too, and so may clearcoat (red) and its roughness (green).
 */
#include "pipeline/stages.h"

#include <string.h>

double nt_bump_height(const nt_settings *settings)
{
	return settings->bump_height > 0 ? settings->bump_height : 1.0 / 64;
}

static bool has(const nt_map *map)
{
	return map && map->name && *map->name;
}

/* Maps of one image lie at one place; the first of them says where, and others that do not are left out. */
static bool fits(const nt_map *map, const nt_map *first)
{
	const nt_placement *a = &map->placement, *b = first ? &first->placement : NULL;
	return has(map) && (!has(first) || (a->clamp == b->clamp && a->moved == b->moved &&
		(!a->moved || (memcmp(a->scale, b->scale, sizeof a->scale) == 0 &&
			memcmp(a->offset, b->offset, sizeof a->offset) == 0))));
}

static nt_map_request *begin(nt_map_request *requests, size_t *count, nt_texture_kind kind, const char *suffix)
{
	nt_map_request *w = &requests[(*count)++];
	*w = (nt_map_request){.what = {.kind = kind, .suffix = suffix}};
	return w;
}

/* A channel of a map, by its letter; otherwise: if it has none. The first map of an image says what is beyond it. */
static void put(nt_map_request *w, int channel, nt_map *map, nt_channel otherwise)
{
	const char *letters = "rgbml", *letter = map->channel ? strchr(letters, map->channel) : NULL;
	bool first = true;
	for (int k = 0; k < 4; k++)
		first &= !w->what.channels[k].name;
	w->what.clamp = first ? map->placement.clamp : w->what.clamp;
	w->maps[channel] = map;
	w->what.channels[channel] = (nt_texture_channel){true, map->name, map->given,
		{.channel = letter ? (nt_channel)(letter - letters) : otherwise, .base = map->base, .gain = map->gain,
			.exponent = map->exponent}};
}

/* Red, green and blue of a map of colours, which stands for the three once. */
static void request_colors(nt_map *colors, nt_map *alpha, nt_map_request *requests, size_t *count)
{
	const bool with_alpha = alpha && fits(alpha, colors),
		packed = with_alpha || (has(colors) && !nt_map_is_plain(colors));
	if (!packed && !has(colors))
		return;
	nt_map_request *w = begin(requests, count, packed ? NT_TEXTURE_PACKED : NT_TEXTURE_COLOR,
		with_alpha ? "-alpha" : "-adjusted");
	for (int k = 0; k < 3 && has(colors); k++) {
		put(w, k, colors, (nt_channel)k);
		w->what.channels[k].map.channel = (nt_channel)k;
		w->maps[k] = k ? NULL : colors;
	}
	if (with_alpha)
		put(w, 3, alpha, NT_CHANNEL_OPACITY);
	for (int k = 0; k < 3; k++)
		w->what.channels[k].used |= packed;
}

/* Maps of numbers, in channels from `first` on; NULL: there are none. */
static nt_map_request *request_numbers(nt_map *const maps[], int first, int map_count, const char *suffix,
	nt_map_request *requests, size_t *count)
{
	nt_map_request *w = NULL;
	for (int k = 0; k < map_count; k++) {
		if (!has(maps[k]))
			continue;
		w = w ? w : begin(requests, count, NT_TEXTURE_PACKED, suffix);
		put(w, first + k, maps[k], NT_CHANNEL_LUMINANCE);
	}
	return w;
}

static void request_reflection(nt_material *m, nt_map_request *requests, size_t *count)
{
	nt_map *roughness = &m->roughness_map, *occlusion = &m->occlusion_map;
	nt_map *metallic = fits(&m->metallic_map, roughness) ? &m->metallic_map : NULL;
	const nt_map *leader = has(roughness) ? roughness : metallic;
	const bool together = leader && fits(occlusion, leader);
	if (!together)
		request_numbers(&occlusion, 0, 1, "-occlusion", requests, count);
	nt_map *const maps[] = {together ? occlusion : NULL, roughness, metallic};
	nt_map_request *w = request_numbers(maps, 0, 3, "-orm", requests, count);
	if (!w)
		return;
	/* without a map a channel is white where somebody samples it; a factor of 0 leaves nothing of it */
	w->what.channels[1].used |= m->roughness > 0;
	w->what.channels[2].used |= m->metallic > 0;
}

static void request_layers(nt_material *m, nt_map_request *requests, size_t *count)
{
	nt_map *const coat[] = {&m->clearcoat_map, &m->clearcoat_roughness_map};
	const bool together = has(coat[0]) && fits(coat[1], coat[0]);
	request_numbers(coat, 0, together ? 2 : 1, "-clearcoat", requests, count);
	if (!together)
		request_numbers(coat + 1, 1, 1, "-clearcoat", requests, count);
	nt_map *const sheen[] = {&m->sheen_map, &m->sheen_map, &m->sheen_map};
	nt_map_request *w = request_numbers(sheen, 0, 3, "-sheen", requests, count);
	for (int k = 0; w && k < 3; k++)
		w->what.channels[k].map.srgb = true;
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
	put(w, 0, &m->normal_map, NT_CHANNEL_LUMINANCE);
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
