/* SPDX-License-Identifier: MIT */
/* See peers.h. A peer runs in a process of its own: mikktspace.c does not end on hubs, and NaN may end any. */
#include "peers.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_CORNERS = 30000, SECONDS = 2 };

static const struct {
	const char *name;
	nmtan_method method;
	nmtan_repair repair;
} ours[PEERS_OURS] = {{"mikktspace raw", NMTAN_METHOD_MIKKTSPACE, NMTAN_REPAIR_OFF},
	{"mikktspace", NMTAN_METHOD_MIKKTSPACE, NMTAN_REPAIR_ON}, {"robust", NMTAN_METHOD_ROBUST, NMTAN_REPAIR_ON}};

void peers_open(peers *p)
{
	p->native_count = native_open(getenv("PEERS"), p->native);
}

static bool solve(size_t which, const nt_owned *mesh, float (*tangents)[4])
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = ours[which].method,
		.repair = ours[which].repair, .threads = 1};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	return nmtan_tangents(&mesh->mesh, &options, &output, NULL) == NMTAN_OK;
}

static bool solve_apart(const native *peer, const nt_owned *mesh, float (*tangents)[4])
{
	int status = 1;
	fflush(NULL);
	const pid_t child = fork();
	if (child == 0) {
		alarm(SECONDS);
		_exit(native_solve(peer, mesh, tangents) ? 0 : 1);
	}
	return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void peers_add(const peers *p, const nt_owned *mesh, peer_counts *counts)
{
	const size_t bytes = 16 * mesh->corner_count;
	if (mesh->face_sizes || mesh->corner_count == 0 || mesh->corner_count > MOST_CORNERS)
		return;
	float (*tangents)[4] = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
	if (tangents == MAP_FAILED)
		return;
	for (size_t i = 0; i < PEERS_OURS + p->native_count; i++) {
		memset(tangents, 0, bytes);
		if (i < PEERS_OURS ? solve(i, mesh, tangents) : solve_apart(&p->native[i - PEERS_OURS], mesh, tangents))
			faults_add(mesh, (const float (*)[4])tangents, &counts->of[i]);
		else
			counts->unfinished[i]++;
	}
	munmap(tangents, bytes);
}

void peers_write_head(const peers *p, FILE *md)
{
	fprintf(md, "\n## What a renderer cannot use\n\nTriangles with two values of w or one that is not "
		"their orientation's / corners whose tangent is not a unit vector / corners more than 2^-10 "
		"off perpendicular, on the meshes of triangles with at most %d corners, all levels together; a "
		"normal that is not finite has nothing across it. (n): a peer ended, or did not end in %d "
		"seconds, on n meshes.\n\n| family |",
		MOST_CORNERS, SECONDS);
	for (size_t i = 0; i < PEERS_OURS + p->native_count; i++)
		fprintf(md, " %s |", i < PEERS_OURS ? ours[i].name : p->native[i - PEERS_OURS].name);
	fprintf(md, "\n|---|");
	for (size_t i = 0; i < PEERS_OURS + p->native_count; i++)
		fprintf(md, "---|");
	fprintf(md, "\n");
}

void peers_write_row(const peers *p, const char *family, const peer_counts *counts, FILE *md)
{
	if (counts->of[0].corners == 0)
		return;
	fprintf(md, "| %s |", family);
	for (size_t i = 0; i < PEERS_OURS + p->native_count; i++) {
		const faults *f = &counts->of[i];
		fprintf(md, " %zu / %zu / %zu", f->wrong, f->zero, f->leaning);
		if (counts->unfinished[i])
			fprintf(md, " (%zu)", counts->unfinished[i]);
		fprintf(md, " |");
	}
	fprintf(md, "\n");
}
