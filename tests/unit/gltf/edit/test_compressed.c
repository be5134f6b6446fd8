/* SPDX-License-Identifier: MIT */
/*
 * The same mesh plain, packed by meshoptimizer and compressed by Draco. Its u runs back in the middle,
 * so that vertices have to be split.
 */
#include "hand_gltf_file.h"
#include <math.h>
#include <meshoptimizer.h>
#include "gltf/draco.h"
#include "gltf/load.h"

enum { N = 12, VERTICES = (N + 1) * (N + 1), CORNERS = N * N * 6 };

typedef struct sheet {
	float positions[VERTICES][3], normals[VERTICES][3], texcoords[VERTICES][2];
	uint8_t colors[VERTICES][4];
	uint32_t indices[CORNERS];
} sheet;

static void make_sheet(sheet *s)
{
	for (int y = 0; y <= N; y++)
		for (int x = 0; x <= N; x++) {
			const int v = y * (N + 1) + x, u = x < 5 ? x : 10 - x;
			s->positions[v][0] = (float)x * 0.25f;
			s->positions[v][1] = (float)y * 0.25f;
			s->positions[v][2] = (float)((x * 7 + y * 3) % 5) * 0.0625f;
			s->normals[v][0] = s->normals[v][1] = 0;
			s->normals[v][2] = 1;
			s->texcoords[v][0] = (float)u * 0.125f;
			s->texcoords[v][1] = (float)y * 0.0625f;
			for (int k = 0; k < 4; k++)
				s->colors[v][k] = (uint8_t)(v * (k + 3));
		}
	uint32_t *at = s->indices;
	for (uint32_t y = 0; y < N; y++)
		for (uint32_t x = 0; x < N; x++) {
			const uint32_t a = y * (N + 1) + x, quad[] = {a, a + 1, a + N + 2, a, a + N + 2, a + N + 1};
			memcpy(at, quad, sizeof quad);
			at += 6;
		}
}

static size_t add_part(nt_buffer *bin, const void *bytes, size_t size)
{
	nt_buffer_append(bin, "\0\0\0", (4 - bin->size % 4) % 4);
	const size_t at = bin->size;
	nt_buffer_append(bin, bytes, size);
	return at;
}

#define HEAD "{\"asset\":{\"version\":\"2.0\"}," NORMAL_MAP
#define ACCESSOR(view, type, count, kind, more)                                                    \
	"{" view "\"componentType\":" type ",\"count\":" count ",\"type\":\"" kind "\"" more "}"
#define BOUNDS ",\"min\":[0,0,0],\"max\":[3,3,0.25]"

/* The fourth has a type of its own: colours, or tangents. */
#define ACCESSORS(view_0, view_1, view_2, view_3, view_4, type)                                    \
	"\"accessors\":[" ACCESSOR(view_0, "5126", "169", "VEC3", BOUNDS) ","                      \
	ACCESSOR(view_1, "5126", "169", "VEC3", "") "," ACCESSOR(view_2, "5126", "169", "VEC2", "") "," \
	ACCESSOR(view_3, type, "169", "VEC4", ",\"normalized\":true") ","                          \
	ACCESSOR(view_4, "5125", "864", "SCALAR", "") "],"
#define ACCESSORS_WITH_VIEWS(type)                                                                 \
	ACCESSORS("\"bufferView\":0,", "\"bufferView\":1,", "\"bufferView\":2,", "\"bufferView\":3,", \
		"\"bufferView\":4,", type)

static const char *const accessors_with_views = ACCESSORS_WITH_VIEWS("5121");
static const char *const accessors_without = ACCESSORS("", "", "", "", "", "5121");
static const char *const accessors_with_tangents = ACCESSORS_WITH_VIEWS("5120");
#define PRIMITIVE                                                                                  \
	"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2," \
	"\"COLOR_0\":3},\"indices\":4,\"material\":0"
#define WITH_TANGENTS                                                                              \
	"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2," \
	"\"TANGENT\":3},\"indices\":4,\"material\":0"
