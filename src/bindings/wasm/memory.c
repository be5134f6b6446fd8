/* SPDX-License-Identifier: MIT */
/*
 * The system of the WebAssembly module, which imports nothing: memory and a clock. All blocks live until a call is
 * over: they are taken one behind the other, and forget() frees them together.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

enum { PAGE = 65536, ALIGNMENT = 16 };

extern unsigned char __heap_base; /* by the linker: the first byte that nobody uses */

static uintptr_t end; /* of the last block; 0: there is none */

__attribute__((export_name("forget"))) void nt_wasm_forget(void)
{
	end = 0;
}

__attribute__((export_name("allocate"))) void *malloc(size_t bytes)
{
	const uintptr_t last = end ? end : (uintptr_t)&__heap_base;
	const uintptr_t begin = (last + ALIGNMENT - 1) & ~(uintptr_t)(ALIGNMENT - 1);
	if (begin < last || bytes > UINTPTR_MAX - PAGE - begin)
		return NULL;
	const size_t pages = (begin + bytes + PAGE - 1) / PAGE, has = __builtin_wasm_memory_size(0);
	if (pages > has && __builtin_wasm_memory_grow(0, pages - has) == SIZE_MAX)
		return NULL;
	end = begin + bytes;
	return (void *)begin;
}

void free(void *block)
{
	(void)block;
}

/* Nothing that the package offers takes the time. */
int clock_gettime(clockid_t clock, struct timespec *time)
{
	(void)clock;
	*time = (struct timespec){0, 0};
	return 0;
}
