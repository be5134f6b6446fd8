/* SPDX-License-Identifier: MIT */
/*
 * The hash of the weld's rows (topology/weld_row.h): vertices of structured meshes spread over a table as random ones
 * would.
 */
#include "test.h"
#include "topology/weld_parts.h"

enum { SIDE = 256, COUNT = SIDE * SIDE, TABLE_BITS = 17, TAG_BITS = 14 };

/* Row i of a family; the rows of a family are all different. x and y run over a grid of SIDE by SIDE. */
typedef void make_row(unsigned i, float x, float y, float row[8]);

static void set(
	float row[8], float px, float py, float pz, float nx, float ny, float nz, float u, float v)
{
	memcpy(row, (float[8]){px, py, pz, nx, ny, nz, u, v}, 8 * sizeof *row);
}

static void plane_of_integers(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, x, y, 0, 0, 0, 1, x / 256, y / 256);
}

static void plane_on_its_side(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, 0, x, y, 1, 0, 0, 0, 0);
}

static void plane_about_the_origin(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, x - 127.5f, 0, y - 127.5f, 0, 1, 0, 0.5f, 0.5f);
}

static void line_of_integers(unsigned i, float x, float y, float row[8])
{
	(void)x;
	(void)y;
	set(row, (float)i, 0, 0, 0, 0, 0, 0, 0);
}

static void line_of_v(unsigned i, float x, float y, float row[8])
{
	(void)x;
	(void)y;
	set(row, 0, 0, 0, 0, 0, 0, 0, (float)i);
}

static void mirrored_in_all_axes(unsigned i, float x, float y, float row[8])
{
	const float sx = i & 1 ? -1.0f : 1.0f, sy = i & 256 ? -1.0f : 1.0f;
	x = (float)((int)x / 2) + 0.25f;
	y = (float)((int)y / 2) + 0.25f;
	set(row, sx * x, sy * y, x + y, sx, sy, 0, x, y);
}

static void coordinates_that_are_swapped(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, x, y, x, y, x, y, x, y);
}

static void texture_coordinates_alone(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, 1, 2, 3, 0, 0, 1, x / 256, y / 256);
}

static void normals_of_a_byte(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, 0, 0, 0, (x - 128) / 128, (y - 128) / 128, 1, 0, 0);
}

static void position_and_texture_apart(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, x, 0, 0, 0, 0, 1, y, 0);
}

static void powers_of_two(unsigned i, float x, float y, float row[8])
{
	(void)x;
	(void)y;
	float values[8];
	for (int k = 0; k < 8; k++)
		values[k] = (i >> (2 * k) & 3) == 0 ? 0.0f
						    : 0.5f * (float)(1 << (i >> (2 * k) & 3));
	memcpy(row, values, sizeof values);
}

static void z_in_the_last_bits(unsigned i, float x, float y, float row[8])
{
	(void)x;
	(void)y;
	set(row, 1, 1, 1 + (float)i * 0x1p-23f, 0, 0, 1, 0, 0);
}

static void shorts_from_0_to_1(unsigned i, float x, float y, float row[8])
{
	(void)i;
	set(row, x * 257 / 65535, y * 257 / 65535, 0, 0, 0, 1, x * 257 / 65535,
		1 - y * 257 / 65535);
}

static void cube_of_few_values(unsigned i, float x, float y, float row[8])
{
	(void)x;
	(void)y;
	set(row, (float)(i % 40), (float)(i / 40 % 40), (float)(i / 1600), 0, 0, 1, 0, 0);
}

static void hash_of_a_row(make_row *make, uint64_t *hashes)
{
	const nt_weld_key key = nt_weld_make_key();
	for (unsigned i = 0; i < COUNT; i++) {
		float values[8];
		nt_weld_row row;
		make(i, (float)(i % SIDE), (float)(i / SIDE), values);
		memcpy(&row, values, sizeof row);
		hashes[i] = nt_weld_hash(&key, &row);
	}
}

/* Mean entries looked at to find a row again in a table that has become half full. */
static double mean_probes(const uint64_t *hashes)
{
	bool *taken = calloc((size_t)1 << TABLE_BITS, sizeof *taken);
	size_t probes = 0;
	for (unsigned i = 0; i < COUNT; i++) {
		size_t at = (size_t)(hashes[i] >> (64 - TABLE_BITS));
		for (probes++; taken[at]; at = (at + 1) % ((size_t)1 << TABLE_BITS))
			probes++;
		taken[at] = true;
	}
	free(taken);
	return (double)probes / COUNT;
}

/* How often two rows agree in the bits of a tag, beside hashes that are random. */
static double tag_matches(const uint64_t *hashes)
{
	size_t *counts = calloc((size_t)1 << TAG_BITS, sizeof *counts);
	double pairs = 0;
	const nt_welder w = {.table_bits = 33 - TAG_BITS};
	for (unsigned i = 0; i < COUNT; i++)
		pairs += (double)counts[nt_weld_entry(&w, hashes[i], 0) >> (32 - TAG_BITS)]++;
	free(counts);
	return pairs * (1 << TAG_BITS) / (0.5 * COUNT * (COUNT - 1.0));
}

TEST(structured_rows_spread_like_random_ones)
{
	static const struct {
		const char *name;
		make_row *make;
	} families[] = {
		{"a plane of whole numbers", plane_of_integers},
		{"a plane on its side", plane_on_its_side},
		{"a plane about the origin", plane_about_the_origin},
		{"a line of whole numbers", line_of_integers},
		{"a line of whole v", line_of_v},
		{"mirrored in all axes", mirrored_in_all_axes},
		{"coordinates that are swapped", coordinates_that_are_swapped},
		{"texture coordinates alone", texture_coordinates_alone},
		{"normals of a byte", normals_of_a_byte},
		{"position and texture apart", position_and_texture_apart},
		{"powers of two", powers_of_two},
		{"z in the last bits", z_in_the_last_bits},
		{"shorts from 0 to 1", shorts_from_0_to_1},
		{"a cube of few values", cube_of_few_values},
	};
	uint64_t *hashes = malloc(COUNT * sizeof *hashes);
	for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
		/* linear probing, random hashes: (1 + 1 / (1 - 1/2)) / 2 = 1.5 (Knuth 6.4); a table of 2^17 entries
		 * strays from it by 0.01 */
		hash_of_a_row(families[f].make, hashes);
		const double probes = mean_probes(hashes), tags = tag_matches(hashes);
		if (probes < 1.45 || probes > 1.55 || tags < 0.9 || tags > 1.1)
			fail_msg("%s: %.3f probes instead of 1.5, tags agree %.3f times as often as random ones",
				families[f].name, probes, tags);
	}
	free(hashes);
}

int main(void)
{
	return run_group("topology/weld_hash");
}
