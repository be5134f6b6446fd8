/* SPDX-License-Identifier: MIT */
/*
 * What every test file includes: cmocka in the order it wants its headers, and what a text says.
 */
#ifndef NT_TEST_H
#define NT_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* A text has each of these, but not those that begin with "!"; NULL ends them. */
static inline void assert_says(const char *text, const char *const *parts)
{
	for (; *parts; parts++)
		if (!strstr(text, *parts + (**parts == '!')) != (**parts == '!'))
			fail_msg("%s in: %s", *parts, text);
}

#define PARTS(...) ((const char *const[]){__VA_ARGS__, NULL})

#endif
