/* SPDX-License-Identifier: MIT */
/*
 * The result of a material's statements together. Roughness is that of the formula in the man page, worked out by
 * hand: n = 30 gives (2/32)^(1/4) = 1/2, n = 510 gives 1/4.
 */
#include "test.h"
#include <math.h>
#include "obj/parts.h"

typedef struct reading {
	nt_scene scene;
	nt_mtl mtl;
	nt_error error;
} reading;

/* The material of these lines. */
static const nt_material *settle(reading *r, const char *lines)
{
	char text[1000];
	*r = (reading){0};
	snprintf(text, sizeof text, "%snewmtl a\n%s",
		strncmp(lines, "# ", 2) == 0 ? "# Blender 3.6.5 MTL File: 'x'\n" : "", lines);
	nt_scene_init(&r->scene, "a.obj");
	nt_error_clear(&r->error);
	assert_int_equal(nt_mtl_parse(&r->scene, "a.mtl", (const unsigned char *)text, strlen(text), &r->mtl,
		&r->error), NT_OK);
	assert_int_equal(r->mtl.count, 1);
	return &r->mtl.definitions[0].material;
}

static void close_reading(reading *r)
{
	nt_mtl_free(&r->mtl);
	nt_scene_free(&r->scene);
}

/* Whether the only finding is this one; NULL: there is none. */
static void expect_finding(const reading *r, nt_code code, size_t line, const char *detail)
{
	assert_int_equal(r->scene.findings.count, detail != NULL);
	if (!detail)
		return;
	const nt_finding *f = &r->scene.findings.items[0];
	assert_int_equal(f->code, code);
	assert_string_equal(f->detail, detail);
	assert_int_equal(f->place.line, line);
	assert_string_equal(f->place.file, "a.mtl");
	assert_string_equal(f->place.object, "material \"a\"");
}

TEST(roughness_of_highlights)
{
	static const struct {
		const char *lines;
		float roughness;
	} cases[] = {
		{"", 1}, {"Ns 30", 0.5f}, {"Ns 510", 0.25f}, {"Ns 0", 1}, {"Ns -5", 1}, {"Ks 1 1 1", 1},
		{"Ns 30\nKs 0.2 0 0\nillum 2", 0.5f}, {"Ns 30\nKs 0 0 0", 1}, {"illum 1\nNs 30", 1},
		{"illum 0\nNs 30", 1},
		{"Ns 30\nPr 0.125", 0.125f}, {"Pr 2", 1}, {"Ns big\nillum none", 1},
		{"# \nNs 250", 0.5f}, {"# \nNs 0", 1}, {"# \nNs 2000", 0}, {"# \nNs 250\nKs 0 0 0\nillum 1", 0.5f},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		reading r;
		const nt_material *m = settle(&r, cases[i].lines);
		if (fabsf(m->roughness - cases[i].roughness) > 1e-6f)
			fail_msg("%s: roughness %g", cases[i].lines, (double)m->roughness);
		close_reading(&r);
	}
}

TEST(alpha_is_said_in_two_ways)
{
	static const struct {
		const char *lines;
		float alpha;
		size_t line;
		const char *detail;
	} cases[] = {
		{"d 0.25", 0.25f, 0, NULL}, {"Tr 0.25", 0.75f, 0, NULL}, {"d 0.25\nTr 0.75", 0.25f, 0, NULL},
		{"Tr 0.751\nd 0.25", 0.25f, 0, NULL},
		{"Tr 0.5\nd 0.25", 0.25f, 4, "MTL: d 0.25 and Tr 0.5 are different: d counts"},
		{"d 1\nTr 1", 1, 3, "MTL: d 1 and Tr 1 are different: d counts"},
		{"d 0", 1, 3, "MTL: d 0 makes it invisible: taken as opaque"},
		{"Tr 1.0", 1, 3, "MTL: Tr 1 makes it invisible: taken as opaque"},
		{"d 0\nTr 1", 1, 3, "MTL: d 0 makes it invisible: taken as opaque"},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		char lines[100];
		reading r;
		snprintf(lines, sizeof lines, "Kd 1 1 1\n%s", cases[i].lines);
		const nt_material *m = settle(&r, lines);
		assert_true(fabsf(m->base_color[3] - cases[i].alpha) < 1e-6f);
		expect_finding(&r, NT_CODE_MATERIAL_DOUBTFUL, cases[i].line, cases[i].detail);
		close_reading(&r);
	}
}

TEST(layers_are_taken)
{
	reading r;
	const nt_material *m = settle(&r, "Ps 0.5\nPc 0.75\nPcr 0.25\naniso 0.125\nanisor 0.25\nNi 1.33\nTf 1 1 1\n");
	assert_true(m->sheen == 0.5f && m->sheen_roughness == 0.5f);
	assert_true(m->clearcoat == 0.75f && m->clearcoat_roughness == 0.25f);
	assert_true(m->anisotropy == 0.125f && m->anisotropy_rotation == (float)(3.14159265358979323846 / 2));
	assert_true(m->ior == 1.33f);
	expect_finding(&r, NT_CODE_MATERIAL_LOST, 0, NULL);
	close_reading(&r);
	m = settle(&r, "aniso 1\nanisor 3e38");
	assert_true(isfinite(m->anisotropy_rotation));
	close_reading(&r);
	m = settle(&r, "Ni 1.0");
	assert_true(m->ior == 0);
	close_reading(&r);
	m = settle(&r, "Ni 0.5");
	assert_true(m->ior == 0);
	expect_finding(&r, NT_CODE_MATERIAL_DOUBTFUL, 2, "MTL: Ni 0.5 is below 1: not used");
	close_reading(&r);
}

