/* SPDX-License-Identifier: MIT */
/*
 * Material libraries, from strings and from a folder that the test makes and removes.
 */
#include "folder.h"
#include "test.h"
#include <sys/stat.h>
#include <unistd.h>
#include "obj/parts.h"
#include "obj/read.h"

typedef struct reading {
	nt_scene scene;
	nt_mtl mtl;
	nt_error error;
	nt_status status;
} reading;

static void parse(reading *r, const char *text)
{
	*r = (reading){0};
	nt_scene_init(&r->scene, "a.obj");
	nt_error_clear(&r->error);
	const size_t size = strlen(text);
	unsigned char *bytes = malloc(size ? size : 1);
	memcpy(bytes, text, size);
	r->status = nt_mtl_parse(&r->scene, "lib/a.mtl", bytes, size, &r->mtl, &r->error);
	free(bytes);
}

static const nt_mtl_definition *parse_one(reading *r, const char *text)
{
	parse(r, text);
	assert_int_equal(r->status, NT_OK);
	assert_int_equal(r->mtl.count, 1);
	return &r->mtl.definitions[0];
}

static void close_reading(reading *r)
{
	nt_mtl_free(&r->mtl);
	nt_scene_free(&r->scene);
}

TEST(every_property_is_read)
{
	reading r;
	const nt_mtl_definition *d = parse_one(&r,
		"# c\r\nnewmtl  old  stone \r\n\tKa 1 1 1\r\nKd 0.5 0.25 1\r\nd 0.75\r\nKe 0 2 0.5\r\nPr 0.125\r\n"
		"Pm 1\r\nmap_Kd stone.png\r\nmap_Ke glow.jpg\r\nnorm bumps.png\r\nillum 2\r\nNs 10\r\n");
	assert_string_equal(d->material.name, "old  stone");
	assert_string_equal(d->material.library, "lib/a.mtl");
	assert_int_equal(d->material.line, 2);
	const float color[4] = {0.5f, 0.25f, 1, 0.75f}, emissive[3] = {0, 2, 0.5f};
	assert_memory_equal(d->material.base_color, color, sizeof color);
	assert_memory_equal(d->material.emissive, emissive, sizeof emissive);
	assert_true(d->material.roughness == 0.125f);
	assert_true(d->material.metallic == 1);
	assert_true(d->material.normal_scale == 1);
	assert_string_equal(d->material.base_color_map.name, "stone.png");
	assert_string_equal(d->material.emissive_map.name, "glow.jpg");
	assert_string_equal(d->material.normal_map.name, "bumps.png");
	assert_null(d->material.bump);
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

TEST(defaults_are_those_of_a_plain_material)
{
	reading r;
	const nt_mtl_definition *d = parse_one(&r, "newmtl a");
	const float color[4] = {1, 1, 1, 1}, emissive[3] = {0, 0, 0};
	assert_memory_equal(d->material.base_color, color, sizeof color);
	assert_memory_equal(d->material.emissive, emissive, sizeof emissive);
	assert_true(d->material.roughness == 1);
	assert_true(d->material.metallic == 0);
	assert_null(d->material.base_color_map.name);
	assert_null(d->material.normal_map.name);
	close_reading(&r);
}

TEST(other_spellings_of_values)
{
	reading r;
	const nt_mtl_definition *d =
		parse_one(&r, "newmtl a\nkd 0.5\nTr 0.25\nPR 7\nPm -1\nmap_kd  a b.png \nmap_Ke\n");
	const float color[4] = {0.5f, 0.5f, 0.5f, 0.75f};
	assert_memory_equal(d->material.base_color, color, sizeof color);
	assert_true(d->material.roughness == 1);
	assert_true(d->material.metallic == 0);
	assert_string_equal(d->material.base_color_map.name, "a b.png");
	assert_null(d->material.emissive_map.name);
	close_reading(&r);
	d = parse_one(&r, "newmtl a\nd -halo 0.5\nKd spectral a.rfl 1\n");
	assert_true(d->material.base_color[3] == 0.5f);
	assert_true(d->material.base_color[0] == 1);
	close_reading(&r);
}

TEST(bump_is_kept_apart_and_yields_to_normal_maps)
{
	static const char *const words[] = {"map_Bump", "map_bump", "bump"};
	for (int i = 0; i < 3; i++) {
		char text[100];
		reading r;
		snprintf(text, sizeof text, "newmtl a\n%s -bm 0.5 b.png\n", words[i]);
		const nt_mtl_definition *d = parse_one(&r, text);
		assert_string_equal(d->material.normal_map.name, "b.png");
		assert_true(d->material.normal_scale == 0.5f);
		assert_string_equal(d->material.bump, words[i]);
		assert_int_equal(d->material.normal_map.line, 2);
		close_reading(&r);
	}
	static const char *const both[] = {"newmtl a\nbump -bm 3 b.png\nmap_Kn n.png\n",
		"newmtl a\nmap_Kn n.png\nbump -bm 3 b.png\n", "newmtl a\nnorm n.png\nmap_Bump b.png\n"};
	for (int i = 0; i < 3; i++) {
		reading r;
		const nt_mtl_definition *d = parse_one(&r, both[i]);
		assert_string_equal(d->material.normal_map.name, "n.png");
		assert_true(d->material.normal_scale == 1);
		assert_null(d->material.bump);
		close_reading(&r);
	}
}

TEST(map_options_are_skipped_by_their_arguments)
{
	static const struct {
		const char *text, *name;
		float scale;
		bool turbulent;
	} cases[] = {
		{"a.png", "a.png", 1, false},
		{"a file.png", "a file.png", 1, false},
		{"-bm 0.5 a.png", "a.png", 0.5f, false},
		{"a b.png -bm 0.25", "a b.png", 0.25f, false},
		{"-clamp on -blendu off -blendv on -mm 0 1 -texres 512 -boost 2 -imfchan r a.png", "a.png", 1, false},
		{"-o 1 a.png", "a.png", 1, false},
		{"-s 1 2 3 a.png", "a.png", 1, false},
		{"-t 0.5 0.5 a.png", "a.png", 1, true},
		{"-t 0 0 0 a.png", "a.png", 1, false},
		{"-s 1 2 3 4.png", "4.png", 1, false},
		{"-s 1 2 3", "3", 1, false},
		{"-type sphere -cc on a.png", "a.png", 1, false},
		{"-unknown.png", "-unknown.png", 1, false},
		{"C:\\maps\\a.png", "C:/maps/a.png", 1, false},
		{"..\\a.png", "../a.png", 1, false},
		{"\"a b.png\"", "a b.png", 1, false},
		{"-bm 1", "", 1, false},
		{"-bm", "", 1, false},
		{"-bm 0.5", "", 1, false},
		{"", "", 1, false},
		{"a-bm 1", "a-bm 1", 1, false},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		char text[200];
		reading r;
		snprintf(text, sizeof text, "newmtl a\nbump %s\n", cases[i].text);
		const nt_material *m = &parse_one(&r, text)->material;
		assert_string_equal(m->normal_map.name ? m->normal_map.name : "", cases[i].name);
		assert_true(m->normal_scale == cases[i].scale);
		assert_int_equal(r.scene.findings.count, cases[i].turbulent);
		close_reading(&r);
	}
}

TEST(placements_are_read)
{
	static const struct {
		const char *text;
		nt_placement placement;
	} cases[] = {
		{"a.png", {0}},
		{"-s 2 3 a.png", {true, {2, 3}, {0, 0}, false}},
		{"-s 2 a.png", {true, {2, 1}, {0, 0}, false}}, /* what is not said is 1, or 0 */
		{"-s 1 -2 0 a.png", {true, {1, -2}, {0, 0}, false}},
		{"-o 0.5 a.png", {true, {1, 1}, {0.5f, 0}, false}},
		{"-o 0.5 0.25 9 -s -1 1 1 a.png", {true, {-1, 1}, {0.5f, 0.25f}, false}},
		{"-s 2 2 -s 3 3 a.png", {true, {3, 3}, {0, 0}, false}}, /* the last one counts */
		{"-s 1 1 1 -o 0 0 0 a.png", {false, {1, 1}, {0, 0}, false}}, /* exporters write it */
		{"-o 0 0 1 a.png", {0}}, /* only a texture with depth would notice */
		{"-s inf 1 a.png", {0}},
		{"-clamp on a.png", {.clamp = true}},
		{"-clamp ON a.png", {.clamp = true}},
		{"-clamp on -clamp off a.png", {0}},
		{"-clamp a.png", {0}},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		const nt_placement *expected = &cases[i].placement;
		char text[200];
		reading r;
		snprintf(text, sizeof text, "newmtl a\nmap_Kd %s\n", cases[i].text);
		const nt_placement *placement = &parse_one(&r, text)->material.base_color_map.placement;
		assert_int_equal(placement->moved, expected->moved);
		assert_int_equal(placement->clamp, expected->clamp);
		for (int axis = 0; axis < 2 && expected->moved; axis++) {
			assert_true(placement->scale[axis] == expected->scale[axis]);
			assert_true(placement->offset[axis] == expected->offset[axis]);
		}
		close_reading(&r);
	}
}

TEST(lost_statements_are_findings)
{
	reading r;
	parse(&r, "Kd 1 1 1\nnewmtl a\ndecal r.png\ndecal r.png\nrubbish\nmap_Kd -s 2 2 -t 2 2 a.png\n");
	assert_int_equal(r.status, NT_OK);
	assert_int_equal(r.scene.findings.count, 4);
	const struct {
		const char *detail;
		size_t line, count;
	} expected[] = {{"MTL: Kd", 1, 1}, {"MTL: decal", 3, 2}, {"MTL: rubbish", 5, 1},
		{"MTL: -t of map_Kd", 6, 1}};
	for (int i = 0; i < 4; i++) {
		assert_string_equal(r.scene.findings.items[i].detail, expected[i].detail);
		assert_string_equal(r.scene.findings.items[i].place.file, "lib/a.mtl");
		assert_int_equal(r.scene.findings.items[i].place.line, expected[i].line);
		assert_int_equal(r.scene.findings.items[i].count, expected[i].count);
	}
	close_reading(&r);
}

TEST(words_behind_numbers_are_infos_and_comments_are_none)
{
	static const struct {
		const char *text, *detail;
	} cases[] = {
		{"newmtl a\nKd 1 0 1 x\n", "MTL: \"x\" behind the numbers of Kd"},
		{"newmtl a\nKd 1 0 1 0.5 2\n", "MTL: \"0.5\" behind the numbers of Kd"},
		{"newmtl a\nNs 20 x\n", "MTL: \"x\" behind the numbers of Ns"},
		{"newmtl a\nd 1 # opaque\n", NULL},
		{"newmtl a\nKd 1 0 1 #\n", NULL},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		reading r;
		parse(&r, cases[i].text);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.findings.count, cases[i].detail ? 1 : 0);
		if (cases[i].detail) {
			assert_int_equal(r.scene.findings.items[0].code, NT_CODE_STATEMENT_IGNORED);
			assert_string_equal(r.scene.findings.items[0].detail, cases[i].detail);
		}
		close_reading(&r);
	}
}

