/* SPDX-License-Identifier: MIT */
/*
 * A changed document as text. The writer goes over the tree in the order of the old text and copies this up to the next
 * change: a value that was set, children that were taken out, or a place for new ones. New values are spaced as their
 * neighbours: commas as between the first two children of its container, lines as before the first one; without such,
 * as at the beginning of the document.
 */
#include <stdlib.h>
#include "json/tree.h"

/* Some bytes of the document's text, or constant ones. */
typedef struct slice {
	const char *begin;
	size_t size;
} slice;

/* How the children of a container are spaced: each on a line that begins with `base` and `units` indentations, or
 * all on one line. */
typedef struct spacing {
	bool broken;
	slice base;
	size_t units;
} spacing;

/* So many bytes are handed on at a time. */
enum { PIECE_BYTES = 64 * 1024 };

typedef struct writer {
	const nt_json *document;
	nt_json_put_text take; /* NULL: the text is only measured */
	void *user;
	nt_status status;      /* of take() */
	char *piece;           /* [PIECE_BYTES], `used` of which wait */
	size_t used;
	uint64_t size;         /* of the text so far */
	const char *copied; /* the old text is written, or skipped, up to here */
	/* as the document begins */
	bool broken;
	slice unit, newline, colon;
	slice comma; /* on one line */
} writer;

/* White space that is longer is not repeated. */
enum { MOST_SPACE = 256, MOST_INDENT = 16 };

static const slice no_text = {"", 0};

static void flush(writer *w)
{
	if (w->used && !w->status)
		w->status = w->take(w->user, w->piece, w->used);
	w->used = 0;
}

/* Room for some of the next `size` bytes, *part of them, which are there at once. */
static char *extend(writer *w, size_t size, size_t *part)
{
	if (w->used == PIECE_BYTES)
		flush(w);
	*part = size < PIECE_BYTES - w->used ? size : PIECE_BYTES - w->used;
	char *const to = w->piece + w->used;
	w->used += *part;
	return to;
}

static void put(writer *w, slice s)
{
	w->size += s.size;
	if (!w->take)
		return;
	for (size_t part; s.size; s.begin += part, s.size -= part) {
		char *const to = extend(w, s.size, &part);
		memcpy(to, s.begin, part);
	}
}

/* ---- the old text ---- */

/* Behind the value, or the key, that begins here. */
static const char *skip_value(const char *at)
{
	size_t depth = 0;
	do {
		if (*at == '"') {
			at += strlen(at) + 1;
		} else if (*at == '{' || *at == '[') {
			depth++;
			at++;
		} else if (*at == '}' || *at == ']') {
			depth--;
			at++;
		} else {
			at += strcspn(at, "\"{}[],: \t\r\n");
			if (depth)
				at += strspn(at, ",: \t\r\n");
		}
	} while (depth);
	return at;
}

/* The same for a child that is there. */
static const char *end_of(const nt_json_value *child)
{
	const bool known = !child->made && nt_json_is_container(child) && child->apart && child->of.list->end;
	return known ? child->of.list->end : skip_value(nt_json_begin(child));
}

/* The value of the child that begins here, which has a key in an object. */
static const char *value_of(const char *child, bool in_object)
{
	if (!in_object)
		return child;
	child = nt_json_skip_space(skip_value(child));
	return nt_json_skip_space(child + 1);
}

/* The place of a container's first child in the old text, or the closing bracket. */
static const char *first_in_text(const nt_json_value *container)
{
	return nt_json_skip_space(nt_json_begin(container) + 1);
}

static bool is_closing(char c)
{
	return c == '}' || c == ']';
}

/* Copies the old text up to there; closing quotes were NULs. */
static void copy_to(writer *w, const char *end)
{
	size_t size = (size_t)(end - w->copied);
	w->size += size;
	for (size_t part; w->take && size; w->copied += part, size -= part) {
		char *const to = extend(w, size, &part);
		for (size_t i = 0; i < part; i++)
			to[i] = w->copied[i] ? w->copied[i] : '"';
	}
	w->copied = end;
}

/* ---- spacing ---- */

static slice between(const char *begin, const char *end)
{
	return (slice){begin, (size_t)(end - begin)};
}

/* The separator of the first two children in the old text of a container; empty if it has no two. */
static slice comma_in_text(const nt_json_value *container)
{
	const char *at = first_in_text(container);
	if (is_closing(*at))
		return no_text;
	at = value_of(at, *nt_json_begin(container) == '{');
	const nt_json_value *first = container->size ? nt_json_child(container, 0) : NULL;
	const char *const end = first && nt_json_begin(first) == at ? end_of(first) : skip_value(at);
	at = nt_json_skip_space(end);
	return *at == ',' ? between(end, nt_json_skip_space(at + 1)) : no_text;
}

