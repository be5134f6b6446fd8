/* SPDX-License-Identifier: MIT */
/*
 * Meshes of which only results are asked for: the output and what is said are those of a run that keeps the geometry of
 * all of them, as --verify makes it, whatever the number of threads. A scene of primitives of all kinds: grids of
 * SIDE x SIDE quads.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include "pipeline/stages.h"

enum { SIDE = 16, VERTICES = (SIDE + 1) * (SIDE + 1), CORNERS = 6 * SIDE * SIDE };

/* Kinds of primitives, in this order, again and again. */
typedef enum kind {
	MIRRORED,    /* half of its texture coordinates: vertices are split */
	PLAIN,       /* no vertex is */
	WIDE,        /* the same with indices of 32 bits, which are used where they are */
	TAIL,        /* mirrored, with two indices that form no triangle */
	REVERSED,    /* the vertices of the one before it, other triangles */
	SAME,        /* all accessors of the first mirrored one */
	CONFLICT,    /* the same, and textures with different transforms: a finding */
	CHAIN,       /* a strip */
	LONG,        /* normals of length 2, and one of length 0 */
	LISTED,      /* mirrored, without indices */
	CUT,         /* two triangles with one vertex in common, which is split: as many vertices then as corners */
	BESIDE,      /* the second triangle of the same vertices, in which none is split */
	KINDS
} kind;

typedef struct file {
	hand_file accessors;
	nt_buffer primitives;
	size_t primitive_count;
} file;

/* POSITION, NORMAL and TEXCOORD_0 of a grid, different for each `number`; the number of the first. vertices: [count] of
 * the grid; NULL: all VERTICES. */