TEST(damaged_numbers_are_named_and_not_used)
{
	static const struct {
		const char *text, *detail;
		size_t line;
	} cases[] = {
		{"newmtl a\nPr rough\n", "MTL: Pr: found \"rough\", expected a finite number", 2},
		{"newmtl a\n\rKd 1 1\r",
			"MTL: Kd: found the end of the line, expected 3 numbers, or one for all", 3},
		{"newmtl a\nd\n", "MTL: d: found the end of the line, expected a number", 2},
		{"newmtl a\nKe 1 nan 1\n", "MTL: Ke: found \"nan\", expected a finite number", 2},
		{"newmtl a\nKd 1 1x 1\n", "MTL: Kd: found \"1x\", expected a finite number", 2},
		{"newmtl a\nbump -bm x f.png\n", "MTL: -bm of bump: found \"x\", expected a finite number", 2},
		{"newmtl a\nmap_Kd -s inf 1 f.png\n", "MTL: -s of map_Kd: found \"inf\", expected a finite number", 2},
		{"newmtl a\nmap_Kd -clamp f.png\n", "MTL: -clamp of map_Kd: found \"f.png\", expected on or off", 2},
		{"newmtl a\nmap_Pr -imfchan w f.png\n",
			"MTL: -imfchan of map_Pr: found \"w\", expected r, g, b, m, l or z", 2},
	};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
		reading r;
		parse(&r, cases[i].text);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.findings.count, 1);
		const nt_finding *found = &r.scene.findings.items[0];
		assert_int_equal(found->code, NT_CODE_MATERIAL_LOST);
		assert_string_equal(found->detail, cases[i].detail);
		assert_string_equal(found->place.file, "lib/a.mtl");
		assert_int_equal(found->place.line, cases[i].line);
		close_reading(&r);
	}
}