/* The first line of the document that has a member tells how new text is laid out where no neighbour does. */
static void find_style(writer *w)
{
	const nt_json_value *root = &w->document->root;
	const char *text = w->document->text, *at = strchr(text, '{');
	w->newline = (slice){"\n", 1};
	w->colon = (slice){":", 1};
	w->comma = (slice){",", 1};
	if (!at)
		return;
	const char *const first = nt_json_skip_space(at + 1), *line = at + 1;
	for (const char *c = at + 1; c < first; c++) {
		if (*c == '\n') {
			w->broken = true;
			w->newline = c[-1] == '\r' ? (slice){"\r\n", 2} : w->newline;
			line = c + 1;
		}
	}
	if (w->broken)
		w->unit = between(line, first - line < MOST_INDENT ? first : line + MOST_INDENT);
	if (*first == '"') {
		const char *const key_end = skip_value(first), *const value = value_of(first, true);
		w->colon = value - key_end <= MOST_INDENT ? between(key_end, value) : w->colon;
		const slice comma = nt_json_begin(root) && *nt_json_begin(root) == '{' ? comma_in_text(root) : no_text;
		if (!w->broken && comma.size && comma.size <= MOST_INDENT)
			w->comma = comma;
		else if (w->broken && w->colon.size > 1)
			w->comma = (slice){", ", 2};
	}
}

static void put_line(writer *w, const spacing *s)
{
	if (!s->broken)
		return;
	put(w, w->newline);
	put(w, s->base);
	for (size_t i = 0; i < s->units; i++)
		put(w, w->unit);
}

/* How the children of a container are spaced that is in the old text; outer: how it is spaced itself. */
static spacing spacing_in_text(const nt_json_value *container, const spacing *outer)
{
	const char *const first = first_in_text(container), *line = nt_json_begin(container) + 1;
	spacing s = *outer;
	s.units++;
	if (container->made || is_closing(*first) || first - line > MOST_SPACE)
		return s;
	s = (spacing){.base = no_text};
	for (const char *c = line; c < first; c++) {
		if (*c == '\n') {
			s.broken = true;
			s.base = between(c + 1, first);
		}
	}
	return s;
}

/* ---- new text ---- */

/* Lets the one who takes the text write what comes next. */
static void hand_over(writer *w)
{
	if (!w->take)
		return;
	flush(w);
	if (!w->status)
		w->status = w->take(w->user, "", 0);
}

