/* SPDX-License-Identifier: MIT */
/*
 * peer_assimp FOLDER: tangents by assimp's CalcTangentSpace, natively, for each FOLDER/NAME.mesh (see
 * peers.mjs for the files). The mesh goes in as OBJ text; only the step that computes tangents is timed.
 */
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <dirent.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Seconds; a run that takes longer is not repeated. */
static const double LONG_RUN = 1;

typedef struct mesh_file {
	uint32_t vertex_count, corner_count;
	float *positions, *normals, *texcoords;
	uint32_t *indices;
} mesh_file;

static double seconds(void)
{
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *read_words(FILE *f, size_t count)
{
	void *words = malloc(4 * count + 4);
	if (!words || fread(words, 4, count, f) != count)
		exit(2);
	return words;
}

static mesh_file read_mesh(const char *path)
{
	mesh_file m;
	FILE *f = fopen(path, "rb");
	if (!f || fread(&m, 4, 2, f) != 2)
		exit(2);
	m.positions = read_words(f, 3 * (size_t)m.vertex_count);
	m.normals = read_words(f, 3 * (size_t)m.vertex_count);
	m.texcoords = read_words(f, 2 * (size_t)m.vertex_count);
	m.indices = read_words(f, m.corner_count);
	fclose(f);
	return m;
}

static void free_mesh(mesh_file *m)
{
	free(m->positions);
	free(m->normals);
	free(m->texcoords);
	free(m->indices);
}

static char *print_obj(const mesh_file *m, size_t *size)
{
	char *text = NULL;
	FILE *f = open_memstream(&text, size);
	if (!f)
		exit(4);
	for (uint32_t v = 0; v < m->vertex_count; v++) {
		const float *p = m->positions + 3 * v, *n = m->normals + 3 * v, *t = m->texcoords + 2 * v;
		fprintf(f, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\nvt %.9g %.9g\n", (double)p[0], (double)p[1],
			(double)p[2], (double)n[0], (double)n[1], (double)n[2], (double)t[0], (double)t[1]);
	}
	for (uint32_t c = 0; c < m->corner_count; c += 3) {
		const uint32_t a = m->indices[c] + 1, b = m->indices[c + 1] + 1, d = m->indices[c + 2] + 1;
		fprintf(f, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, d, d, d);
	}
	fclose(f);
	return text;
}

/* Imports and computes; returns the seconds of the last step. */
static double run(const char *obj, size_t size, const mesh_file *m, float (*tangents)[4])
{
	const struct aiScene *scene = aiImportFileFromMemory(obj, (unsigned)size, 0, "obj");
	if (!scene || scene->mNumMeshes != 1) {
		fprintf(stderr, "peer_assimp: %s\n", scene ? "not one mesh" : aiGetErrorString());
		exit(3);
	}
	const double start = seconds();
	scene = aiApplyPostProcessing(scene, aiProcess_CalcTangentSpace);
	const double took = seconds() - start;
	const struct aiMesh *mesh = scene ? scene->mMeshes[0] : NULL;
	if (!mesh || !mesh->mTangents || mesh->mNumFaces * 3 != m->corner_count)
		exit(3);
	for (unsigned face = 0; face < mesh->mNumFaces; face++) {
		for (unsigned k = 0; k < 3; k++) {
			const unsigned v = mesh->mFaces[face].mIndices[k];
			const struct aiVector3D t = mesh->mTangents[v], b = mesh->mBitangents[v];
			const struct aiVector3D n = mesh->mNormals[v];
			const float side = (n.y * t.z - n.z * t.y) * b.x + (n.z * t.x - n.x * t.z) * b.y +
					   (n.x * t.y - n.y * t.x) * b.z;
			const float row[4] = {t.x, t.y, t.z, side < 0 ? -1.0f : 1.0f};
			memcpy(tangents[3 * face + k], row, sizeof row);
		}
	}
	aiReleaseImport(scene);
	return took;
}

static void run_file(const char *folder, const char *name, FILE *times)
{
	char path[512];
	snprintf(path, sizeof path, "%s/%s.mesh", folder, name);
	mesh_file m = read_mesh(path);
	size_t size;
	char *obj = print_obj(&m, &size);
	float (*tangents)[4] = malloc(m.corner_count * sizeof *tangents);
	if (!tangents)
		exit(4);
	double best = INFINITY;
	for (int i = 0; i < 3 && (i == 0 || best < LONG_RUN); i++)
		best = fmin(best, run(obj, size, &m, tangents));
	fprintf(times, "%s assimp %.9g\n", name, best);
	snprintf(path, sizeof path, "%s/%s.assimp.tan", folder, name);
	FILE *f = fopen(path, "wb");
	if (!f || fwrite(tangents, sizeof *tangents, m.corner_count, f) != m.corner_count || fclose(f))
		exit(2);
	free(tangents);
	free(obj);
	free_mesh(&m);
}

int main(int argc, char **argv)
{
	if (argc != 2)
		return 2;
	char path[512];
	snprintf(path, sizeof path, "%s/peers.txt", argv[1]);
	FILE *times = fopen(path, "a");
	DIR *folder = opendir(argv[1]);
	if (!times || !folder)
		return 2;
	for (struct dirent *e; (e = readdir(folder));) {
		const size_t length = strlen(e->d_name);
		if (length < 5 || strcmp(e->d_name + length - 5, ".mesh") != 0)
			continue;
		e->d_name[length - 5] = 0;
		run_file(argv[1], e->d_name, times);
	}
	closedir(folder);
	return fclose(times) ? 2 : 0;
}
