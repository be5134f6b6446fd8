/* SPDX-License-Identifier: MIT */
/*
 * The header of a PLY file as parsed: elements, their properties, and what the lines themselves say.
 */
#ifndef NT_PLY_HEADER_H
#define NT_PLY_HEADER_H

#include "base/error.h"
#include "base/memory.h"
#include "ply/value.h"

enum { PLY_NO_PROPERTY = -1 };

typedef struct ply_property {
	const char *name;
	size_t line;
	ply_type type;
	bool list;
	ply_type count_type; /* of a list */
	size_t offset;       /* in the binary row, where no list comes before */
} ply_property;

typedef struct ply_element {
	const char *name;
	size_t line;
	size_t count;
	ply_property *properties;
	size_t property_count, property_capacity;
	bool has_list;
	size_t row_bytes; /* of a binary row; with lists: of one whose lists are empty */
} ply_element;

typedef struct ply_header {
	ply_encoding encoding;
	ply_element *elements;
	size_t element_count, element_capacity;
	const char **textures; /* names after "comment TextureFile" */
	size_t texture_count, texture_capacity;
	size_t unknown_lines, unknown_line; /* lines before the first element that are no statements: how many,
	                                       the first */
	size_t body;        /* offset of the first byte after the header */
	size_t body_line;   /* its line, 1-based */
	const char *newline; /* as the header has it: "\n", "\r\n" or "\r" */
	nt_arena texts;
} ply_header;

/* Reads the header of scene->bytes. */
nt_status ply_parse_header(ply_header *header, const unsigned char *bytes, size_t size,
	nt_error *error);
void ply_free_header(ply_header *header);

/* The element of that name, NULL: none; the property, PLY_NO_PROPERTY: none. */
const ply_element *ply_find_element(const ply_header *header, const char *name);
int ply_find_property(const ply_element *element, const char *name);

/* Bytes of the value at `at` of a binary row, of which that many are there. */
static inline size_t ply_value_bytes(const ply_property *property, const unsigned char *at, bool swap)
{
	return !property->list ? ply_size(property->type) : ply_size(property->count_type) +
		ply_size(property->type) * (size_t)ply_load_integer(at, property->count_type, swap);
}

/* "float", "uchar" ... */
const char *ply_type_name(ply_type type);

/* The next line of a header: its text without the line's end, where the one after begins. */
typedef struct ply_line {
	const char *text;
	size_t length;
	size_t next;
	const char *newline; /* NULL: the file ends here */
} ply_line;

/* The next line of a header, where '\r' may be a line's end by itself. */
ply_line ply_header_line(const ply_header *header, const unsigned char *bytes, size_t size, size_t begin);

/* The next word of [*at, end), blanks around it skipped; its length, 0: none. */
size_t ply_next_word(const char **at, const char *end, const char **word);

#endif
