/* SPDX-License-Identifier: MIT */
#include "fail_alloc.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdint.h>

/* of all threads */
static atomic_size_t left = SIZE_MAX; /* allocations that succeed; SIZE_MAX: all */
static atomic_bool failed;
static bool alone; /* one fails, and no later one */

void fail_allocations_from(size_t n)
{
	left = n;
	failed = alone = false;
}

void fail_allocation(size_t n)
{
	fail_allocations_from(n);
	alone = true;
}

bool stop_failing_allocations(void)
{
	left = SIZE_MAX;
	return failed;
}

static bool fails(void)
{
	size_t now = left;
	while (now > 0 && now < SIZE_MAX && !atomic_compare_exchange_weak(&left, &now, now - 1))
		;
	if (now > 0)
		return false;
	failed = true;
	if (alone)
		left = SIZE_MAX;
	errno = ENOMEM;
	return true;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
int __real_posix_memalign(void **block, size_t alignment, size_t size);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t length);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
int __wrap_posix_memalign(void **block, size_t alignment, size_t size);
char *__wrap_strdup(const char *text);
char *__wrap_strndup(const char *text, size_t length);

void *__wrap_malloc(size_t size)
{
	return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
	return fails() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size)
{
	return fails() ? NULL : __real_realloc(block, size);
}

int __wrap_posix_memalign(void **block, size_t alignment, size_t size)
{
	return fails() ? ENOMEM : __real_posix_memalign(block, alignment, size);
}

char *__wrap_strdup(const char *text)
{
	return fails() ? NULL : __real_strdup(text);
}

char *__wrap_strndup(const char *text, size_t length)
{
	return fails() ? NULL : __real_strndup(text, length);
}
