/* SPDX-License-Identifier: MIT */
/*
 * What a renderer cannot use, in our answers and in those of native peers (tests/bench/native.h), family by family.
 */
#ifndef NT_STRESS_PEERS_H
#define NT_STRESS_PEERS_H

#include <stdio.h>
#include "../bench/faults.h"
#include "../bench/native.h"

enum { PEERS_OURS = 3, PEERS_MOST = PEERS_OURS + NATIVE_MOST };

typedef struct peers {
	native native[NATIVE_MOST];
	size_t native_count;
} peers;

/* The sums over a family's meshes of triangles. */
typedef struct peer_counts {
	faults of[PEERS_MOST];
	size_t unfinished[PEERS_MOST]; /* meshes on which a peer ended, or did not end within seconds */
} peer_counts;

/* Those in the folder that $PEERS names; what is missing is said. */
void peers_open(peers *p);

/* Adds a mesh; one with quads, or with too many corners to wait for all, is left out. */
void peers_add(const peers *p, const nt_owned *mesh, peer_counts *counts);

void peers_write_head(const peers *p, FILE *md);
void peers_write_row(const peers *p, const char *family, const peer_counts *counts, FILE *md);

#endif