static size_t put_vertices(hand_file *f, int number, bool mirrored, float length, const uint32_t *vertices,
	size_t count)
{
	static float positions[CORNERS][3], normals[CORNERS][3], texcoords[CORNERS][2];
	for (size_t i = 0; i < count; i++) {
		const uint32_t v = vertices ? vertices[i] : (uint32_t)i;
		const float x = (float)(v % (SIDE + 1)), y = (float)(v / (SIDE + 1));
		const float tilt = 0.3f * sinf(x + (float)number), up = sqrtf(1 - tilt * tilt);
		memcpy(positions[i], (float[]){x, y, 0.4f * sinf(y + 0.1f * (float)number)}, sizeof positions[i]);
		memcpy(normals[i], (float[]){length * tilt, 0, length * up}, sizeof normals[i]);
		memcpy(texcoords[i], (float[]){mirrored ? fabsf(x - SIDE / 2) : x, y + 0.2f * sinf(x)},
			sizeof texcoords[i]);
	}
	if (length != 1)
		memset(normals[SIDE], 0, sizeof normals[SIDE]);
	const size_t first = put_accessor(f, positions, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(f, normals, count, NT_GLTF_FLOAT, "VEC3");
	put_accessor(f, texcoords, count, NT_GLTF_FLOAT, "VEC2");
	return first;
}

static void make_corners(uint32_t *corners, bool reversed)
{
	for (uint32_t y = 0; y < SIDE; y++)
		for (uint32_t x = 0; x < SIDE; x++) {
			const uint32_t a = y * (SIDE + 1) + x, b = a + SIDE + 1,
				quad[6] = {a, a + 1, b + 1, a, b + 1, b};
			memcpy(corners + 6 * (y * SIDE + x), quad, sizeof quad);
		}
	for (size_t c = 0; reversed && 2 * c < CORNERS; c++) {
		const uint32_t other = corners[CORNERS - 1 - c];
		corners[CORNERS - 1 - c] = corners[c];
		corners[c] = other;
	}
}

/* The number of an accessor of `count` indices, of 16 bits or 32. */
static size_t put_indices(hand_file *f, const uint32_t *corners, size_t count, bool wide)
{
	uint16_t narrow[CORNERS + 2];
	if (wide)
		return put_accessor(f, corners, count, NT_GLTF_UINT, "SCALAR");
	for (size_t c = 0; c < count; c++)
		narrow[c] = (uint16_t)corners[c];
	return put_accessor(f, narrow, count, NT_GLTF_USHORT, "SCALAR");
}

static void put_primitive(file *f, kind which, bool faulty)
{
	uint32_t corners[CORNERS + 2] = {0};
	const int number = (int)f->primitive_count;
	const bool mirrored = which != PLAIN && which != WIDE && which != LONG, lists = which == LISTED;
	make_corners(corners, which == REVERSED);
	if (faulty)
		corners[CORNERS / 2] = VERTICES;
	/* both sides of the line where texture coordinates are mirrored */
	static const uint32_t few[] = {SIDE / 2, SIDE / 2 + 1, SIDE + SIDE / 2 + 2, SIDE + SIDE / 2, SIDE / 2 - 1},
		cut[] = {0, 1, 2, 3, 4, 0};
	const bool shares = which == REVERSED || which == BESIDE, same = which == SAME || which == CONFLICT;
	hand_file *const rows = &f->accessors;
	const size_t first = same ? 0 : shares ? rows->accessor_count - 4 :
		which == CUT ? put_vertices(rows, number, mirrored, 1, few, 5) :
		put_vertices(rows, number, mirrored, which == LONG ? 2 : 1, lists ? corners : NULL,
			lists ? CORNERS : VERTICES);
	const size_t count = which == CUT ? 6 : which == BESIDE ? 3 : which == TAIL ? CORNERS + 2 : CORNERS;
	const size_t indices = same ? 3 : lists ? 0 :
		put_indices(rows, which == CUT ? cut : which == BESIDE ? cut + 3 : corners, count, which == WIDE);
	nt_buffer_format(&f->primitives, "%s{\"attributes\":{\"POSITION\":%zu,\"NORMAL\":%zu,\"TEXCOORD_0\":%zu},",
		number ? "," : "", first, first + 1, first + 2);
	if (!lists)
		nt_buffer_format(&f->primitives, "\"indices\":%zu,", indices);
	nt_buffer_format(&f->primitives, "\"mode\":%d,\"material\":%d}", which == CHAIN ? 5 : 4, which == CONFLICT);
	f->primitive_count++;
}

/* A scene of `count` primitives, of which those behind `faulty` have an index that is no vertex. */
static void put_scene(size_t count, size_t faulty)
{
	file f = {0};
	nt_buffer members = {0};
	for (size_t i = 0; i < count; i++)
		put_primitive(&f, (kind)(i % KINDS), i >= faulty);
	nt_buffer_format(&members, "\"extensionsUsed\":[\"KHR_texture_transform\"],\"textures\":[{}],"
		"\"materials\":[{\"normalTexture\":{\"index\":0}},{\"normalTexture\":{\"index\":0},\"extensions\":{"
		"\"KHR_materials_clearcoat\":{\"clearcoatNormalTexture\":{\"index\":0,\"extensions\":{"
		"\"KHR_texture_transform\":{\"scale\":[2,1]}}}}}}],\"meshes\":[{\"primitives\":[%s]}],",
		f.primitives.data);
	put_glb("in.glb", &f.accessors, members.data);
	nt_buffer_free(&members);
	nt_buffer_free(&f.primitives);
}

static void assert_same_findings(const nt_finding_list *a, const nt_finding_list *b)
{
	assert_int_equal(a->count, b->count);
	for (size_t i = 0; i < a->count; i++) {
		assert_int_equal(a->items[i].code, b->items[i].code);
		assert_int_equal(a->items[i].count, b->items[i].count);
		assert_string_equal(a->items[i].place.pointer, b->items[i].place.pointer);
		assert_string_equal(a->items[i].detail, b->items[i].detail);
	}
}

TEST(the_same_as_where_geometry_is_kept)
{
	put_scene(2 * KINDS, SIZE_MAX);
	nt_summary first = convert_file("in.glb", "first.glb", (nt_settings){.verify = true, .threads = 1});
	assert_int_equal(first.solved_count, 2 * KINDS);
	assert_int_equal(first.same_count, 4);
	assert_true(first.appended_tangents > 0);
	assert_true(count_findings(&first, NT_CODE_TAN_UVSET_CONFLICT) > 0);
	static const unsigned threads[] = {1, 2, 4};
	for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
		nt_summary results = convert_file("in.glb", "results.glb", (nt_settings){.threads = threads[i]});
		assert_true(same_files("first.glb", "results.glb"));
		assert_same_findings(&first.findings, &results.findings);
		assert_memory_equal(&first.counts, &results.counts, sizeof first.counts);
		assert_int_equal(first.solved_count, results.solved_count);
		assert_int_equal(first.same_count, results.same_count);
		assert_int_equal(first.triangle_count, results.triangle_count);
		assert_int_equal(first.vertex_count, results.vertex_count);
		assert_int_equal(first.appended_tangents, results.appended_tangents);
		nt_summary_free(&results);
	}
	nt_summary_free(&first);
}

