/* SPDX-License-Identifier: MIT */
/*
 * Changing documents. A value that is set forgets its content, not its place in the text; that something was taken out
 * of a list is noted, so that the writer looks for it in the text. Lists that grow move and leave their old memory to
 * the arena; the pages of large ones are given back.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/memory.h"
#include "ext/linked.h"
#include "json/tree.h"

/* Integers below it are in the value itself. */
#define COUNTED_LIMIT ((uint64_t)1 << 48)

/* Children that a container which gets some has room for: a new view or accessor has so many. Objects of more than the
 * latter have keys of their own once they change. */
enum { LEAST_CAPACITY = 4, MOST_SHARED = 16 };

static nt_json_value *fail(nt_json *document)
{
	document->failed = true;
	document->scratch = (nt_json_value){.type = NT_JSON_NULL, .made = 1};
	return &document->scratch;
}

/* Another content at the same place, but for containers and override texts. */
static void set(nt_json_value *value, nt_json_value content)
{
	content.of.text = nt_json_begin(value);
	content.made = 1;
	*value = content;
}

/* ---- containers ---- */

/* An empty container at the same place, with room for so many children. */
static bool set_container(nt_json *document, nt_json_value *value, nt_json_type type, size_t capacity)
{
	nt_json_list *list = nt_json_new_list(document, capacity, false, nt_json_begin(value));
	if (!list)
		return false;
	*value = (nt_json_value){.of.list = list, .type = type, .made = 1, .apart = 1};
	return true;
}

/* Moves the children of a container. With `owns` it is an object, which gets keys of its own; else these stay.
 * False: out of memory. */
static bool move(nt_json *document, nt_json_value *container, size_t capacity, bool owns)
{
	nt_json_list *const old = container->apart ? container->of.list : NULL;
	nt_json_list *list = nt_json_new_list(document, capacity, owns, nt_json_begin(container));
	if (!list)
		return false;
	if (old) {
		list->end = old->end;
		if (owns)
			memcpy(nt_json_own_keys(list), old->keys, container->size * sizeof *old->keys);
		else
			list->keys = old->keys;
		memcpy(list->children, old->children, container->size * sizeof *list->children);
		nt_drop_pages(old, sizeof *old + old->capacity * sizeof *old->children);
	}
	container->of.list = list;
	container->apart = 1;
	return true;
}

/* Whether an object has keys of its own, once it has one more child. */
static bool owns_keys(const nt_json_value *object)
{
	return object->type == NT_JSON_OBJECT && (object->size >= MOST_SHARED ||
		(object->apart && nt_json_own_keys(object->of.list)));
}

/* Room for one more child. */
static bool grow(nt_json *document, nt_json_value *container)
{
	const bool has_room = container->apart && container->size < container->of.list->capacity,
		owns = owns_keys(container);
	if (has_room && (!owns || nt_json_own_keys(container->of.list)))
		return true;
	return move(document, container, has_room ? container->of.list->capacity : container->size < LEAST_CAPACITY
		? LEAST_CAPACITY : container->size + container->size / 2, owns);
}

/* A null behind the children of a container, which becomes an empty one of that type if it is no such. */
static nt_json_value *add(nt_json *document, nt_json_value *container, nt_json_type type)
{
	if (!container) /* one that memory was missing for */
		return NULL;
	if (container->type != type && !set_container(document, container, type, LEAST_CAPACITY))
		return NULL;
	if (!grow(document, container))
		return NULL;
	nt_json_value *child = nt_json_child(container, container->size++);
	*child = (nt_json_value){.type = NT_JSON_NULL, .made = 1};
	return child;
}

/* The document's copy of a key; its text is NULL: out of memory. */
static nt_json_name keep_key(nt_json *document, const char *key)
{
	const size_t length = strlen(key);
	return (nt_json_name){nt_arena_text(&document->arena, key, length), length};
}

/* The keys of an object and one more: those that an object with the same ones got last time, if that was the same
 * key. The search goes on behind those of the last time, since objects are made in turns. NULL: out of memory. */