/* The second has no material, and so no use for tangents; it alone has colours. */
#define TWO_PRIMITIVES                                                                             \
	"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}," \
	"\"indices\":4,\"material\":0},{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2," \
	"\"COLOR_0\":3},\"indices\":4"

static void write_plain(const sheet *s, const char *name)
{
	hand_file f = {0};
	put_accessor(&f, s->positions, VERTICES, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, s->normals, VERTICES, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, s->texcoords, VERTICES, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, s->colors, VERTICES, NT_GLTF_UBYTE, "VEC4");
	put_accessor(&f, s->indices, CORNERS, NT_GLTF_UINT, "SCALAR");
	put_glb(name, &f, NORMAL_MAP PRIMITIVE "}]}],");
}

static void write_meshopt(const sheet *s, const char *accessors, const char *meshes, const char *name)
{
	const struct {
		const void *bytes;
		size_t count, stride;
	} parts[5] = {{s->positions, VERTICES, 12}, {s->normals, VERTICES, 12}, {s->texcoords, VERTICES, 8},
		{s->colors, VERTICES, 4}, {s->indices, CORNERS, 4}};
	nt_buffer bin = {0}, json = {0};
	unsigned char packed[16384];
	size_t fallback = 0;
	nt_buffer_text(&json, HEAD "\"extensionsUsed\":[\"EXT_meshopt_compression\"],"
		"\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"bufferViews\":[");
	for (int i = 0; i < 5; i++) {
		const size_t size = i < 4 ?
			meshopt_encodeVertexBuffer(packed, sizeof packed, parts[i].bytes, parts[i].count,
				parts[i].stride) :
			meshopt_encodeIndexSequence(packed, sizeof packed, s->indices, CORNERS);
		assert_true(size > 0);
		const size_t at = add_part(&bin, packed, size);
		nt_buffer_format(&json, "%s{\"buffer\":1,\"byteOffset\":%zu,\"byteLength\":%zu,%s"
			"\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,"
			"\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,\"mode\":\"%s\"}}}",
			i ? "," : "", fallback, parts[i].count * parts[i].stride,
			i == 0 ? "\"byteStride\":12," : "", at, size, parts[i].stride, parts[i].count,
			i < 4 ? "ATTRIBUTES" : "INDICES");
		fallback += parts[i].count * parts[i].stride;
	}
	nt_buffer_format(&json, "],%s%s}]}],\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":%zu,"
		"\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}]}",
		accessors, meshes, bin.size, fallback);
	put_glb_file(name, json.data, bin.data, bin.size);
	nt_buffer_free(&bin);
	nt_buffer_free(&json);
}

static void write_draco(const sheet *s, nt_draco_method method, const char *name)
{
	const nt_draco_attribute attributes[] = {
		{.unique_id = 0, .kind = NT_DRACO_POSITION, .component_type = 5126, .components = 3,
			.quantization = {.bits = 14}, .data = s->positions},
		{.unique_id = 1, .kind = NT_DRACO_NORMAL, .component_type = 5126, .components = 3,
			.quantization = {.bits = 10}, .data = s->normals},
		{.unique_id = 2, .kind = NT_DRACO_TEXCOORD, .component_type = 5126, .components = 2,
			.quantization = {.bits = 12}, .data = s->texcoords},
		{.unique_id = 3, .kind = NT_DRACO_COLOR, .component_type = 5121, .components = 4,
			.normalized = true, .data = s->colors},
	};
	const nt_draco_mesh mesh = {.method = method, .point_count = VERTICES, .face_count = CORNERS / 3,
		.indices = s->indices, .attributes = attributes, .attribute_count = 4};
	nt_draco_block block;
	nt_error error;
	assert_int_equal(nt_draco_encode(&mesh, &block, &error), NT_OK);
	nt_buffer bin = {0}, json = {0};
	nt_buffer_append(&bin, block.bytes, block.size);
	nt_buffer_format(&json, HEAD "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
		"\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"bufferViews\":[{\"buffer\":0,"
		"\"byteLength\":%zu}],%s" PRIMITIVE ",\"extensions\":{\"KHR_draco_mesh_compression\":{"
		"\"bufferView\":0,\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"COLOR_0\":3}}}}"
		"]}],\"buffers\":[{\"byteLength\":%zu}]}", block.size, accessors_without, block.size);
	put_glb_file(name, json.data, bin.data, bin.size);
	nt_draco_block_free(&block);
	nt_buffer_free(&bin);
	nt_buffer_free(&json);
}

