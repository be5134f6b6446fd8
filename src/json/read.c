/* SPDX-License-Identifier: MIT */
/*
 * JSON text into a tree of values: one pass without recursion. The children of open containers are gathered on one
 * stack, from which a container takes its own when it is closed, so that lists have their final size. No number becomes
 * binary here, unless it may be beyond double; most are never asked for.
 *
 * Here and not a library's, because every value keeps the place of its text, which the trees of nlohmann and RapidJSON
 * do not.
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include "base/text.h"
#include "ext/linked.h"
#include "json/tree.h"

/* NULs behind the text: it ends for every loop, also where keys are compared in words of four bytes. */
enum { PADDING_BYTES = 4 };

/* Keys of the object of a depth that is read, and behind them those of the one before it. Mostly they are the same: as
 * long as they are, they are compared and not read, and the objects share them. The accessors of a primitive have two
 * kinds of keys, one with bounds. */
typedef struct names {
	nt_json_name *list; /* [count] */
	size_t count, capacity;
	const nt_json_name *kept, *other; /* those of the object before it, and other ones that came before these */
	size_t kept_count, other_count;
	bool sound; /* no key of `kept` occurs twice */
} names;

/* A container whose end has not been read. */
typedef struct opened {
	const char *begin;
	size_t first; /* where its children begin in the stack */
	bool is_object;
	bool foreign; /* duplicate keys and numbers beyond double are no fault */
	bool foreign_member; /* of the value that comes next */
	bool has_new_key; /* the object before it had another one there */
} opened;

typedef struct reader {
	nt_json *document;
	char *at;
	const char *foreign;
	size_t foreign_length;
	nt_error *error;
	nt_json_value *values; /* [value_count] of the open containers */
	size_t value_count, value_capacity, depth, deepest;
	/* most of both is never touched */
	opened open[NT_JSON_MAX_DEPTH]; /* [depth] */
	names keys[NT_JSON_MAX_DEPTH];  /* [deepest] */
} reader;

/* ---- faults ---- */

static nt_status fail(const reader *r, const char *at, const char *expected)
{
	const unsigned char c = (unsigned char)*at;
	const size_t offset = (size_t)(at - r->document->text);
	if (offset == r->document->size)
		return nt_fail_offset(r->error, NT_ERROR_INPUT, offset, "JSON: the text ends, expected %s", expected);
	if (c > 0x20 && c < 0x7f)
		return nt_fail_offset(r->error, NT_ERROR_INPUT, offset, "JSON: '%c', expected %s", c, expected);
	return nt_fail_offset(r->error, NT_ERROR_INPUT, offset, "JSON: byte 0x%02X, expected %s", c, expected);
}

/* ---- strings ---- */

/* Behind the bytes that stand for themselves. */
static char *skip_plain(char *at)
{
	while (*at != '"' && *at != '\\' && (unsigned char)*at >= 0x20 && (unsigned char)*at < 0x80)
		at++;
	return at;
}

/* Four hexadecimal digits; -1: others. */
static int32_t read_hex(const char *at)
{
	int32_t value = 0;
	for (int i = 0; i < 4; i++) {
		const int c = at[i], digit = c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ?
			(c | 32) - 'a' + 10 : -1;
		if (digit < 0)
			return -1;
		value = value * 16 + digit;
	}
	return value;
}

/* The length of an escape, of both surrogates too; 0: it is none. */
static size_t read_escape(const char *at, uint32_t *code)
{
	static const char letters[] = "\"\\/bfnrt", codes[] = "\"\\/\b\f\n\r\t";
	const char *letter = at[1] ? strchr(letters, at[1]) : NULL;
	if (letter) {
		*code = (unsigned char)codes[letter - letters];
		return 2;
	}
	const int32_t first = at[1] == 'u' ? read_hex(at + 2) : -1;
	*code = (uint32_t)first;
	if (first < 0xD800 || first > 0xDFFF)
		return first < 0 ? 0 : 6;
	const int32_t second = first < 0xDC00 && at[6] == '\\' && at[7] == 'u' ? read_hex(at + 8) : -1;
	if (second < 0xDC00 || second > 0xDFFF)
		return 0;
	*code = 0x10000 + ((uint32_t)(first - 0xD800) << 10) + (uint32_t)(second - 0xDC00);
	return 12;
}

