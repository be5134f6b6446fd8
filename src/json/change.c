/* SPDX-License-Identifier: MIT */
/*
 * Changing documents. A value that is set forgets its content, not its place in the text; what is taken out of a list is
 * counted, so that the writer looks for it in the text. Lists that grow move and leave their old memory to the arena.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include "ext/number.h"
#include "json/tree.h"

static nt_json_value *fail(nt_json *document)
{
	document->failed = true;
	document->scratch = (nt_json_value){.type = NT_JSON_NULL, .made = 1};
	return &document->scratch;
}

/* Another content at the same place. */
static void set(nt_json_value *value, nt_json_value content)
{
	content.begin = value->begin;
	content.made = 1;
	*value = content;
}

/* ---- containers ---- */

/* Room for one more child; false: out of memory. */
static bool grow(nt_json *document, nt_json_value *container)
{
	const bool of_object = container->type == NT_JSON_OBJECT;
	const nt_json_list *old = container->of.list;
	size_t capacity;
	if (old && container->size < old->capacity)
		return true;
	nt_json_list *list = nt_size_mul(container->size, 2, &capacity) ?
		nt_json_new_list(document, capacity + 2, of_object) : NULL;
	if (!list)
		return false;
	if (old) {
		list->end = old->end;
		list->taken = old->taken;
		memcpy(list + 1, old + 1, container->size * nt_json_child_bytes(of_object));
	}
	container->of.list = list;
	return true;
}

/* A null behind the children of a container, which becomes an empty one of that type if it is no such. */
static nt_json_value *add(nt_json *document, nt_json_value *container, nt_json_type type)
{
	if (!container) /* one that memory was missing for */
		return NULL;
	if (container->type != type)
		set(container, (nt_json_value){.type = type});
	if (!grow(document, container))
		return NULL;
	container->size++;
	nt_json_value *child = nt_json_child(container, container->size - 1);
	*child = (nt_json_value){.type = NT_JSON_NULL, .made = 1};
	return child;
}

nt_json_value *nt_json_put(nt_json *document, nt_json_value *object, const char *key)
{
	nt_json_value *found = nt_json_find(object, key);
	if (found)
		return found;
	const size_t length = strlen(key);
	const char *text = nt_arena_text(&document->arena, key, length);
	if (!text || !add(document, object, NT_JSON_OBJECT))
		return fail(document);
	nt_json_member *member = &nt_json_members(object->of.list)[object->size - 1];
	member->key = text;
	member->key_length = length;
	return &member->value;
}

nt_json_value *nt_json_append(nt_json *document, nt_json_value *array)
{
	nt_json_value *child = add(document, array, NT_JSON_ARRAY);
	return child ? child : fail(document);
}

void nt_json_remove_at(nt_json *document, nt_json_value *container, size_t index)
{
	(void)document;
	const size_t count = nt_json_count(container);
	if (index >= count)
		return;
	nt_json_list *list = container->of.list;
	const size_t bytes = nt_json_child_bytes(container->type == NT_JSON_OBJECT);
	char *child = (char *)(list + 1) + index * bytes;
	list->taken += nt_json_child(container, index)->begin != NULL;
	memmove(child, child + bytes, (count - index - 1) * bytes);
	container->size--;
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
	const char *copy = nt_arena_text(&document->arena, text, length);
	if (copy)
		set(value, (nt_json_value){.of.text = copy, .size = length, .type = type});
	else
		fail(document);
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
	const int length = snprintf(text, sizeof text, "%" PRIu64, content);
	set_text(document, value, NT_JSON_INTEGER, text, (size_t)length);
}

void nt_json_set_double(nt_json *document, nt_json_value *value, double content)
{
	char text[NT_NUMBER_TEXT];
	double old;
	if (nt_json_get_double(value, &old) && old == content && !signbit(old) == !signbit(content))
		return;
	const size_t length = (size_t)(nt_write_json_double(text, content) - text);
	set_text(document, value, isfinite(content) ? NT_JSON_REAL : NT_JSON_NULL, text, length);
}

void nt_json_set_string(nt_json *document, nt_json_value *value, const char *text, size_t length)
{
	size_t old_length;
	const char *old = nt_json_get_string(value, &old_length);
	if (!old || old_length != length || memcmp(old, text, length) != 0)
		set_text(document, value, NT_JSON_STRING, text, length);
}

void nt_json_set_object(nt_json *document, nt_json_value *value)
{
	(void)document;
	set(value, (nt_json_value){.type = NT_JSON_OBJECT});
}

/* What a copy has: texts are shared, lists are its own. */
static nt_json_value copy(nt_json *document, const nt_json_value *from)
{
	nt_json_value to = *from;
	to.begin = NULL;
	to.made = 1;
	if (!nt_json_is_container(from) || from->size == 0) {
		if (nt_json_is_container(from))
			to.of.list = NULL;
		return to;
	}
	to.of.list = nt_json_new_list(document, from->size, from->type == NT_JSON_OBJECT);
	if (!to.of.list)
		return *fail(document);
	if (from->type == NT_JSON_OBJECT)
		memcpy(to.of.list + 1, from->of.list + 1, from->size * sizeof(nt_json_member));
	for (size_t i = 0; i < from->size; i++)
		*nt_json_child(&to, i) = copy(document, nt_json_child(from, i));
	return to;
}

void nt_json_set_copy(nt_json *document, nt_json_value *value, const nt_json_value *from)
{
	set(value, copy(document, from));
}