static const nt_json_name *longer_keys(nt_json *document, const nt_json_name *keys, size_t count, const char *key)
{
	for (size_t i = 0; i < NT_JSON_LONGER; i++) {
		const size_t at = (document->longer_at + i) % NT_JSON_LONGER;
		const nt_json_longer *known = &document->longer[at];
		if (!known->keys || known->of != keys || known->count != count ||
			strcmp(known->keys[count].text, key) != 0)
			continue;
		document->longer_at = at + 1;
		return known->keys;
	}
	nt_json_name *made = nt_arena_alloc(&document->arena, count + 1, sizeof *made);
	const nt_json_name name = keep_key(document, key);
	if (!made || !name.text)
		return NULL;
	if (count)
		memcpy(made, keys, count * sizeof *made);
	made[count] = name;
	document->longer[document->longer_at++ % NT_JSON_LONGER] =
		(nt_json_longer){.of = keys, .keys = made, .count = count};
	return made;
}

nt_json_value *nt_json_put(nt_json *document, nt_json_value *object, const char *key)
{
	nt_json_value *child = nt_json_find(object, key);
	if (child)
		return child;
	child = add(document, object, NT_JSON_OBJECT);
	if (!child)
		return fail(document);
	nt_json_list *list = object->of.list;
	const size_t last = object->size - 1;
	const nt_json_name *keys = NULL;
	nt_json_name *own = nt_json_own_keys(list);
	if (own)
		own[last] = keep_key(document, key);
	else
		keys = longer_keys(document, last ? list->keys : NULL, last, key);
	if (own ? !own[last].text : !keys) {
		object->size--;
		return fail(document);
	}
	list->keys = own ? own : keys;
	return child;
}

nt_json_value *nt_json_append(nt_json *document, nt_json_value *array)
{
	nt_json_value *child = add(document, array, NT_JSON_ARRAY);
	return child ? child : fail(document);
}

void nt_json_remove_at(nt_json *document, nt_json_value *container, size_t index)
{
	const bool is_object = nt_json_type_of(container) == NT_JSON_OBJECT;
	if (index >= nt_json_count(container))
		return;
	if (is_object && !nt_json_own_keys(container->of.list) && !move(document, container, container->size, true)) {
		fail(document);
		return;
	}
	const size_t behind = container->size-- - index - 1;
	nt_json_value *child = nt_json_child(container, index);
	container->taken |= nt_json_begin(child) != NULL;
	memmove(child, child + 1, behind * sizeof *child);
	if (is_object)
		memmove(&nt_json_own_keys(container->of.list)[index], &container->of.list->keys[index + 1],
			behind * sizeof(nt_json_name));
}

void nt_json_remove(nt_json *document, nt_json_value *object, const char *key)
{
	const size_t length = strlen(key);
	for (size_t i = nt_json_count(object); i-- > 0;) {
		size_t found;
		const char *name = nt_json_key(object, i, &found);
		if (name && found == length && memcmp(name, key, length) == 0)
			nt_json_remove_at(document, object, i);
	}
}

/* ---- contents ---- */

static void set_text(nt_json *document, nt_json_value *value, nt_json_type type, const char *text, size_t length)
{
	nt_json_override *override = nt_arena_alloc(&document->arena, sizeof *override + length + 1, 1);
	if (!override) {
		fail(document);
		return;
	}
	override->begin = nt_json_begin(value);
	memcpy(override->text, text, length);
	override->text[length] = '\0';
	*value = (nt_json_value){.of.override = override, .size = length, .type = type, .made = 1, .apart = 1};
}

void nt_json_set_bool(nt_json *document, nt_json_value *value, bool content)
{
	(void)document;
	bool old;
	if (!nt_json_get_bool(value, &old) || old != content)
		set(value, (nt_json_value){.type = NT_JSON_BOOLEAN, .truth = content});
}