static nt_status fail_escape(const reader *r, const char *at)
{
	if (at[1] == 'u' && read_hex(at + 2) >= 0)
		return nt_fail_offset(r->error, NT_ERROR_INPUT, (uint64_t)(at - r->document->text),
			"JSON: the surrogate \\u%.*s is not one of a pair, expected UTF-16", 4, at + 2);
	return fail(r, at + 1, at[1] == 'u' ? "four hexadecimal digits" : "an escape that JSON has");
}

static char *put_utf8(char *to, uint32_t code)
{
	if (code < 0x80) {
		*to++ = (char)code;
		return to;
	}
	const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
	*to++ = (char)(0xFF00 >> (more + 1) | code >> 6 * more);
	for (int i = more - 1; i >= 0; i--)
		*to++ = (char)(0x80 | (code >> 6 * i & 0x3F));
	return to;
}

/* The text of a checked string with escapes, in the arena; NULL: out of memory. */
static nt_json_override *decode(reader *r, const char *at, const char *end, size_t *length)
{
	const size_t bytes = sizeof(nt_json_override) + (size_t)(end - at) + 1;
	nt_json_override *const override = nt_arena_alloc(&r->document->arena, bytes, 1);
	if (!override)
		return NULL;
	override->begin = at - 1;
	char *to = override->text;
	while (at < end) {
		uint32_t code;
		if (*at != '\\') {
			*to++ = *at++;
			continue;
		}
		at += read_escape(at, &code);
		to = put_utf8(to, code);
	}
	*to = '\0';
	*length = (size_t)(to - override->text);
	return override;
}

/* The string that begins here; its closing quote becomes a NUL. */
static nt_status read_string(reader *r, nt_json_value *value)
{
	char *const begin = r->at + 1, *at = skip_plain(begin);
	bool plain = true;
	while (*at != '"') {
		const char *const end = r->document->text + r->document->size;
		uint32_t code;
		size_t step;
		if (*at == '\\') {
			plain = false;
			step = read_escape(at, &code);
			if (!step)
				return fail_escape(r, at);
		} else if ((unsigned char)*at < 0x20) {
			return fail(r, at, at == end ? "a quote" : "an escape for a control character");
		} else {
			step = nt_utf8_length(at, (size_t)(end - at));
			if (!step)
				return fail(r, at, "UTF-8");
		}
		at = skip_plain(at + step);
	}
	*at = '\0';
	r->at = at + 1;
	size_t length = (size_t)(at - begin);
	/* values are made as a whole, here and below: a word that was written bit by bit is slow to be read */
	*value = (nt_json_value){.of.text = begin, .size = length, .type = NT_JSON_STRING};
	if (plain)
		return NT_OK;
	nt_json_override *const override = decode(r, begin, at, &length);
	*value = (nt_json_value){.of.override = override, .size = length, .type = NT_JSON_STRING, .apart = 1};
	return override ? NT_OK : nt_fail_memory(r->error);
}

/* ---- scalars ---- */

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

/* One digit or more. */
static nt_status read_digits(reader *r)
{
	if (!is_digit(*r->at))
		return fail(r, r->at, "a digit");
	while (is_digit(*r->at))
		r->at++;
	return NT_OK;
}

/* Whether digits, with a minus perhaps, are an integer of 64 bits. */
static bool fits_64_bits(const char *at, const char *end)
{
	const bool negative = *at == '-';
	uint64_t value = 0;
	if (end - at < 19)
		return true;
	for (at += negative; at < end; at++)
		if (__builtin_mul_overflow(value, 10u, &value) ||
			__builtin_add_overflow(value, (uint64_t)(*at - '0'), &value))
			return false;
	return !negative || value <= (uint64_t)1 << 63;
}

