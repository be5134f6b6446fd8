/* SPDX-License-Identifier: MIT */
/*
 * Looking into documents. Numbers are read from their spelling each time they are asked for.
 */
#include <math.h>
#include "ext/number.h"
#include "json/tree.h"

nt_json_value *nt_json_root(nt_json *document)
{
	return &document->root;
}

bool nt_json_failed(const nt_json *document)
{
	return document->failed;
}

nt_json_type nt_json_type_of(const nt_json_value *value)
{
	return value ? (nt_json_type)value->type : NT_JSON_NONE;
}

const char *nt_json_type_text(const nt_json_value *value)
{
	static const char *const texts[] = {"nothing", "null", "a boolean", "an integer", "a number",
		"a string", "an array", "an object"};
	return texts[nt_json_type_of(value)];
}

/* ---- containers ---- */

size_t nt_json_count(const nt_json_value *value)
{
	return value && nt_json_is_container(value) ? value->size : 0;
}

nt_json_value *nt_json_at(const nt_json_value *value, size_t index)
{
	return index < nt_json_count(value) ? nt_json_child(value, index) : NULL;
}

const char *nt_json_key(const nt_json_value *object, size_t index, size_t *length)
{
	if (index >= nt_json_count(object) || object->type != NT_JSON_OBJECT)
		return NULL;
	const nt_json_member *member = &nt_json_members(object->of.list)[index];
	if (length)
		*length = member->key_length;
	return member->key;
}

nt_json_value *nt_json_find(const nt_json_value *object, const char *key)
{
	if (!object || object->type != NT_JSON_OBJECT)
		return NULL;
	const size_t length = strlen(key);
	for (size_t i = 0; i < object->size; i++) {
		nt_json_member *member = &nt_json_members(object->of.list)[i];
		if (member->key_length == length && memcmp(member->key, key, length) == 0)
			return &member->value;
	}
	return NULL;
}

/* ---- scalars ---- */

bool nt_json_get_bool(const nt_json_value *value, bool *result)
{
	if (nt_json_type_of(value) != NT_JSON_BOOLEAN)
		return false;
	*result = value->truth;
	return true;
}

/* The magnitude of an integer, which fits. */
static uint64_t read_integer(const nt_json_value *value, bool *negative)
{
	const char *at = value->of.text, *const end = at + value->size;
	uint64_t magnitude = 0;
	*negative = *at == '-';
	for (at += *negative; at < end; at++)
		magnitude = magnitude * 10 + (uint64_t)(*at - '0');
	return magnitude;
}

static double read_real(const nt_json_value *value)
{
	double real = 0;
	nt_read_double(value->of.text, value->of.text + value->size, &real);
	return real;
}

bool nt_json_get_uint64(const nt_json_value *value, uint64_t *result)
{
	if (nt_json_type_of(value) == NT_JSON_INTEGER) {
		bool negative;
		const uint64_t magnitude = read_integer(value, &negative);
		if (negative && magnitude)
			return false;
		*result = magnitude;
		return true;
	}
	if (nt_json_type_of(value) != NT_JSON_REAL)
		return false;
	const double real = read_real(value);
	if (!(real >= 0 && real < 0x1p64) || floor(real) != real)
		return false;
	*result = (uint64_t)real;
	return true;
}

bool nt_json_get_double(const nt_json_value *value, double *result)
{
	const nt_json_type type = nt_json_type_of(value);
	if (type != NT_JSON_INTEGER && type != NT_JSON_REAL)
		return false;
	const double real = read_real(value);
	if (isinf(real))
		return false;
	*result = real;
	return true;
}

const char *nt_json_get_string(const nt_json_value *value, size_t *length)
{
	if (nt_json_type_of(value) != NT_JSON_STRING)
		return NULL;
	if (length)
		*length = value->size;
	return value->of.text;
}

/* ---- equality ---- */

static bool equal_texts(const nt_json_value *a, const nt_json_value *b)
{
	return a->size == b->size && memcmp(a->of.text, b->of.text, a->size) == 0;
}

static bool equal_numbers(const nt_json_value *a, const nt_json_value *b)
{
	if (equal_texts(a, b))
		return true;
	if (a->type != NT_JSON_INTEGER || b->type != NT_JSON_INTEGER)
		return read_real(a) == read_real(b);
	bool a_negative, b_negative;
	const uint64_t x = read_integer(a, &a_negative), y = read_integer(b, &b_negative);
	return x == y && (a_negative == b_negative || x == 0);
}

static bool equal_children(const nt_json_value *a, const nt_json_value *b)
{
	bool equal = a->size == b->size;
	for (size_t i = 0; equal && i < a->size; i++) {
		if (a->type == NT_JSON_OBJECT) {
			const nt_json_member *x = &nt_json_members(a->of.list)[i], *y = &nt_json_members(b->of.list)[i];
			equal = x->key_length == y->key_length && memcmp(x->key, y->key, x->key_length) == 0;
		}
		equal = equal && nt_json_equal(nt_json_child(a, i), nt_json_child(b, i));
	}
	return equal;
}

static bool is_number(const nt_json_value *value)
{
	return value->type == NT_JSON_INTEGER || value->type == NT_JSON_REAL;
}

bool nt_json_equal(const nt_json_value *a, const nt_json_value *b)
{
	if (!a || !b)
		return a == b;
	if (is_number(a) && is_number(b))
		return equal_numbers(a, b);
	if (a->type != b->type)
		return false;
	if (nt_json_is_container(a))
		return equal_children(a, b);
	return a->type == NT_JSON_STRING ? equal_texts(a, b) : a->truth == b->truth;
}
