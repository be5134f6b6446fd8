/* SPDX-License-Identifier: MIT */
/*
 * The page's style, elements and script, as they stand in src/report/render/page, in the binary. The assembler includes
 * the files; both compilers we build with have one that can, and no generated C is needed. The script is one function
 * made of several files, in the order in which they need each other.
 */
#include "report/render/inside.h"

#define FILE_BYTES(file) ".incbin \"src/report/render/page/" file "\"\n"
#ifdef __wasm__
#define SECTION(name) ".section .rodata." #name ",\"\",@\n"
#define END(name) ".size " #name ", . - " #name "\n"
#else
#define SECTION(name) ".pushsection .rodata\n"
#define END(name) ".popsection\n"
#endif
#define EMBED(name, files)                             \
	__asm__(SECTION(name)                          \
		".global " #name "\n"                  \
		".hidden " #name "\n" #name ":\n"      \
		files                                  \
		".byte 0\n" END(name))

EMBED(nt_page_style, FILE_BYTES("page.css"));
EMBED(nt_page_body, FILE_BYTES("page.html"));
EMBED(nt_page_script, ".ascii \"'use strict';\\n(() => {\\n\"\n" FILE_BYTES("data.js") FILE_BYTES("math.js")
	FILE_BYTES("shaders.js") FILE_BYTES("space.js") FILE_BYTES("uv.js") FILE_BYTES("findings.js")
	FILE_BYTES("index.js") FILE_BYTES("diff.js") FILE_BYTES("main.js") ".ascii \"})();\\n\"\n");