TEST(a_thousand_statements_are_named_and_the_others_are_one_finding)
{
	enum { NAMED = 1000, OTHERS = 3 };
	char text[8 * (NAMED + OTHERS) + 16], *p = text + sprintf(text, "newmtl a\n");
	for (int i = 0; i < NAMED + OTHERS; i++)
		p += sprintf(p, "x%d\n", i);
	reading r;
	parse(&r, text);
	assert_int_equal(r.scene.findings.count, NAMED + 1);
	assert_string_equal(r.scene.findings.items[NAMED - 1].detail, "MTL: x999");
	assert_string_equal(r.scene.findings.items[NAMED].detail, "MTL: ");
	assert_int_equal(r.scene.findings.items[NAMED].count, OTHERS);
	close_reading(&r);
}

TEST(every_prefix_is_survived)
{
	static const char text[] = "\xEF\xBB\xBFnewmtl a\r\nKd 1 1 1\nd -halo 0.5\nmap_Kd -bm 1 -s 1 1 a b.png\n"
		"bump \"b.png\" -bm 0.5\nxyz\nnewmtl b\nKe 1";
	for (size_t size = 0; size < sizeof text; size++) {
		char cut[sizeof text];
		memcpy(cut, text, size);
		cut[size] = '\0';
		reading r;
		parse(&r, cut);
		assert_int_equal(r.status, NT_OK);
		close_reading(&r);
	}
}

