/* SPDX-License-Identifier: MIT */
/*
 * digest FILE...: one number for the results of all methods, with and without repair, on golden meshes. Every build of
 * the library prints the same. C11 and C++, for programs that link nothing else; the meshes are read byte by byte,
 * whatever the order of the processor's.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "nmtan.h"

static uint64_t digest = 0xcbf29ce484222325u;

static void add_words(const void *words, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		uint32_t bits;
		memcpy(&bits, (const char *)words + 4 * i, sizeof bits);
		if ((bits & 0x7fffffffu) > 0x7f800000u)
			bits = 0x7fc00000u; /* the bits of a NaN are not promised */
		digest = (digest ^ bits) * 0x100000001b3u;
	}
}

static uint32_t word_at(const unsigned char *bytes)
{
	return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static float *read_floats(const unsigned char *bytes, size_t count)
{
	float *floats = (float *)malloc(count * sizeof *floats + 1);
	for (size_t i = 0; floats && i < count; i++) {
		const uint32_t bits = word_at(bytes + 4 * i);
		memcpy(&floats[i], &bits, sizeof bits);
	}
	return floats;
}

/* Corners, then vertices after a split. */
static int solve(const nmtan_mesh *mesh, size_t corners, nmtan_method method, nmtan_repair repair)
{
	nmtan_options options = NMTAN_OPTIONS_INIT;
	options.method = method;
	options.repair = repair;
	options.threads = 3;
	float *floats = (float *)malloc((4 + 3 + 2 + 8) * corners * sizeof *floats + 1);
	uint32_t *indices = (uint32_t *)malloc(2 * corners * sizeof *indices + 1);
	nmtan_output output = NMTAN_OUTPUT_INIT;
	output.tangents = floats;
	output.bitangents = floats + 4 * corners;
	output.magnitudes = floats + 7 * corners;
	nmtan_split_output split = NMTAN_SPLIT_OUTPUT_INIT;
	split.indices = indices;
	split.sources = indices + corners;
	split.source_capacity = corners;
	split.vertex_tangents = floats + 9 * corners;
	const int failed = !floats || !indices || nmtan_tangents(mesh, &options, &output, NULL) != NMTAN_OK ||
		nmtan_vertex_tangents(mesh, &options, &split, NULL) != NMTAN_OK;
	if (!failed) {
		add_words(floats, 9 * corners);
		add_words(split.vertex_tangents, 4 * (mesh->vertex_count + split.source_count));
		add_words(indices, corners);
	}
	free(floats);
	free(indices);
	return failed;
}

/* A golden file (data/golden/FORMAT.md), as it is and with the corners of its faces taken by index, so that seams and
 * shared vertices come up. */
static int digest_file(const char *path)
{
	static unsigned char bytes[1 << 22];
	FILE *file = fopen(path, "rb");
	const size_t size = file ? fread(bytes, 1, sizeof bytes, file) : 0;
	if (file)
		fclose(file);
	const size_t faces = size > 16 ? word_at(bytes + 8) : 0, corners = size > 16 ? word_at(bytes + 12) : 0;
	const unsigned char *at = bytes + 16 + (faces + 3) / 4 * 4;
	if (size < 16 || memcmp(bytes, "NMTG", 4) != 0 || size != (size_t)(at - bytes) + 48 * corners)
		return 1;
	float *positions = read_floats(at, 3 * corners), *normals = read_floats(at + 12 * corners, 3 * corners);
	float *texcoords = read_floats(at + 24 * corners, 2 * corners);
	uint32_t *indices = (uint32_t *)malloc(corners * sizeof *indices + 1);
	nmtan_mesh mesh = NMTAN_MESH_INIT;
	mesh.face_count = faces;
	mesh.vertex_count = corners;
	mesh.face_sizes = bytes + 16;
	mesh.positions = positions;
	mesh.normals = normals;
	mesh.texcoords = texcoords;
	int failed = !positions || !normals || !texcoords || !indices;
	for (size_t c = 0; !failed && c < corners; c++)
		indices[c] = (uint32_t)(c % 7 == 6 ? c - 6 : c);
	for (int method = NMTAN_METHOD_MIKKTSPACE; !failed && method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
		for (int i = 0; !failed && i < 4; i++) {
			mesh.indices = i / 2 ? indices : NULL;
			failed = solve(&mesh, corners, (nmtan_method)method,
				i % 2 ? NMTAN_REPAIR_OFF : NMTAN_REPAIR_ON);
		}
	free(positions);
	free(normals);
	free(texcoords);
	free(indices);
	return failed;
}

int main(int count, char **arguments)
{
	for (int i = 1; i < count; i++)
		if (digest_file(arguments[i])) {
			printf("%s fails\n", arguments[i]);
			return 1;
		}
	printf("%08lx%08lx self-test %d\n", (unsigned long)(digest >> 32), (unsigned long)(digest & 0xffffffffu),
		nmtan_self_test());
	return count < 2;
}
