/* SPDX-License-Identifier: MIT */
/* See measure.h. */
#include "measure.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

const char *measure_processor(void)
{
	static char line[256];
	FILE *f = fopen("/proc/cpuinfo", "r");
	const char *name = NULL;
	while (f && !name && fgets(line, sizeof line, f))
		name = strncmp(line, "model name", 10) == 0 ? strchr(line, ':') : NULL;
	if (f)
		fclose(f);
	line[strcspn(line, "\n")] = 0;
	return name ? name + 2 : "unknown processor";
}

static double seconds_of(clockid_t clock)
{
	struct timespec t;
	clock_gettime(clock, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double measure_seconds(void)
{
	return seconds_of(CLOCK_MONOTONIC);
}

double measure_thread_seconds(void)
{
	return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double measure_degrees(const float *tangent, const double *exact)
{
	double sine = 0, cosine = 0;
	for (int i = 0; i < 3; i++) {
		const int k = (i + 1) % 3, l = (i + 2) % 3;
		const double x = tangent[k] * exact[l] - tangent[l] * exact[k];
		sine += x * x;
		cosine += tangent[i] * exact[i];
	}
	const double angle = atan2(sqrt(sine), cosine) * 57.29577951308232;
	return isfinite(angle) ? angle : 180;
}

int measure_compare(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

void *measure_room(size_t count, size_t size)
{
	void *block = calloc(count ? count : 1, size);
	if (!block) {
		fprintf(stderr, "error: out of memory\n");
		exit(4);
	}
	return block;
}

FILE *measure_open(const char *folder, const char *name, const char *mode)
{
	char path[512];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	FILE *f = fopen(path, mode);
	if (!f && mode[0] == 'w') {
		fprintf(stderr, "error: %s: %s\n", path, strerror(errno));
		exit(2);
	}
	return f;
}

void measure_pool_add(measure_pool *pool, double value)
{
	if (pool->count == pool->capacity) {
		pool->capacity = pool->capacity ? 2 * pool->capacity : 65536;
		pool->values = realloc(pool->values, pool->capacity * sizeof *pool->values);
		if (!pool->values) {
			fprintf(stderr, "error: out of memory\n");
			exit(4);
		}
	}
	pool->values[pool->count++] = value;
}

void measure_pool_finish(measure_pool *pool)
{
	pool->median = pool->high = pool->worst = NAN;
	if (pool->count > 0) {
		qsort(pool->values, pool->count, sizeof *pool->values, measure_compare);
		pool->median = pool->values[pool->count / 2];
		pool->high = pool->values[(size_t)((double)(pool->count - 1) * 0.999)];
		pool->worst = pool->values[pool->count - 1];
	}
	free(pool->values);
	pool->values = NULL;
}
