/* SPDX-License-Identifier: MIT */
/*
 * Opening modules: see module.h.
 *
 * Memory may end inside of dlopen() as well. The loader says so by its message alone, and ends the process itself where
 * it has none for its table of C++ symbols: so there must be enough before it begins. Memory that constructors of C++
 * libraries ask for in vain comes from the reserve, since an exception must not pass the loader.
 */
#include "ext/module.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "ext/tables.h"

/* ---- modules ---- */

/* The folder of installed modules; NULL if the tool is not installed. */
#ifdef NT_LIBDIR
static const char *const installed = NT_LIBDIR "/nmtan";
#else
static const char *const installed = NULL;
#endif

/* More than the loader takes for any of the modules (at most 62 kB), and little enough for malloc to keep it. */
enum { LOADER_BYTES = 112 << 10 };

typedef struct row {
	const char *name, *purpose;
	size_t struct_bytes;
	const nt_module_head *linked; /* NULL: it is to be opened */
} row;

static const row rows[NT_MODULE_COUNT] = {
	[NT_MODULE_DRACO] = {"draco", "Draco compression", sizeof(nt_draco_table), &nt_draco_module.head},
	[NT_MODULE_MESHOPT] = {"meshopt", "compression by meshoptimizer", sizeof(nt_meshopt_table),
		&nt_meshopt_module.head},
	[NT_MODULE_OPENMESH] = {"openmesh", "a report on seams or boundaries that fork",
		sizeof(nt_openmesh_table), &nt_openmesh_module.head},
	[NT_MODULE_TINYGLTF] = {"tinygltf", "verifying what was written", sizeof(nt_tinygltf_table),
		&nt_tinygltf_module.head},
	[NT_MODULE_PNG] = {"png", "PNG", sizeof(nt_codec_table), &nt_png_module.head},
	[NT_MODULE_TIFF] = {"tiff", "TIFF", sizeof(nt_codec_table), &nt_tiff_module.head},
	[NT_MODULE_WEBP] = {"webp", "WebP", sizeof(nt_codec_table), &nt_webp_module.head},
};

static _Atomic(const nt_module_head *) tables[NT_MODULE_COUNT];
static pthread_mutex_t opening = PTHREAD_MUTEX_INITIALIZER;

/* The table of a module; NULL: it is not open. */
static const void *opened(nt_module module)
{
	return atomic_load_explicit(&tables[module], memory_order_acquire);
}

/* ---- where it is ---- */

/* The folder of the running program; empty where the system does not tell. */
static nt_status find_program(char folder[PATH_MAX], nt_error *error)
{
	const ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
	if (length < 0 && errno != ENOENT && errno != EACCES)
		return nt_fail(error, NT_ERROR_IO, "cannot find the folder of the running program: %s",
			strerror(errno));
	folder[length < 0 ? 0 : length] = 0;
	char *slash = strrchr(folder, '/');
	if (slash)
		slash[slash == folder] = 0;
	return NT_OK;
}

/* Whether the module is in a folder; fills its path. Opening a pipe of that name would not end. */
static nt_status look_in(const char *folder, const row *module, char path[PATH_MAX], bool *found, nt_error *error)
{
	*found = false;
	const int length = snprintf(path, PATH_MAX, "%s/nmtan-%s.so", folder, module->name);
	if (length < 0 || length >= PATH_MAX)
		return NT_OK;
	struct stat info;
	const bool there = stat(path, &info) == 0;
	*found = there && S_ISREG(info.st_mode);
	if (there || errno == ENOENT || errno == ENOTDIR)
		return NT_OK;
	return nt_fail(error, NT_ERROR_IO, "cannot look for %s: %s", path, strerror(errno));
}

static nt_status find_module(const row *module, char path[PATH_MAX], nt_error *error)
{
	char program[PATH_MAX];
	bool found = false;
	nt_status status = find_program(program, error);
	if (!status && *program)
		status = look_in(program, module, path, &found, error);
	if (!status && !found && installed)
		status = look_in(installed, module, path, &found, error);
	if (status || found)
		return status;
	return nt_fail(error, NT_ERROR_MODULE, "%s needs the module nmtan-%s.so, which is not in %s%s%s",
		module->purpose, module->name, program, installed ? " or " : "", installed ? installed : "");
}

/* ---- opening it ---- */

static nt_status fail_open(const char *path, nt_error *error)
{
	const char *why = dlerror();
	if (!why || strstr(why, "annot allocate memory") || strstr(why, "cannot create shared object descriptor") ||
		strcmp(why, "out of memory") == 0)
		return nt_fail_memory(error);
	return nt_fail(error, NT_ERROR_MODULE, "the module %s cannot be opened: %s", path, why);
}

