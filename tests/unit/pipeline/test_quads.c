/* SPDX-License-Identifier: MIT */
/*
 * Quads of an OBJ as a GLB has them: no triangle of a simple quad is inverted, w is the exact orientation of each
 * triangle, the raw tangents are those of the quads, and only outlines that cross themselves are called folded.
 */
#include "hand_gltf_file.h"
#include <stdio.h>
#include "api/tangents.h"
#include "topology/orientation.h"

enum { QUADS = 4000 };

/* Quads that share nothing. Whole numbers; texture coordinates in 64ths, so that 1 - v is exact. */
static int positions[4 * QUADS][3], texcoords[4 * QUADS][2];

/* Twice the area of a, b, c in the first two coordinates. */
static int64_t area(const int *a, const int *b, const int *c)
{
	return (int64_t)(b[0] - a[0]) * (c[1] - a[1]) - (int64_t)(b[1] - a[1]) * (c[0] - a[0]);
}

static bool sides_cross(const int *a, const int *b, const int *c, const int *d)
{
	return (area(a, b, c) > 0) != (area(a, b, d) > 0) && (area(c, d, a) > 0) != (area(c, d, b) > 0);
}

/* Four points of which no three are on a line. */
typedef int outline[4][2];

static bool crosses(outline q)
{
	return sides_cross(q[0], q[1], q[2], q[3]) || sides_cross(q[1], q[2], q[3], q[0]);
}

/* The corner that turns inwards; -1: there is none. */
static int inner_corner(outline q)
{
	const int64_t whole = area(q[0], q[1], q[2]) + area(q[0], q[2], q[3]);
	for (int k = 0; k < 4; k++)
		if ((area(q[(k + 3) % 4], q[k], q[(k + 1) % 4]) > 0) != (whole > 0))
			return k;
	return -1;
}

static void draw(uint32_t *seed, bool simple, outline q)
{
	do {
		for (int i = 0; i < 8; i++) {
			*seed = *seed * 1664525u + 1013904223u;
			q[i / 2][i % 2] = (int)(*seed >> 26);
		}
	} while (!area(q[0], q[1], q[2]) || !area(q[0], q[2], q[3]) || !area(q[0], q[1], q[3]) ||
		!area(q[1], q[2], q[3]) || (simple && crosses(q)));
}

/* Simple quads, every third one bent, in a plane that holds no axis. The texture has their shape, is its mirror image,
 * any simple quad, or any quad. Returns how many of the textures cross themselves. */
static size_t put_quads(void)
{
	size_t crossed = 0, darts[4][2] = {{0}};
	uint32_t seed = 5;
	nt_buffer text = {0};
	nt_buffer_format(&text, "vn 0 0 1\n");
	for (int i = 0; i < QUADS; i++) {
		outline shape, uv;
		draw(&seed, true, shape);
		draw(&seed, i % 4 == 2, uv);
		for (int k = 0; k < 4; k++) {
			const int x = shape[k][0], y = shape[k][1], z = i % 3 == 0 && k == 2;
			const int p[3] = {x + 2 * y + 2 * z + 1000 * i, 2 * x + y - 2 * z, 2 * x - 2 * y + z};
			const int t[2] = {i % 4 == 1 ? 64 - x : i % 4 ? uv[k][0] : x, i % 4 < 2 ? y : uv[k][1]};
			memcpy(positions[4 * i + k], p, sizeof p);
			memcpy(texcoords[4 * i + k], t, sizeof t);
			nt_buffer_format(&text, "v %d %d %d\nvt %.9g %.9g\n", p[0], p[1], p[2], t[0] / 64.0,
				t[1] / 64.0);
		}
		nt_buffer_format(&text, "f -4/-4/1 -3/-3/1 -2/-2/1 -1/-1/1\n");
		crossed += crosses(texcoords + 4 * i);
		if (i % 4 < 2 && inner_corner(shape) >= 0)
			darts[inner_corner(shape)][i % 4]++;
	}
	for (int k = 0; k < 8; k++)
		assert_true(darts[k / 2][k % 2] > 20);
	put_text_file("in.obj", text.data);
	nt_buffer_free(&text);
	return crossed;
}

/* Against the Newell normal of a quad: more than 0 along, less than 0 against it. */
static int64_t facing(size_t quad, const size_t corners[3])
{
	int64_t n[3] = {0}, t[3] = {0}, sum = 0;
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		for (size_t v = 0; v < 4; v++) {
			const int *p = positions[4 * quad + v], *q = positions[4 * quad + (v + 1) % 4];
			n[i] += (int64_t)p[j] * q[k] - (int64_t)p[k] * q[j];
		}
		for (size_t v = 0; v < 3; v++) {
			const int *p = positions[corners[v]], *q = positions[corners[(v + 1) % 3]];
			t[i] += (int64_t)p[j] * q[k] - (int64_t)p[k] * q[j];
		}
		sum += n[i] * t[i];
	}
	return sum;
}

/* Whether a bent quad is cut into an inverted triangle along either diagonal: seen along its normal it crosses
 * itself. */
