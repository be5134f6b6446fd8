/* SPDX-License-Identifier: MIT */
/*
 * hostile PART PARTS COUNT FILE...: COUNT damaged copies of the files, every PARTS-th from PART on; the
 * files themselves too. The tests of hostile.sh.
 *
 * Each file is worked on by child processes, a few dozen runs each, so that a crash, a leak (LeakSanitizer
 * speaks when a child ends), a run of more than ten seconds of the processor (however long others keep it
 * waiting), or more than 2 GB of memory costs one child and names its run. Without a sanitizer the 2 GB are
 * address space (RLIMIT_AS); AddressSanitizer reserves terabytes of that, so under it the child's peak of
 * memory is compared afterwards. The opens and renames of the tool are watched by way of the linker's
 * --wrap: what lies outside the input's folder must not be opened, and nothing outside the output's be made;
 * a failed run leaves nothing, and has a place and a sentence. Files that come as far as geometry when they
 * are whole get nine of ten mutations.
 */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "any_settings.h"
#include "mutate.h"
#include "pipeline/run.h"

enum { GROUP = 25, SECONDS = 10, STUCK_SECONDS = 600, MEGABYTES = 2048, EXIT_WRONG = 3 };

/* Memory that children and their parent share. */
static struct {
	size_t run;      /* under way, of the file's */
	size_t runs, written, refused, geometry, opened, memory;
	double slowest;  /* seconds */
	long largest;    /* KB */
} *shared;

static char root[64]; /* of everything; in it: in/, in/link -> .., out/, canary.bin */
static char input[400], output_folder[100];

/* The parent's, where LeakSanitizer in a child finds them. */
static char *whole;
static bool *solid; /* of each file: it comes as far as geometry */

/* ---- the watch ---- */

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __real_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);

static void wrong(const char *format, ...)
{
	va_list arguments;
	va_start(arguments, format);
	fprintf(stderr, "hostile: run %zu of %s: ", shared->run, input);
	vfprintf(stderr, format, arguments);
	fprintf(stderr, "\n");
	va_end(arguments);
	_exit(EXIT_WRONG);
}

/* Whether a path, or the folder of one that is not there, is inside root/part. */
static bool is_inside(const char *path, const char *part)
{
	char folder[128], copy[4096];
	snprintf(folder, sizeof folder, "%s/%s", root, part);
	snprintf(copy, sizeof copy, "%s", path);
	char *real = realpath(copy, NULL), *slash = strrchr(copy, '/');
	if (!real && slash) {
		*slash = '\0';
		real = realpath(copy, NULL);
	}
	const size_t length = strlen(folder);
	const bool inside = real && strncmp(real, folder, length) == 0 &&
		(real[length] == '/' || real[length] == '\0');
	free(real);
	return inside;
}