void nt_json_set_uint64(nt_json *document, nt_json_value *value, uint64_t content)
{
	char text[24];
	uint64_t old;
	if (nt_json_get_uint64(value, &old) && old == content)
		return;
	if (content < COUNTED_LIMIT) {
		set(value, (nt_json_value){.type = NT_JSON_INTEGER, .size = content});
		return;
	}
	const int length = snprintf(text, sizeof text, "%" PRIu64, content);
	set_text(document, value, NT_JSON_INTEGER, text, (size_t)length);
}

void nt_json_set_int64(nt_json *document, nt_json_value *value, int64_t content)
{
	char text[24];
	if (content >= 0)
		nt_json_set_uint64(document, value, (uint64_t)content);
	else
		set_text(document, value, NT_JSON_INTEGER, text,
			(size_t)snprintf(text, sizeof text, "%" PRId64, content));
}

void nt_json_put_uint64(nt_json *document, nt_json_value *object, const char *key, uint64_t content)
{
	nt_json_set_uint64(document, nt_json_put(document, object, key), content);
}

static void set_real(nt_json *document, nt_json_value *value, const char *text, const char *end, bool is_number)
{
	if (is_number)
		set_text(document, value, NT_JSON_REAL, text, (size_t)(end - text));
	else
		set(value, (nt_json_value){.type = NT_JSON_NULL});
}

void nt_json_set_double(nt_json *document, nt_json_value *value, double content)
{
	char text[NT_NUMBER_TEXT];
	double old;
	if (nt_json_get_double(value, &old) && old == content && !signbit(old) == !signbit(content))
		return;
	set_real(document, value, text, nt_write_json_double(text, content), isfinite(content));
}

void nt_json_set_float(nt_json *document, nt_json_value *value, float content)
{
	char text[NT_NUMBER_TEXT];
	set_real(document, value, text, nt_write_json_float(text, content), isfinite(content));
}

void nt_json_set_string(nt_json *document, nt_json_value *value, const char *text, size_t length)
{
	size_t old_length;
	const char *old = nt_json_get_string(value, &old_length);
	if (!old || old_length != length || memcmp(old, text, length) != 0)
		set_text(document, value, NT_JSON_STRING, text, length);
}

void nt_json_set_open(nt_json *document, nt_json_value *value, const char *text, size_t length)
{
	set_text(document, value, NT_JSON_STRING, text, length);
	value->open = 1;
}

void nt_json_set_open_array(nt_json *document, nt_json_value *value)
{
	if (set_container(document, value, NT_JSON_ARRAY, 0))
		value->open = 1;
	else
		fail(document);
}

void nt_json_set_object(nt_json *document, nt_json_value *value)
{
	if (!set_container(document, value, NT_JSON_OBJECT, 0))
		fail(document);
}

/* The children of a container that has the room, one by one. */
static void copy_children(nt_json *document, nt_json_value *value, const nt_json_value *from)
{
	const bool is_object = from->type == NT_JSON_OBJECT;
	nt_json_list *list = nt_json_new_list(document, from->size, is_object, nt_json_begin(value));
	if (!list) {
		fail(document);
		return;
	}
	if (is_object)
		memcpy(nt_json_own_keys(list), from->of.list->keys, from->size * sizeof(nt_json_name));
	for (size_t i = 0; i < from->size; i++) {
		list->children[i] = (nt_json_value){.type = NT_JSON_NULL, .made = 1};
		nt_json_set_copy(document, &list->children[i], nt_json_child(from, i));
	}
	*value = (nt_json_value){.of.list = list, .size = from->size, .type = from->type, .made = 1, .apart = 1};
}

/* Lists and texts of a copy are its own. */
void nt_json_set_copy(nt_json *document, nt_json_value *value, const nt_json_value *from)
{
	const nt_json_type type = (nt_json_type)from->type;
	if (nt_json_is_container(from) && from->size)
		copy_children(document, value, from);
	else if (nt_json_is_container(from) && !set_container(document, value, type, 0))
		fail(document);
	else if ((type == NT_JSON_STRING || type == NT_JSON_REAL || type == NT_JSON_INTEGER) &&
		!nt_json_is_counted(from))
		set_text(document, value, type, nt_json_text(from), from->size);
	else if (!nt_json_is_container(from))
		set(value, *from);
}