static nt_status read_number(reader *r, bool foreign, nt_json_value *value)
{
	const char *const begin = r->at;
	r->at += *begin == '-';
	const char *const whole = r->at;
	nt_status status = NT_OK;
	if (*r->at == '0')
		r->at++;
	else
		status = read_digits(r);
	const char *const point = r->at;
	if (!status && *r->at == '.') {
		r->at++;
		status = read_digits(r);
	}
	const bool has_exponent = !status && (*r->at == 'e' || *r->at == 'E');
	if (has_exponent) {
		r->at++;
		r->at += *r->at == '+' || *r->at == '-';
		status = read_digits(r);
	}
	if (status)
		return status;
	double number = 0;
	if (!foreign && (has_exponent || point - whole > 308))
		nt_read_double(begin, r->at, &number);
	if (isinf(number))
		return nt_fail_offset(r->error, NT_ERROR_INPUT, (uint64_t)(begin - r->document->text),
			"JSON: the number %.*s, expected one that a double can hold",
			r->at - begin < 100 ? (int)(r->at - begin) : 100, begin);
	*value = (nt_json_value){.of.text = begin, .size = (uint64_t)(r->at - begin),
		.type = r->at == point && fits_64_bits(begin, point) ? NT_JSON_INTEGER : NT_JSON_REAL};
	return NT_OK;
}

static nt_status read_word(reader *r, const char *word, nt_json_type type, nt_json_value *value)
{
	const char *const begin = r->at;
	for (const char *letter = word; *letter; letter++, r->at++)
		if (*r->at != *letter)
			return fail(r, r->at, word);
	*value = (nt_json_value){.of.text = begin, .type = type, .truth = *word == 't'};
	return NT_OK;
}

/* ---- containers ---- */

/* Hands a finished value to the container around it. */
static nt_status push(reader *r, nt_json_value value)
{
	if (!r->depth) {
		r->document->root = value;
		return NT_OK;
	}
	if (r->value_count == r->value_capacity &&
		!nt_grow((void **)&r->values, &r->value_capacity, r->value_count + 1, sizeof *r->values))
		return nt_fail_memory(r->error);
	r->values[r->value_count++] = value;
	return NT_OK;
}

/* Whether the next key is spelled as one in the text that is there: it has no escapes then, and was found to be sound.
 * The text ends with NULs, which no key has that is in it. */
static bool is_repeated(const reader *r, const nt_json_name *key)
{
	return (uintptr_t)key->text - (uintptr_t)r->document->text < r->document->size &&
		nt_json_same_bytes(r->at + 1, key->text, key->length) && r->at[1 + key->length] == '"';
}

static nt_status read_new_key(reader *r, opened *o, names *keys, size_t index)
{
	nt_json_value string;
	const nt_status status = read_string(r, &string);
	if (status)
		return status;
	if (!nt_grow((void **)&keys->list, &keys->capacity, index + 1, sizeof *keys->list))
		return nt_fail_memory(r->error);
	keys->list[index] = (nt_json_name){nt_json_text(&string), string.size};
	keys->count = index < keys->count ? keys->count : index + 1;
	o->has_new_key = true;
	return NT_OK;
}

/* A member's key and the colon. */
static nt_status read_key(reader *r)
{
	opened *const o = &r->open[r->depth - 1];
	names *const keys = &r->keys[r->depth - 1];
	const size_t index = r->value_count - o->first;
	if (*r->at != '"')
		return fail(r, r->at, "a key in quotes");
	if (index < keys->count && is_repeated(r, &keys->list[index])) {
		r->at += keys->list[index].length + 2;
		r->at[-1] = '\0';
	} else {
		const nt_status status = read_new_key(r, o, keys, index);
		if (status)
			return status;
	}
	r->at = (char *)nt_json_skip_space(r->at);
	if (*r->at != ':')
		return fail(r, r->at, "':'");
	r->at++;
	const nt_json_name *const key = &keys->list[index];
	o->foreign_member = r->foreign && key->length == r->foreign_length &&
		nt_json_same_bytes(key->text, r->foreign, key->length);
	return NT_OK;
}

static bool is_foreign(const reader *r)
{
	return r->depth && (r->open[r->depth - 1].foreign || r->open[r->depth - 1].foreign_member);
}

/* A container begins; *complete receives whether it ends here too. */
static nt_status open_container(reader *r, bool *complete)
{
	const char *const begin = r->at;
	const bool is_object = *begin == '{', foreign = is_foreign(r);
	if (r->depth == NT_JSON_MAX_DEPTH)
		return nt_fail_offset(r->error, NT_ERROR_INPUT, (uint64_t)(r->at - r->document->text),
			"JSON is nested deeper than %d arrays and objects", NT_JSON_MAX_DEPTH);
	r->at = (char *)nt_json_skip_space(r->at + 1);
	*complete = *r->at == (is_object ? '}' : ']');
	if (*complete) {
		r->at++;
		return push(r, (nt_json_value){.of.text = begin, .type = is_object ? NT_JSON_OBJECT : NT_JSON_ARRAY});
	}
	if (r->depth == r->deepest)
		r->keys[r->deepest++] = (names){.count = 0};
	r->open[r->depth++] = (opened){.begin = begin, .first = r->value_count, .is_object = is_object,
		.foreign = foreign};
	return is_object ? read_key(r) : NT_OK;
}

