/* SPDX-License-Identifier: MIT */
/*
 * The header of a PLY file: lines of words up to end_header, whatever ends the lines. It costs memory
 * and time in proportion to its own size; what it promises about the rest of the file is checked where the rest
 * is read.
 */
#include "ply/parts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/memory.h"
#include "base/hash_index.h"

static const struct {
	const char *name, *alias;
} type_names[] = {
	[PLY_INT8] = {"char", "int8"},
	[PLY_UINT8] = {"uchar", "uint8"},
	[PLY_INT16] = {"short", "int16"},
	[PLY_UINT16] = {"ushort", "uint16"},
	[PLY_INT32] = {"int", "int32"},
	[PLY_UINT32] = {"uint", "uint32"},
	[PLY_FLOAT32] = {"float", "float32"},
	[PLY_FLOAT64] = {"double", "float64"},
};
enum { TYPE_COUNT = sizeof type_names / sizeof type_names[0] };

typedef struct word {
	const char *text;
	size_t length; /* 0: there is none */
} word;

/* A header that is being read. */
typedef struct parser {
	ply_header *header;
	nt_error *error;
	const char *at, *end; /* what is left of the line */
	ply_span text;        /* the line with its end */
	bool is_last;         /* it has none: the file ends there */
	size_t line;
	bool has_format;
	nt_name_table names; /* of the elements; a name's number is its element's */
} parser;

const char *ply_type_name(ply_type type)
{
	return type_names[type].name;
}

/* Takes the line that begins where the last one ended. The first one tells whether '\r' comes alone: a '\n' after it
 * may then be data. False: the file ended with the last one. */
static bool next_line(parser *p)
{
	ply_header *header = p->header;
	const unsigned char *const bytes = header->bytes;
	size_t end = p->text.end;
	if (p->is_last)
		return false;
	p->text.begin = end;
	while (end < header->size && !ply_is_line_end(bytes[end]))
		end++;
	p->at = (const char *)bytes + p->text.begin;
	p->end = (const char *)bytes + end;
	p->is_last = end == header->size;
	const bool returned = !p->is_last && bytes[end] == '\r', alone = p->line && strcmp(header->newline, "\r") == 0;
	const bool pair = returned && !alone && end + 1 < header->size && bytes[end + 1] == '\n';
	if (p->line++ == 0)
		header->newline = pair ? "\r\n" : returned ? "\r" : "\n";
	p->text.end = end + !p->is_last + pair;
	return true;
}

static bool word_is(word w, const char *text)
{
	return strlen(text) == w.length && memcmp(w.text, text, w.length) == 0;
}

/* The next word of the line, blanks before it skipped. */
static word next_word(parser *p)
{
	while (p->at < p->end && ply_is_blank((unsigned char)*p->at))
		p->at++;
	const char *const begin = p->at;
	while (p->at < p->end && !ply_is_blank((unsigned char)*p->at))
		p->at++;
	return (word){begin, (size_t)(p->at - begin)};
}

/* Length and text for "%.*s", shortened to what a message can take. */
static int shown(word w)
{
	return (int)nt_utf8_cut_of(w.text, w.length, 40);
}

static nt_status fail_word(parser *p, word found, const char *expected)
{
	if (found.length == 0)
		return nt_fail_line(p->error, NT_ERROR_INPUT, p->line,
			"the line ends where %s was expected", expected);
	return nt_fail_line(p->error, NT_ERROR_INPUT, p->line, "found \"%.*s\", expected %s",
		shown(found), found.text, expected);
}

static nt_status expect_end(parser *p)
{
	const word w = next_word(p);
	return w.length ? fail_word(p, w, "the end of the line") : NT_OK;
}

static nt_status parse_format(parser *p)
{
	static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
	if (p->has_format)
		return nt_fail_line(p->error, NT_ERROR_INPUT, p->line, "a second format line");
	const word name = next_word(p);
	int encoding = 0;
	while (encoding < 3 && !word_is(name, names[encoding]))
		encoding++;
	if (encoding == 3)
		return fail_word(p, name, "ascii, binary_little_endian or binary_big_endian");
	const word version = next_word(p);
	if (version.length && !word_is(version, "1.0"))
		return nt_fail_line(p->error, NT_ERROR_UNSUPPORTED, p->line,
			"PLY version \"%.*s\": only 1.0 is known", shown(version), version.text);
	if (version.length == 0)
		return fail_word(p, version, "the version, 1.0,");
	p->header->encoding = (ply_encoding)encoding;
	p->has_format = true;
	return expect_end(p);
}

