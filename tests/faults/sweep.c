/* SPDX-License-Identifier: MIT */
/*
 * sweep PRELOAD memory|ERRNO|shorten:FILE [onwards] STRIDE FIRST FOLDER [many] [report=FILE] -- COMMAND...
 *
 * Runs a command in a folder once as it is, then again and again with the n-th allocation (memory) or the n-th system
 * call (EIO, ENOMEM, EINTR, ENOSPC) failing, or with a file that becomes empty at the n-th call, for n = FIRST, FIRST +
 * STRIDE, ... until nothing fails any more. The folder is put back before each run. It checks each run:
 *
 *   - it ends by itself, with the code of the run without faults, 4 for memory, 2 or 4 for system calls, 2 or 3 (where
 *     it was empty when it was opened) for a file that became empty;
 *   - with that of the run without faults: files, standard output and standard error are what they were then;
 *   - else it says so on standard error, in one line unless there are "many" inputs, and leaves each file as it was
 *     before or as it should be, and no others, and not all of them and standard output as they should be, unless it
 *     says that "the output stands", or names a manifest. A folder of outputs may have been made, and the "report" may
 *     tell of the fault.
 *
 * Prints "tried N, bad N" after a line for each of the first bad ones. Times in messages do not count.
 */
#include "faulty.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_FILES = 200, SHOWN = 20 };

typedef struct bytes {
	char *data;
	size_t size;
} bytes;

typedef struct entry {
	char path[512];
	bytes content;
	bool is_folder;
} entry;

typedef struct folder {
	entry entries[MOST_FILES];
	size_t count;
} folder;

typedef struct result {
	int status; /* of waitpid */
	bytes out, err;
	folder files;
} result;

static void die(const char *what, const char *which)
{
	fprintf(stderr, "sweep: %s %s: %s\n", what, which, strerror(errno));
	exit(70);
}

/* ---- files ---- */

static bytes read_file(const char *path)
{
	bytes b = {0};
	const int fd = open(path, O_RDONLY);
	struct stat info;
	if (fd < 0 || fstat(fd, &info) != 0)
		die("cannot read", path);
	b.data = malloc((size_t)info.st_size + 1);
	while (b.data && b.size < (size_t)info.st_size) {
		const ssize_t n = read(fd, b.data + b.size, (size_t)info.st_size - b.size);
		if (n <= 0)
			die("cannot read", path);
		b.size += (size_t)n;
	}
	if (!b.data)
		die("no memory for", path);
	b.data[b.size] = 0;
	close(fd);
	return b;
}

static void write_file(const char *path, bytes b)
{
	const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
	if (fd < 0 || write(fd, b.data, b.size) != (ssize_t)b.size || close(fd) != 0)
		die("cannot write", path);
}

static bool same(bytes a, bytes b)
{
	return a.size == b.size && memcmp(a.data, b.data, a.size) == 0;
}

/* Everything in the working folder. */
static void list(folder *f, const char *path)
{
	DIR *directory = opendir(path);
	if (!directory)
		die("cannot list", path);
	for (struct dirent *d; (d = readdir(directory));) {
		if (strcmp(d->d_name, ".") == 0 || strcmp(d->d_name, "..") == 0)
			continue;
		if (f->count == MOST_FILES)
			die("too many files in", path);
		entry *e = &f->entries[f->count++];
		snprintf(e->path, sizeof e->path, "%s/%s", path, d->d_name);
		struct stat info;
		if (lstat(e->path, &info) != 0)
			die("cannot find", e->path);
		e->is_folder = S_ISDIR(info.st_mode);
		e->content = (bytes){0};
		if (e->is_folder)
			list(f, e->path);
		else if (S_ISREG(info.st_mode))
			e->content = read_file(e->path);
	}
	closedir(directory);
}

static const entry *find(const folder *f, const char *path)
{
	for (size_t i = 0; i < f->count; i++)
		if (strcmp(f->entries[i].path, path) == 0)
			return &f->entries[i];
	return NULL;
}

static void free_folder(folder *f)
{
	for (size_t i = 0; i < f->count; i++)
		free(f->entries[i].content.data);
	f->count = 0;
}

/* Back to how it was. */
static void restore(const folder *before, const folder *now)
{
	for (size_t i = now->count; i-- > 0;) {
		const entry *e = &now->entries[i];
		if (!find(before, e->path) && remove(e->path) != 0)
			die("cannot remove", e->path);
	}
	for (size_t i = 0; i < before->count; i++) {
		const entry *e = &before->entries[i], *is = find(now, e->path);
		if (!e->is_folder && e->content.data && (!is || !same(is->content, e->content))) {
			remove(e->path);
			write_file(e->path, e->content);
		}
	}
}

/* ---- runs ---- */

