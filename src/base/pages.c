/* SPDX-License-Identifier: MIT */
/*
 * Large blocks of memory: see pages.h.
 */
#include "base/pages.h"

#include <stdlib.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

enum { HUGE_PAGE_BYTES = 2 * 1024 * 1024 };

void *nt_alloc_large(size_t bytes)
{
#ifdef MADV_HUGEPAGE
	if (bytes >= 2 * HUGE_PAGE_BYTES) {
		void *block;
		if (posix_memalign(&block, HUGE_PAGE_BYTES, bytes) != 0)
			return NULL;
		madvise(block, bytes, MADV_HUGEPAGE); /* advice: a refusal changes nothing */
		return block;
	}
#endif
	return malloc(bytes);
}