static bool is_inverted_anyway(size_t quad)
{
	bool inverted[2] = {false, false};
	for (size_t i = 0; i < 4; i++) {
		const unsigned char *k = nt_quad_triangles[i / 2][i % 2];
		const size_t corners[3] = {4 * quad + k[0], 4 * quad + k[1], 4 * quad + k[2]};
		inverted[i / 2] |= facing(quad, corners) < 0;
	}
	return quad % 3 == 0 && inverted[0] && inverted[1];
}

/* Contents of a GLB: the quads' corners in the order of its triangles, and their tangents. */
typedef struct written {
	size_t corners[6 * QUADS];
	float tangents[6 * QUADS][4];
} written;

static void read_written(const char *name, written *w)
{
	nt_scene scene;
	nt_file file;
	const nt_read_options options = {.texcoord_set = -1};
	open_file(&scene, &file, name, &options);
	const nt_json_value *primitive = nt_json_at(nt_json_find(nt_json_at(nt_gltf_root_member(scene.source, "meshes"),
		0), "primitives"), 0);
	uint64_t p, t, indices, count;
	assert_true(nt_json_get_uint64(nt_json_find(nt_json_find(primitive, "attributes"), "POSITION"), &p));
	assert_true(nt_json_get_uint64(nt_json_find(nt_json_find(primitive, "attributes"), "TANGENT"), &t));
	assert_true(nt_json_get_uint64(nt_json_find(primitive, "indices"), &indices));
	const float *position = rows_of(&scene, (uint32_t)p, 3, &count);
	const float *tangent = rows_of(&scene, (uint32_t)t, 4, &count);
	const float *index = rows_of(&scene, (uint32_t)indices, 1, &count);
	assert_int_equal(count, 6 * QUADS);
	for (size_t i = 0; i < count; i++) {
		size_t c = i / 6 * 4; /* of the quad, the corner at this position */
		const float *at = position + 3 * (size_t)index[i];
		for (; c < i / 6 * 4 + 4; c++)
			if (at[0] == (float)positions[c][0] && at[1] == (float)positions[c][1] &&
				at[2] == (float)positions[c][2])
				break;
		assert_true(c < i / 6 * 4 + 4);
		w->corners[i] = c;
		memcpy(w->tangents[i], tangent + 4 * (size_t)index[i], sizeof w->tangents[i]);
	}
	nt_scene_free(&scene);
	nt_file_close(&file);
}

/* The library's own, of the quads. */
static void solve(float (*tangents)[4])
{
	static float p[4 * QUADS][3], n[4 * QUADS][3], t[4 * QUADS][2];
	static uint8_t sizes[QUADS];
	for (size_t c = 0; c < 4 * QUADS; c++) {
		for (int i = 0; i < 3; i++)
			p[c][i] = (float)positions[c][i];
		for (int i = 0; i < 2; i++)
			t[c][i] = (float)texcoords[c][i] / 64;
		n[c][2] = 1;
	}
	memset(sizes, 4, sizeof sizes);
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.face_count = QUADS;
	mesh.vertex_count = 4 * QUADS;
	mesh.face_sizes = sizes;
	mesh.positions = p[0];
	mesh.normals = n[0];
	mesh.texcoords = t[0];
	nmtan_options options = NMTAN_OPTIONS_INIT;
	options.repair = NMTAN_REPAIR_OFF;
	nmtan_output output = NMTAN_OUTPUT_INIT;
	output.tangents = tangents[0];
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
}

static written repaired, raw;
static float solved[4 * QUADS][4];

TEST(simple_quads_are_written_inside_and_w_fits_each_triangle)
{
	const size_t crossed = put_quads();
	nt_settings settings = {.output_format = NT_FORMAT_GLB, .verify = true};
	nt_summary summary = convert_file("in.obj", "out.glb", settings);
	assert_int_equal(count_findings(&summary, NT_CODE_UV_FOLDED_QUAD), crossed);
	nt_summary_free(&summary);
	settings.repair = NMTAN_REPAIR_OFF;
	summary = convert_file("in.obj", "raw.glb", settings);
	nt_summary_free(&summary);
	read_written("out.glb", &repaired);
	read_written("raw.glb", &raw);
	assert_memory_equal(repaired.corners, raw.corners, sizeof raw.corners);
	solve(solved);
	size_t kept = 0;
	for (size_t i = 0; i < 6 * QUADS; i += 3) {
		const size_t *c = repaired.corners + i;
		assert_true(facing(i / 6, c) >= 0 || is_inverted_anyway(i / 6));
		const float w = area(texcoords[c[0]], texcoords[c[1]], texcoords[c[2]]) > 0 ? 1 : -1;
		for (size_t k = 0; k < 3; k++) {
			assert_float_equal(repaired.tangents[i + k][3], w, 0);
			assert_memory_equal(raw.tangents[i + k], solved[c[k]], sizeof *solved);
			kept += memcmp(repaired.tangents[i + k], solved[c[k]], sizeof *solved) == 0;
		}
		/* where the texture has the shape of a flat quad, or is its mirror image, MikkTSpace's w is right */
		if (i / 6 % 4 < 2 && i / 6 % 3)
			assert_float_equal(solved[c[0]][3], w, 0);
	}
	assert_true(kept > 5 * QUADS);
}

AROUND_ALL(make_folder, remove_folder)
