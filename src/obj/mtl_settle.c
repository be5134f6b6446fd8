/* SPDX-License-Identifier: MIT */
/*
 * From MTL's terms to glTF's: what the statements of a newmtl come to together. The man page has the same as a table
 * (MATERIALS OF AN OBJ).
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
#include "obj/mtl.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Numbers that agree but for being rounded in the text. */
static const float SAME_NUMBER = 0.01f;

/* The exponent that white means in a map_Ns without Ns: the largest that programs write. */
static const float LARGEST_NS = 1000;

/* MTL has no roughness of sheen; Blender's is this where nobody says another. */
static const float SHEEN_ROUGHNESS = 0.5f;

/* Files of nonsense have as many different words as lines: beyond this many findings they are one. */
enum { NAMED_FINDINGS_MOST = 1000 };

void nt_mtl_find(nt_scene *scene, nt_code code, const char *path, size_t line, const char *material, const char *detail)
{
	nt_place place = nt_line_place(path, line);
	const bool named = scene->findings.count <= NAMED_FINDINGS_MOST;
	if (named && material)
		snprintf(place.object, sizeof place.object, "material \"%.200s\"", material);
	nt_finding_add(&scene->findings, code, &place, 1, "%s", named ? detail : "MTL: ");
}

typedef struct settling {
	const mtl_values *said;
	nt_scene *scene;
	nt_material *m;
} settling;

static bool has(const settling *s, mtl_number which)
{
	return s->said->numbers[which].line != 0;
}

/* The stated number, from 0 to 1; else `otherwise`. */
static float unit(const settling *s, mtl_number which, float otherwise)
{
	const float value = s->said->numbers[which].value;
	return !has(s, which) ? otherwise : value < 0 ? 0 : value > 1 ? 1 : value;
}

static bool has_map(const settling *s, mtl_map which)
{
	return s->said->maps[which].map.name != NULL;
}

NT_PRINTF(4, 5)
static void find(const settling *s, nt_code code, size_t line, const char *format, ...)
{
	char detail[256];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(detail, sizeof detail, format, arguments);
	va_end(arguments);
	nt_mtl_find(s->scene, code, s->m->library, line, s->m->name, detail);
}

static void lose_map(const settling *s, mtl_map which, const char *why)
{
	if (has_map(s, which))
		find(s, NT_CODE_MATERIAL_LOST, s->said->maps[which].map.line, "MTL: %s%s",
			s->said->maps[which].word, why);
}

/* ---- maps ---- */

/* A map of numbers, of which a + b v is wanted. */
static void take_map(const settling *s, mtl_map which, float a, float b, nt_map *map)
{
	*map = s->said->maps[which].map;
	map->base = a + b * map->base;
	map->gain *= b;
	map->factor = 1;
}

/* A map of numbers, which the number beside it scales. */
static void take_scaled(const settling *s, mtl_map which, mtl_number number, nt_map *map)
{
	take_map(s, which, 0, 1, map);
	const float value = unit(s, number, 1);
	const bool counts = has(s, number) && value != 0 && !s->said->blender;
	map->factor = counts ? value : 1;
}

/* One channel of an image that has three of them in order. */
static void take_channel(const settling *s, mtl_map which, char channel, mtl_number number, nt_map *map)
{
	if (map->name)
		return;
	if (number == MTL_NUMBER_COUNT)
		take_map(s, which, 0, 1, map);
	else
		take_scaled(s, which, number, map);
	map->channel = channel;
}

/* A map of colours. */
static void take_color_map(const settling *s, mtl_map which, nt_map *map)
{
	*map = s->said->maps[which].map;
	if (map->channel)
		find(s, NT_CODE_MATERIAL_LOST, map->line, "MTL: -imfchan of %s", s->said->maps[which].word);
	map->channel = 0;
}

/* ---- properties ---- */

static bool is_black(const float color[3])
{
	return color[0] == 0 && color[1] == 0 && color[2] == 0;
}

