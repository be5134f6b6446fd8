/* SPDX-License-Identifier: MIT */
/*
 * A changed document as text. The writer goes over the tree in the order of the old text and copies this up to the next
 * change: a value that was set, children that were added, or a container that lost some. Its other children are copied.
 * New text is laid out as the document begins, but on one line in a container that is.
 */
#include <stdlib.h>
#include "json/tree.h"

/* Some bytes of the document's text, or constant ones. */
typedef struct slice {
	const char *begin;
	size_t size;
} slice;

/* How a container is laid out: its children on lines of their own, which begin with some units, or all on one. */
typedef struct layout {
	bool broken;
	size_t units;
} layout;

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
enum { MOST_SPACE = 64 };

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

/* ---- layout ---- */

static slice between(const char *begin, const char *end)
{
	return (slice){begin, (size_t)(end - begin)};
}

/* Takes white space for new text, unless it is long. */
static void take_space(slice *to, const char *begin, const char *end)
{
	if (end - begin <= MOST_SPACE)
		*to = between(begin, end);
}

/* The first member of the document says how new text is laid out: its line, what stands before its value and, if all is
 * on one line, what is between it and the next. */
static void find_style(writer *w)
{
	const char *text = w->document->text, *at = strchr(text, '{');
	w->unit = (slice){"", 0};
	w->newline = (slice){"\n", 1};
	w->colon = (slice){":", 1};
	w->comma = (slice){",", 1};
	if (!at)
		return;
	const char *const first = nt_json_skip_space(at + 1);
	for (const char *c = at + 1; c < first; c++)
		if (*c == '\n') {
			w->broken = true;
			w->newline = c[-1] == '\r' ? (slice){"\r\n", 2} : w->newline;
			take_space(&w->unit, c + 1, first);
		}
	if (*first != '"')
		return;
	const char *const key_end = skip_value(first);
	const char *const value = nt_json_skip_space(nt_json_skip_space(key_end) + 1);
	take_space(&w->colon, key_end, value);
	if (w->broken && w->colon.size > 1)
		w->comma = (slice){", ", 2};
	if (w->broken)
		return;
	const nt_json_value *root = &w->document->root, *known = nt_json_at(root, 0);
	const char *const end = known && nt_json_begin(known) == value ? end_of(known) : skip_value(value);
	const char *const comma = nt_json_skip_space(end);
	if (*comma == ',')
		take_space(&w->comma, end, nt_json_skip_space(comma + 1));
}

static void put_line(writer *w, const layout *l)
{
	if (!l->broken)
		return;
	put(w, w->newline);
	for (size_t i = 0; i < l->units; i++)
		put(w, w->unit);
}

/* outer: how the container around it is laid out. */
static layout layout_of(const nt_json_value *container, const layout *outer)
{
	layout l = {outer->broken, outer->units + 1};
	if (!container->made && container->apart && container->of.list->end) {
		const char *at = nt_json_begin(container) + 1;
		while (nt_json_is_space(*at) && *at != '\n')
			at++;
		l.broken = *at == '\n';
	}
	return l;
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

size_t nt_json_escape(unsigned char c, char made[NT_JSON_ESCAPE])
{
	static const char escaped[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";
	const char hex[NT_JSON_ESCAPE] = {'\\', 'u', '0', '0', "01"[c >> 4 & 1], "0123456789abcdef"[c & 15]};
	if (c >= 0x20 && c != '"' && c != '\\')
		return 0;
	memcpy(made, hex, sizeof hex);
	const char *known = c ? strchr(escaped, c) : NULL;
	if (known)
		made[1] = letters[known - escaped];
	return known ? 2 : NT_JSON_ESCAPE;
}

/* `open`: its end is handed over. */
static void put_string(writer *w, const char *text, size_t size, bool open)
{
	char made[NT_JSON_ESCAPE];
	size_t plain = 0;
	put(w, (slice){"\"", 1});
	for (size_t i = 0; i < size; i++) {
		const size_t length = nt_json_escape((unsigned char)text[i], made);
		if (!length)
			continue;
		put(w, (slice){text + plain, i - plain});
		put(w, (slice){made, length});
		plain = i + 1;
	}
	put(w, (slice){text + plain, size - plain});
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

static void put_value(writer *w, const nt_json_value *value, const layout *outer);
static void write_value(writer *w, const nt_json_value *value, const layout *outer);

/* The place of a child in the old text with its key. A quote in a key comes behind a backslash. */
static const char *begin_of(const nt_json_value *child, bool in_object)
{
	const char *at = nt_json_begin(child);
	if (!in_object)
		return at;
	while (*--at != '\0') {
	}
	while (*at != '"' || at[-1] == '\\')
		at--;
	return at;
}

static void put_child(writer *w, const nt_json_value *container, size_t index, const layout *inner)
{
	const bool in_object = container->type == NT_JSON_OBJECT;
	const nt_json_value *child = nt_json_child(container, index);
	if (index)
		put(w, inner->broken ? (slice){",", 1} : w->comma);
	put_line(w, inner);
	if (nt_json_begin(child)) {
		w->copied = begin_of(child, in_object);
		write_value(w, child, inner);
		copy_to(w, end_of(child));
		return;
	}
	if (in_object) {
		const nt_json_name *key = &container->of.list->keys[index];
		put_string(w, key->text, key->length, false);
		put(w, w->colon);
	}
	put_value(w, child, inner);
}

static void put_container(writer *w, const nt_json_value *container, const layout *outer)
{
	const bool is_object = container->type == NT_JSON_OBJECT;
	const layout inner = layout_of(container, outer), end = {inner.broken, outer->units};
	put(w, (slice){is_object ? "{" : "[", 1});
	if (container->open)
		hand_over(w);
	for (size_t i = 0; i < container->size; i++)
		put_child(w, container, i, &inner);
	if (container->size)
		put_line(w, &end);
	put(w, (slice){is_object ? "}" : "]", 1});
}

static void put_value(writer *w, const nt_json_value *value, const layout *outer)
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

/* The children of a container in the old text that has lost none; new ones come last. */
static void write_children(writer *w, const nt_json_value *container, const layout *outer)
{
	const layout inner = layout_of(container, outer);
	size_t i = 0;
	for (; i < container->size && nt_json_begin(nt_json_child(container, i)); i++)
		write_value(w, nt_json_child(container, i), &inner);
	if (i == container->size)
		return;
	const char *end = container->of.list->end - 1;
	while (nt_json_is_space(end[-1]))
		end--;
	copy_to(w, end);
	for (; i < container->size; i++)
		put_child(w, container, i, &inner);
}

/* A value in the old text, whose beginning is not copied yet. */
static void write_value(writer *w, const nt_json_value *value, const layout *outer)
{
	const bool is_list = nt_json_is_container(value) && value->apart && !value->made;
	if (value->made || (is_list && (value->taken || !value->of.list->end))) {
		copy_to(w, nt_json_begin(value));
		put_value(w, value, outer);
		w->copied = end_of(value);
	} else if (is_list) {
		write_children(w, value, outer);
	}
}

static nt_status write_text(writer *w)
{
	w->copied = w->document->text;
	find_style(w);
	write_value(w, &w->document->root, &(layout){.broken = w->broken});
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
