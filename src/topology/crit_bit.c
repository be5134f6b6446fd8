/* SPDX-License-Identifier: MIT */
/*
 * The tree of crit_bit.h. Node 0 has the whole tree as its child 0, so that there is a place for everything.
 */
#include "topology/crit_bit.h"

static unsigned bit_of(const nt_crit_bit_word *key, unsigned bit)
{
	return key[bit / 32] >> (31 - bit % 32) & 1;
}

uint32_t nt_crit_bit_add(nt_crit_bit *tree, uint32_t number)
{
	nt_crit_bit_node *const nodes = tree->nodes, *at = nodes;
	if (tree->node_count == 0) {
		nodes[tree->node_count++] = (nt_crit_bit_node){{number, 0}, 0, {1, 1}};
		return number;
	}

	/* the one key that may be equal */
	const nt_crit_bit_word *const key = tree->keys + tree->words * number;
	unsigned side = 0;
	while (!at->is_key[side]) {
		at = &nodes[at->child[side]];
		side = bit_of(key, at->bit);
	}
	const uint32_t found = at->child[side];
	const nt_crit_bit_word *const other = tree->keys + tree->words * found;
	size_t word = 0;
	while (word < tree->words && key[word] == other[word])
		word++;
	if (word == tree->words)
		return found;

	/* a node for the first bit in which they differ, before the first one of a later bit */
	const unsigned bit = (unsigned)(32 * word) + (unsigned)__builtin_clz(key[word] ^ other[word]);
	at = nodes;
	side = 0;
	while (!at->is_key[side] && nodes[at->child[side]].bit < bit) {
		at = &nodes[at->child[side]];
		side = bit_of(key, at->bit);
	}
	const unsigned own = bit_of(key, bit);
	nt_crit_bit_node *node = &nodes[tree->node_count];
	node->bit = (uint16_t)bit;
	node->child[own] = number;
	node->is_key[own] = 1;
	node->child[!own] = at->child[side];
	node->is_key[!own] = at->is_key[side];
	at->child[side] = (uint32_t)tree->node_count++;
	at->is_key[side] = 0;
	return number;
}