int __wrap_open(const char *path, int flags, ...)
{
	va_list arguments;
	va_start(arguments, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
	va_end(arguments);
	/* what the system says of this process: maker.c */
	if ((flags & O_ACCMODE) == O_RDONLY && strncmp(path, "/proc/", 6) == 0)
		return __real_open(path, flags, mode);
	shared->opened++;
	if (!is_inside(path, "out") && ((flags & O_ACCMODE) != O_RDONLY || !is_inside(path, "in")))
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

/* ---- one run ---- */

/* Removes the files of a folder. Returns how many there were. */
static size_t empty_folder(const char *path)
{
	size_t count = 0;
	DIR *folder = opendir(path);
	for (const struct dirent *entry; folder && (entry = readdir(folder));)
		if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
			count++;
			if (unlinkat(dirfd(folder), entry->d_name, 0) != 0)
				wrong("a folder called %s came to be", entry->d_name);
		}
	if (folder)
		closedir(folder);
	return count;
}

/* Seconds of the processor, since others may be using it; the clock ends only what waits for ever. */
static void set_limits(unsigned seconds, unsigned stuck)
{
	const struct itimerval limit = {.it_value.tv_sec = seconds};
	setitimer(ITIMER_PROF, &limit, NULL);
	alarm(stuck);
}

static double cpu_seconds(void)
{
	struct timespec time;
	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Past the container and the document's own rooms: something was solved, or what was refused is a mesh. */
static bool met_geometry(const nt_summary *summary, const nt_error *error)
{
	static const char *const places[] = {"/accessors/", "/bufferViews/", "/primitives/"};
	bool met = summary->solved_count > 0 || summary->triangle_count > 0;
	for (size_t i = 0; !met && i < sizeof places / sizeof *places; i++)
		met = strstr(error->place.pointer, places[i]) != NULL;
	return met || (error->status && (error->place.line > 0 || error->place.object[0]));
}

/* The options vary from run to run. */
static bool run_input(uint32_t *chance)
{
	const nt_report_options report = {.threads = 1};
	const char *name;
	const nt_settings settings = any_settings(input, chance, &report, &name);
	const bool check = settings.check;
	char output[200];
	snprintf(output, sizeof output, "%s/%s", output_folder, name);
	nt_summary summary;
	nt_error error;
	nt_error_clear(&error);
	const nt_status status = nt_run(input, check ? NULL : output, &settings, &summary, &error);
	const bool met = met_geometry(&summary, &error);
	nt_summary_free(&summary);
	const size_t made = empty_folder(output_folder);
	if (status == NT_ERROR_INTERNAL || (status && strlen(error.message) < 8))
		wrong("status %d, \"%s\"", (int)status, error.message);
	if ((made == 0) != (status != NT_OK || check))
		wrong("status %d and %zu files", (int)status, made);
	if (status && getenv("NT_VERBOSE"))
		fprintf(stderr, "%d %s:%zu:%lld %s: %s\n", (int)status, error.place.file, error.place.line,
			(long long)error.place.offset, error.place.pointer, error.message);
	shared->memory += status == NT_ERROR_MEMORY;
	shared->written += status == NT_OK;
	shared->refused += status != NT_OK;
	return met;
}

static void store(const char *path, const char *bytes, size_t size)
{
	FILE *stream = fopen(path, "wb");
	if (!stream || fwrite(bytes, 1, size, stream) != size || fclose(stream) != 0)
		wrong("%s cannot be written", path);
}

/* Run 0 is the file as it is. */
static void run_damaged(const char *bytes, char *copy, size_t size, size_t number, size_t run)
{
	uint32_t chance = (uint32_t)(number * 1000003 + run);
	memcpy(copy, bytes, size);
	if (run > 0)
		for (uint32_t k = 1 + mutate_random(&chance, 2); k-- > 0 && size > 0;)
			size = mutate(copy, size, &chance);
	store(input, copy, size);
	if (getenv("NT_KEEP"))
		store(getenv("NT_KEEP"), copy, size);
	const double begin = cpu_seconds();
	set_limits(SECONDS, STUCK_SECONDS);
	const bool met = run_input(&chance);
	set_limits(0, 0);
	const double seconds = cpu_seconds() - begin;
	if (seconds > shared->slowest)
		shared->slowest = seconds;
	shared->geometry += met;
	shared->runs += run > 0;
}

/* ---- the children ---- */

/* Runs [begin, end) of a file in a child. False when it did not end well; shared->run tells where. */
static bool run_group(const char *bytes, size_t size, size_t number, size_t begin, size_t end)
{
	fflush(NULL);
	const pid_t child = fork();
	if (child == 0) {
#ifndef __SANITIZE_ADDRESS__
		const struct rlimit limit = {(rlim_t)MEGABYTES << 20, (rlim_t)MEGABYTES << 20};
		setrlimit(RLIMIT_AS, &limit);
#endif
		char *copy = malloc(size + 2 * MUTATE_ROOM);
		for (shared->run = begin; copy && shared->run < end; shared->run++)
			run_damaged(bytes, copy, size, number, shared->run);
		free(copy);
		exit(copy ? 0 : EXIT_WRONG); /* leaks are looked for here */
	}
	int how;
	struct rusage usage;
	if (child < 0 || wait4(child, &how, 0, &usage) < 0) {
		perror("hostile: fork");
		exit(2);
	}
	if (usage.ru_maxrss > shared->largest)
		shared->largest = usage.ru_maxrss;
	if (WIFSIGNALED(how))
		fprintf(stderr, "hostile: run %zu of %s: %s\n", shared->run, input, strsignal(WTERMSIG(how)));
	if (usage.ru_maxrss > MEGABYTES * 1024L) {
		fprintf(stderr, "hostile: up to run %zu of %s: %ld MB\n", shared->run, input, usage.ru_maxrss >> 10);
		return false;
	}
	return WIFEXITED(how) && WEXITSTATUS(how) == 0;
}

/* Runs [begin, end) of a file; goes on behind a run that fails. Returns how many do. */
static size_t run_file(const char *path, const char *bytes, size_t size, size_t number,
	size_t begin, size_t end)
{
	size_t failed = 0;
	while (begin < end) {
		const size_t stop = begin + GROUP < end ? begin + GROUP : end;
		if (run_group(bytes, size, number, begin, stop)) {
			begin = stop;
			continue;
		}
		fprintf(stderr, "hostile: that was %s, number %zu, runs %zu to %zu\n", path, number, begin,
			shared->run < stop ? shared->run : stop - 1);
		failed++;
		empty_folder(output_folder);
		begin = shared->run < stop ? shared->run + 1 : stop;
	}
	return failed;
}

/* Gives the damaged copies of a file what it refers to: the files beside it. */
static void place(const char *path)
{
	char command[2048];
	const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
	snprintf(input, sizeof input, "%s/in/x%s", root, dot ? dot : "");
	snprintf(command, sizeof command,
		"rm -rf '%s/in' && mkdir '%s/in' && ln -s .. '%s/in/link' && cd '%.*s' && "
		"cp -r *.bin *.png *.jpg *.webp *.ktx2 *.mtl '%s/in/' 2>/dev/null; true",
		root, root, root, (int)(slash - path), path, root);
	if (system(command) != 0)
		exit(2);
}

/* A whole file, and a byte; NULL when there is none. */
static char *load(const char *path, size_t *size)
{
	struct stat info;
	FILE *stream = fopen(path, "rb");
	char *bytes = stream && stat(path, &info) == 0 ? malloc((size_t)info.st_size + 1) : NULL;
	*size = bytes ? fread(bytes, 1, (size_t)info.st_size, stream) : 0;
	if (stream)
		fclose(stream);
	return bytes;
}

static bool prepare(void)
{
	char canary[100];
	shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
	strcpy(root, "/tmp/nmtan-hostile-XXXXXX");
	if (shared == MAP_FAILED || !mkdtemp(root))
		return false;
	snprintf(output_folder, sizeof output_folder, "%s/out", root);
	snprintf(canary, sizeof canary, "%s/canary.bin", root);
	FILE *stream = fopen(canary, "wb");
	const bool there = stream && fprintf(stream, "%100000d", 1) == 100000;
	return stream && fclose(stream) == 0 && there && mkdir(output_folder, 0700) == 0;
}

int main(int argc, char **argv)
{
	const char *only = getenv("NT_RUN"); /* "number:run" runs that one alone */
	if (argc < 5 || !prepare())
		return 2;
	const size_t part = strtoul(argv[1], NULL, 10), parts = strtoul(argv[2], NULL, 10);
	const size_t wanted = strtoul(argv[3], NULL, 10) / parts, count = (size_t)argc - 4;
	solid = calloc(count, sizeof *solid);
	size_t failed = 0, solids = 0, mine = 0;
	/* Twice: whole, to see how far each comes; then damaged. */
	for (int damaged = 0; solid && damaged < 2; damaged++) {
		for (size_t i = part; i < count; i += parts) {
			size_t size, begin = 0, end = 1;
			if (damaged) {
				const size_t others = mine - solids;
				begin = 1;
				end = 2 + (solid[i] ? wanted * 9 / 10 / solids : others ? wanted / 10 / others : 0);
			}
			if (only && damaged && strtoul(only, NULL, 10) == i) {
				begin = strtoul(strchr(only, ':') + 1, NULL, 10);
				end = begin + 1;
			} else if (only) {
				continue;
			}
			whole = load(argv[4 + i], &size);
			if (!whole)
				return 2;
			place(argv[4 + i]);
			const size_t before = shared->geometry;
			failed += run_file(argv[4 + i], whole, size, i, begin, end);
			if (!damaged) {
				solid[i] = shared->geometry > before;
				solids += solid[i];
				mine++;
				shared->geometry = before;
			}
			free(whole);
		}
	}
	free(solid);
	char command[100];
	snprintf(command, sizeof command, "rm -rf '%s'", root);
	if (system(command) != 0)
		failed++;
	/* whole files, runs, written, refused, as far as geometry, files opened, slowest, largest, failed */
	printf("%zu %zu %zu %zu %zu %zu %.2f %ld %zu\n", mine, shared->runs, shared->written,
		shared->refused, shared->geometry, shared->opened, shared->slowest, shared->largest >> 10, failed);
	return failed != 0;
}