/* `open`: its end is handed over. */
static void put_string(writer *w, const char *text, size_t size, bool open)
{
	static const char escaped[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";
	put(w, (slice){"\"", 1});
	for (size_t i = 0, plain = 0; i <= size; i++) {
		const unsigned char c = i < size ? (unsigned char)text[i] : 0;
		if (c >= 0x20 && c != '"' && c != '\\')
			continue;
		put(w, (slice){text + plain, i - plain});
		plain = i + 1;
		const char *known = c ? strchr(escaped, c) : NULL;
		const char hex[] = {'\\', 'u', '0', '0', "01"[c >> 4 & 1], "0123456789abcdef"[c & 15]};
		if (known)
			put(w, (slice){(const char[]){'\\', letters[known - escaped]}, 2});
		else if (i < size)
			put(w, (slice){hex, sizeof hex});
	}
	if (open)
		hand_over(w);
	put(w, (slice){"\"", 1});
}

static void put_number(writer *w, const nt_json_value *value)
{
	char digits[20], *first = digits + sizeof digits;
	if (!nt_json_is_counted(value)) {
		put(w, (slice){nt_json_text(value), value->size});
		return;
	}
	uint64_t number = value->size;
	do {
		*--first = (char)('0' + number % 10);
	} while (number /= 10);
	put(w, between(first, digits + sizeof digits));
}

static void put_value(writer *w, const nt_json_value *value, const spacing *outer);

static void put_key(writer *w, const nt_json_value *container, size_t index)
{
	if (container->type != NT_JSON_OBJECT)
		return;
	const nt_json_name *key = &container->of.list->shape->keys[index];
	put_string(w, key->text, key->length, false);
	put(w, w->colon);
}

/* outer: how the container is spaced. */
static void put_container(writer *w, const nt_json_value *container, const spacing *outer)
{
	const bool is_object = container->type == NT_JSON_OBJECT;
	spacing inner = *outer;
	inner.units++;
	put(w, (slice){is_object ? "{" : "[", 1});
	if (container->open)
		hand_over(w);
	for (size_t i = 0; i < container->size; i++) {
		if (i)
			put(w, inner.broken ? (slice){",", 1} : w->comma);
		put_line(w, &inner);
		put_key(w, container, i);
		put_value(w, nt_json_child(container, i), &inner);
	}
	if (container->size)
		put_line(w, outer);
	put(w, (slice){is_object ? "}" : "]", 1});
}

static void put_value(writer *w, const nt_json_value *value, const spacing *outer)
{
	switch ((nt_json_type)value->type) {
	case NT_JSON_BOOLEAN:
		put(w, value->truth ? (slice){"true", 4} : (slice){"false", 5});
		break;
	case NT_JSON_INTEGER:
	case NT_JSON_REAL:
		put_number(w, value);
		break;
	case NT_JSON_STRING:
		put_string(w, nt_json_text(value), value->size, value->open);
		break;
	case NT_JSON_ARRAY:
	case NT_JSON_OBJECT:
		put_container(w, value, outer);
		break;
	default:
		put(w, (slice){"null", 4});
		break;
	}
}

/* ---- changes ---- */

static void write_value(writer *w, const nt_json_value *value, const spacing *outer);

/* Goes over the children of a container from which some were taken out, whose text is skipped: with the comma
 * behind them where no other is left before, else with the one before. Returns whether one is left. */
static bool write_left(writer *w, const nt_json_value *container, const spacing *inner)
{
	const bool is_object = container->type == NT_JSON_OBJECT;
	const char *const first = first_in_text(container), *child = first;
	const char *left_end = NULL, *end = first; /* of the last one that is left, of the last one */
	size_t index = 0;
	while (!is_closing(*child)) {
		const char *const begin = value_of(child, is_object);
		const nt_json_value *value = index < container->size ? nt_json_child(container, index) : NULL;
		const bool is_left = value && nt_json_begin(value) == begin;
		if (is_left) {
			copy_to(w, left_end ? left_end : first);
			w->copied = left_end ? end : child;
			write_value(w, value, inner);
			index++;
		}
		end = is_left ? end_of(value) : skip_value(begin);
		left_end = is_left ? end : left_end;
		child = nt_json_skip_space(end);
		if (*child == ',')
			child = nt_json_skip_space(child + 1);
	}
	copy_to(w, left_end ? left_end : index < container->size ? first : nt_json_begin(container) + 1);
	w->copied = left_end || index < container->size ? end : child;
	return left_end != NULL;
}

/* Puts what was added behind children in the old text; has_before: there are some. */
static void write_added(writer *w, const nt_json_value *container, size_t first, bool has_before, const spacing *inner,
	const spacing *outer)
{
	const char *const in_text = first_in_text(container);
	const bool was_empty = is_closing(*in_text);
	slice comma = comma_in_text(container);
	if (comma.size > MOST_SPACE)
		comma = no_text;
	if (was_empty) {
		copy_to(w, nt_json_begin(container) + 1);
		w->copied = in_text;
	}
	for (size_t i = first; i < container->size; i++) {
		const bool separated = i > first || has_before;
		if (separated && comma.size) {
			put(w, comma);
		} else if (separated) {
			put(w, inner->broken ? (slice){",", 1} : w->comma);
			put_line(w, inner);
		} else if (was_empty) {
			put_line(w, inner);
		}
		put_key(w, container, i);
		put_value(w, nt_json_child(container, i), inner);
	}
	if (was_empty)
		put_line(w, outer);
}

/* outer: how the container is spaced. */
static void write_container(writer *w, const nt_json_value *container, const spacing *outer)
{
	if (!container->apart)
		return;
	size_t added = container->size;
	while (added && !nt_json_begin(nt_json_child(container, added - 1)))
		added--;
	const spacing inner = spacing_in_text(container, outer);
	bool has_before = added > 0;
	if (container->taken)
		has_before = write_left(w, container, &inner);
	else
		for (size_t i = 0; i < added; i++)
			write_value(w, nt_json_child(container, i), &inner);
	if (added == container->size)
		return;
	if (has_before && !container->taken) {
		const char *end = container->of.list->end - 1;
		while (nt_json_is_space(end[-1]))
			end--;
		copy_to(w, end);
	}
	write_added(w, container, added, has_before, &inner, outer);
}

/* A value in the old text, whose beginning is not copied yet. */
static void write_value(writer *w, const nt_json_value *value, const spacing *outer)
{
	if (value->made) {
		copy_to(w, nt_json_begin(value));
		put_value(w, value, outer);
		w->copied = skip_value(nt_json_begin(value));
	} else if (nt_json_is_container(value)) {
		write_container(w, value, outer);
	}
}

static nt_status write_text(writer *w)
{
	w->unit = no_text;
	w->copied = w->document->text;
	find_style(w);
	const spacing outer = {.broken = w->broken, .base = no_text};
	write_value(w, &w->document->root, &outer);
	copy_to(w, w->document->text + w->document->size);
	if (w->take)
		flush(w);
	return w->status;
}

nt_status nt_json_measure(const nt_json *document, uint64_t *size, nt_error *error)
{
	if (document->failed)
		return nt_fail_memory(error);
	writer w = {.document = document};
	write_text(&w);
	*size = w.size;
	return NT_OK;
}

nt_status nt_json_write(const nt_json *document, nt_json_put_text take, void *user, nt_error *error)
{
	char *piece = document->failed ? NULL : nt_alloc(PIECE_BYTES, 1);
	if (!piece)
		return nt_fail_memory(error);
	writer w = {.document = document, .take = take, .user = user, .piece = piece};
	const nt_status status = write_text(&w);
	free(piece);
	return status;
}

static nt_status append_text(void *user, const char *text, size_t size)
{
	nt_buffer *buffer = user;
	nt_buffer_append(buffer, text, size);
	return buffer->failed ? NT_ERROR_MEMORY : NT_OK;
}

nt_status nt_json_dump(const nt_json *document, nt_buffer *text, nt_error *error)
{
	return nt_json_write(document, append_text, text, error) ? nt_fail_memory(error) : NT_OK;
}
