/* SPDX-License-Identifier: MIT */
/*
 * See core_real.h. All ways to solve a mesh take turns, so that a busy machine hurts all of them; the best of the
 * rounds counts. nmtan has its default options, repair on; the peers allocate on every call, so that nmtan without a
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

enum { ROUNDS = 7, MOST_WAYS = 6 + NATIVE_MOST };

/* The least time of a way in one round, in seconds; triangles between two looks at the clock, which is a system
 * call. */
static const double ROUND = 0.01;
enum { LEAST_TIMED = 10000 };

typedef struct way {
	const char *name;
	nmtan_method method;
	unsigned threads;
	bool warm;          /* with a workspace */
	const native *peer; /* NULL: nmtan */
} way;

/* The ways that ratios are of. */
enum { COLD, WARM, COLD_THREADS, THREADS, SORTED, ROBUST, FIRST_PEER };

static void solve(const way *w, const nt_owned *mesh, nmtan_workspace *workspace, float (*tangents)[4])
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = w->method, .threads = w->threads,
		.workspace = w->warm ? workspace : NULL};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	if (w->peer ? !native_solve(w->peer, mesh, tangents)
		: nmtan_tangents(&mesh->mesh, &options, &output, NULL) != 0) {
		fprintf(stderr, "core: %s failed\n", w->name);
		exit(1);
	}
}

static void time_model(const model *m, const way *ways, size_t count, nmtan_workspace *workspace, double *best)
{
	float (*tangents)[4] = measure_room(m->mesh.corner_count, sizeof *tangents);
	const size_t repeat = 1 + LEAST_TIMED / m->mesh.mesh.face_count;
	for (size_t w = 0; w < count; w++)
		best[w] = INFINITY;
	for (int round = 0; round < ROUNDS; round++) {
		for (size_t w = 0; w < count; w++) {
			double (*clock)(void) = ways[w].threads == 1 ? measure_thread_seconds : measure_seconds;
			const double end = clock() + ROUND;
			double start;
			do {
				start = clock();
				for (size_t i = 0; i < repeat; i++)
					solve(&ways[w], &m->mesh, workspace, tangents);
				best[w] = fmin(best[w], (clock() - start) / (double)repeat);
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
		[SORTED] = {"sorted", NMTAN_METHOD_MIKKTSPACE_SORTED, 1, true, NULL},
		[ROBUST] = {"robust", NMTAN_METHOD_ROBUST, 1, true, NULL},
	};
	for (size_t i = 0; i < FIRST_PEER; i++)
		ways[i] = ours[i];
	for (size_t i = 0; i < peer_count; i++)
		ways[FIRST_PEER + i] = (way){peers[i].name, NMTAN_METHOD_MIKKTSPACE, 1, false, &peers[i]};
	return FIRST_PEER + peer_count;
}

/* Meshes that real ones hardly are: of few triangles, and of vertices that are all unusable. */
typedef enum shape { CLEAN, NOISE, ONE_POINT, ALONG_NORMALS } shape;

static const struct {
	const char *name;
	shape shape;
	uint32_t columns, rows;
} made[] = {{"few", CLEAN, 1, 1}, {"few", CLEAN, 2, 2}, {"few", CLEAN, 4, 4}, {"few", CLEAN, 8, 8},
	{"few, noise", NOISE, 1, 1},
	{"few, noise", NOISE, 2, 2}, {"few, noise", NOISE, 4, 4}, {"all UVs in one point", ONE_POINT, 70, 70},
	{"tangents along normals", ALONG_NORMALS, 70, 70}};
enum { MADE = sizeof made / sizeof *made };

/* Moves everything by up to a fifth of a cell, normals by three degrees; the texture turns round in the middle. */
static void disturb(nt_owned *o, float cell)
{
	nt_random random = nt_random_seed(5);
	for (size_t v = 0; v < o->mesh.vertex_count; v++) {
		float *n = o->normals[v], *uv = o->texcoords[v];
		for (int i = 0; i < 3; i++) {
			o->positions[v][i] += cell * (float)(0.4 * nt_random_real(&random) - 0.2);
			n[i] += (float)(0.1 * nt_random_real(&random) - 0.05);
		}
		const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
		for (int i = 0; i < 3; i++)
			n[i] /= length;
		for (int i = 0; i < 2; i++)
			uv[i] += cell * (float)(0.4 * nt_random_real(&random) - 0.2);
		uv[0] = uv[0] > 0.5f ? 1 - uv[0] : uv[0];
	}
}

static nt_owned make_mesh(shape of, uint32_t columns, uint32_t rows)
{
	nt_owned o = nt_surface_grid(NT_NOISE, columns, rows, 0, 1);
	if (of == NOISE)
		disturb(&o, 1.0f / (float)columns);
	for (size_t v = 0; v < o.mesh.vertex_count; v++) {
		const float u = o.texcoords[v][0], along_v = o.texcoords[v][1];
		if (of == ONE_POINT)
			o.texcoords[v][0] = o.texcoords[v][1] = 0.5f;
		for (int i = 0; of == ALONG_NORMALS && i < 3; i++) {
			o.positions[v][i] = i == 0 ? along_v : i == 2 ? u : 0;
			o.normals[v][i] = i == 2;
		}
	}
	return o;
}

void core_real_table(char *const *files, size_t count, const char *folder)
{
	static model models[MODEL_MOST + MADE];
	native peers[NATIVE_MOST];
	way ways[MOST_WAYS];
	double best[MODEL_MOST + MADE][MOST_WAYS];
	size_t model_count = models_make(files, count, models);
	for (size_t i = 0; i < MADE; i++, model_count++) {
		snprintf(models[model_count].name, sizeof models->name, "%s", made[i].name);
		models[model_count].mesh = make_mesh(made[i].shape, made[i].columns, made[i].rows);
	}
	const size_t way_count = list_ways(peers, native_open(folder, peers), ways);
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	for (size_t m = 0; m < model_count; m++)
		time_model(&models[m], ways, way_count, workspace, best[m]);
	nmtan_workspace_destroy(workspace);

	printf("Million triangles a second of nmtan's default without and with a workspace, on one thread and "
		"on all (%u); the default's time beside that of mikktspace-sorted, which is what the published "
		"order costs; what robust takes of the default's time; the peers, and how many times as fast "
		"the default without a workspace is. Best of %d interleaved rounds.\n\n| mesh | triangles | "
		"default | workspace | all threads | both | published | robust |",
		nt_thread_count(0), ROUNDS);
	for (size_t w = FIRST_PEER; w < way_count; w++)
		printf(" %s |", ways[w].name);
	printf("\n|---|---|---|---|---|---|---|---|");
	for (size_t w = FIRST_PEER; w < way_count; w++)
		printf("---|");
	for (size_t m = 0; m < model_count; m++) {
		const double *b = best[m], million = 1e-6 * (double)models[m].mesh.mesh.face_count;
		printf("\n| %s | %zu |", models[m].name, models[m].mesh.mesh.face_count);
		for (size_t w = 0; w < SORTED; w++)
			printf(" %.1f |", million / b[w]);
		printf(" %.2f | %.2f |", b[WARM] / b[SORTED], b[ROBUST] / b[WARM]);
		for (size_t w = FIRST_PEER; w < way_count; w++)
			printf(" %.2f (%.1f) |", million / b[w], b[w] / b[COLD]);
	}
	printf("\n\n");
	fflush(stdout);
	models_free(models, model_count);
}
