/* SPDX-License-Identifier: MIT */
/*
 * How much memory this process may take: see memory.h. A limit that cannot be read does not count.
 */
#include "base/memory.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

static uint64_t least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint64_t meminfo_available(void)
{
	char line[128];
	uint64_t kilobytes, found = UINT64_MAX;
	FILE *file = fopen("/proc/meminfo", "re");
	while (file && found == UINT64_MAX && fgets(line, sizeof line, file))
		if (sscanf(line, "MemAvailable: %" SCNu64 " kB", &kilobytes) == 1)
			found = kilobytes * 1024;
	if (file)
		fclose(file);
	return found;
}

/* A file with one number; "max" is none. */
static uint64_t limit_in(const char *root, const char *group, const char *name)
{
	char path[4096];
	uint64_t number, found = UINT64_MAX;
	const int length = snprintf(path, sizeof path, "%s%s/%s", root, group, name);
	FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "re") : NULL;
	if (file && fscanf(file, "%" SCNu64, &number) == 1)
		found = number;
	if (file)
		fclose(file);
	return found;
}

/* The least limit of a group and those above it. In a container the path may be that outside of it, so that only the
 * root is there. */
static uint64_t limit_of_group(const char *root, char *group, const char *name)
{
	uint64_t found = limit_in(root, "", name);
	for (char *slash; (slash = strrchr(group, '/')) && slash[1]; *slash = '\0')
		found = least(found, limit_in(root, group, name));
	return found;
}

/* The list has lines like "0::/a/b" (version 2) and "4:memory:/a/b", whose files are below a folder "memory". */
uint64_t nt_memory_of_groups(const char *list, const char *root)
{
	char line[4096], memory[4096];
	uint64_t found = UINT64_MAX;
	snprintf(memory, sizeof memory, "%s/memory", root);
	FILE *file = fopen(list, "re");
	while (file && fgets(line, sizeof line, file)) {
		char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
		if (!group)
			continue;
		*group++ = '\0';
		group[strcspn(group, "\n")] = '\0';
		if (!controllers[1])
			found = least(found, limit_of_group(root, group, "memory.max"));
		else if (strcmp(controllers + 1, "memory") == 0)
			found = least(found, limit_of_group(memory, group, "memory.limit_in_bytes"));
	}
	if (file)
		fclose(file);
	return found;
}

uint64_t nt_memory_available(void)
{
	struct rlimit limit;
	uint64_t found = least(meminfo_available(), nt_memory_of_groups("/proc/self/cgroup", "/sys/fs/cgroup"));
	if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
		found = least(found, (uint64_t)limit.rlim_cur);
	return found;
}
