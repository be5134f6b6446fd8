/* SPDX-License-Identifier: MIT */
/*
 * Looking into documents. Numbers are read from their spelling each time they are asked for.
 */
#include <math.h>
#include "ext/linked.h"
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
	const nt_json_name *key = &object->of.list->keys[index];
	if (length)
		*length = key->length;
	return key->text;
}

nt_json_value *nt_json_find_key(const nt_json_value *object, const char *key, size_t length)
{
	if (!object || object->type != NT_JSON_OBJECT || object->size == 0)
		return NULL;
	const nt_json_name wanted = {key, length};
	const nt_json_name *const keys = object->of.list->keys;
	size_t i = 0;
	while (i < object->size && !nt_json_same_key(&keys[i], &wanted))
		i++;
	return i < object->size ? nt_json_child(object, i) : NULL;
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
	uint64_t magnitude = 0;
	*negative = false;
	if (nt_json_is_counted(value))
		return value->size;
	const char *at = nt_json_text(value), *const end = at + value->size;
	*negative = *at == '-';
	for (at += *negative; at < end; at++)
		magnitude = magnitude * 10 + (uint64_t)(*at - '0');
	return magnitude;
}

static double read_real(const nt_json_value *value)
{
	double real = 0;
	if (nt_json_is_counted(value))
		return (double)value->size;
	nt_read_double(nt_json_text(value), nt_json_text(value) + value->size, &real);
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
	return nt_json_text(value);
}

/* ---- equality ---- */

static bool equal_numbers(const nt_json_value *a, const nt_json_value *b)
{
	if (a->type != NT_JSON_INTEGER || b->type != NT_JSON_INTEGER)
		return read_real(a) == read_real(b);
	bool a_negative, b_negative;
	const uint64_t x = read_integer(a, &a_negative), y = read_integer(b, &b_negative);
	return x == y && (a_negative == b_negative || x == 0);
}

static bool equal_children(const nt_json_value *a, const nt_json_value *b)
{
	bool equal = a->size == b->size;
	for (size_t i = 0; equal && i < a->size; i++)
		equal = (a->type == NT_JSON_ARRAY || nt_json_same_key(&a->of.list->keys[i], &b->of.list->keys[i])) &&
			nt_json_equal(nt_json_child(a, i), nt_json_child(b, i));
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
	if (a->type == NT_JSON_STRING)
		return a->size == b->size && memcmp(nt_json_text(a), nt_json_text(b), a->size) == 0;
	return a->truth == b->truth;
}
