/* SPDX-License-Identifier: MIT */
/*
 * Whether this build computes what every other does. Flags that let a compiler round or order operations as it likes
 * have no macro everywhere, and the floating point of a processor may be set to flush small numbers: so a few triangles
 * are solved by each method, and what comes of them has one digest. The mesh is 25 vertices of eight bytes, with a
 * mirror seam, normals of uneven length, sums that cancel and zeros of either sign, closed by triangles to a pole, as
 * spheres have them: clang's -funsafe-math-optimizations shows nowhere else.
 */
#include <string.h>
#include "base/exact.h"
#include "nmtan.h"

enum { COLUMNS = 5, GRID = COLUMNS * COLUMNS, RIM = 4 * (COLUMNS - 1), VERTICES = GRID + RIM,
	TRIANGLES = 2 * (COLUMNS - 1) * (COLUMNS - 1) + 2 * RIM };

/* The result of every build, and of those of nmtan.c that have MikkTSpace's methods alone. */
#ifdef NT_NO_SUMS
enum { LAST_METHOD = NMTAN_METHOD_MIKKTSPACE };
static const uint64_t digest_of_all = 0x7cc3bc5d62f0313bu;
#else
enum { LAST_METHOD = NMTAN_METHOD_ROBUST };
static const uint64_t digest_of_all = 0xcb30618f7a5c4e6fu;
#endif

/* Position, normal, texture coordinate. */
static const int8_t rows[GRID][8] = {
	{-48, -48, 0, 0, 0, 127, -48, -48}, {-24, -48, 0, 0, 0, 127, -24, -48}, {0, -48, 0, 0, 0, 127, 0, -48},
	{24, -48, 0, 0, 0, 127, 24, -48}, {48, -48, 0, 0, 0, 127, 0, -48}, {-48, -24, 0, 0, 0, 127, -48, -24},
	{-24, -24, 0, 0, 0, 127, -24, -24}, {0, -24, 0, 0, 0, 127, 0, -24}, {24, -24, 0, 0, 0, 127, 24, -24},
	{48, -24, 0, 0, 0, 127, 0, -24}, {-52, 1, -11, 22, 13, 92, -55, 8}, {-15, 1, 1, 4, 36, 121, -15, 5},
	{-7, -7, -3, 20, -32, 93, 0, 9}, {29, 0, 4, 4, -38, 119, 22, -4}, {42, 6, -17, -13, -4, 98, 2, 3},
	{-45, 30, -15, -19, 17, 115, -40, 23}, {-29, 28, 15, -5, 13, 112, -21, 22},
	{-5, 17, -9, -21, -11, 104, -9, 30}, {33, 20, -4, -4, -40, 99, 20, 32}, {50, 33, 0, -24, 25, 93, -5, 32},
	{-45, 51, 5, 10, -27, 120, -45, 40}, {-27, 41, -7, 16, -20, 97, -23, 40}, {-6, 39, 16, -21, 28, 96, 2, 39},
	{17, 45, 19, 8, -21, 106, 22, 50}, {54, 42, -13, 22, 19, 120, -6, 48}};

/* Vertices around the grid. Each has one of its own at a pole, which are as far apart as rounding puts them. */
static const uint8_t rim[RIM] = {0, 1, 2, 3, 4, 9, 14, 19, 24, 23, 22, 21, 20, 15, 10, 5};

/* FNV-1a over the values of floats, whatever the order of their bytes. */
static uint64_t digest_floats(uint64_t digest, const float *floats, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t bits;
		memcpy(&bits, &floats[i], sizeof bits);
		for (int byte = 0; byte < 4; byte++, bits >>= 8)
			digest = (digest ^ (bits & 0xff)) * 0x100000001b3u;
	}
	return digest;
}

static void make_triangles(uint32_t *indices)
{
	for (uint32_t row = 0; row + 1 < COLUMNS; row++)
		for (uint32_t column = 0; column + 1 < COLUMNS; column++, indices += 6) {
			const uint32_t a = row * COLUMNS + column, c = a + COLUMNS + 1;
			const uint32_t corners[6] = {a, a + 1, c, a, c, c - 1};
			memcpy(indices, corners, sizeof corners);
		}
	for (uint32_t i = 0; i < RIM; i++, indices += 6) {
		const uint32_t next = (i + 1) % RIM;
		const uint32_t corners[6] = {GRID + i, rim[i], rim[next], GRID + i, rim[next], GRID + next};
		memcpy(indices, corners, sizeof corners);
	}
}

int nmtan_self_test(void)
{
	float vertices[VERTICES][8], tangents[3 * TRIANGLES][4], bitangents[3 * TRIANGLES][3];
	float magnitudes[3 * TRIANGLES][2];
	uint32_t indices[3 * TRIANGLES];
	uint64_t digest = 0xcbf29ce484222325u;
	const volatile double above_half = 0x1p-53 + 0x1p-90; /* of the last place of 1 */
	if (nt_fma(above_half, 1.0, 1.0) == 1.0)
		return 0;
	for (size_t v = 0; v < GRID; v++)
		for (size_t i = 0; i < 8; i++)
			vertices[v][i] = (float)rows[v][i] / (i < 3 ? 100.0f : 127.0f);
	for (size_t i = 0; i < RIM; i++) {
		const float x = vertices[rim[i]][0] * 0x1p-54f, y = vertices[rim[i]][1] * 0x1p-54f;
		const float pole[8] = {x, y, -1.0f, x, y, -1.0f, (float)i / (float)RIM, 0.0f};
		memcpy(vertices[GRID + i], pole, sizeof pole);
	}
	make_triangles(indices);
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.face_count = TRIANGLES;
	mesh.vertex_count = VERTICES;
	mesh.indices = indices;
	mesh.positions = vertices[0];
	mesh.normals = vertices[0] + 3;
	mesh.texcoords = vertices[0] + 6;
	mesh.position_stride_bytes = mesh.normal_stride_bytes = mesh.texcoord_stride_bytes = sizeof *vertices;
	nmtan_output output = NMTAN_OUTPUT_INIT;
	output.tangents = tangents[0];
	output.bitangents = bitangents[0];
	output.magnitudes = magnitudes[0];
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= LAST_METHOD; method++)
		for (int more = 0; more < 2; more++) {
			nmtan_options options = NMTAN_OPTIONS_INIT;
			options.method = (nmtan_method)method;
			options.repair = more ? NMTAN_REPAIR_OFF : NMTAN_REPAIR_ON;
			options.threads = 1;
			output.bitangents = more ? bitangents[0] : NULL;
			output.magnitudes = more ? magnitudes[0] : NULL;
			if (nmtan_tangents(&mesh, &options, &output, NULL) != NMTAN_OK)
				return 0;
			digest = digest_floats(digest, tangents[0], sizeof tangents / sizeof(float));
			if (more) {
				digest = digest_floats(digest, bitangents[0], sizeof bitangents / sizeof(float));
				digest = digest_floats(digest, magnitudes[0], sizeof magnitudes / sizeof(float));
			}
		}
	return digest == digest_of_all;
}
