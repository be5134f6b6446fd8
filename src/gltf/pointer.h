/* SPDX-License-Identifier: MIT */
/*
 * The JSON pointer of an element of a root array. It is made for every accessor and view that is looked at, mostly
 * for nothing, and snprintf() was an eighth of the time of a document of 100 000 primitives (perf).
 */
#ifndef NT_GLTF_POINTER_H
#define NT_GLTF_POINTER_H

#include <string.h>
#include "gltf/document.h"

/* Writes "/array/index". */
static inline void nt_gltf_pointer(char pointer[NT_GLTF_POINTER], const char *array, uint64_t index)
{
	char digits[20];
	size_t at = sizeof digits;
	do {
		digits[--at] = (char)('0' + index % 10);
	} while (index /= 10);
	const size_t length = strlen(array);
	pointer[0] = '/';
	memcpy(pointer + 1, array, length);
	pointer[length + 1] = '/';
	memcpy(pointer + length + 2, digits + at, sizeof digits - at);
	pointer[length + 2 + sizeof digits - at] = '\0';
}

#endif
