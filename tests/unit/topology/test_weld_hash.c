/* SPDX-License-Identifier: MIT */
/*
 * The hash of the weld's rows (topology/weld.h): vertices of structured meshes spread over a table as random ones
 * would.
 */
#include "test.h"
#include "topology/inside.h"

enum { SIDE = 256, COUNT = SIDE * SIDE, TABLE_BITS = 17, TAG_BITS = 14 };

enum { FAMILIES = 14 };

static const char *const names[FAMILIES] = {"a plane of whole numbers", "a plane on its side",
	"a plane about the origin", "a line of whole numbers", "a line of whole v", "mirrored in all axes",
	"coordinates that are swapped", "texture coordinates alone", "normals of a byte", "position and texture apart",
	"powers of two", "z in the last bits", "shorts from 0 to 1", "a cube of few values"};

static float power_of_two(unsigned bits)
{
	return bits ? 0.5f * (float)(1 << bits) : 0.0f;
}

/* Row i of each family; the rows of a family are all different. x and y run over a grid of SIDE by SIDE. */
static void make_rows(unsigned i, float rows[FAMILIES][8])
{
	const float x = (float)(i % SIDE), y = (float)(i / SIDE), n = (float)i;
	const float sx = i & 1 ? -1.0f : 1.0f, sy = i & 256 ? -1.0f : 1.0f;
	const float half_x = (float)(i % SIDE / 2) + 0.25f, half_y = (float)(i / SIDE / 2) + 0.25f;
	const float made[FAMILIES][8] = {
		{x, y, 0, 0, 0, 1, x / 256, y / 256},
		{0, x, y, 1, 0, 0, 0, 0},
		{x - 127.5f, 0, y - 127.5f, 0, 1, 0, 0.5f, 0.5f},
		{n, 0, 0, 0, 0, 0, 0, 0},
		{0, 0, 0, 0, 0, 0, 0, n},
		{sx * half_x, sy * half_y, half_x + half_y, sx, sy, 0, half_x, half_y},
		{x, y, x, y, x, y, x, y},
		{1, 2, 3, 0, 0, 1, x / 256, y / 256},
		{0, 0, 0, (x - 128) / 128, (y - 128) / 128, 1, 0, 0},
		{x, 0, 0, 0, 0, 1, y, 0},
		{power_of_two(i & 3), power_of_two(i >> 2 & 3), power_of_two(i >> 4 & 3), power_of_two(i >> 6 & 3),
			power_of_two(i >> 8 & 3), power_of_two(i >> 10 & 3), power_of_two(i >> 12 & 3),
			power_of_two(i >> 14 & 3)},
		{1, 1, 1 + n * 0x1p-23f, 0, 0, 1, 0, 0},
		{x * 257 / 65535, y * 257 / 65535, 0, 0, 0, 1, x * 257 / 65535, 1 - y * 257 / 65535},
		{(float)(i % 40), (float)(i / 40 % 40), (float)(i / 1600), 0, 0, 1, 0, 0},
	};
	memcpy(rows, made, sizeof made);
}

static void hash_rows(size_t family, uint64_t key_of_process, uint64_t *hashes)
{
	nt_hash_key_words[0] = key_of_process * 0x243f6a8885a308d3u | 1;
	nt_hash_key_words[1] = key_of_process * 0x13198a2e03707345u | 1;
	const nt_weld_key key = nt_weld_make_key();
	for (unsigned i = 0; i < COUNT; i++) {
		float rows[FAMILIES][8];
		nt_weld_row row;
		make_rows(i, rows);
		memcpy(&row, rows[family], sizeof row);
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

/* Keys are given: with one of some hundred, tags of a line of whole v agree more often than the bound allows. */
TEST(structured_rows_spread_like_random_ones)
{
	enum { KEYS = 3 };
	uint64_t *hashes = malloc(COUNT * sizeof *hashes);
	for (size_t i = 0; i < FAMILIES * KEYS; i++) {
		const size_t f = i / KEYS, k = i % KEYS + 1;
		/* linear probing, random hashes: (1 + 1 / (1 - 1/2)) / 2 = 1.5 (Knuth 6.4); a table of 2^17 entries
		 * strays from it by 0.01 */
		hash_rows(f, k, hashes);
		const double probes = mean_probes(hashes), tags = tag_matches(hashes);
		if (probes < 1.45 || probes > 1.55 || tags < 0.9 || tags > 1.1)
			fail_msg("%s, key %zu: %.3f probes instead of 1.5, tags agree %.3f times as often as random "
				"ones", names[f], k, probes, tags);
	}
	free(hashes);
}