/* A file's mesh, loaded. */
typedef struct loaded {
	nt_file file;
	nt_scene scene;
	nt_mesh *mesh;
} loaded;

static void load(loaded *l, const char *name, size_t mesh)
{
	static const nt_read_options options = {.texcoord_set = -1, .world = true};
	nt_error error;
	open_file(&l->scene, &l->file, name, &options);
	l->mesh = &l->scene.meshes[mesh];
	if (nt_gltf_load(&l->scene, l->mesh, &options, &error))
		fail_msg("%s: %s: %s", name, error.place.pointer, error.message);
}

static void unload(loaded *l)
{
	nt_scene_free(&l->scene);
	nt_file_close(&l->file);
}

static bool lists_extension(const loaded *l, const char *list)
{
	return nt_gltf_root_member(l->scene.source, list) != NULL;
}

static void solve_as(const char *input, const char *output, nt_settings settings)
{
	settings.verify = true;
	nt_summary summary = convert_file(input, output, settings);
	assert_int_equal(summary.solved_count, 1);
	nt_summary_free(&summary);
}

static void solve(const char *input, const char *output, nt_draco_choice draco)
{
	solve_as(input, output, (nt_settings){.draco = draco});
}

static const float *row(const float *rows, const nt_mesh *mesh, size_t corner, size_t width)
{
	return rows + width * (mesh->indices ? mesh->indices[corner] : corner);
}

/* Corner by corner, the attributes of both are the same bits. */
static void check_same_corners(const nt_mesh *a, const nt_mesh *b)
{
	assert_int_equal(a->corner_count, b->corner_count);
	for (size_t c = 0; c < a->corner_count; c++) {
		assert_memory_equal(row(a->positions, a, c, 3), row(b->positions, b, c, 3), 12);
		assert_memory_equal(row(a->normals, a, c, 3), row(b->normals, b, c, 3), 12);
		assert_memory_equal(row(a->texcoords, a, c, 2), row(b->texcoords, b, c, 2), 8);
		assert_memory_equal(row(a->colors, a, c, 4), row(b->colors, b, c, 4), 16);
	}
}

/* Tangents agree within an angle; w is the same. */
static void check_tangents(const nt_mesh *a, const nt_mesh *b, double degrees)
{
	assert_non_null(a->tangents);
	assert_non_null(b->tangents);
	for (size_t c = 0; c < a->corner_count; c++) {
		const float *s = row(a->tangents, a, c, 4), *t = row(b->tangents, b, c, 4);
		const double x = s[1] * t[2] - s[2] * t[1], y = s[2] * t[0] - s[0] * t[2];
		const double z = s[0] * t[1] - s[1] * t[0], dot = s[0] * t[0] + s[1] * t[1] + s[2] * t[2];
		assert_true(atan2(sqrt(x * x + y * y + z * z), dot) * 57.29577951 <= degrees);
		assert_true(s[3] == t[3]);
	}
}

static sheet source;

