/* SPDX-License-Identifier: MIT */
#include "base/hash.h"
#include "test.h"
#include <stdbool.h>

TEST(hashes_tell_texts_and_lengths_apart)
{
	const uint64_t a = nt_hash_bytes(0, "abcde", 5);
	assert_true(a == nt_hash_bytes(0, "abcdeX", 5));
	assert_true(a != nt_hash_bytes(0, "abcdf", 5));
	assert_true(a != nt_hash_bytes(1, "abcde", 5));
	/* a zero more is another text */
	assert_true(a != nt_hash_bytes(0, "abcde\0", 6));
	assert_true(nt_hash_bytes(0, "", 0) != nt_hash_bytes(0, "\0", 1));
	/* all blocks count, in their order */
	const char text[] = "0123456789abcdefghijklmnopqrstuv9876543210";
	for (size_t i = 0; i + 1 < sizeof text; i++) {
		char other[sizeof text];
		memcpy(other, text, sizeof text);
		other[i]++;
		assert_true(nt_hash_bytes(0, text, sizeof text - 1) != nt_hash_bytes(0, other, sizeof text - 1));
	}
	assert_true(nt_hash_bytes(0, text, 32) != nt_hash_bytes(0, "ghijklmnopqrstuv0123456789abcdef", 32));
}

/* Written names are the same in each process. */
TEST(names_have_no_key)
{
	assert_true(nt_hash_name(0, "") == 0x9e3779b97f4a7c15u);
	/* one word, and then the upper half added to the lower by XOR */
	const uint64_t product = (0x9e3779b97f4a7c15u ^ 1 ^ 'a') * 0xff51afd7ed558ccdu;
	assert_true(nt_hash_name(0, "a") == (product ^ product >> 32));
}

TEST(equal_floats_have_equal_bits)
{
	assert_true(nt_hash_floats(0.0f, -0.0f) == nt_hash_floats(-0.0f, 0.0f));
	assert_true(nt_hash_floats(1, 2) != nt_hash_floats(2, 1));
}

/* The output of a process of its own. */
static uint64_t hash_of_other_process(void)
{
	char command[4096], line[32] = "";
	snprintf(command, sizeof command, "'%s' hash", own_name);
	FILE *other = popen(command, "r");
	assert_non_null(other);
	assert_non_null(fgets(line, sizeof line, other));
	assert_int_equal(pclose(other), 0);
	return strtoull(line, NULL, 16);
}

TEST(processes_have_keys_of_their_own)
{
	const uint64_t own = nt_hash_bytes(0, "nmtan", 5), one = hash_of_other_process(), two = hash_of_other_process();
	assert_true(own != one && own != two && one != two);
}

/* Mean slots looked at to find one of `count` different pairs again in a half full table of 2^17, of the hash's lower
 * or upper bits. */
static double mean_probes(const uint64_t *key, const uint64_t (*pairs)[2], size_t count, bool upper)
{
	enum { BITS = 17, MASK = (1 << BITS) - 1 };
	bool *taken = calloc(MASK + 1, sizeof *taken);
	size_t probes = 0;
	for (size_t i = 0; i < count; i++) {
		const uint64_t hash = nt_hash_words_by(key, pairs[i][0], pairs[i][1]);
		size_t at = (size_t)(upper ? hash >> (64 - BITS) : hash) & MASK;
		for (probes++; taken[at]; at = (at + 1) & MASK)
			probes++;
		taken[at] = true;
	}
	free(taken);
	return (double)probes / (double)count;
}

/* With any key, as what is random: linear probing needs 1.5 (Knuth 6.4). */
TEST(structured_pairs_spread)
{
	enum { SIDE = 256, COUNT = SIDE * SIDE, FAMILIES = 5, KEYS = 50 };
	uint64_t (*pairs)[2] = malloc(COUNT * sizeof *pairs), key[2] = {1, 2};
	for (int family = 0; family < FAMILIES; family++)
		for (int k = 0; k < KEYS; k++) {
			for (size_t i = 0; i < 2; i++) {
				key[i] = key[i] * 6364136223846793005u + 1442695040888963407u;
				key[i] ^= key[i] >> 33;
			}
			for (uint32_t i = 0; i < COUNT; i++) {
				const uint32_t x = i % SIDE, y = i / SIDE;
				const uint64_t of[FAMILIES][2] = {
					{nt_hash_floats((float)x, (float)y), 0},
					{nt_hash_floats((float)x / 256, 0.5f), nt_hash_floats((float)y / 256, 0)},
					{(uint64_t)7 << 32 | x, y},
					{nt_hash_floats((float)x, 1), y},
					{nt_hash_floats(0, 0), nt_hash_floats(1 + (float)i * 0x1p-23f, 0)},
				};
				memcpy(pairs[i], of[family], sizeof pairs[i]);
			}
			for (int upper = 0; upper < 2; upper++) {
				const double probes = mean_probes(key, (const uint64_t (*)[2])pairs, COUNT, upper);
				if (probes < 1.45 || probes > 1.55)
					fail_msg("family %d, key %d, %s bits: %.3f probes", family, k,
						upper ? "upper" : "lower", probes);
			}
		}
	free(pairs);
}

static int print_hash(int count, char **arguments)
{
	(void)count, (void)arguments;
	return printf("%016llx\n", (unsigned long long)nt_hash_bytes(0, "nmtan", 5)) < 0;
}

WITH_ARGUMENTS(print_hash)