static int compare_keys(const void *a, const void *b)
{
	const nt_json_name *x = *(const nt_json_name *const *)a, *y = *(const nt_json_name *const *)b;
	if (x->length != y->length)
		return x->length < y->length ? -1 : 1;
	const int difference = memcmp(x->text, y->text, x->length);
	return difference ? difference : x < y ? -1 : x > y;
}

/* Finds a key that one before it has too; `count`: there is none. Few are compared pair by pair, many are sorted.
 * False: out of memory. */
static bool find_repeated(const nt_json_name *keys, size_t count, size_t *repeated)
{
	enum { FEW = 16 };
	*repeated = count;
	for (size_t i = 1; i < count && count <= FEW; i++)
		for (size_t k = 0; k < i; k++)
			if (nt_json_same_key(&keys[i], &keys[k]))
				*repeated = i;
	if (count <= FEW)
		return true;
	const nt_json_name **order = nt_alloc(count, sizeof *order);
	for (size_t i = 0; order && i < count; i++)
		order[i] = &keys[i];
	if (order)
		qsort(order, count, sizeof *order, compare_keys);
	for (size_t i = 1; order && i < count && *repeated == count; i++)
		if (nt_json_same_key(order[i], order[i - 1]))
			*repeated = (size_t)(order[i] - keys);
	free(order);
	return order != NULL;
}

/* A key of the object that ends here must not occur twice. */
static nt_status check_keys(const reader *r, const nt_json_name *keys, const nt_json_value *children, size_t count)
{
	size_t repeated;
	if (!find_repeated(keys, count, &repeated))
		return nt_fail_memory(r->error);
	if (repeated == count)
		return NT_OK;
	/* behind the key: in front of the value there are a colon and white space */
	const char *at = nt_json_begin(&children[repeated]) - 1;
	while (at[-1] != '\0')
		at--;
	return nt_fail_offset(r->error, NT_ERROR_INPUT, (uint64_t)(at - r->document->text),
		"JSON: the key \"%.*s\" occurs twice in one object", NT_CUT(200, keys[repeated].text));
}

static bool are_same(const nt_json_name *a, const nt_json_name *b, size_t count)
{
	size_t i = 0;
	while (i < count && nt_json_same_key(&a[i], &b[i]))
		i++;
	return i == count;
}

/* Keeps the keys of the object that ends here. False: out of memory. */
static bool keep_keys(reader *r, const opened *o, names *keys, size_t count)
{
	if (keys->kept && !o->has_new_key && keys->kept_count == count)
		return true;
	const nt_json_name *kept = keys->other;
	if (!kept || keys->other_count != count || !are_same(kept, keys->list, count)) {
		nt_json_name *copy = nt_arena_alloc(&r->document->arena, count, sizeof *copy);
		if (!copy)
			return false;
		kept = memcpy(copy, keys->list, count * sizeof *copy);
	}
	keys->other = keys->kept;
	keys->other_count = keys->kept_count;
	keys->kept = kept;
	keys->kept_count = count;
	keys->sound = false;
	return true;
}

/* The container ends whose bracket was read; its children leave the stack. */
static nt_status close_container(reader *r)
{
	const opened *const o = &r->open[--r->depth];
	names *const keys = &r->keys[r->depth];
	const size_t count = r->value_count - o->first;
	const nt_json_value *const children = r->values + o->first;
	nt_json_list *const list = nt_json_new_list(r->document, count, false, o->begin);
	if (!list || (o->is_object && !keep_keys(r, o, keys, count)))
		return nt_fail_memory(r->error);
	if (o->is_object) {
		list->keys = keys->kept;
		const nt_status status = o->foreign || keys->sound ? NT_OK : check_keys(r, list->keys, children, count);
		if (status)
			return status;
		keys->sound |= !o->foreign;
	}
	memcpy(list->children, children, count * sizeof *children);
	list->end = r->at;
	r->value_count = o->first;
	return push(r, (nt_json_value){.of.list = list, .size = count,
		.type = o->is_object ? NT_JSON_OBJECT : NT_JSON_ARRAY, .apart = 1});
}

