/* SPDX-License-Identifier: MIT */
/*
 * A crit-bit tree (PATRICIA: Morrison 1968) of keys that are in an array: what tables of hashes turn to when the keys
 * were made to have one hash. A key is found in as many steps as it has bits at most, whatever the others are.
 */
#ifndef NT_TOPOLOGY_CRIT_BIT_H
#define NT_TOPOLOGY_CRIT_BIT_H

#include <stddef.h>
#include <stdint.h>

/* Where keys that are equal so far part: those with a 0 as bit `bit` are below child 0. */
typedef struct nt_crit_bit_node {
	uint32_t child[2];
	uint16_t bit;       /* of the key's words, one after the other, each from its highest bit on */
	uint8_t is_key[2];  /* a child is the number of a key, else of a node */
} nt_crit_bit_node;

/* Of keys, which may be floats. */
typedef uint32_t nt_crit_bit_word __attribute__((may_alias));

typedef struct nt_crit_bit {
	const nt_crit_bit_word *keys; /* [..][words]; may move between calls */
	size_t words;
	nt_crit_bit_node *nodes; /* room for one a key */
	size_t node_count;       /* 0: empty */
} nt_crit_bit;

/* Adds the key of that number unless it is there. Returns the number of the equal key in the tree, which may be its
 * own. */
uint32_t nt_crit_bit_add(nt_crit_bit *tree, uint32_t number);

#endif