/* ---- files ---- */

static int make_libraries(void **state)
{
	if (make_folder(state) || mkdir(in_folder("in"), 0700) || mkdir(in_folder("in/sub"), 0700))
		return -1;
	put_text_file("in/a.mtl", "newmtl a\nKd 0.5 0.5 0.5\nbump b.png\nnewmtl unused\nmap_Bump c.png\n");
	put_text_file("in/b c.mtl", "newmtl b c\nnewmtl a\n");
	put_text_file("in/sub/d.mtl", "newmtl d\nnorm d.png\n");
	put_text_file("outside.mtl", "newmtl secret\n");
	char outside[200];
	snprintf(outside, sizeof outside, "%s", in_folder("outside.mtl"));
	return symlink(outside, in_folder("in/link.mtl")) || symlink("a.mtl", in_folder("in/other name.mtl"));
}

static void open_obj(reading *r, char path[200], const char *text, bool allow_outside)
{
	*r = (reading){0};
	snprintf(path, 200, "%s", in_folder("in/x.obj"));
	nt_scene_init(&r->scene, path);
	r->scene.bytes = (const unsigned char *)text;
	r->scene.byte_count = strlen(text);
	const nt_read_options options = {.texcoord_set = -1,
		.outside = allow_outside ? NT_OUTSIDE_YES : NT_OUTSIDE_NO, .threads = 1};
	assert_int_equal(nt_obj_open(&r->scene, &options, &r->error), NT_OK);
}

#define FACE "v 0 0 0\nf 1 1 1\n"

TEST(libraries_are_found_beside_the_obj)
{
	reading r;
	char path[200];
	open_obj(&r, path,
		"usemtl d\n" FACE "usemtl a\nf 1 1 1\nusemtl b c\nf 1 1 1\n"
		"mtllib a.mtl b c.mtl ./a.mtl\nmtllib sub\\d.mtl\nmtllib \"a.mtl\"\n", false);
	assert_int_equal(r.scene.material_count, 3);
	const nt_material *materials = r.scene.materials;
	assert_string_equal(materials[0].name, "d");
	assert_string_equal(materials[0].normal_map.name, "d.png");
	assert_string_equal(materials[0].library, in_folder("in/sub/d.mtl"));
	assert_int_equal(r.scene.meshes[0].slots, NT_SLOT_NORMAL);
	assert_string_equal(materials[1].name, "a");
	assert_true(materials[1].base_color[0] == 0.5f);
	assert_string_equal(materials[2].name, "b c");
	assert_string_equal(materials[1].bump, "bump");
	assert_int_equal(materials[1].normal_map.line, 3);
	/* a once more, in b c.mtl: the file a.mtl is read once, however it is called */
	assert_int_equal(r.scene.findings.count, 1);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_STATEMENT_IGNORED);
	assert_int_equal(r.scene.findings.items[0].count, 1);
	close_reading(&r);
}