static void settle_colors(const settling *s)
{
	nt_material *m = s->m;
	for (int k = 0; k < 3; k++) {
		if (s->said->colors[MTL_KD].line)
			m->base_color[k] = fminf(s->said->colors[MTL_KD].value[k], 1);
		m->emissive[k] = s->said->colors[MTL_KE].value[k];
	}
	take_color_map(s, MTL_MAP_KD, &m->base_color_map);
	take_color_map(s, MTL_MAP_KE, &m->emissive_map);
	if (m->base_color_map.name && is_black(m->base_color))
		find(s, NT_CODE_MATERIAL_DOUBTFUL, s->said->colors[MTL_KD].line,
			"MTL: black Kd beside a map: the map counts");
	const char *ambient = s->said->maps[MTL_MAP_KA].map.name;
	const bool unlit = s->said->colors[MTL_KA].line && is_black(s->said->colors[MTL_KA].value);
	if (ambient && !unlit && !(m->base_color_map.name && strcmp(ambient, m->base_color_map.name) == 0))
		lose_map(s, MTL_MAP_KA, "");
}

static void settle_alpha(const settling *s)
{
	nt_material *m = s->m;
	const mtl_number which = has(s, MTL_D) ? MTL_D : MTL_TR;
	const size_t line = s->said->numbers[which].line;
	float alpha = which == MTL_D ? unit(s, MTL_D, 1) : 1 - unit(s, MTL_TR, 0);
	if (has(s, MTL_D) && has(s, MTL_TR) && fabsf(alpha - (1 - unit(s, MTL_TR, 0))) > SAME_NUMBER)
		find(s, NT_CODE_MATERIAL_DOUBTFUL, line, "MTL: d %g and Tr %g are different: d counts",
			(double)s->said->numbers[MTL_D].value, (double)s->said->numbers[MTL_TR].value);
	if (alpha == 0) {
		find(s, NT_CODE_MATERIAL_DOUBTFUL, line, "MTL: %s makes it invisible: taken as opaque",
			which == MTL_D ? "d 0" : "Tr 1");
		alpha = 1;
	}
	m->base_color[3] = alpha;
	if (has_map(s, MTL_MAP_D))
		take_map(s, MTL_MAP_D, 0, 1, &m->alpha_map);
	else if (has_map(s, MTL_MAP_TR))
		take_map(s, MTL_MAP_TR, 1, -1, &m->alpha_map);
	m->alpha_map.factor = s->said->blender ? 1 : alpha;
}

/* Whether there are highlights: the illumination models 0 and 1 have none, nor has black Ks. Blender means nothing by
 * either. */
static bool shines(const settling *s)
{
	const bool model = has(s, MTL_ILLUM) && s->said->numbers[MTL_ILLUM].value < 2;
	const bool black = s->said->colors[MTL_KS].line && is_black(s->said->colors[MTL_KS].value);
	return has(s, MTL_NS) && (s->said->blender || (!model && !black));
}

static float roughness_of_ns(const settling *s)
{
	const float n = s->said->numbers[MTL_NS].value;
	if (!shines(s) || !(n > 0))
		return 1;
	if (s->said->blender)
		return n < 1000 ? 1 - sqrtf(n / 1000) : 0;
	return (float)sqrt(sqrt(2 / ((double)n + 2)));
}

/* The maps of highlights, where no statement says what the roughness is. */
static void take_highlight_map(const settling *s, nt_map *map)
{
	if (has_map(s, MTL_MAP_NS)) {
		take_map(s, MTL_MAP_NS, 0, 1, map);
		const float n = s->said->numbers[MTL_NS].value;
		map->exponent = s->said->blender ? 0 : has(s, MTL_NS) && n > 0 ? n : LARGEST_NS;
	} else if (has_map(s, MTL_MAP_KS) && shines(s)) {
		/* white shines as Ns says, black not at all */
		take_map(s, MTL_MAP_KS, 1, s->m->roughness - 1, map);
	}
}

