/* SPDX-License-Identifier: MIT */
/*
 * What the files of this room know of a document: a copy of its text, and a tree of values that point into it.
 *
 * In the copy the closing quote of every string is a NUL, so that a string without escapes is its own text. There is no
 * other NUL before the end, so that who copies text puts quotes in their place. A value that changes still knows where
 * the old one stands; children that are new come behind those that are in the text.
 */
#ifndef NT_JSON_TREE_H
#define NT_JSON_TREE_H

#include <string.h>
#include "base/memory.h"
#include "json/json.h"

struct nt_json_value {
	const char *begin; /* where it stands, or stood, in the text; NULL: it was added */
	union {
		const char *text;          /* numbers: their spelling; strings: what they say, NUL-terminated */
		struct nt_json_list *list; /* containers; NULL: empty */
	} of;
	uint64_t size : 56; /* bytes of text, NUL not counted; children */
	uint64_t type : 4;  /* nt_json_type */
	uint64_t truth : 1; /* booleans */
	uint64_t made : 1;  /* what the text has at `begin` is not the content */
};

typedef struct nt_json_member {
	nt_json_value value;
	const char *key; /* NUL-terminated */
	size_t key_length;
} nt_json_member;

/* Children of a container; nt_json_value[capacity] or nt_json_member[capacity] follow. */
typedef struct nt_json_list {
	const char *end; /* in the text, behind the bracket; NULL: the container had no children there */
	size_t capacity;
	size_t taken; /* children that are in the text and no more here */
} nt_json_list;

struct nt_json {
	char *text; /* [size] and some NULs */
	size_t size;
	nt_json_value root;
	nt_json_value scratch; /* what changing functions hand out once memory is exhausted */
	nt_arena arena;        /* lists, strings with escapes, new contents */
	bool failed;
};

static inline bool nt_json_is_container(const nt_json_value *value)
{
	return value->type == NT_JSON_ARRAY || value->type == NT_JSON_OBJECT;
}

static inline nt_json_value *nt_json_elements(const nt_json_list *list)
{
	return (nt_json_value *)(list + 1);
}

static inline nt_json_member *nt_json_members(const nt_json_list *list)
{
	return (nt_json_member *)(list + 1);
}

static inline size_t nt_json_child_bytes(bool of_object)
{
	return of_object ? sizeof(nt_json_member) : sizeof(nt_json_value);
}

/* A child of a container that has it. */
static inline nt_json_value *nt_json_child(const nt_json_value *container, size_t index)
{
	return container->type == NT_JSON_OBJECT ? &nt_json_members(container->of.list)[index].value :
						   &nt_json_elements(container->of.list)[index];
}

static inline bool nt_json_is_space(char c)
{
	return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

static inline const char *nt_json_skip_space(const char *at)
{
	while (nt_json_is_space(*at))
		at++;
	return at;
}

/* A list in the document's arena with room for `capacity` children; NULL: out of memory. */
nt_json_list *nt_json_new_list(nt_json *document, size_t capacity, bool of_object);

#endif