/* ---- the whole ---- */

/* *complete receives false when a container was opened, whose first value comes next. */
static nt_status read_value(reader *r, bool *complete)
{
	nt_json_value value;
	nt_status status;
	*complete = true;
	switch (*r->at) {
	case '{':
	case '[':
		return open_container(r, complete);
	case '"':
		status = read_string(r, &value);
		break;
	case 't':
		status = read_word(r, "true", NT_JSON_BOOLEAN, &value);
		break;
	case 'f':
		status = read_word(r, "false", NT_JSON_BOOLEAN, &value);
		break;
	case 'n':
		status = read_word(r, "null", NT_JSON_NULL, &value);
		break;
	default:
		if (*r->at != '-' && !is_digit(*r->at))
			return fail(r, r->at, "a value");
		status = read_number(r, is_foreign(r), &value);
		break;
	}
	return status ? status : push(r, value);
}

/* Behind a value in a container: *complete receives whether this ends too. */
static nt_status read_separator(reader *r, bool *complete)
{
	const bool in_object = r->open[r->depth - 1].is_object;
	r->at = (char *)nt_json_skip_space(r->at);
	*complete = *r->at == (in_object ? '}' : ']');
	if (!*complete && *r->at != ',')
		return fail(r, r->at, in_object ? "',' or '}'" : "',' or ']'");
	r->at++;
	if (*complete)
		return close_container(r);
	r->at = (char *)nt_json_skip_space(r->at);
	return in_object ? read_key(r) : NT_OK;
}

static nt_status read_text(reader *r)
{
	bool complete;
	nt_status status;
	do {
		r->at = (char *)nt_json_skip_space(r->at);
		status = read_value(r, &complete);
		while (!status && complete && r->depth)
			status = read_separator(r, &complete);
	} while (!status && !complete);
	if (status)
		return status;
	r->at = (char *)nt_json_skip_space(r->at);
	return r->at == r->document->text + r->document->size ? NT_OK : fail(r, r->at, "the end of the text");
}

nt_json_list *nt_json_new_list(nt_json *document, size_t capacity, bool has_keys, const char *begin)
{
	size_t bytes;
	const size_t each = sizeof(nt_json_value) + (has_keys ? sizeof(nt_json_name) : 0);
	if (!nt_size_mul(capacity, each, &bytes) || !nt_size_add(bytes, sizeof(nt_json_list), &bytes))
		return NULL;
	nt_json_list *list = nt_arena_alloc(&document->arena, bytes, 1);
	if (list)
		*list = (nt_json_list){.begin = begin, .capacity = capacity, .has_own_keys = has_keys};
	if (list)
		list->keys = nt_json_own_keys(list);
	return list;
}

nt_status nt_json_parse(nt_json **document, const char *text, size_t size, const char *foreign, nt_error *error)
{
	*document = NULL;
	if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0)
		return nt_fail_offset(error, NT_ERROR_INPUT, 0,
			"JSON begins with a byte order mark, which glTF does not allow");
	nt_json *parsed = nt_calloc(1, sizeof *parsed);
	reader *r = nt_alloc(1, sizeof *r);
	size_t bytes;
	nt_status status = NT_ERROR_MEMORY;
	if (r)
		memset(r, 0, offsetof(reader, open));
	if (parsed && r && nt_size_add(size, PADDING_BYTES, &bytes))
		parsed->text = nt_alloc(bytes, 1);
	if (parsed && parsed->text) {
		if (size)
			memcpy(parsed->text, text, size);
		memset(parsed->text + size, 0, PADDING_BYTES);
		parsed->size = size;
		r->document = parsed;
		r->at = parsed->text;
		r->foreign = foreign;
		r->foreign_length = foreign ? strlen(foreign) : 0;
		r->error = error;
		status = read_text(r);
	} else {
		nt_fail_memory(error);
	}
	for (size_t i = 0; r && i < r->deepest; i++)
		free(r->keys[i].list);
	if (r)
		free(r->values);
	free(r);
	if (status)
		nt_json_free(parsed);
	else
		*document = parsed;
	return status;
}

void nt_json_free(nt_json *document)
{
	if (!document)
		return;
	nt_arena_free(&document->arena);
	free(document->text);
	free(document);
}