static void run(char **command, char *preload, char *file, const char *scratch, result *r)
{
	char out[600], err[600], variable[600], library[600];
	snprintf(out, sizeof out, "%s.out", scratch);
	snprintf(err, sizeof err, "%s.err", scratch);
	snprintf(variable, sizeof variable, "%s=%s", FAULTY_FILE, file);
	snprintf(library, sizeof library, "LD_PRELOAD=%s", preload);
	char *environment[] = {variable, library, "LC_ALL=C", "PATH=/usr/bin:/bin", NULL};
	posix_spawn_file_actions_t actions;
	posix_spawn_file_actions_init(&actions);
	posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
	posix_spawn_file_actions_addopen(&actions, 1, out, O_WRONLY | O_CREAT | O_TRUNC, 0644);
	posix_spawn_file_actions_addopen(&actions, 2, err, O_WRONLY | O_CREAT | O_TRUNC, 0644);
	pid_t child;
	if (posix_spawn(&child, command[0], &actions, NULL, command, environment) != 0)
		die("cannot start", command[0]);
	posix_spawn_file_actions_destroy(&actions);
	if (waitpid(child, &r->status, 0) != child)
		die("cannot wait for", command[0]);
	r->out = read_file(out);
	r->err = read_file(err);
	r->files.count = 0;
	list(&r->files, ".");
}

static void free_result(result *r)
{
	free(r->out.data);
	free(r->err.data);
	free_folder(&r->files);
}

/* "s" or "ms" as a word; 0: neither. */
static size_t length_of_unit(const char *s)
{
	const size_t length = s[0] == 'm' ? 2 : 1;
	return s[length - 1] == 's' && !isalpha((unsigned char)s[length]) ? length : 0;
}

/* Messages without their times. */
static void strip_times(bytes *b)
{
	char *to = b->data;
	for (const char *from = b->data; *from;) {
		char *end;
		if (isdigit((unsigned char)*from) && (strtod(from, &end), *end == ' ') && length_of_unit(end + 1))
			from = end + 1 + length_of_unit(end + 1);
		else
			*to++ = *from++;
	}
	*to = 0;
	b->size = (size_t)(to - b->data);
}

/* Lines that are not said without the fault. */
static size_t count_new_lines(bytes said, bytes usual)
{
	size_t lines = 0;
	for (char *line = said.data; *line;) {
		char *end = strchr(line, '\n');
		if (!end)
			return lines + 1;
		const char last = end[1];
		end[1] = 0;
		lines += strstr(usual.data, line) == NULL;
		end[1] = last;
		line = end + 1;
	}
	return lines;
}

typedef struct expectations {
	faulty_kind kind;
	bool many; /* inputs: more than one line may be said */
	const char *report; /* a file that tells of the fault, or NULL */
	const char *shortened; /* a file that becomes empty, or NULL */
} expectations;

/* The text behind the last colon of a message. */
static const char *last_words(bytes said)
{
	static char words[300];
	const char *colon = strrchr(said.data, ':');
	snprintf(words, sizeof words, "%s", colon ? colon + 1 + strspn(colon + 1, " ") : said.data);
	words[strcspn(words, "\n")] = 0;
	return words;
}

/* Records and manifests have the times of their run; a record says nothing of a file that cannot be looked at again. */
static bool has_times(const char *path)
{
	return strstr(path, "/.nmtan-record") || strstr(path, ".jsonl");
}

/* The fault of the files; NULL: nothing. `whole`: all must be what they should be. */
static const char *judge_files(const expectations *rules, const folder *before, const folder *clean, const folder *now,
	bool whole, bytes said)
{
	for (size_t i = 0; i < now->count; i++) {
		const entry *is = &now->entries[i], *should = find(clean, is->path), *was = find(before, is->path);
		if (is->is_folder || has_times(is->path) ||
			(rules->shortened && strcmp(is->path + 2, rules->shortened) == 0))
			continue;
		const bool right = should && same(is->content, should->content);
		if (!right && !whole && rules->report && strstr(is->path, rules->report) &&
			strstr(is->content.data, last_words(said)))
			continue;
		if (!right && !whole && was && same(is->content, was->content))
			continue;
		if (!right)
			return should || was ? "a file has wrong content" : "a file is left behind";
	}
	for (size_t i = 0; i < before->count; i++)
		if (!find(now, before->entries[i].path))
			return "a file is gone";
	for (size_t i = 0; whole && i < clean->count; i++)
		if (!has_times(clean->entries[i].path) && !find(now, clean->entries[i].path))
			return "a file is missing";
	return NULL;
}

/* Whether the run without faults left other files than it found, but for one that this run finds shortened. */
static bool makes_files(const expectations *rules, const folder *before, const folder *clean)
{
	for (size_t i = 0; i < clean->count; i++) {
		const entry *is = &clean->entries[i], *was = find(before, is->path);
		if (has_times(is->path) || is->is_folder ||
			(rules->shortened && strcmp(is->path + 2, rules->shortened) == 0))
			continue;
		if (!was || !same(is->content, was->content))
			return true;
	}
	return false;
}

/* Whether a file is named that is not compared, so that nobody knows whether it stands. */
static bool blames_one_with_times(const folder *clean, bytes said)
{
	for (size_t i = 0; i < clean->count; i++)
		if (has_times(clean->entries[i].path) && strstr(said.data, clean->entries[i].path + 2))
			return true;
	return false;
}