TEST(name_with_blanks_is_tried_whole_first)
{
	reading r;
	char path[200];
	open_obj(&r, path, "mtllib b c.mtl\nusemtl b c\n" FACE, false);
	assert_int_equal(r.scene.findings.count, 0);
	assert_non_null(r.scene.materials[0].library);
	assert_int_equal(r.scene.meshes[0].slots, 0);
	close_reading(&r);
	open_obj(&r, path, "mtllib a.mtl none.mtl\nusemtl a\n" FACE, false);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_MTL_MISSING);
	assert_string_equal(r.scene.findings.items[0].detail, "none.mtl: no such file");
	assert_non_null(r.scene.materials[0].library);
	close_reading(&r);
}

TEST(a_link_within_the_folder_is_followed)
{
	reading r;
	char path[200];
	open_obj(&r, path, "mtllib other name.mtl\nusemtl a\n" FACE, false);
	assert_non_null(r.scene.materials[0].library);
	close_reading(&r);
}

TEST(nothing_outside_the_folder_is_read)
{
	char text[400], path[200];
	const char *const names[] = {"../outside.mtl", "..\\outside.mtl", "sub/../../outside.mtl", "link.mtl"};
	for (int i = 0; i < 5; i++) {
		reading r;
		if (i < 4)
			snprintf(text, sizeof text, "mtllib %s\nusemtl secret\n" FACE, names[i]);
		else
			snprintf(text, sizeof text, "mtllib %s\nusemtl secret\n" FACE,
				in_folder("outside.mtl"));
		open_obj(&r, path, text, false);
		assert_int_equal(r.scene.findings.count, 1);
		assert_int_equal(r.scene.findings.items[0].code, NT_CODE_MTL_MISSING);
		assert_non_null(strstr(r.scene.findings.items[0].detail, "--outside=yes"));
		assert_null(r.scene.materials[0].library);
		close_reading(&r);
		open_obj(&r, path, text, true);
		assert_int_equal(r.scene.findings.count, 0);
		assert_non_null(r.scene.materials[0].library);
		close_reading(&r);
	}
	reading r;
	open_obj(&r, path, "mtllib C:\\a.mtl\nmtllib sub\nmtllib\n" FACE, false);
	assert_int_equal(r.scene.findings.count, 3);
	assert_string_equal(r.scene.findings.items[0].detail, "C:/a.mtl: a path with a drive letter");
	assert_non_null(strstr(r.scene.findings.items[1].detail, "sub: cannot read"));
	assert_string_equal(r.scene.findings.items[2].detail, ": no file name");
	close_reading(&r);
}

TEST(text_becomes_utf8)
{
	static const struct {
		const char *from, *to;
	} cases[] = {
		{"plain", "plain"},
		{"", ""},
		{"\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80", "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80"},
		{"\xE9t\xE9", "\xC3\xA9t\xC3\xA9"},          /* Latin-1 */
		{"\xC3", "\xC3\x83"},                        /* cut */
		{"\xC0\x80", "\xC3\x80\xC2\x80"},            /* overlong */
		{"\xE0\x80\x80", "\xC3\xA0\xC2\x80\xC2\x80"},
		{"\xED\xA0\x80", "\xC3\xAD\xC2\xA0\xC2\x80"}, /* a surrogate */
		{"\xF4\x90\x80\x80", "\xC3\xB4\xC2\x90\xC2\x80\xC2\x80"}, /* beyond U+10FFFF */
	};
	nt_arena arena = {0};
	for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
		assert_string_equal(obj_utf8_text(&arena, cases[i].from, strlen(cases[i].from)), cases[i].to);
	nt_arena_free(&arena);
}

AROUND_ALL(make_libraries, remove_folder)