/* "TextureFile wood grain.png": the rest of the line is the name. */
static nt_status parse_comment(parser *p)
{
	if (!word_is(next_word(p), "TextureFile"))
		return NT_OK;
	word name = next_word(p);
	const char *end = p->end;
	while (end > name.text && ply_is_blank((unsigned char)end[-1]))
		end--;
	if (name.length == 0)
		return NT_OK;
	ply_header *header = p->header;
	const char *copy = nt_arena_text(&header->texts, name.text, (size_t)(end - name.text));
	if (!copy || !nt_grow((void **)&header->textures, &header->texture_capacity,
			     header->texture_count + 1, sizeof *header->textures))
		return nt_fail_memory(p->error);
	header->textures[header->texture_count++] = copy;
	return NT_OK;
}

static bool read_count(word w, size_t *count)
{
	*count = 0;
	for (size_t i = 0; i < w.length; i++) {
		if (w.text[i] < '0' || w.text[i] > '9' || !nt_size_mul(*count, 10, count) ||
			!nt_size_add(*count, (size_t)(w.text[i] - '0'), count))
			return false;
	}
	return w.length > 0;
}

static nt_status parse_element(parser *p)
{
	ply_header *header = p->header;
	const word name = next_word(p);
	if (name.length == 0)
		return fail_word(p, name, "the element's name");
	ply_element element = {.line = p->line, .text = p->text};
	const word number = next_word(p);
	if (!read_count(number, &element.count))
		return fail_word(p, number, "the number of rows");
	const uint32_t first = nt_name_add(&p->names, name.text, name.length);
	if (first == UINT32_MAX)
		return nt_fail_memory(p->error);
	if (first < header->element_count)
		return nt_fail_line(p->error, NT_ERROR_INPUT, p->line,
			"a second element \"%.*s\": the first is on line %zu", shown(name),
			name.text, header->elements[first].line);
	element.name = nt_arena_text(&header->texts, name.text, name.length);
	if (!element.name || !nt_grow((void **)&header->elements, &header->element_capacity,
				     header->element_count + 1, sizeof element))
		return nt_fail_memory(p->error);
	header->elements[header->element_count++] = element;
	return expect_end(p);
}

static nt_status parse_type(parser *p, word name, ply_type *type)
{
	for (int i = 0; i < TYPE_COUNT; i++) {
		if (word_is(name, type_names[i].name) || word_is(name, type_names[i].alias)) {
			*type = (ply_type)i;
			return NT_OK;
		}
	}
	return fail_word(p, name, "a type (char, uchar, short, ushort, int, uint, float or double)");
}

/* "list <type> <type>" or "<type>". */
static nt_status parse_property_type(parser *p, ply_property *property)
{
	word name = next_word(p);
	property->list = word_is(name, "list");
	if (property->list) {
		name = next_word(p);
		const nt_status status = parse_type(p, name, &property->count_type);
		if (status)
			return status;
		if (property->count_type >= PLY_FLOAT32)
			return fail_word(p, name, "an integer type for the length of the list");
		name = next_word(p);
	}
	return parse_type(p, name, &property->type);
}

static nt_status parse_property(parser *p)
{
	ply_header *header = p->header;
	if (header->element_count == 0)
		return nt_fail_line(p->error, NT_ERROR_INPUT, p->line,
			"a property before the first element");
	ply_element *element = &header->elements[header->element_count - 1];
	ply_property property = {.line = p->line, .text = p->text, .offset = element->row_bytes};
	const nt_status status = parse_property_type(p, &property);
	if (status)
		return status;
	const word name = next_word(p);
	if (name.length == 0)
		return fail_word(p, name, "the property's name");
	property.name = nt_arena_text(&header->texts, name.text, name.length);
	if (!property.name || !nt_grow((void **)&element->properties, &element->property_capacity,
				      element->property_count + 1, sizeof property))
		return nt_fail_memory(p->error);
	element->list_count += property.list;
	element->last_list = property.list ? element->property_count : element->last_list;
	element->properties[element->property_count++] = property;
	element->row_bytes += ply_size(property.list ? property.count_type : property.type);
	return expect_end(p);
}