static void settle_reflection(const settling *s)
{
	nt_material *m = s->m;
	m->metallic = unit(s, MTL_PM, 0);
	m->roughness = unit(s, MTL_PR, roughness_of_ns(s));
	if (has_map(s, MTL_MAP_PR))
		take_scaled(s, MTL_MAP_PR, MTL_PR, &m->roughness_map);
	if (has_map(s, MTL_MAP_PM))
		take_scaled(s, MTL_MAP_PM, MTL_PM, &m->metallic_map);
	if (has_map(s, MTL_MAP_AO))
		take_map(s, MTL_MAP_AO, 0, 1, &m->occlusion_map);
	const mtl_map packed = has_map(s, MTL_MAP_ORM) ? MTL_MAP_ORM : MTL_MAP_RMA;
	if (has_map(s, packed)) {
		const char *order = packed == MTL_MAP_ORM ? "rgb" : "brg"; /* of occlusion, roughness, metallic */
		take_channel(s, packed, order[0], MTL_NUMBER_COUNT, &m->occlusion_map);
		take_channel(s, packed, order[1], MTL_PR, &m->roughness_map);
		take_channel(s, packed, order[2], MTL_PM, &m->metallic_map);
	}
	if (packed == MTL_MAP_ORM)
		lose_map(s, MTL_MAP_RMA, " beside map_ORM");
	if (s->said->blender && has_map(s, MTL_MAP_REFL) && !m->metallic_map.name)
		take_map(s, MTL_MAP_REFL, 0, 1, &m->metallic_map);
	else
		lose_map(s, MTL_MAP_REFL, "");
	if (!has(s, MTL_PR) && !m->roughness_map.name)
		take_highlight_map(s, &m->roughness_map);
	for (mtl_map which = MTL_MAP_KS; which <= MTL_MAP_NS; which++)
		if (s->said->maps[which].map.line != m->roughness_map.line)
			lose_map(s, which, "");
}

static void settle_layers(const settling *s)
{
	nt_material *m = s->m;
	m->clearcoat = unit(s, MTL_PC, 0);
	m->clearcoat_roughness = unit(s, MTL_PCR, 0);
	if (has_map(s, MTL_MAP_PC))
		take_scaled(s, MTL_MAP_PC, MTL_PC, &m->clearcoat_map);
	if (has_map(s, MTL_MAP_PCR) && (m->clearcoat > 0 || has_map(s, MTL_MAP_PC)))
		take_scaled(s, MTL_MAP_PCR, MTL_PCR, &m->clearcoat_roughness_map);
	m->sheen = unit(s, MTL_PS, 0);
	m->sheen_roughness = SHEEN_ROUGHNESS;
	if (has_map(s, MTL_MAP_PS))
		take_scaled(s, MTL_MAP_PS, MTL_PS, &m->sheen_map);
	m->anisotropy = unit(s, MTL_ANISO, 0);
	/* whole turns change nothing, and many would not be a float */
	m->anisotropy_rotation =
		(float)(2 * 3.14159265358979323846 * fmod((double)s->said->numbers[MTL_ANISOR].value, 1));
}

/* Ni 1 (and 0) is what programs write that know no refraction. */
static void settle_refraction(const settling *s)
{
	const float ni = s->said->numbers[MTL_NI].value;
	if (ni > 1)
		s->m->ior = ni;
	else if (ni != 0 && ni < 1)
		find(s, NT_CODE_MATERIAL_DOUBTFUL, s->said->numbers[MTL_NI].line,
			"MTL: Ni %g is below 1: not used", (double)ni);
	const float *filter = s->said->colors[MTL_TF].value;
	if (filter[0] != filter[1] || filter[0] != filter[2])
		find(s, NT_CODE_MATERIAL_LOST, s->said->colors[MTL_TF].line, "MTL: Tf");
}

/* Normal maps come before bump maps, whatever their order. */
static void settle_normals(const settling *s)
{
	nt_material *m = s->m;
	const mtl_map which = has_map(s, MTL_MAP_NORM) ? MTL_MAP_NORM : MTL_MAP_BUMP;
	if (!has_map(s, which))
		return;
	m->normal_map = s->said->maps[which].map;
	m->normal_scale = s->said->maps[which].scale;
	if (which == MTL_MAP_BUMP)
		m->bump = s->said->maps[which].word;
	else if (has_map(s, MTL_MAP_BUMP) && strcmp(s->said->maps[MTL_MAP_BUMP].map.name, m->normal_map.name) != 0)
		find(s, NT_CODE_MATERIAL_LOST, s->said->maps[MTL_MAP_BUMP].map.line, "MTL: %.64s, replaced by %.64s",
			s->said->maps[MTL_MAP_BUMP].word, s->said->maps[which].word);
	m->bump_is_normal = s->said->any_blender;
}

void nt_mtl_settle(const mtl_values *said, nt_scene *scene, nt_material *m)
{
	const settling s = {said, scene, m};
	settle_colors(&s);
	settle_alpha(&s);
	settle_reflection(&s);
	settle_layers(&s);
	settle_refraction(&s);
	settle_normals(&s);
}
