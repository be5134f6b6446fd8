/* SPDX-License-Identifier: MIT */
/*
 * A document as the files of this room see it: a copy of its text, and a tree of values that point into it.
 *
 * In the copy the closing quote of every string is a NUL, so that a string without escapes is its own text. There is no
 * other NUL before the end, so that who copies text puts quotes in their place. A value that changes still knows where
 * the old one stands; children that are new come behind those that are in the text.
 *
 * A document of 100 000 primitives has millions of values, so these are small. Most are only a place in the text. An
 * object has its keys together with those of its depth before it that have the same ones in the same order.
 */
#ifndef NT_JSON_TREE_H
#define NT_JSON_TREE_H

#include <string.h>
#include "base/memory.h"
#include "json/json.h"

typedef struct nt_json_list nt_json_list;

/* Decoded or replaced text of a value. */
typedef struct nt_json_override {
	const char *begin; /* where it stands, or stood, in the text; NULL: it was added */
	char text[];       /* NUL-terminated */
} nt_json_override;

struct nt_json_value {
	union {
		const char *text;   /* where it stands, or stood, in the text, strings behind the quote; NULL:
		                       it was added */
		nt_json_override *override; /* apart: strings with escapes, numbers and strings that were set */
		nt_json_list *list; /* apart: containers that have children, or had some */
	} of;
	uint64_t size : 48; /* bytes of text, NUL not counted; children; the number of a counted one */
	uint64_t type : 4;  /* nt_json_type */
	uint64_t truth : 1; /* booleans */
	uint64_t made : 1;  /* what the text has there is not the content */
	uint64_t apart : 1;
	uint64_t open : 1;  /* of a string or an array: who takes the text goes on with it */
	uint64_t taken : 1; /* of a container: children that are in the text are no more here */
};

typedef struct nt_json_name {
	const char *text; /* NUL-terminated */
	size_t length;
} nt_json_name;

/* Children of a container. */
struct nt_json_list {
	const char *begin; /* of the container, in the text; NULL: it was added */
	const char *end;   /* in the text, behind the bracket; NULL: the container had no children there */
	const nt_json_name *keys; /* of an object */
	uint64_t capacity : 63;
	uint64_t has_own_keys : 1; /* [capacity] behind the children; else others share them */
	nt_json_value children[];
};

enum { NT_JSON_LONGER = 32 };

/* The keys that an object with the keys `of` got when one was added. */
typedef struct nt_json_longer {
	const nt_json_name *of, *keys; /* [count], [count + 1] */
	size_t count;
} nt_json_longer;

struct nt_json {
	char *text; /* [size] and some NULs */
	size_t size;
	nt_json_value root;
	nt_json_value scratch; /* what changing functions hand out once memory is exhausted */
	nt_arena arena;        /* lists, override texts, keys */
	nt_json_longer longer[NT_JSON_LONGER]; /* that were asked for last */
	size_t longer_at;      /* behind the last one of these */
	bool failed;
};

static inline bool nt_json_is_container(const nt_json_value *value)
{
	return value->type == NT_JSON_ARRAY || value->type == NT_JSON_OBJECT;
}

/* The present or former place of a value in the text; NULL: it was added. */
static inline const char *nt_json_begin(const nt_json_value *value)
{
	if (value->apart)
		return nt_json_is_container(value) ? value->of.list->begin : value->of.override->begin;
	return value->type == NT_JSON_STRING ? value->of.text - 1 : value->of.text;
}

/* Whether an integer is in the value itself. */
static inline bool nt_json_is_counted(const nt_json_value *value)
{
	return value->type == NT_JSON_INTEGER && value->made && !value->apart;
}

/* [size] what a string says, or how a number that is not counted is spelled. */
static inline const char *nt_json_text(const nt_json_value *value)
{
	return value->apart ? value->of.override->text : value->of.text;
}

/* The children of a container that has some. */
static inline nt_json_value *nt_json_child(const nt_json_value *container, size_t index)
{
	return &container->of.list->children[index];
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

/* memcmp() == 0 of few bytes, in some instructions: the ends of a text of 4 or more overlap. */
static inline bool nt_json_same_bytes(const char *a, const char *b, size_t length)
{
	uint32_t x, y;
	size_t i = 0;
	for (; i + sizeof x < length; i += sizeof x) {
		memcpy(&x, a + i, sizeof x);
		memcpy(&y, b + i, sizeof y);
		if (x != y)
			return false;
	}
	if (length >= sizeof x) {
		memcpy(&x, a + length - sizeof x, sizeof x);
		memcpy(&y, b + length - sizeof y, sizeof y);
		return x == y;
	}
	while (i < length && a[i] == b[i])
		i++;
	return i == length;
}

static inline bool nt_json_same_key(const nt_json_name *a, const nt_json_name *b)
{
	return a->length == b->length && nt_json_same_bytes(a->text, b->text, a->length);
}

/* NULL: others share them. */
static inline nt_json_name *nt_json_own_keys(nt_json_list *list)
{
	return list->has_own_keys ? (nt_json_name *)(list->children + list->capacity) : NULL;
}

/* A list in the document's arena with room for `capacity` children, and for keys of its own or without; NULL: out of
 * memory. */
nt_json_list *nt_json_new_list(nt_json *document, size_t capacity, bool has_keys, const char *begin);

#endif