/* Every view changes. Views of the output are all packed, or all plain. */
TEST(meshopt_gives_what_plain_gives)
{
	write_plain(&source, "plain.glb");
	write_meshopt(&source, accessors_with_views, PRIMITIVE, "packed.glb");
	solve("plain.glb", "plain_out.glb", NT_DRACO_KEEP);
	for (int keeps = 0; keeps < 2; keeps++) {
		solve_as("packed.glb", "packed_out.glb",
			(nt_settings){.meshopt = keeps ? NT_MESHOPT_KEEP : NT_MESHOPT_OFF});
		loaded in, plain, packed;
		load(&in, "packed.glb", 0);
		load(&plain, "plain_out.glb", 0);
		load(&packed, "packed_out.glb", 0);
		check_same_corners(in.mesh, packed.mesh);
		check_same_corners(plain.mesh, packed.mesh);
		check_tangents(plain.mesh, packed.mesh, 0);
		assert_true(packed.mesh->vertex_count > VERTICES);
		const nt_json_value *views = nt_gltf_root_member(packed.scene.source, "bufferViews");
		assert_int_equal(nt_json_count(views), 6);
		for (size_t i = 0; i < nt_json_count(views); i++)
			assert_int_equal(nt_json_find(nt_json_at(views, i), "extensions") != NULL, keeps);
		assert_true(lists_extension(&in, "extensionsRequired"));
		assert_int_equal(lists_extension(&packed, "extensionsRequired"), keeps);
		/* no dead bytes: nothing is left of the packed ones, up to alignment of each view */
		assert_true(packed.file.size < (keeps ? plain.file.size / 2 : plain.file.size + 600));
		unload(&in);
		unload(&plain);
		unload(&packed);
	}
}

/* The same with a u that runs on. */
static sheet even_sheet(void)
{
	sheet even = source;
	for (int v = 0; v < VERTICES; v++)
		even.texcoords[v][0] = (float)(v % (N + 1)) * 0.125f;
	return even;
}

/* Nothing is split, so that nothing has to be unpacked; --verify does. */
TEST(meshopt_views_that_do_not_change_stay_packed)
{
	sheet even = even_sheet();
	write_meshopt(&even, accessors_with_views, PRIMITIVE, "packed.glb");
	solve("packed.glb", "packed_out.glb", NT_DRACO_KEEP);
	loaded out;
	load(&out, "packed_out.glb", 0);
	assert_int_equal(out.mesh->vertex_count, VERTICES);
	assert_memory_equal(out.mesh->positions, even.positions, sizeof even.positions);
	assert_true(lists_extension(&out, "extensionsRequired"));
	unload(&out);
}

/* u runs along x and v, which glTF has down, along y: T = x, N = z and B = -y, so that w = -1. */
TEST(packed_tangents_that_are_valid_stay_packed)
{
	static const int8_t tangent[4] = {127, 0, 0, -127};
	sheet even = even_sheet();
	for (int v = 0; v < VERTICES; v++)
		memcpy(even.colors[v], tangent, sizeof tangent);
	nt_settings settings = {.existing = NT_EXISTING_REPAIR, .verify = true};
	/* the last one has an invalid tangent; and what is asked for beside the repair is done */
	for (int i = 0; i < 4; i++) {
		even.colors[N + 3][0] = i < 3 ? 127 : 0;
		write_meshopt(&even, accessors_with_tangents, WITH_TANGENTS, "packed.glb");
		settings.bitangents = i == 1;
		settings.precision = i == 2 ? NT_PRECISION_SHORT : NT_PRECISION_FLOAT;
		nt_summary summary = convert_file("packed.glb", "packed_out.glb", settings);
		assert_int_equal(summary.solved_count, 1);
		nt_summary_free(&summary);
		assert_int_equal(same_files("packed.glb", "packed_out.glb"), i == 0);
	}
}

/* Splitting the first primitive gives the second, which gets no tangents, new vertices too: in all of its
 * attributes. */
TEST(meshopt_views_of_others_in_the_pool_grow)
{
	write_meshopt(&source, accessors_with_views, TWO_PRIMITIVES, "packed.glb");
	solve("packed.glb", "packed_out.glb", NT_DRACO_KEEP);
	loaded in, out;
	load(&in, "packed.glb", 1);
	load(&out, "packed_out.glb", 1);
	assert_true(out.mesh->vertex_count > VERTICES);
	check_same_corners(in.mesh, out.mesh);
	unload(&in);
	unload(&out);
}