static nt_status parse_line(parser *p, bool *finished)
{
	const word keyword = next_word(p);
	if (word_is(keyword, "comment"))
		return parse_comment(p);
	if (keyword.length == 0 || word_is(keyword, "obj_info"))
		return NT_OK;
	if (word_is(keyword, "format"))
		return parse_format(p);
	if (word_is(keyword, "element"))
		return parse_element(p);
	if (word_is(keyword, "property"))
		return parse_property(p);
	/* A line that some exporter wrote without "comment" before it. Behind the first element it could be a
	 * misspelt property, without which rows would be read as what they are not. */
	if (p->header->element_count == 0 && !word_is(keyword, "end_header")) {
		if (p->header->unknown_lines++ == 0)
			p->header->unknown_line = p->line;
		return NT_OK;
	}
	if (!word_is(keyword, "end_header"))
		return fail_word(p, keyword,
			"comment, obj_info, element, property or end_header");
	*finished = true;
	return expect_end(p);
}

/* All lines up to end_header. */
static nt_status parse_lines(parser *p)
{
	next_line(p);
	if (!word_is(next_word(p), "ply"))
		return nt_fail_line(p->error, NT_ERROR_INPUT, 1, "not a PLY file: it does not begin with \"ply\"");
	nt_status status = expect_end(p);
	for (bool finished = false; !status && !finished;)
		status = next_line(p) ? parse_line(p, &finished) : nt_fail_line(p->error, NT_ERROR_INPUT, p->line,
			"the file ends within the header, end_header was expected");
	if (!status && !p->has_format)
		status = nt_fail_line(p->error, NT_ERROR_INPUT, p->line, "the header has no format line");
	return status;
}

nt_status ply_parse_header(ply_header *header, const unsigned char *bytes, size_t size, nt_error *error)
{
	parser p = {.header = header, .error = error};
	header->bytes = bytes;
	header->size = size;
	const nt_status status = parse_lines(&p);
	header->body = p.text.end;
	header->body_line = p.line + 1;
	nt_name_table_free(&p.names);
	return status;
}

void ply_free_header(ply_header *header)
{
	for (size_t i = 0; i < header->element_count; i++)
		free(header->elements[i].properties);
	free(header->elements);
	free((void *)header->textures);
	nt_arena_free(&header->texts);
	*header = (ply_header){0};
}

ply_element *ply_find_element(const ply_header *header, const char *name)
{
	for (size_t i = 0; i < header->element_count; i++)
		if (strcmp(header->elements[i].name, name) == 0)
			return &header->elements[i];
	return NULL;
}

int ply_find_property(const ply_element *element, const char *name)
{
	for (size_t i = 0; i < element->property_count; i++)
		if (strcmp(element->properties[i].name, name) == 0)
			return (int)i;
	return PLY_NO_PROPERTY;
}

nt_place ply_place(const ply_header *header, const unsigned char *at)
{
	nt_place place;
	nt_place_clear(&place);
	if (header->encoding != PLY_ASCII) {
		place.offset = (uint64_t)(at - header->bytes);
		return place;
	}
	const unsigned char *const end = header->bytes + header->size;
	place.line = header->body_line;
	for (const unsigned char *p = header->bytes + header->body; p < at; p++)
		place.line += *p == '\n' || (*p == '\r' && !(p + 1 < end && p[1] == '\n'));
	return place;
}

nt_status ply_fail_at(const ply_header *header, const unsigned char *at, nt_error *error, const char *format, ...)
{
	char message[sizeof error->message];
	va_list arguments;
	va_start(arguments, format);
	vsnprintf(message, sizeof message, format, arguments);
	va_end(arguments);
	const nt_place place = ply_place(header, at);
	return header->encoding == PLY_ASCII ? nt_fail_line(error, NT_ERROR_INPUT, place.line, "%s", message)
		: nt_fail_offset(error, NT_ERROR_INPUT, place.offset, "%s", message);
}
