/* SPDX-License-Identifier: MIT */
/* See native.h. The declarations of peers are their public interface, as far as it is used. */
#include "native.h"

#include <dlfcn.h>
#include <glob.h>
#include <stdio.h>
#include <string.h>

typedef void meshopt_tangents(float *result, const unsigned *indices, size_t index_count, const float *positions,
	size_t vertex_count, size_t position_stride, const float *normals, size_t normal_stride, const float *texcoords,
	size_t texcoord_stride, unsigned flags);
enum { MESHOPT_COMPATIBLE = 1 };

typedef struct mikk_context mikk_context;
typedef struct mikk_interface {
	int (*face_count)(const mikk_context *);
	int (*face_size)(const mikk_context *, int face);
	void (*position)(const mikk_context *, float out[], int face, int corner);
	void (*normal)(const mikk_context *, float out[], int face, int corner);
	void (*texcoord)(const mikk_context *, float out[], int face, int corner);
	void (*set_basic)(const mikk_context *, const float tangent[], float sign, int face, int corner);
	void (*set)(void);
} mikk_interface;
struct mikk_context {
	mikk_interface *interface;
	void *user;
};
typedef int mikk_solve(const mikk_context *);

typedef struct mikk_user {
	const nt_owned *mesh;
	float (*tangents)[4];
} mikk_user;

static const nt_owned *mesh_of(const mikk_context *c)
{
	return ((const mikk_user *)c->user)->mesh;
}

static int face_count(const mikk_context *c)
{
	return (int)mesh_of(c)->mesh.face_count;
}

static int face_size(const mikk_context *c, int face)
{
	(void)c, (void)face;
	return 3;
}

static uint32_t vertex_of(const mikk_context *c, int face, int corner)
{
	return mesh_of(c)->indices[3 * (size_t)face + (size_t)corner];
}

static void position(const mikk_context *c, float out[], int face, int corner)
{
	memcpy(out, mesh_of(c)->positions[vertex_of(c, face, corner)], 12);
}

static void normal(const mikk_context *c, float out[], int face, int corner)
{
	memcpy(out, mesh_of(c)->normals[vertex_of(c, face, corner)], 12);
}

static void texcoord(const mikk_context *c, float out[], int face, int corner)
{
	memcpy(out, mesh_of(c)->texcoords[vertex_of(c, face, corner)], 8);
}

static void set_basic(const mikk_context *c, const float tangent[], float sign, int face, int corner)
{
	float *to = ((const mikk_user *)c->user)->tangents[3 * (size_t)face + (size_t)corner];
	memcpy(to, tangent, 12);
	to[3] = sign;
}

/* The first file that matches; its handle, and its name for people. */
static void *open_library(const char *folder, const char *stem, char name[64])
{
	char pattern[512];
	glob_t found;
	void *library = NULL;
	snprintf(name, 64, "%s", stem);
	if (folder) {
		snprintf(pattern, sizeof pattern, "%s/lib%s*.so", folder, stem);
		if (glob(pattern, 0, NULL, &found) == 0) {
			library = dlopen(found.gl_pathv[0], RTLD_NOW);
			if (!library)
				fprintf(stderr, "bench: %s\n", dlerror());
			const char *base = strrchr(found.gl_pathv[0], '/') + 1 + strlen("lib");
			snprintf(name, 64, "%.*s", (int)(strlen(base) - strlen(".so")), base);
		}
		globfree(&found);
	}
	if (!library) {
		snprintf(pattern, sizeof pattern, "lib%s.so", stem);
		library = dlopen(pattern, RTLD_NOW);
	}
	return library;
}

size_t native_open(const char *folder, native *peers)
{
	size_t n = 0;
	char name[64];
	void *library = open_library(folder, "meshoptimizer", name);
	void (*function)(void) = NULL;
	if (library)
		*(void **)&function = dlsym(library, "meshopt_generateTangents");
	if (function) {
		peers[n].function = function;
		snprintf(peers[n++].name, sizeof peers->name, "%.48s", name);
		peers[n] = (native){.function = function, .flags = MESHOPT_COMPATIBLE};
		snprintf(peers[n++].name, sizeof peers->name, "%.48s compatible", name);
	} else {
		printf("bench: %s %s, skipped\n", name,
			library ? "makes no tangents (Debian's 0.18 does not)" : "is not there");
	}
	library = open_library(folder, "mikktspace", name);
	if (library && (*(void **)&function = dlsym(library, "genTangSpaceDefault"))) {
		peers[n] = (native){.function = function, .flags = ~0u};
		snprintf(peers[n++].name, sizeof peers->name, "%.48s", name);
	} else {
		printf("bench: no libmikktspace*.so in %s, skipped\n", folder ? folder : "$PEERS, which is not set");
	}
	return n;
}

bool native_solve(const native *peer, const nt_owned *mesh, float (*tangents)[4])
{
	if (peer->flags != ~0u) {
		((meshopt_tangents *)peer->function)(&tangents[0][0], mesh->indices, mesh->corner_count,
			mesh->mesh.positions,
			mesh->mesh.vertex_count, 12, mesh->mesh.normals, 12, mesh->mesh.texcoords, 8, peer->flags);
		return true;
	}
	mikk_interface interface = {face_count, face_size, position, normal, texcoord, set_basic, NULL};
	mikk_user user = {mesh, tangents};
	const mikk_context context = {&interface, &user};
	return ((mikk_solve *)peer->function)(&context) != 0;
}
