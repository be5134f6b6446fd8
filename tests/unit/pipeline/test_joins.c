/* SPDX-License-Identifier: MIT */
/*
 * --across=mesh: primitives of one glTF mesh have the tangents, byte for byte, of one primitive with all their
 * triangles. The surface is a wavy grid whose cells go to three primitives in turn; every primitive has vertices of its
 * own, with the values of its neighbours. Texture coordinates are mirrored on the right half and the same for all
 * corners of some cells, which repair has to fill.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include "gltf/load.h"

enum { SIDE = 24, CELLS = SIDE * SIDE, MOST_PARTS = 3 };

/* One primitive: four vertices for each of its cells. */
typedef struct part {
	size_t cells;
	float positions[4 * CELLS][3], normals[4 * CELLS][3], texcoords[4 * CELLS][2], moves[4 * CELLS][3];
	uint32_t indices[6 * CELLS];
} part;

typedef struct surface {
	part parts[MOST_PARTS];
} surface;

static void put_vertex(part *p, size_t i, int x, int y, bool flat_uv)
{
	const float height = 0.8f * sinf(0.7f * (float)x) * cosf(0.5f * (float)y);
	const float normal[3] = {0.3f * sinf((float)x), 0.2f * cosf((float)(x + y)), 1};
	const float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + 1);
	for (int k = 0; k < 3; k++)
		p->normals[i][k] = normal[k] / length;
	memcpy(p->positions[i], (float[]){(float)x, (float)y, height}, sizeof p->positions[i]);
	p->texcoords[i][0] = flat_uv ? 0.5f : fabsf((float)x - SIDE / 2 + 0.3f * sinf((float)y));
	p->texcoords[i][1] = flat_uv ? 0.5f : -(float)y - 0.4f * sinf(0.9f * (float)x);
	/* the target lifts the right end */
	p->moves[i][2] = x > SIDE / 3 ? 0.3f * (float)(x - SIDE / 3) : 0;
}

static void make_surface(surface *s)
{
	memset(s, 0, sizeof *s);
	for (int y = 0; y < SIDE; y++)
		for (int x = 0; x < SIDE; x++) {
			part *p = &s->parts[(x / 2 + 2 * (y / 3)) % MOST_PARTS];
			const uint32_t a = (uint32_t)(4 * p->cells);
			const bool flat_uv = (x * 7 + y * 5) % 31 == 0;
			for (int k = 0; k < 4; k++)
				put_vertex(p, a + (uint32_t)k, x + k % 2, y + k / 2, flat_uv);
			const uint32_t corners[6] = {a, a + 1, a + 3, a, a + 3, a + 2};
			memcpy(p->indices + 6 * p->cells++, corners, sizeof corners);
		}
}

/* A part that has the triangles of all. */
static void join_surface(const surface *s, part *joined)
{
	memset(joined, 0, sizeof *joined);
	for (size_t i = 0; i < MOST_PARTS; i++) {
		const part *p = &s->parts[i];
		const size_t vertices = 4 * joined->cells;
		memcpy(joined->positions[vertices], p->positions, 4 * p->cells * sizeof *p->positions);
		memcpy(joined->normals[vertices], p->normals, 4 * p->cells * sizeof *p->normals);
		memcpy(joined->texcoords[vertices], p->texcoords, 4 * p->cells * sizeof *p->texcoords);
		memcpy(joined->moves[vertices], p->moves, 4 * p->cells * sizeof *p->moves);
		for (size_t c = 0; c < 6 * p->cells; c++)
			joined->indices[6 * joined->cells + c] = (uint32_t)vertices + p->indices[c];
		joined->cells += p->cells;
	}
}

/* ---- files ---- */

/* A primitive has six accessors: POSITION, NORMAL, TEXCOORD_0, indices, the target's POSITION, and TANGENT with a value
 * that no solve gives. Returns the first. */