static void check_draco(nt_draco_method method)
{
	write_draco(&source, method, "in.glb");
	solve("in.glb", "plain.glb", NT_DRACO_OFF);
	solve("in.glb", "out.glb", NT_DRACO_KEEP);
	loaded in, plain, out;
	load(&in, "in.glb", 0);
	load(&plain, "plain.glb", 0);
	load(&out, "out.glb", 0);
	check_same_corners(in.mesh, plain.mesh);
	assert_false(lists_extension(&plain, "extensionsUsed"));
	assert_true(lists_extension(&out, "extensionsRequired"));
	assert_true(out.mesh->vertex_count >= plain.mesh->vertex_count);
	assert_int_equal(out.mesh->corner_count, CORNERS);
	/* tangents compressed by 12 bits: libraries.md measured 0.024 degrees */
	if (method == NT_DRACO_SEQUENTIAL) {
		check_same_corners(in.mesh, out.mesh);
		check_tangents(plain.mesh, out.mesh, 0.03);
		assert_int_equal(out.mesh->vertex_count, plain.mesh->vertex_count);
	} else {
		assert_non_null(out.mesh->tangents);
	}
	assert_true(out.file.size < plain.file.size / 2);
	unload(&in);
	unload(&plain);
	unload(&out);
}

/* The block of a file's only primitive. */
static const nt_draco_mesh *block_of(const loaded *l)
{
	uint64_t view;
	const nt_json_value *meshes = nt_gltf_root_member(l->scene.source, "meshes");
	const nt_json_value *primitive =
		nt_json_at(nt_json_find(nt_json_at(meshes, 0), "primitives"), 0);
	const nt_json_value *extension = nt_gltf_draco_of(primitive);
	assert_true(nt_json_get_uint64(nt_json_find(extension, "bufferView"), &view));
	const nt_draco_mesh *mesh = nt_gltf_draco_block(l->scene.source, view);
	assert_non_null(mesh);
	return mesh;
}

/* Half a step of the quantization of values over `range`, and rounding. */
static double half_step(double range, int bits)
{
	return range / ((1 << bits) - 1) * 0.5 + 1e-6;
}

TEST(explicit_methods_compress_plain_primitives)
{
	write_plain(&source, "in.glb");
	solve("in.glb", "plain.glb", NT_DRACO_OFF);
	solve("in.glb", "out.glb", NT_DRACO_AS_SEQUENTIAL);
	loaded plain, out;
	load(&plain, "plain.glb", 0);
	load(&out, "out.glb", 0);
	assert_int_equal(block_of(&out)->method, NT_DRACO_SEQUENTIAL);
	assert_true(lists_extension(&out, "extensionsUsed"));
	assert_true(lists_extension(&out, "extensionsRequired"));
	assert_int_equal(out.mesh->vertex_count, plain.mesh->vertex_count);
	assert_int_equal(out.mesh->corner_count, plain.mesh->corner_count);
	/* positions lie in a box of 3, 14 bits; texture coordinates (-2 to 5 times 0.125) in one of 0.875, 12 */
	for (size_t c = 0; c < CORNERS; c++) {
		for (size_t k = 0; k < 3; k++)
			assert_true(fabs(row(out.mesh->positions, out.mesh, c, 3)[k] -
				row(plain.mesh->positions, plain.mesh, c, 3)[k]) <= half_step(3, 14));
		for (size_t k = 0; k < 2; k++)
			assert_true(fabs(row(out.mesh->texcoords, out.mesh, c, 2)[k] -
				row(plain.mesh->texcoords, plain.mesh, c, 2)[k]) <= half_step(0.875, 12));
		assert_memory_equal(row(out.mesh->colors, out.mesh, c, 4),
			row(plain.mesh->colors, plain.mesh, c, 4), 16);
	}
	check_tangents(plain.mesh, out.mesh, 0.03);
	/* the plain elements are gone: four bytes are left of each */
	assert_true(out.file.size < plain.file.size / 2);
	unload(&plain);
	unload(&out);
}

