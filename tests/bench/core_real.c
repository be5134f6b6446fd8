/* SPDX-License-Identifier: MIT */
/*
 * See core_real.h. All ways to solve a mesh take turns, so that a busy machine hurts all of them; the best of the rounds
 * counts. nmtan has its default options, repair on; the peers allocate on every call, so that nmtan without a
 * workspace is the fair comparison, and the one that most programs make. One thread is timed by its own clock, more
 * by the wall's.
 */
#include "core_real.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "measure.h"
#include "models.h"
#include "native.h"

enum { ROUNDS = 7, MOST_WAYS = 5 + NATIVE_MOST };

/* What a way runs in one round at least, in seconds. */
static const double ROUND = 0.01;

typedef struct way {
	const char *name;
	nmtan_method method;
	unsigned threads;
	bool warm;          /* with a workspace */
	const native *peer; /* NULL: nmtan */
} way;

/* The ways that ratios are of. */
enum { COLD, WARM, COLD_THREADS, THREADS, ROBUST, FIRST_PEER };

static void solve(const way *w, const nt_owned *mesh, nmtan_workspace *workspace, float (*tangents)[4])
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = w->method, .threads = w->threads,
		.workspace = w->warm ? workspace : NULL};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	if (w->peer ? !native_solve(w->peer, mesh, tangents) : nmtan_tangents(&mesh->mesh, &options, &output, NULL) != 0) {
		fprintf(stderr, "core: %s failed\n", w->name);
		exit(1);
	}
}

static void time_model(const model *m, const way *ways, size_t count, nmtan_workspace *workspace, double *best)
{
	float (*tangents)[4] = measure_room(m->mesh.corner_count, sizeof *tangents);
	for (size_t w = 0; w < count; w++)
		best[w] = INFINITY;
	for (int round = 0; round < ROUNDS; round++) {
		for (size_t w = 0; w < count; w++) {
			double (*clock)(void) = ways[w].threads == 1 ? measure_thread_seconds : measure_seconds;
			const double end = clock() + ROUND;
			double start;
			do {
				start = clock();
				solve(&ways[w], &m->mesh, workspace, tangents);
				best[w] = fmin(best[w], clock() - start);
			} while (start < end);
		}
	}
	free(tangents);
}

static size_t list_ways(const native *peers, size_t peer_count, way *ways)
{
	const unsigned all = nt_thread_count(0);
	const way ours[FIRST_PEER] = {
		[COLD] = {"default", NMTAN_METHOD_MIKKTSPACE, 1, false, NULL},
		[WARM] = {"workspace", NMTAN_METHOD_MIKKTSPACE, 1, true, NULL},
		[COLD_THREADS] = {"all threads", NMTAN_METHOD_MIKKTSPACE, all, false, NULL},
		[THREADS] = {"both", NMTAN_METHOD_MIKKTSPACE, all, true, NULL},
		[ROBUST] = {"robust", NMTAN_METHOD_ROBUST, 1, true, NULL},
	};
	for (size_t i = 0; i < FIRST_PEER; i++)
		ways[i] = ours[i];
	for (size_t i = 0; i < peer_count; i++)
		ways[FIRST_PEER + i] = (way){peers[i].name, NMTAN_METHOD_MIKKTSPACE, 1, false, &peers[i]};
	return FIRST_PEER + peer_count;
}

void core_real_table(char *const *files, size_t count, const char *folder)
{
	static model models[MODEL_MOST];
	native peers[NATIVE_MOST];
	way ways[MOST_WAYS];
	double best[MODEL_MOST][MOST_WAYS];
	const size_t model_count = models_make(files, count, models);
	const size_t way_count = list_ways(peers, native_open(folder, peers), ways);
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	for (size_t m = 0; m < model_count; m++)
		time_model(&models[m], ways, way_count, workspace, best[m]);
	nmtan_workspace_destroy(workspace);

	printf("Million triangles a second of nmtan's default without and with a workspace, on one thread and on all (%u); what "
		"robust takes of the default's time; the peers, and how many times as fast the default without a workspace "
		"is. Best of %d interleaved rounds.\n\n| mesh | triangles | default | workspace | all threads | both | robust |",
		nt_thread_count(0), ROUNDS);
	for (size_t w = FIRST_PEER; w < way_count; w++)
		printf(" %s |", ways[w].name);
	printf("\n|---|---|---|---|---|---|---|");
	for (size_t w = FIRST_PEER; w < way_count; w++)
		printf("---|");
	for (size_t m = 0; m < model_count; m++) {
		const double *b = best[m], million = 1e-6 * (double)models[m].mesh.mesh.face_count;
		printf("\n| %s | %zu |", models[m].name, models[m].mesh.mesh.face_count);
		for (size_t w = 0; w < ROBUST; w++)
			printf(" %.1f |", million / b[w]);
		printf(" %.2f |", b[ROBUST] / b[WARM]);
		for (size_t w = FIRST_PEER; w < way_count; w++)
			printf(" %.2f (%.1f) |", million / b[w], b[w] / b[COLD]);
	}
	printf("\n\n");
	fflush(stdout);
	models_free(models, model_count);
}