static void check_map(const nt_map *map, const char *name, char channel, float base, float gain, float factor)
{
	assert_string_equal(map->name, name);
	assert_int_equal(map->channel, channel);
	assert_true(fabsf(map->base - base) < 1e-6f && fabsf(map->gain - gain) < 1e-6f);
	assert_true(map->factor == factor);
}

TEST(maps_have_their_numbers)
{
	reading r;
	const nt_material *m = settle(&r,
		"Pr 0.5\nmap_Pr -imfchan g -mm 0.25 0.5 r.png\nPm 0\nmap_Pm m.png\nmap_ao o.png\n"
		"map_Pc c.png\nPcr 0.5\nmap_Pcr cr.png\nmap_Ps s.png\nmap_Tr t.png");
	check_map(&m->roughness_map, "r.png", 'g', 0.25f, 0.5f, 0.5f);
	check_map(&m->metallic_map, "m.png", 0, 0, 1, 1); /* 0 would hide it */
	check_map(&m->occlusion_map, "o.png", 0, 0, 1, 1);
	check_map(&m->clearcoat_map, "c.png", 0, 0, 1, 1);
	check_map(&m->clearcoat_roughness_map, "cr.png", 0, 0, 1, 0.5f);
	check_map(&m->sheen_map, "s.png", 0, 0, 1, 1);
	check_map(&m->alpha_map, "t.png", 0, 1, -1, 1);
	assert_int_equal(m->roughness_map.line, 3);
	expect_finding(&r, NT_CODE_MATERIAL_LOST, 0, NULL);
	close_reading(&r);

	m = settle(&r, "# \nPr 0.5\nmap_Pr r.png\nPm 0.5\nrefl m.png\nd 0.5\nmap_d d.png");
	check_map(&m->roughness_map, "r.png", 0, 0, 1, 1);
	check_map(&m->metallic_map, "m.png", 0, 0, 1, 1);
	check_map(&m->alpha_map, "d.png", 0, 0, 1, 1);
	close_reading(&r);
}

TEST(packed_maps_have_their_order)
{
	reading r;
	const nt_material *m = settle(&r, "map_ORM x.png\nPr 0.5");
	check_map(&m->occlusion_map, "x.png", 'r', 0, 1, 1);
	check_map(&m->roughness_map, "x.png", 'g', 0, 1, 0.5f);
	check_map(&m->metallic_map, "x.png", 'b', 0, 1, 1);
	close_reading(&r);
	m = settle(&r, "map_RMA x.png\nmap_Pm m.png");
	check_map(&m->roughness_map, "x.png", 'r', 0, 1, 1);
	check_map(&m->metallic_map, "m.png", 0, 0, 1, 1);
	check_map(&m->occlusion_map, "x.png", 'b', 0, 1, 1);
	close_reading(&r);
}

/* 1 - (1 - roughness) v of map_Ks. */
TEST(maps_of_highlights)
{
	reading r;
	const nt_material *m = settle(&r, "Ns 30\nKs 1 1 1\nmap_Ks s.png");
	check_map(&m->roughness_map, "s.png", 0, 1, -0.5f, 1);
	close_reading(&r);
	m = settle(&r, "Ns 30\nmap_Ns n.png");
	check_map(&m->roughness_map, "n.png", 0, 0, 1, 1);
	assert_true(m->roughness_map.exponent == 30);
	close_reading(&r);
	m = settle(&r, "map_Ns n.png");
	assert_true(m->roughness_map.exponent == 1000);
	close_reading(&r);
	m = settle(&r, "# \nNs 30\nmap_Ns n.png");
	assert_true(m->roughness_map.exponent == 0);
	close_reading(&r);
}

TEST(what_is_lost_is_named)
{
	static const struct {
		const char *lines, *detail;
	} cases[] = {
		{"map_Ks s.png", "MTL: map_Ks"}, {"map_Kd a.png\nmap_Ka b.png", "MTL: map_Ka"},
		{"map_Kd a.png\nmap_Ka a.png", NULL},
		{"Ka 0 0 0\nmap_Ka b.png", NULL},
		{"Tf 1 0.5 1", "MTL: Tf"}, {"map_refl r.png", "MTL: map_refl"}, {"map_disp r.png", "MTL: map_disp"},
		{"map_Kd -imfchan g a.png", "MTL: -imfchan of map_Kd"},
		{"map_Pr -imfchan z a.png", "MTL: -imfchan z of map_Pr"},
		{"map_ORM a.png\nmap_RMA b.png", "MTL: map_RMA beside map_ORM"}, {"map_Ns n.png\nPr 1", "MTL: map_Ns"},
		{"map_aniso r.png", "MTL: map_aniso"},
		{"bump a.png\nmap_Bump b.png", "MTL: bump, replaced by a later map_Bump"},
		{"map_Bump b.png\nnorm a.png", "MTL: map_Bump, replaced by norm"}, {"norm a.png\nbump a.png", NULL},
		{"map_Bump a\\b.png\nbump a/b.png", NULL}, {"map_Kd a.png\nmap_Kd", NULL},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		reading r;
		settle(&r, cases[i].lines);
		const size_t count = r.scene.findings.count;
		assert_int_equal(count, cases[i].detail != NULL);
		if (count) {
			assert_int_equal(r.scene.findings.items[0].code, NT_CODE_MATERIAL_LOST);
			assert_string_equal(r.scene.findings.items[0].detail, cases[i].detail);
			assert_string_equal(r.scene.findings.items[0].place.object, "material \"a\"");
		}
		close_reading(&r);
	}
}
