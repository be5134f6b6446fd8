/* SPDX-License-Identifier: MIT */
/*
 * What every test file includes: cmocka in the order it wants its headers.
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

#endif