static nt_status check(const row *module, const char *path, const nt_module_head *head, nt_error *error)
{
	if (!head)
		return nt_fail(error, NT_ERROR_MODULE, "%s is no module of nmtan", path);
	if (strcmp(head->version, NMTAN_VERSION_STRING) != 0)
		return nt_fail(error, NT_ERROR_MODULE, "%s is a module of nmtan %s, expected one of nmtan %s", path,
			head->version, NMTAN_VERSION_STRING);
	if (head->struct_bytes != module->struct_bytes)
		return nt_fail(error, NT_ERROR_MODULE, "%s is a module of another build of nmtan %s", path,
			head->version);
	return NT_OK;
}

static nt_status load(const row *module, const nt_module_head **head, nt_error *error)
{
	char path[PATH_MAX], symbol[64];
	const nt_status status = find_module(module, path, error);
	if (status)
		return status;
	void *enough = malloc(LOADER_BYTES);
	if (!enough)
		return nt_fail_memory(error);
	free(enough);
	nt_reserve_begin();
	void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
	nt_reserve_end();
	if (!handle)
		return fail_open(path, error);
	snprintf(symbol, sizeof symbol, "nt_%s_module", module->name);
	*head = dlsym(handle, symbol);
	return check(module, path, *head, error);
}

const void *nt_module_open(nt_module module, nt_status *status, nt_error *error)
{
	const void *table = opened(module);
	*status = NT_OK;
	if (table)
		return table;
	pthread_mutex_lock(&opening);
	const nt_module_head *head = opened(module);
	if (!head) {
		head = rows[module].linked;
		if (!head)
			*status = load(&rows[module], &head, error);
		if (!*status) {
			if (head->cxx)
				nt_reserve_serve(head->cxx);
			atomic_store_explicit(&tables[module], head, memory_order_release);
		}
	}
	pthread_mutex_unlock(&opening);
	return *status ? NULL : head;
}

void nt_module_describe(nt_module module, char *line, size_t size)
{
	nt_status status;
	nt_error error;
	const nt_module_head *head = nt_module_open(module, &status, &error);
	if (head)
		snprintf(line, size, "%s: %s%s%s, %s", rows[module].name, head->library,
			head->library_version ? " " : "",
			head->library_version ? head->library_version : "", head->licence);
	else
		snprintf(line, size, "%s: %s", rows[module].name, error.message);
}

/* ---- functions that are in modules, which the first call opens ---- */

nt_status nt_draco_decode(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	*result = NULL;
	return draco ? draco->decode(result, bytes, size, max_faces, error) : status;
}

nt_status nt_draco_encode(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	*block = (nt_draco_block){0};
	return draco ? draco->encode(mesh, block, error) : status;
}

nt_status nt_draco_quantize(const nt_draco_mesh *mesh, float *const *values, nt_error *error)
{
	nt_status status;
	const nt_draco_table *draco = nt_module_open(NT_MODULE_DRACO, &status, error);
	return draco ? draco->quantize(mesh, values, error) : status;
}

nt_status nt_meshopt_check(const nt_meshopt_view *view, uint64_t size, const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->check(view, size, pointer, error) : status;
}

nt_status nt_meshopt_unpack(const nt_meshopt_view *view, const unsigned char *packed, unsigned char *bytes,
	const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->unpack(view, packed, bytes, pointer, error) : status;
}

nt_status nt_meshopt_filter(const nt_meshopt_view *view, unsigned char *bytes, const char *pointer, nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->filter(view, bytes, pointer, error) : status;
}

nt_status nt_meshopt_pack(const nt_meshopt_view *view, const unsigned char *bytes, unsigned char **packed, size_t *size,
	nt_error *error)
{
	nt_status status;
	const nt_meshopt_table *meshopt = nt_module_open(NT_MODULE_MESHOPT, &status, error);
	return meshopt ? meshopt->pack(view, bytes, packed, size, error) : status;
}

nt_status nt_walk_marked(const nt_walked_mesh *mesh, nt_walk_taker *take, void *context, size_t *left_out,
	nt_error *error)
{
	nt_status status;
	const nt_openmesh_table *openmesh = nt_module_open(NT_MODULE_OPENMESH, &status, error);
	return openmesh ? openmesh->walk(mesh, take, context, left_out, error) : status;
}

nt_status nt_tinygltf_accept(const unsigned char *bytes, size_t size, nt_tinygltf_find find, void *user,
	nt_error *error)
{
	nt_status status;
	const nt_tinygltf_table *tinygltf = nt_module_open(NT_MODULE_TINYGLTF, &status, error);
	return tinygltf ? tinygltf->accept(bytes, size, find, user, error) : status;
}
