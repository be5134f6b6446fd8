/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <stdlib.h>
#include <string.h>
#include "topology/crit_bit.h"

enum { WORDS = 3 };

/* Adds all keys and compares with a search among those before. Returns the steps to the deepest key. */
static size_t add_all(const uint32_t (*keys)[WORDS], size_t count)
{
	nt_crit_bit tree = {.keys = keys[0], .words = WORDS, .nodes = malloc(count * sizeof *tree.nodes)};
	for (size_t i = 0; i < count; i++) {
		size_t first = 0;
		while (memcmp(keys[first], keys[i], sizeof keys[i]) != 0)
			first++;
		assert_int_equal(nt_crit_bit_add(&tree, (uint32_t)i), first);
	}
	size_t *depths = calloc(tree.node_count, sizeof *depths), deepest = 0;
	for (size_t left = tree.node_count; left-- > 0;) /* nodes below others may come before them */
		for (size_t n = 0; n < tree.node_count; n++)
			for (unsigned side = 0; side < (n ? 2u : 1u); side++)
				if (!tree.nodes[n].is_key[side] && depths[tree.nodes[n].child[side]] < depths[n] + 1) {
					depths[tree.nodes[n].child[side]] = depths[n] + 1;
					left = tree.node_count; /* again */
				}
	for (size_t n = 0; n < tree.node_count; n++)
		deepest = depths[n] > deepest ? depths[n] : deepest;
	free(depths);
	free(tree.nodes);
	return deepest;
}

static void keys_are_numbered_by_the_first_equal_one(void **state)
{
	(void)state;
	enum { COUNT = 1000 };
	uint32_t keys[COUNT][WORDS], random = 1;
	for (uint32_t kinds = 1; kinds < 5000; kinds *= 7) {
		for (size_t i = 0; i < COUNT; i++) {
			random = random * 1664525u + 1013904223u;
			const uint32_t kind = (random >> 8) % kinds;
			memcpy(keys[i], (uint32_t[WORDS]){kind % 3, kind * 0x9e3779b1u, kind / 100 << 31},
				sizeof keys[i]);
		}
		assert_true(add_all(keys, COUNT) < 32 * WORDS);
	}
}

/* The longest way there is: each key differs from those before in one bit more. */
static void the_deepest_tree_has_a_node_for_each_bit(void **state)
{
	(void)state;
	uint32_t keys[32 * WORDS + 1][WORDS] = {{0}};
	for (size_t i = 1; i <= 32 * WORDS; i++) {
		memcpy(keys[i], keys[i - 1], sizeof keys[i]);
		keys[i][(i - 1) / 32] |= (uint32_t)1 << (31 - (i - 1) % 32);
	}
	assert_int_equal(add_all(keys, 32 * WORDS + 1), 32 * WORDS);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(keys_are_numbered_by_the_first_equal_one),
		cmocka_unit_test(the_deepest_tree_has_a_node_for_each_bit),
	};
	return cmocka_run_group_tests_name("topology/crit_bit", tests, NULL, NULL);
}
