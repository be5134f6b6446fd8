/* SPDX-License-Identifier: MIT */
/*
 * The function that libFuzzer calls: an input becomes a file in memory (/dev/shm), is converted or checked as a run
 * of the tool would, with settings by chance, which the input's bytes decide, and what comes of it is looked at:
 *
 * - a failed run has a sentence and leaves no file, a successful one leaves what it says;
 * - an output is read back, and needs nothing: a run in place leaves it as it is;
 * - two threads write the bytes of one;
 * - a report is rendered in every format, and the JSON one is read back;
 * - nothing outside of the input's folder is opened, and nothing outside of the output's is made (the linker's --wrap).
 *
 * Images are decoded alone: see image.h. Memory, leaks and time are libFuzzer's and the sanitizers' to watch: see
 * run.sh. FUZZ_TARGET names the target. FUZZ_VERBOSE tells what a run was told and what came of it.
 */
#include <dirent.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "any_settings.h"
#include "image.h"
#include "mutate.h"
#include "pipeline/run.h"
#include "report/render/render.h"
#include "report/report.h"

size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t room);
int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t room, unsigned seed);

static const struct target {
	const char *name, *file; /* what the input is called */
	const char *run;         /* what is run, if that is another file: it refers to the input */
	size_t (*mutate)(char *bytes, size_t size, size_t room, uint32_t *seed); /* NULL: as libFuzzer does */
	void (*test)(const uint8_t *bytes, size_t size); /* NULL: a run, as below */
} targets[] = {
	{"obj", "x.obj", NULL, NULL, NULL},
	{"mtl", "x.mtl", "mtl.obj", NULL, NULL},
	{"ply", "x.ply", NULL, NULL, NULL},
	{"gltf", "x.gltf", NULL, mutate_json, NULL},
	{"glb", "x.glb", NULL, mutate_glb, NULL},
	{"drc", "x.drc", NULL, NULL, NULL},
	{"image", "x.png", NULL, mutate_image, fuzz_image},
};

static const struct target *target;
static char folder[64]; /* of everything; in it: in/, in/link -> .., out/, plates.bin, canary.bin */
static char input[100], source[100];
static nt_settings told;
static bool verbose;

static void wrong(const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	fprintf(stderr, "WRONG: ");
	vfprintf(stderr, format, arguments);
	fprintf(stderr, "\n");
	va_end(arguments);
	abort();
}

/* ---- the watch ---- */

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __real_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);

/* Whether a path, or the first folder above it that is there, is inside folder/part. */
static bool is_inside(const char *path, const char *part)
{
	char place[128], copy[4096];
	snprintf(place, sizeof place, "%s/%s", folder, part);
	snprintf(copy, sizeof copy, "%s", path);
	char *real = realpath(copy, NULL), *slash;
	while (!real && (slash = strrchr(copy, '/'))) {
		*slash = '\0';
		real = realpath(copy, NULL);
	}
	const size_t length = strlen(place);
	const bool inside = real && strncmp(real, place, length) == 0 && (real[length] == '/' || real[length] == '\0');
	free(real);
	return inside;
}

