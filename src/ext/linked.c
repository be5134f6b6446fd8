/* SPDX-License-Identifier: MIT */
/*
 * The foreign libraries in the tool itself: see linked.h.
 */
#include "ext/linked.h"

#include <stdio.h> /* before jpeglib.h, which does not include it */
#include <jpeglib.h>
#include <libdeflate.h>
#include <xxhash.h>

#define SPELLED(macro) #macro
#define TEXT(macro) SPELLED(macro)

const nt_linked_library *nt_linked_libraries(size_t *count)
{
	static const nt_linked_library libraries[] = {
		{"fast_float", NULL, "MIT OR Apache-2.0 OR BSL-1.0"},
		{"libdeflate", LIBDEFLATE_VERSION_STRING, "MIT"},
		{"libjpeg-turbo", TEXT(LIBJPEG_TURBO_VERSION), "IJG AND BSD-3-Clause AND Zlib"},
		{"libstdc++", NULL, "GPL-3.0-or-later WITH GCC-exception-3.1"},
		{"stb_image", NULL, "MIT OR Unlicense"},
		{"xxHash", TEXT(XXH_VERSION_MAJOR) "." TEXT(XXH_VERSION_MINOR) "." TEXT(XXH_VERSION_RELEASE),
			"BSD-2-Clause"},
	};
	*count = sizeof libraries / sizeof *libraries;
	return libraries;
}
