/* SPDX-License-Identifier: MIT */
/*
 * Makers of temporary files: see maker.h.
 *
 * A process number alone says little: numbers are given again, every container counts its own, and a folder may be
 * shared between machines. Together with the machine's name, the kernel's number for this boot, the namespace that
 * the process number is from and the time at which the process started, it names one process for ever.
 */
#include "file/maker.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_HOST = 40, BOOT_DIGITS = 32, FIELDS = 4 };

/* ---- what the system says ---- */

/* The first bytes of a file of /proc as text; empty where there is none. */
static void read_text(const char *path, char *text, size_t capacity)
{
	const int fd = open(path, O_RDONLY | O_CLOEXEC);
	ssize_t size = -1;
	if (fd >= 0) {
		do
			size = read(fd, text, capacity - 1);
		while (size < 0 && errno == EINTR);
		close(fd);
	}
	text[size > 0 ? size : 0] = '\0';
}

/* When a process started, in ticks since the boot: field 22 of its stat, counted from behind the name in brackets,
 * which may hold anything. 0: not known. */
static unsigned long long start_of(const char *pid)
{
	char path[64], text[1024];
	snprintf(path, sizeof path, "/proc/%s/stat", pid);
	read_text(path, text, sizeof text);
	const char *at = strrchr(text, ')');
	for (int field = 2; at && field < 22; field++) {
		at = strchr(at, ' ');
		at += at != NULL;
	}
	return at ? strtoull(at, NULL, 10) : 0;
}

/* The boot's number without its dashes. */
static void boot_of_kernel(char boot[BOOT_DIGITS + 1])
{
	char text[64];
	size_t count = 0;
	read_text("/proc/sys/kernel/random/boot_id", text, sizeof text);
	for (const char *c = text; *c && *c != '\n' && count < BOOT_DIGITS; c++)
		if (*c != '-')
			boot[count++] = *c;
	if (!count)
		boot[count++] = '0';
	boot[count] = '\0';
}

/* Where process numbers are from: the number in "pid:[4026531836]". */
static unsigned long long space_of_numbers(void)
{
	char text[64];
	const ssize_t size = readlink("/proc/self/ns/pid", text, sizeof text - 1);
	text[size > 0 ? size : 0] = '\0';
	const char *number = strchr(text, '[');
	return number ? strtoull(number + 1, NULL, 10) : 0;
}

static void name_of_host(char host[MOST_HOST + 1])
{
	char text[256] = "";
	gethostname(text, sizeof text - 1);
	size_t count = 0;
	for (const char *c = text; *c && count < MOST_HOST; c++) {
		const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
				   (*c >= '0' && *c <= '9') || *c == '.' || *c == '-';
		host[count++] = plain ? *c : '_';
	}
	if (!count)
		host[count++] = '0';
	host[count] = '\0';
}

/* It takes eight calls of the system to ask, and a process is the same for all its files; a child of fork() is not. */
void nt_maker_text(char text[NT_MAKER_TEXT])
{
	static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
	static char known[NT_MAKER_TEXT];
	static pid_t known_pid;
	char host[MOST_HOST + 1], boot[BOOT_DIGITS + 1];
	pthread_mutex_lock(&lock);
	if (known_pid != getpid()) {
		name_of_host(host);
		boot_of_kernel(boot);
		known_pid = getpid();
		snprintf(known, sizeof known, "%s-%s-%llu-%ld-%llu", host, boot, space_of_numbers(), (long)known_pid,
			start_of("self"));
	}
	memcpy(text, known, sizeof known);
	pthread_mutex_unlock(&lock);
}

/* ---- who is gone ---- */

typedef struct maker {
	char *host, *boot, *space, *pid, *start;
} maker;

static bool is_number(const char *text)
{
	return *text && strlen(text) <= 20 && strspn(text, "0123456789") == strlen(text);
}

/* Cuts a text into its fields, from the end, since a host's name may have dashes. False: it is no maker's, or of one
 * that did not know enough of itself. */
static bool cut(char *text, maker *m)
{
	char **const fields[FIELDS] = {&m->start, &m->pid, &m->space, &m->boot};
	for (int i = 0; i < FIELDS; i++) {
		char *dash = strrchr(text, '-');
		if (!dash)
			return false;
		*dash = '\0';
		*fields[i] = dash + 1;
	}
	m->host = text;
	return *m->host && strcmp(m->host, "0") != 0 && strlen(m->boot) == BOOT_DIGITS && is_number(m->space) &&
	       is_number(m->pid) && is_number(m->start) && strcmp(m->space, "0") != 0 &&
	       strcmp(m->start, "0") != 0;
}

bool nt_maker_is_gone(const char *text, size_t length, bool local)
{
	char theirs[NT_MAKER_TEXT], ours[NT_MAKER_TEXT];
	maker they, we;
	if (length >= sizeof theirs)
		return false;
	memcpy(theirs, text, length);
	theirs[length] = '\0';
	nt_maker_text(ours);
	if (strcmp(theirs, ours) == 0) /* mostly: each file's folder is looked through when the file is there */
		return false;
	if (strlen(theirs) != length || !cut(theirs, &they) || !cut(ours, &we) || strcmp(they.host, we.host) != 0)
		return false;
	if (strcmp(they.boot, we.boot) != 0)
		return local;
	if (strcmp(they.space, we.space) != 0)
		return false;
	const long pid = strtol(they.pid, NULL, 10);
	if (pid <= 0 || pid > INT32_MAX)
		return false;
	if (kill((pid_t)pid, 0) != 0 && errno == ESRCH)
		return true;
	const unsigned long long start = start_of(they.pid);
	return start != 0 && start != strtoull(they.start, NULL, 10);
}
