/* SPDX-License-Identifier: MIT */
/*
 * The page's style and script, as they stand in src/report/render/page, in the binary. The assembler includes
 * the files; both compilers we build with have one that can, and no generated C is needed.
 */
#include "report/render/page_assets.h"

#define EMBED(name, file)                              \
	__asm__(".pushsection .rodata\n"               \
		".global " #name "\n"                  \
		".hidden " #name "\n" #name ":\n"      \
		".incbin \"src/report/render/page/" file "\"\n" \
		".byte 0\n"                            \
		".popsection\n")

EMBED(nt_page_style, "page.css");
EMBED(nt_page_script, "page.js");