int __wrap_open(const char *path, int flags, ...)
{
	va_list arguments;
	va_start(arguments, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
	va_end(arguments);
	const bool reads = (flags & O_ACCMODE) == O_RDONLY;
	/* what the system says of this process: maker.c */
	const bool known = reads && (strncmp(path, "/proc/", 6) == 0 || is_inside(path, "in"));
	if (folder[0] && !known && !is_inside(path, "out"))
		wrong("opens %s", path);
	return __real_open(path, flags, mode);
}

int __wrap_rename(const char *from, const char *to)
{
	if (!is_inside(to, "out"))
		wrong("renames to %s", to);
	return __real_rename(from, to);
}

int __wrap_link(const char *from, const char *to)
{
	if (!is_inside(to, "out"))
		wrong("links to %s", to);
	return __real_link(from, to);
}

/* ---- files ---- */

static void store(const char *path, const void *bytes, size_t size)
{
	const int fd = __real_open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
	if (fd < 0 || write(fd, bytes, size) != (ssize_t)size || close(fd) != 0)
		wrong("%s cannot be written", path);
}

/* A whole file, malloc'ed. */
static char *load(const char *path, size_t *size)
{
	struct stat info;
	const int fd = open(path, O_RDONLY);
	char *bytes = fd >= 0 && fstat(fd, &info) == 0 ? malloc((size_t)info.st_size + 1) : NULL;
	if (!bytes || read(fd, bytes, (size_t)info.st_size) != (ssize_t)info.st_size)
		wrong("%s cannot be read", path);
	close(fd);
	*size = (size_t)info.st_size;
	return bytes;
}

/* Removes the files of out/. Returns how many there were. */
static size_t empty_output(void)
{
	char path[100];
	size_t count = 0;
	snprintf(path, sizeof path, "%s/out", folder);
	DIR *out = opendir(path);
	for (const struct dirent *entry; out && (entry = readdir(out));)
		if (entry->d_name[0] != '.' || entry->d_name[1] > '.') {
			count++;
			unlinkat(dirfd(out), entry->d_name, 0);
		}
	if (out)
		closedir(out);
	return count;
}

static void remove_folder(void)
{
	char command[100];
	snprintf(command, sizeof command, "rm -rf '%s'", folder);
	if (system(command) != 0)
		fprintf(stderr, "%s stays\n", folder);
}

static void prepare(void)
{
	char command[600];
	const char *data = getenv("FUZZ_DATA");
	snprintf(folder, sizeof folder, "/dev/shm/nmtan-fuzz-XXXXXX");
	if (!mkdtemp(folder))
		wrong("no folder in /dev/shm");
	atexit(remove_folder);
	/* what is outside must be there: a file that is not is never opened */
	snprintf(command, sizeof command, "cd '%s' && mkdir '%s/in' '%s/out' && cp plates.bin bumps.png '%s/in' && "
		"ln -s .. '%s/in/link' && cp plates.bin '%s' && cp plates.bin '%s/canary.bin'",
		data ? data : "data", folder, folder, folder, folder, folder, folder);
	if (system(command) != 0)
		wrong("plates.bin and bumps.png are not there");
	snprintf(source, sizeof source, "%s/in/%s", folder, target->file);
	snprintf(input, sizeof input, "%s/in/%s", folder, target->run ? target->run : target->file);
	static const char obj[] = "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
		"usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\nusemtl c\nf 4/4 3/3 1/1\n";
	if (target->run)
		store(input, obj, sizeof obj - 1);
}

/* ---- one run ---- */

static nt_status run(const char *path, const char *output, const nt_settings *settings, nt_summary *summary,
	nt_error *error)
{
	nt_error_clear(error);
	const nt_status status = nt_run(path, output, settings, summary, error);
	if (verbose)
		fprintf(stderr,
			"%s: check %d format %d only %d existing %d normals %d across %d draco %d morphs %d method "
			"%d images %d buffers %d precision %d bitangents %d verify %d threads %u: "
			"status %d %s:%zu:%lld %s: %s\n",
			path, settings->check, (int)settings->output_format, (int)settings->only,
			(int)settings->existing,
			(int)settings->normals, (int)settings->io.across, (int)settings->io.draco,
			(int)settings->io.morphs, (int)settings->method, (int)settings->io.images,
			(int)settings->io.buffers, (int)settings->io.precision,
			settings->io.bitangents, settings->verify, settings->io.threads, (int)status,
			error->place.file, error->place.line, (long long)error->place.offset, error->place.pointer,
			error->message);
	if (status == NT_ERROR_INTERNAL || (status && strlen(error->message) < 8))
		wrong("status %d, \"%s\"", (int)status, error->message);
	return status;
}

static nt_status to_buffer(void *user, const void *bytes, size_t size, nt_error *error)
{
	nt_buffer *buffer = user;
	nt_buffer_append(buffer, bytes, size);
	return buffer->failed ? nt_fail_memory(error) : NT_OK;
}

static void check_report(const nt_report *report)
{
	nt_error error;
	for (int format = 0; format < NT_REPORT_FORMAT_COUNT; format++) {
		nt_buffer text = {0};
		const nt_report_list what = {.items = &report, .count = 1};
		/* without findings there are no lines */
		const bool may_be_empty = format == NT_REPORT_LINES || format == NT_REPORT_GITHUB;
		if (nt_report_write(&what, (nt_report_format)format, to_buffer, &text, &error) ||
			(text.size == 0 && !may_be_empty))
			wrong("report format %d: %s", format, error.message);
		nt_baseline baseline = {0};
		if (format == NT_REPORT_JSON && nt_baseline_read(&baseline, text.data, text.size, &error))
			wrong("the JSON report cannot be read: %s", error.message);
		nt_baseline_free(&baseline);
		nt_buffer_free(&text);
	}
}

/* The output is read by its own reader and has what it needs. */
static void check_output(const char *output)
{
	nt_settings again = told;
	nt_summary summary;
	nt_error error;
	again.existing = NT_EXISTING_KEEP;
	again.report = NULL;
	again.verify = false;
	again.in_place = true;
	again.io.draco = NT_DRACO_KEEP;
	if (told.io.draco >= NT_DRACO_AS_SEQUENTIAL) /* then no normals are made of meshes that get no tangents */
		again.normals = NT_NORMALS_AUTO;
	again.io.origin = (nt_origin){.choice = NT_ORIGIN_AUTO}; /* glTF takes none */
	if (run(output, output, &again, &summary, &error))
		wrong("what was written is refused: %s: %s", error.place.pointer, error.message);
	/* tangents that were there are not judged, and glTF has none without normals */
	if (!summary.left && told.existing == NT_EXISTING_REPLACE && told.output_format != NT_FORMAT_PLY)
		wrong("what was written lacks something: %zu solved", summary.solved_count);
	nt_summary_free(&summary);
}

static void check_threads(const char *output)
{
	size_t size, size_two;
	char *one = load(output, &size);
	nt_summary summary;
	nt_error error;
	nt_settings two = told;
	two.io.threads = 2;
	empty_output();
	if (run(input, output, &two, &summary, &error))
		wrong("two threads fail: %s", error.message);
	nt_summary_free(&summary);
	char *other = load(output, &size_two);
	if (size != size_two || memcmp(one, other, size) != 0)
		wrong("two threads write other bytes");
	free(one);
	free(other);
}

static void test_run(const uint8_t *bytes, size_t size)
{
	/* FNV-1a */
	uint32_t chance = 2166136261u;
	for (size_t i = 0; i < size; i++)
		chance = (chance ^ bytes[i]) * 16777619u;
	const nt_report_options report = {.threads = 1, .keep_geometry = true, .keep_frames = true};
	const char *name;
	char output[100];
	told = any_settings(input, &chance, &report, &name);
	snprintf(output, sizeof output, "%s/out/%s", folder, name);
	store(source, bytes, size);

	nt_summary summary;
	nt_error error;
	const nt_status status = run(input, told.check ? NULL : output, &told, &summary, &error);
	if (summary.report)
		check_report(summary.report);
	else if (told.report)
		wrong("no report");
	nt_summary_free(&summary);
	if (!status && !told.check) {
		if (mutate_random(&chance, 16) == 0)
			check_threads(output);
		check_output(output);
	}
	const size_t made = empty_output();
	if ((made == 0) != (status != NT_OK || told.check))
		wrong("status %d and %zu files", (int)status, made);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
	(target->test ? target->test : test_run)(bytes, size);
	return 0;
}

/* One in 64 documents may become none. */
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t room, unsigned seed)
{
	uint32_t chance = seed;
	if (!target->mutate || mutate_random(&chance, 64) == 0)
		return LLVMFuzzerMutate(bytes, size, room);
	const size_t changed = target->mutate((char *)bytes, size, room, &chance);
	return changed ? changed : LLVMFuzzerMutate(bytes, size, room);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
	(void)argc;
	(void)argv;
	const char *name = getenv("FUZZ_TARGET");
	for (size_t i = 0; name && i < sizeof targets / sizeof *targets; i++)
		if (strcmp(targets[i].name, name) == 0)
			target = &targets[i];
	if (!target) {
		fprintf(stderr, "FUZZ_TARGET is to be one of:");
		for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
			fprintf(stderr, " %s", targets[i].name);
		fprintf(stderr, "\n");
		exit(2);
	}
	verbose = getenv("FUZZ_VERBOSE") != NULL;
	prepare();
	return 0;
}