/* Tangents that are there, of another type than they would get, and valid: --existing=repair writes none of them. */
TEST(what_needs_no_repair_stays)
{
	put_scene(2 * KINDS, SIZE_MAX);
	nt_summary summary = convert_file("in.glb", "first.glb", (nt_settings){.precision = NT_PRECISION_SHORT});
	nt_summary_free(&summary);
	for (unsigned threads = 1; threads <= 2; threads++) {
		summary = convert_file("first.glb", "again.glb",
			(nt_settings){.existing = NT_EXISTING_REPAIR, .threads = threads});
		assert_int_equal(summary.solved_count, 2 * KINDS);
		nt_summary_free(&summary);
		assert_true(same_files("first.glb", "again.glb"));
	}
}

static void begin_stage(void *run, nt_stage stage)
{
	(void)run;
	(void)stage;
}

/* Data of each mesh after its window: of those that share vertices with others the writer has the results. */
TEST(geometry_is_let_go_of_where_only_results_count)
{
	put_scene(KINDS, SIZE_MAX);
	for (int only_results = 0; only_results < 2; only_results++) {
		const nt_settings settings = {.texcoord_set = -1, .threads = 2};
		const nt_read_options options = {.texcoord_set = -1, .threads = 2, .edits = true,
			.only_results = only_results};
		nt_error error;
		nt_file input;
		nt_scene scene;
		nt_summary summary = {.mesh_count = 0};
		nt_scene_init(&scene, in_folder("in.glb"));
		assert_int_equal(nt_file_open(&input, scene.path, &error), NT_OK);
		scene.bytes = input.data;
		scene.byte_count = input.size;
		const nt_format_entry *glb = nt_format_find(NT_FORMAT_GLB);
		assert_int_equal(glb->open(&scene, &options, &error), NT_OK);
		nt_select(&scene, NT_ONLY_NEEDED, NT_EXISTING_KEEP, NT_MAKING_NONE);
		assert_int_equal(glb->plan(&scene, &options, &error), NT_OK);
		const nt_tasks tasks = {.scene = &scene, .reader = glb, .writer = glb, .settings = &settings,
			.options = &options, .summary = &summary, .begin_stage = begin_stage};
		assert_int_equal(nt_tasks_do(&tasks, &error), NT_OK);
		for (size_t i = 0; i < KINDS; i++) {
			const nt_mesh *mesh = &scene.meshes[i];
			const bool shares = i == TAIL || i == REVERSED || i == CUT || i == BESIDE;
			/* a tail that forms no triangle stays, and so do triangles that a strip or a list without
			 * indices had; the first mesh is shared by one whose texture transform is to be looked at */
			const bool let_go = only_results && i != MIRRORED && i != TAIL && i != SAME && i != CONFLICT &&
				i != CHAIN && i != LISTED;
			assert_int_equal(mesh->merged, shares);
			assert_int_equal(mesh->positions == NULL, let_go);
			assert_int_equal(mesh->split.vertex_tangents == NULL, let_go && shares);
		}
		nt_summary_free(&summary);
		nt_scene_free(&scene);
		nt_file_close(&input);
	}
}

/* The first fault of the file is told, although a later mesh may be loaded earlier. */
TEST(the_first_fault_is_told)
{
	enum { FAULTY = 2 * KINDS + TAIL };
	put_scene(4 * KINDS, FAULTY);
	for (unsigned threads = 1; threads <= 4; threads++) {
		const nt_settings settings = {.texcoord_set = -1, .threads = threads};
		nt_summary summary;
		nt_error error;
		assert_int_equal(nt_run(in_folder("in.glb"), in_folder("out.glb"), &settings, &summary, &error),
			NT_ERROR_INPUT);
		char object[40];
		snprintf(object, sizeof object, "mesh 0, primitive %d, material 0", FAULTY);
		assert_string_equal(error.place.object, object);
		assert_int_equal(count_in_folder(), 1);
		nt_summary_free(&summary);
	}
}

TEST(exhausted_memory_is_told)
{
	put_scene(KINDS, SIZE_MAX);
	for (unsigned threads = 1; threads <= 2; threads++)
		assert_true(exhaust_memory(in_folder("in.glb"), (nt_settings){.threads = threads}) > 50);
}

AROUND_EACH(make_folder, remove_folder)