static size_t put_part(hand_file *f, const part *p)
{
	const size_t count = 4 * p->cells;
	static float authored[4 * CELLS][4];
	for (size_t i = 0; i < count; i++)
		memcpy(authored[i], (float[]){0.6f, 0.8f, 0, 1}, sizeof authored[i]);
	const size_t first = put_accessor(f, p->positions, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(f, p->normals, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(f, p->texcoords, count, NT_GLTF_FLOAT, "VEC2");
	put_accessor(f, p->indices, 6 * p->cells, NT_GLTF_UINT, "SCALAR");
	put_accessor(f, p->moves, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(f, authored, count, NT_GLTF_FLOAT, "VEC4");
	return first;
}

/* With what stands behind its three attributes, and behind those. */
static void put_primitive(nt_buffer *json, size_t first, const char *attributes, int material, const char *rest)
{
	nt_buffer_format(json, "%s{\"attributes\":{\"POSITION\":%zu,\"NORMAL\":%zu,\"TEXCOORD_0\":%zu%s},"
		"\"indices\":%zu,\"material\":%d%s}", json->size && json->data[json->size - 1] == '}' ? "," : "",
		first, first + 1, first + 2, attributes, first + 3, material, rest);
}

/* Writes primitives with commas between them as one mesh. Materials: 0 and 1 have a normal map, 2 has none, 3 to 5 have
 * one that is turned and scaled, 5 another way round. */
static void put_mesh(const char *name, hand_file *f, nt_buffer *primitives)
{
	nt_buffer members = {0};
	nt_buffer_format(&members, "\"extensionsUsed\":[\"KHR_texture_transform\"],\"textures\":[{}],\"materials\":["
		"{\"normalTexture\":{\"index\":0}},{\"normalTexture\":{\"index\":0,\"scale\":2}},{\"name\":\"plain\"},"
		"{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"rotation\":0.5,"
		"\"scale\":[2,1]}}}},{\"normalTexture\":{\"index\":0,"
		"\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,1],\"rotation\":0.5,\"offset\":[3,4]}}}},"
		"{\"normalTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"rotation\":-0.5,"
		"\"scale\":[2,1]}}}}],\"meshes\":[{\"primitives\":[%s]}],", primitives->data);
	put_glb(name, f, members.data);
	nt_buffer_free(&members);
	nt_buffer_free(primitives);
}

/* The surface as one mesh of three primitives with these materials; attributes and rest may be NULL. */
static void put_three(const char *name, const surface *s, const int material[3], const char *const attributes[3],
	const char *const rest[3])
{
	hand_file f = {0};
	nt_buffer primitives = {0};
	for (size_t i = 0; i < MOST_PARTS; i++)
		put_primitive(&primitives, put_part(&f, &s->parts[i]), attributes ? attributes[i] : "", material[i],
			rest ? rest[i] : "");
	put_mesh(name, &f, &primitives);
}

static void put_one(const char *name, const part *p, int material, const char *rest)
{
	hand_file f = {0};
	nt_buffer primitive = {0};
	put_primitive(&primitive, put_part(&f, p), "", material, rest);
	put_mesh(name, &f, &primitive);
}

static void put_joined(const char *name, const surface *s, int material, const char *rest)
{
	static part joined;
	join_surface(s, &joined);
	put_one(name, &joined, material, rest);
}

/* ---- results ---- */

/* The result: an output, opened, and the tangents of one mesh's corners after the other's. */
typedef struct result {
	nt_file file;
	nt_scene scene;
	size_t border_count, repaired;
	double border_degrees;
} result;

static void convert(result *r, const char *name, nt_settings settings)
{
	nt_summary summary = convert_file(name, settings.check ? NULL : "out.glb", settings);
	*r = (result){.repaired = count_findings(&summary, NT_CODE_TAN_REPAIRED),
		.border_count = count_findings(&summary, NT_CODE_TAN_PRIMITIVE_BORDER)};
	for (size_t i = 0; i < summary.findings.count; i++) {
		const nt_finding *finding = &summary.findings.items[i];
		if (finding->code != NT_CODE_TAN_PRIMITIVE_BORDER)
			continue;
		double degrees = 0;
		assert_int_equal(sscanf(finding->detail, "by up to %lf degrees", &degrees), 1);
		r->border_degrees = fmax(r->border_degrees, degrees);
	}
	nt_summary_free(&summary);
	if (settings.check)
		return;
	const nt_read_options options = {.texcoord_set = -1, .morphs = NT_MORPH_KEEP};
	nt_error error;
	open_file(&r->scene, &r->file, "out.glb", &options);
	for (size_t i = 0; i < r->scene.mesh_count; i++)
		assert_int_equal(nt_gltf_load(&r->scene, &r->scene.meshes[i], &options, &error), NT_OK);
}

static void close_result(result *r)
{
	nt_scene_free(&r->scene);
	nt_file_close(&r->file);
}

static const float *tangent(const nt_mesh *mesh, size_t corner)
{
	return mesh->tangents + 4 * (size_t)(mesh->indices ? mesh->indices[corner] : corner);
}

/* Corners of primitive `part` whose tangents differ from those of the joined mesh's corners from `first` on. */
static size_t differing(const nt_mesh *mesh, const nt_mesh *joined, size_t first)
{
	size_t count = 0;
	assert_non_null(mesh->tangents);
	for (size_t c = 0; c < mesh->corner_count; c++)
		count += memcmp(tangent(mesh, c), tangent(joined, first + c), 4 * sizeof(float)) != 0;
	return count;
}

static const int mapped[3] = {0, 1, 0};
static const nt_settings across = {.io.across = NT_ACROSS_MESH, .io.threads = 1};

/* ---- tests ---- */

static surface sheet;

TEST(bytes_are_those_of_one_primitive)
{
	result r, one;
	put_joined("one.glb", &sheet, 0, "");
	put_three("three.glb", &sheet, mapped, NULL, NULL);
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		nt_settings settings = {.method = (nmtan_method)method, .io.threads = 1};
		convert(&one, "one.glb", settings);
		settings.io.across = NT_ACROSS_MESH;
		for (unsigned threads = 1; threads < 4; threads++) {
			settings.io.threads = threads;
			convert(&r, "three.glb", settings);
			for (size_t i = 0, corner = 0; i < 3; corner += r.scene.meshes[i++].corner_count)
				assert_int_equal(differing(&r.scene.meshes[i], &one.scene.meshes[0], corner), 0);
			/* what is counted for each is what is counted for all */
			assert_true(one.repaired > 0);
			assert_int_equal(r.repaired, one.repaired);
			close_result(&r);
		}
		/* without it they differ: the test sees something */
		settings.io.across = NT_ACROSS_PRIMITIVE;
		convert(&r, "three.glb", settings);
		assert_true(differing(&r.scene.meshes[0], &one.scene.meshes[0], 0) > 20);
		close_result(&r);
		close_result(&one);
	}
}

TEST(those_without_need_contribute_and_stay_as_they_are)
{
	result r, one;
	put_joined("one.glb", &sheet, 0, "");
	convert(&one, "one.glb", across);
	/* the second asks for nothing, the third has tangents of its own: six accessors each, the last is TANGENT */
	put_three("three.glb", &sheet, (int[]){0, 2, 1}, (const char *[]){"", "", ",\"TANGENT\":17"}, NULL);
	convert(&r, "three.glb", across);
	const nt_mesh *meshes = r.scene.meshes;
	assert_int_equal(differing(&meshes[0], &one.scene.meshes[0], 0), 0);
	assert_null(meshes[1].tangents);
	for (size_t i = 0; i < meshes[2].vertex_count; i++)
		assert_memory_equal(meshes[2].tangents + 4 * i, ((float[]){0.6f, 0.8f, 0, 1}), 4 * sizeof(float));
	close_result(&r);
	close_result(&one);
}

TEST(texture_transforms_divide)
{
	result r, one;
	/* 3 and 4 are the same but for the offset, which does nothing to directions; 2 has no say */
	put_three("three.glb", &sheet, (int[]){3, 2, 4}, NULL, NULL);
	put_joined("one.glb", &sheet, 3, "");
	convert(&one, "one.glb", across);
	convert(&r, "three.glb", across);
	const nt_mesh *meshes = r.scene.meshes;
	assert_int_equal(differing(&meshes[0], &one.scene.meshes[0], 0), 0);
	assert_int_equal(differing(&meshes[2], &one.scene.meshes[0],
		meshes[0].corner_count + meshes[1].corner_count), 0);
	close_result(&one);
	close_result(&r);
	/* 0 and 5 are not: each is alone */
	for (int other = 0; other <= 5; other += 5) {
		put_three("three.glb", &sheet, (int[]){other, 3, 3}, NULL, NULL);
		convert(&one, "three.glb", (nt_settings){.io.threads = 1});
		convert(&r, "three.glb", across);
		assert_int_equal(differing(&r.scene.meshes[0], &one.scene.meshes[0], 0), 0);
		assert_true(differing(&r.scene.meshes[1], &one.scene.meshes[1], 0) > 20);
		close_result(&one);
		close_result(&r);
	}
}

/* The first primitive's accessors in a second mesh, alone, and in a third with the same neighbours. */
TEST(shared_geometry_gets_tangents_of_its_own)
{
	result r, one, apart;
	hand_file f = {0};
	nt_buffer primitives = {0};
	size_t first[3];
	for (size_t i = 0; i < 3; i++)
		first[i] = put_part(&f, &sheet.parts[i]);
	for (const char *i = "012|0|012"; *i; i++)
		if (*i == '|')
			nt_buffer_text(&primitives, "]},{\"primitives\":[");
		else
			put_primitive(&primitives, first[*i - '0'], "", 0, "");
	put_mesh("shared.glb", &f, &primitives);
	put_joined("one.glb", &sheet, 0, "");
	put_three("three.glb", &sheet, mapped, NULL, NULL);
	convert(&one, "one.glb", across);
	convert(&apart, "three.glb", (nt_settings){.io.threads = 1});
	convert(&r, "shared.glb", across);
	const nt_mesh *m = r.scene.meshes;
	assert_int_equal(r.scene.mesh_count, 7);
	assert_int_equal(differing(&m[0], &one.scene.meshes[0], 0), 0);
	assert_int_equal(differing(&m[2], &one.scene.meshes[0], m[0].corner_count + m[1].corner_count), 0);
	assert_int_equal(differing(&m[3], &apart.scene.meshes[0], 0), 0);
	assert_int_equal(differing(&m[4], &one.scene.meshes[0], 0), 0);
	assert_int_equal(differing(&m[5], &one.scene.meshes[0], m[0].corner_count), 0);
	/* no vertex was appended: TANGENT is another accessor for each mesh */
	assert_int_equal(m[0].vertex_count, 4 * sheet.parts[0].cells);
	close_result(&r);
	close_result(&one);
	close_result(&apart);
}

TEST(targets_are_solved_as_one_too)
{
	result r, one;
	surface moved = sheet;
	/* the first stays: in its target there is nothing */
	memset(moved.parts[0].moves, 0, sizeof moved.parts[0].moves);
	put_joined("one.glb", &moved, 0, ",\"targets\":[{\"POSITION\":4}]");
	put_three("three.glb", &moved, mapped, NULL, (const char *[]){",\"targets\":[{}]",
		",\"targets\":[{\"POSITION\":10}]", ",\"targets\":[{\"POSITION\":16}]"});
	convert(&one, "one.glb", across);
	convert(&r, "three.glb", across);
	uint64_t count;
	const float *joined = rows_of(&one.scene, tangent_of(&one.scene, 0, 0, 0), 3, &count);
	size_t turned = 0;
	for (size_t i = 0, corner = 0; i < 3; corner += r.scene.meshes[i++].corner_count) {
		const nt_mesh *mesh = &r.scene.meshes[i];
		const float *rows = rows_of(&r.scene, tangent_of(&r.scene, 0, i, 0), 3, &count);
		assert_int_equal(differing(mesh, &one.scene.meshes[0], corner), 0);
		for (size_t c = 0; c < mesh->corner_count; c++) {
			const float *delta = rows + 3 * mesh->indices[c];
			assert_memory_equal(delta, joined + 3 * one.scene.meshes[0].indices[corner + c], 12);
			turned += i == 0 && (delta[0] != 0 || delta[1] != 0 || delta[2] != 0);
		}
	}
	assert_true(turned > 0);
	close_result(&r);
	close_result(&one);
}

/* As most exporters write it: one list of vertices, of which each primitive uses some. At the borders all use the same
 * ones, and have the same tangents there: one TANGENT, and no copies but those that one primitive needs. */
TEST(shared_vertices_are_not_split_at_borders)
{
	static part joined;
	result r, one;
	hand_file f = {0};
	nt_buffer primitives = {0};
	memset(&joined, 0, sizeof joined);
	joined.cells = CELLS;
	for (int y = 0; y <= SIDE; y++)
		for (int x = 0; x <= SIDE; x++)
			put_vertex(&joined, (size_t)(y * (SIDE + 1) + x), x, y, false);
	for (uint32_t i = 0; i < CELLS; i++) {
		const uint32_t a = i / SIDE * (SIDE + 1) + i % SIDE, b = a + SIDE + 1;
		memcpy(joined.indices + 6 * (size_t)i, (uint32_t[]){a, a + 1, b + 1, a, b + 1, b},
			6 * sizeof(uint32_t));
	}
	put_part(&f, &joined);
	/* the first two thirds of the rows, and the rest */
	const size_t two = 6 * CELLS / 3 * 2;
	const size_t low = put_accessor(&f, joined.indices, two, NT_GLTF_UINT, "SCALAR");
	const size_t high = put_accessor(&f, joined.indices + two, 6 * CELLS - two, NT_GLTF_UINT, "SCALAR");
	for (int i = 0; i < 2; i++)
		nt_buffer_format(&primitives, "%s{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},"
			"\"indices\":%zu,\"material\":%d}", i ? "," : "", i ? high : low, i);
	put_mesh("two.glb", &f, &primitives);
	put_one("one.glb", &joined, 0, "");
	convert(&one, "one.glb", across);
	convert(&r, "two.glb", across);
	const nt_mesh *meshes = r.scene.meshes;
	assert_int_equal(differing(&meshes[0], &one.scene.meshes[0], 0), 0);
	assert_int_equal(differing(&meshes[1], &one.scene.meshes[0], two), 0);
	assert_int_equal(meshes[0].vertex_count, one.scene.meshes[0].vertex_count);
	close_result(&r);
	/* each by itself they are */
	convert(&r, "two.glb", (nt_settings){.io.threads = 1});
	assert_true(r.scene.meshes[0].vertex_count >= one.scene.meshes[0].vertex_count + SIDE - 1);
	close_result(&r);
	close_result(&one);
}

TEST(failed_allocations_end_the_run)
{
	const nt_report_options report = {0};
	surface small;
	memset(&small, 0, sizeof small);
	for (size_t i = 0; i < MOST_PARTS; i++) {
		small.parts[i] = sheet.parts[i];
		small.parts[i].cells = 5;
	}
	const char *const target = ",\"targets\":[{\"POSITION\":4}]";
	put_three("three.glb", &small, (int[]){3, 2, 3}, NULL, (const char *[]){target, "", ""});
	nt_settings settings = {.dry_run = true, .io.threads = 1, .report = &report};
	assert_true(exhaust_memory(in_folder("three.glb"), settings) > 100);
	settings.io.across = NT_ACROSS_MESH;
	assert_true(exhaust_memory(in_folder("three.glb"), settings) > 100);
}

TEST(same_for_others_and_for_checks)
{
	result r;
	/* nothing to join: the bytes are those of the default */
	put_joined("one.glb", &sheet, 0, "");
	convert(&r, "one.glb", (nt_settings){.io.threads = 1});
	close_result(&r);
	assert_int_equal(rename(in_folder("out.glb"), in_folder("default.glb")), 0);
	convert(&r, "one.glb", across);
	assert_true(same_files("out.glb", "default.glb"));
	close_result(&r);
	put_three("three.glb", &sheet, mapped, NULL, NULL);
	convert(&r, "three.glb", (nt_settings){.io.across = NT_ACROSS_MESH, .check = true, .io.threads = 1});
}

/*
 * Two squares, the second with its texture sheared by a: dP/du is (1, 0) on the first and (cos a, sin a) on the second.
 * At both vertices of the border each square's corners sum up to angles of the squares there. At (1, 0): 90 degrees and
 * 90 - a, since the second is the parallelogram (1, 0), (1 + s, k), which keeps u and v; at (1, 1): 90 and 90 + a.
 * Solved as one the tangent is turned by b from the first with tan b = w sin a / (90 + w cos a), w the second's angle.
 */
static void put_sheared(double k)
{
	hand_file f = {0};
	nt_buffer primitives = {0};
	static part p[2];
	for (int i = 0; i < 2; i++) {
		memset(&p[i], 0, sizeof p[i]);
		p[i].cells = 1;
		for (int c = 0; c < 4; c++) {
			const int x = i + c % 2, y = c / 2;
			p[i].positions[c][0] = (float)x;
			p[i].positions[c][1] = (float)(y + (x == 2 ? k : 0));
			p[i].normals[c][2] = 1;
			p[i].texcoords[c][0] = (float)x;
			p[i].texcoords[c][1] = (float)-y;
		}
		memcpy(p[i].indices, (uint32_t[]){0, 1, 3, 0, 3, 2}, 6 * sizeof(uint32_t));
		put_primitive(&primitives, put_part(&f, &p[i]), "", 0, "");
	}
	put_mesh("border.glb", &f, &primitives);
}

TEST(a_report_tells_borders_that_would_change)
{
	const double pi = 3.14159265358979323846;
	const nt_report_options report = {0};
	for (double k = 0.01; k < 2; k *= 2) {
		const double a = atan(k), degrees = a * 180 / pi;
		/* largest: the first square's corner at (1, 1), where the second has most weight, or the second's own
		 * at (1, 0), which turns by what is left of a */
		const double above = 90 + degrees, below = 90 - degrees;
		const double first = atan2(above * sin(a), 90 + above * cos(a)) * 180 / pi;
		const double second = degrees - atan2(below * sin(a), 90 + below * cos(a)) * 180 / pi;
		const double worst = fmax(first, second);
		result r;
		put_sheared(k);
		for (int check = 0; check < 2; check++) {
			convert(&r, "border.glb", (nt_settings){.report = &report, .check = check, .io.threads = 1});
			if (fabs(r.border_degrees - (worst > 5 ? worst : 0)) > 0.06)
				fail_msg("k %g: %g degrees, expected %g", k, r.border_degrees, worst);
			assert_int_equal(r.border_count > 0, worst > 5);
			if (!check)
				close_result(&r);
		}
		/* nothing is computed unless it is asked for, nor where it is done */
		convert(&r, "border.glb", (nt_settings){.io.threads = 1});
		assert_int_equal(r.border_count, 0);
		close_result(&r);
		convert(&r, "border.glb",
			(nt_settings){.report = &report, .io.across = NT_ACROSS_MESH, .io.threads = 1});
		assert_int_equal(r.border_count, 0);
		close_result(&r);
	}
}

/* Findings of --check about directions, of a file that --across=mesh has made. */
static size_t mismatches(nt_across how)
{
	const nt_report_options report = {0};
	nt_summary summary = convert_file("out.glb", NULL,
		(nt_settings){.check = true, .report = &report, .io.across = how, .io.threads = 1});
	size_t count = 0;
	for (size_t i = 0; i < summary.report->finding_count; i++)
		if (summary.report->findings[i].code == NT_CODE_TAN_DIRECTION_MISMATCH)
			count += summary.report->findings[i].count;
	nt_summary_free(&summary);
	return count;
}

TEST(a_check_judges_by_the_same_rule)
{
	result r;
	put_sheared(4);
	convert(&r, "border.glb", across);
	close_result(&r);
	/* 76 degrees apart, and the joined tangents more than 30 from one of the two squares' */
	assert_true(mismatches(NT_ACROSS_PRIMITIVE) > 0);
	assert_int_equal(mismatches(NT_ACROSS_MESH), 0);
}

static int set_up(void **state)
{
	make_surface(&sheet);
	return make_folder(state);
}

AROUND_ALL(set_up, remove_folder)