static const char *judge(const expectations *rules, const folder *before, const result *clean, const result *r)
{
	if (!WIFEXITED(r->status))
		return WTERMSIG(r->status) == 14 ? "it hangs" : "it dies of a signal";
	const int code = WEXITSTATUS(r->status);
	if (code == WEXITSTATUS(clean->status)) {
		if (!same(r->out, clean->out))
			return "standard output differs";
		if (!same(r->err, clean->err))
			return "standard error differs";
		return judge_files(rules, before, &clean->files, &r->files, true, r->err);
	}
	const bool right = rules->kind == FAULTY_SHORTEN ? code == 2 || code == 3
							 : code == 4 || (rules->kind == FAULTY_CALLS && code == 2);
	if (!right)
		return "wrong exit code";
	const size_t lines = count_new_lines(r->err, clean->err);
	if (lines == 0)
		return "it says nothing";
	if (lines != 1 && !rules->many)
		return "it says more than one line";
	if (makes_files(rules, before, &clean->files) && same(r->out, clean->out) &&
		!blames_one_with_times(&clean->files, r->err) &&
		!strstr(r->err.data, "the output stands") &&
		!judge_files(rules, before, &clean->files, &r->files, true, r->err))
		return "it fails although its files stand";
	return judge_files(rules, before, &clean->files, &r->files, false, r->err);
}

static int number_of(const char *name)
{
	static const struct {
		const char *name;
		int number;
	} known[] = {{"EIO", EIO}, {"ENOMEM", ENOMEM}, {"EINTR", EINTR}, {"ENOSPC", ENOSPC}, {"EACCES", EACCES}};
	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if (strcmp(name, known[i].name) == 0)
			return known[i].number;
	return 0;
}

int main(int count, char **arguments)
{
	int at = 1;
	if (count < 7)
		return 70;
	char *preload = arguments[at++];
	const char *what = arguments[at++];
	expectations rules = {.kind = strcmp(what, "memory") ? FAULTY_CALLS : FAULTY_MEMORY};
	if (strncmp(what, "shorten:", 8) == 0) {
		rules.kind = FAULTY_SHORTEN;
		rules.shortened = what + 8;
	}
	const bool onwards = strcmp(arguments[at], "onwards") == 0;
	at += onwards;
	const size_t stride = strtoul(arguments[at++], NULL, 10), first = strtoul(arguments[at++], NULL, 10);
	char *path = realpath(arguments[at++], NULL), *library = realpath(preload, NULL);
	if (!path || !library)
		die("cannot find", arguments[at - 1]);
	for (; strcmp(arguments[at], "--"); at++) {
		if (strcmp(arguments[at], "many") == 0)
			rules.many = true;
		else if (strncmp(arguments[at], "report=", 7) == 0)
			rules.report = arguments[at] + 7;
		else
			die("what is", arguments[at]);
	}
	char **command = arguments + at + 1;

	char scratch[512], file[600];
	snprintf(scratch, sizeof scratch, "%s.sweep", path);
	snprintf(file, sizeof file, "%s.shared", scratch);
	const int fd = open(file, O_RDWR | O_CREAT | O_TRUNC, 0600);
	if (fd < 0 || ftruncate(fd, sizeof(faulty)) != 0 || chdir(path) != 0)
		die("cannot use", path);
	faulty *shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
	if (shared == MAP_FAILED)
		die("cannot map", file);

	static folder before;
	static result clean, r;
	list(&before, ".");
	*shared = (faulty){.kind = rules.kind, .target = SIZE_MAX};
	run(command, library, file, scratch, &clean);
	strip_times(&clean.err);
	if (!WIFEXITED(clean.status) || (WEXITSTATUS(clean.status) != 0 && WEXITSTATUS(clean.status) != 6) ||
		shared->count == 0) {
		printf("the command fails without a fault: %s\n", clean.err.data);
		return 1;
	}
	restore(&before, &clean.files);
	const size_t calls = shared->count;

	size_t tried = 0, bad = 0;
	for (size_t n = first; n < calls + 1000000; n += stride) {
		*shared = (faulty){.kind = rules.kind, .target = n, .onwards = onwards, .number = number_of(what)};
		if (rules.shortened)
			snprintf(shared->shortened, sizeof shared->shortened, "%s/%s", path, rules.shortened);
		run(command, library, file, scratch, &r);
		strip_times(&r.err);
		const char *wrong = judge(&rules, &before, &clean, &r);
		const bool fired = shared->fired;
		tried += fired;
		if (wrong) {
			bad++;
			if (bad <= SHOWN)
				printf("%s%s %zu (%s): %s (status %d.%d): %.200s\n", what, onwards ? " onwards" : "", n,
					shared->name, wrong, WIFEXITED(r.status) ? WEXITSTATUS(r.status) : -1,
					WTERMSIG(r.status), r.err.data);
		}
		restore(&before, &r.files);
		free_result(&r);
		if (!fired)
			break;
	}
	printf("%s%s: %zu calls, tried %zu, bad %zu\n", what, onwards ? " onwards" : "", calls, tried, bad);
	return bad ? 1 : 0;
}