TEST(explicit_methods_replace_the_one_of_the_source)
{
	const struct {
		nt_draco_method before, after;
		nt_draco_choice choice;
	} cases[] = {
		{NT_DRACO_SEQUENTIAL, NT_DRACO_EDGEBREAKER, NT_DRACO_AS_EDGEBREAKER},
		{NT_DRACO_EDGEBREAKER, NT_DRACO_SEQUENTIAL, NT_DRACO_AS_SEQUENTIAL},
	};
	loaded in, out;
	for (size_t i = 0; i < 2; i++) {
		write_draco(&source, cases[i].before, "in.glb");
		solve("in.glb", "out.glb", cases[i].choice);
		load(&in, "in.glb", 0);
		load(&out, "out.glb", 0);
		assert_int_equal(block_of(&in)->method, cases[i].before);
		assert_int_equal(block_of(&out)->method, cases[i].after);
		assert_non_null(out.mesh->tangents);
		assert_int_equal(out.mesh->corner_count, CORNERS);
		/* nothing is quantized twice */
		if (cases[i].after == NT_DRACO_SEQUENTIAL)
			check_same_corners(in.mesh, out.mesh);
		unload(&in);
		unload(&out);
	}
	/* a plain one by edgebreaker; faces without area are kept by the sequential method */
	sheet sheets[2] = {source, source};
	sheets[1].indices[0] = sheets[1].indices[1];
	for (size_t i = 0; i < 2; i++) {
		write_plain(&sheets[i], "in.glb");
		solve("in.glb", "out.glb", NT_DRACO_AS_EDGEBREAKER);
		load(&out, "out.glb", 0);
		assert_int_equal(block_of(&out)->method, i ? NT_DRACO_SEQUENTIAL : NT_DRACO_EDGEBREAKER);
		assert_int_equal(out.mesh->corner_count, CORNERS);
		unload(&out);
	}
}

static int compare_floats(const void *a, const void *b)
{
	return memcmp(a, b, 3 * sizeof(float));
}

/* Edgebreaker reorders: the positions of all corners are the same as a set. */
TEST(draco_keeps_every_value)
{
	check_draco(NT_DRACO_SEQUENTIAL);
	check_draco(NT_DRACO_EDGEBREAKER);
	loaded in, out;
	load(&in, "in.glb", 0);
	load(&out, "out.glb", 0);
	static float a[CORNERS][3], b[CORNERS][3];
	for (size_t c = 0; c < CORNERS; c++) {
		memcpy(a[c], row(in.mesh->positions, in.mesh, c, 3), sizeof a[c]);
		memcpy(b[c], row(out.mesh->positions, out.mesh, c, 3), sizeof b[c]);
	}
	qsort(a, CORNERS, sizeof a[0], compare_floats);
	qsort(b, CORNERS, sizeof b[0], compare_floats);
	assert_memory_equal(a, b, sizeof a);
	unload(&in);
	unload(&out);
}

/* Byte for byte damage in the packed data is refused or gives some mesh, with indices that are checked. */
TEST(damaged_blocks_are_harmless)
{
	for (int kind = 0; kind < 2; kind++) {
		if (kind)
			write_meshopt(&source, accessors_with_views, PRIMITIVE, "good.glb");
		else
			write_draco(&source, NT_DRACO_EDGEBREAKER, "good.glb");
		nt_file good = file_in_folder("good.glb");
		nt_error error;
		unsigned char *bytes = malloc(good.size);
		for (size_t i = 0; i < 150; i++) {
			memcpy(bytes, good.data, good.size);
			bytes[good.size - 1 - i * 13 % good.size] ^= (unsigned char)(1u << i % 8);
			put_file("bad.glb", bytes, good.size);
			const nt_settings settings = {.texcoord_set = -1, .dry_run = true};
			nt_summary summary;
			const nt_status status =
				nt_run(in_folder("bad.glb"), in_folder("never.glb"), &settings, &summary, &error);
			assert_int_not_equal(status, NT_ERROR_INTERNAL);
			nt_summary_free(&summary);
		}
		free(bytes);
		nt_file_close(&good);
	}
}

static int set_up(void **state)
{
	make_sheet(&source);
	return make_folder(state);
}

AROUND_ALL(set_up, remove_folder)
