/* SPDX-License-Identifier: MIT */
/*
 * JSON documents that can be read, edited and written again. Unedited parts are written as they were spelled: numbers,
 * escapes, white space, order and repetition of keys.
 *
 * A document owns its values; a value is a handle into it. Handles are small and cheap, and stay valid
 * until the container they are in gets or loses a member, or the document is freed. Reading functions
 * take NULL for "no such value" and answer with "nothing", so that look-ups can be chained.
 *
 * Functions that change a document never fail at once: a document that runs out of memory remembers it,
 * as nt_buffer does, and says so in nt_json_failed() and nt_json_write(). They never return NULL.
 *
 * Not for several threads that write; reading from several threads is fine.
 */
#ifndef NT_JSON_JSON_H
#define NT_JSON_JSON_H

#include <string.h>
#include "base/text.h"

/* Arrays and objects may be nested this deep. */
enum { NT_JSON_MAX_DEPTH = 512 };

typedef struct nt_json nt_json;
typedef struct nt_json_value nt_json_value;

typedef enum nt_json_type {
	NT_JSON_NONE, /* there is no value: the handle is NULL */
	NT_JSON_NULL,
	NT_JSON_BOOLEAN,
	NT_JSON_INTEGER, /* written without point and exponent, and fits 64 bits */
	NT_JSON_REAL,
	NT_JSON_STRING,
	NT_JSON_ARRAY,
	NT_JSON_OBJECT
} nt_json_type;

/*
 * Parses a text. RFC 8259, with everything that a reader could take in two ways refused: duplicate
 * keys, invalid UTF-8, lone surrogates, numbers beyond double, a byte order mark (glTF forbids it).
 *
 *   text      [size] bytes, no final NUL needed; not kept
 *   foreign   key of members that are other people's, at any depth: duplicate keys and numbers beyond double are
 *             no fault in them. NULL: there are none
 *   document  receives the document; free it with nt_json_free()
 *
 * Memory: the text, and at most 32 bytes for each array and object, 16 for each element and member, and 16 for each key
 * of an object whose keys none of the two kinds before it has in that order; all but the text twice while parsing.
 * Returns NT_OK, NT_ERROR_INPUT with the byte offset in `error`, or NT_ERROR_MEMORY.
 */
nt_status nt_json_parse(nt_json **document, const char *text, size_t size, const char *foreign, nt_error *error);

/* NULL is allowed. */
void nt_json_free(nt_json *document);

nt_json_value *nt_json_root(nt_json *document);

/* Whether a change ran out of memory. */
bool nt_json_failed(const nt_json *document);

/* ---- reading ---- */

nt_json_type nt_json_type_of(const nt_json_value *value);

/* "an object", "a number" and so on, for messages. */
const char *nt_json_type_text(const nt_json_value *value);

/* Elements of an array, members of an object, else 0. */
size_t nt_json_count(const nt_json_value *value);

/* Element of an array or value of an object's member, in order; NULL when there is none. */
nt_json_value *nt_json_at(const nt_json_value *value, size_t index);

/* Key of an object's member: NUL-terminated, its length in *length (may be NULL); NULL: none. */
const char *nt_json_key(const nt_json_value *object, size_t index, size_t *length);

/* Value of an object's member, the first one with that key, of `length` bytes; NULL when `object` is not an object or
 * has no such member. */
nt_json_value *nt_json_find_key(const nt_json_value *object, const char *key, size_t length);

/* The same; the length of a literal is known where this is compiled. */
static inline nt_json_value *nt_json_find(const nt_json_value *object, const char *key)
{
	return nt_json_find_key(object, key, strlen(key));
}

/* The value as a C type. False, and *result untouched, when it is something else or does not fit. Whole
 * numbers written as reals (2.0, 1e3) count as integers, as glTF asks. */
bool nt_json_get_bool(const nt_json_value *value, bool *result);
bool nt_json_get_uint64(const nt_json_value *value, uint64_t *result);
bool nt_json_get_double(const nt_json_value *value, double *result);

/* The same of an object's member. */
static inline bool nt_json_find_uint64(const nt_json_value *object, const char *key, uint64_t *result)
{
	return nt_json_get_uint64(nt_json_find(object, key), result);
}

/* Text of a string, NUL-terminated (it may contain NULs too), length in *length (may be NULL); NULL
 * when the value is not a string. */
const char *nt_json_get_string(const nt_json_value *value, size_t *length);

/* The same of an object's member. */
static inline const char *nt_json_find_string(const nt_json_value *object, const char *key, size_t *length)
{
	return nt_json_get_string(nt_json_find(object, key), length);
}

/* Whether two values are equal: same types, numbers, texts, and members in the same order. 1 and 1.0
 * are equal. */
bool nt_json_equal(const nt_json_value *a, const nt_json_value *b);

/* ---- changing ---- */

/* The member of an object with that key, appended as null where there is none. A value that is not an
 * object becomes an empty one. */
nt_json_value *nt_json_put(nt_json *document, nt_json_value *object, const char *key);

/* A null appended to an array. A value that is not an array becomes an empty one. */
nt_json_value *nt_json_append(nt_json *document, nt_json_value *array);

/* Takes all members of that key out of an object, or an element out of an array; nothing happens when there is
 * none. */
void nt_json_remove(nt_json *document, nt_json_value *object, const char *key);
void nt_json_remove_at(nt_json *document, nt_json_value *container, size_t index);

/* Gives a value a new content; one that it has already leaves its spelling. `from` is of the same document; its numbers
 * keep their spelling. */
void nt_json_set_bool(nt_json *document, nt_json_value *value, bool content);
void nt_json_set_uint64(nt_json *document, nt_json_value *value, uint64_t content);
void nt_json_set_int64(nt_json *document, nt_json_value *value, int64_t content);
void nt_json_set_double(nt_json *document, nt_json_value *value, double content);
void nt_json_set_float(nt_json *document, nt_json_value *value, float content); /* in the fewest digits */
void nt_json_set_string(nt_json *document, nt_json_value *value, const char *text, size_t length);
/* The same of an object's member, which may be new. */
void nt_json_put_uint64(nt_json *document, nt_json_value *object, const char *key, uint64_t content);
/* See nt_json_write(). */
void nt_json_set_open(nt_json *document, nt_json_value *value, const char *text, size_t length);
void nt_json_set_open_array(nt_json *document, nt_json_value *value);
void nt_json_set_object(nt_json *document, nt_json_value *value); /* empty */
void nt_json_set_copy(nt_json *document, nt_json_value *value, const nt_json_value *from);

/*
 * Hands the document's text on, some of it at a time: as it was parsed, but for the values that were set and the
 * containers with members or elements that were added or taken out. These are laid out as they begin,
 * else as the document does. The same document gives the same bytes. The end of a string that was
 * set open, or what is in such an array, is left to `take`, which is called without any text for it: its length is not
 * measured.
 *
 * Returns NT_OK, NT_ERROR_MEMORY, also where a change before ran out of memory, or what `take` returned, which has
 * filled the error then and is not called again.
 */
typedef nt_status (*nt_json_put_text)(void *user, const char *text, size_t size);
nt_status nt_json_write(const nt_json *document, nt_json_put_text take, void *user, nt_error *error);

/* The length of that text. */
nt_status nt_json_measure(const nt_json *document, uint64_t *size, nt_error *error);

/* The escape of a byte in such a string, and its length; 0: the byte stands for itself. */
enum { NT_JSON_ESCAPE = 6 };
size_t nt_json_escape(unsigned char c, char made[NT_JSON_ESCAPE]);

#endif
