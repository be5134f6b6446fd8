/* SPDX-License-Identifier: MIT */
/*
 * JSON pointers of what is looked at. They are made for every primitive, accessor and view, mostly for nothing, and
 * snprintf() was an eighth of the time of a document of 100 000 primitives (perf).
 */
#ifndef NT_GLTF_POINTER_H
#define NT_GLTF_POINTER_H

#include <string.h>
#include "gltf/document.h"

/* Both append to a pointer that ends at `end`, where there is room, and return its new end. */
static inline char *nt_gltf_put_text(char *end, const char *text)
{
	const size_t length = strlen(text);
	memcpy(end, text, length + 1);
	return end + length;
}

static inline char *nt_gltf_put_number(char *end, uint64_t number)
{
	char digits[20];
	size_t at = sizeof digits;
	do {
		digits[--at] = (char)('0' + number % 10);
	} while (number /= 10);
	memcpy(end, digits + at, sizeof digits - at);
	end += sizeof digits - at;
	*end = '\0';
	return end;
}

/* Writes "/array/index". */
static inline void nt_gltf_pointer(char pointer[NT_GLTF_POINTER], const char *array, uint64_t index)
{
	pointer[0] = '/';
	char *const end = nt_gltf_put_text(pointer + 1, array);
	*end = '/';
	nt_gltf_put_number(end + 1, index);
}

/* Writes the pointer of the primitive that a mesh is; returns its end. */
static inline char *nt_gltf_mesh_pointer(char pointer[NT_GLTF_POINTER], const nt_mesh *mesh)
{
	char *const end = nt_gltf_put_number(nt_gltf_put_text(pointer, "/meshes/"), mesh->gltf_mesh);
	return nt_gltf_put_number(nt_gltf_put_text(end, "/primitives/"), mesh->gltf_primitive);
}

/* The same for the length of an expression: nt_gltf_of_mesh(mesh).pointer */
typedef struct nt_gltf_mesh_text {
	char pointer[NT_GLTF_POINTER];
} nt_gltf_mesh_text;

static inline nt_gltf_mesh_text nt_gltf_of_mesh(const nt_mesh *mesh)
{
	nt_gltf_mesh_text text;
	nt_gltf_mesh_pointer(text.pointer, mesh);
	return text;
}

#endif
