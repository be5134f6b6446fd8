/* SPDX-License-Identifier: MIT */
/*
 * Text as formats write it: how each escapes what a name may have in it, and documents by templates.
 */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "report/render/inside.h"

enum { MADE_BYTES = 20 };
static const char replacement[] = "\xef\xbf\xbd"; /* U+FFFD */

/* Each byte of a character: %1B, or \x1b. */
static const char *each_byte(char *made, bool upper, const char *text, size_t length)
{
	char *to = made;
	for (size_t i = 0; i == 0 || i < length; i++)
		to += snprintf(to, 5, upper ? "%%%02X" : "\\x%02x", (unsigned char)text[i]);
	return made;
}

static const char *escape_json(char *made, const char *text, size_t length, bool script)
{
	const unsigned char c = (unsigned char)*text;
	if (c == '"' || c == '\\' || c == '\n')
		snprintf(made, MADE_BYTES, "\\%c", c == '\n' ? 'n' : c);
	else if (c < 0x20 || c == 0x7f || (c == '<' && script))
		snprintf(made, MADE_BYTES, "\\u%04x", c);
	else
		return length ? NULL : "\\ufffd";
	return made;
}

static const char *escape_markup(char *made, const char *text, size_t length, bool markdown)
{
	static const char *const entities[128] = {
		['<'] = "&lt;", ['>'] = "&gt;", ['&'] = "&amp;", ['"'] = "&quot;", ['\''] = "&#39;"};
	const unsigned char c = (unsigned char)*text;
	if (markdown && (c < 0x20 || c == 0x7f))
		return " ";
	if (markdown && strchr("\\`*_{}[]()#+-!|>~@", c)) {
		snprintf(made, MADE_BYTES, "\\%c", c);
		return made;
	}
	if (c < 128 && entities[c] && !(markdown && strchr("\"'", c)))
		return entities[c];
	return c != '\n' && c != '\t' && nt_utf8_is_unsafe(text, length) ? replacement : NULL;
}

/* The escape of the character at the beginning, of `length` bytes, 0: it is no UTF-8; NULL: it is itself. */
static const char *escape(nt_syntax syntax, char *made, const char *text, size_t length)
{
	static const char unreserved[] =
		"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
	if (syntax == NT_PLAIN)
		return NULL;
	if (syntax == NT_JSON || syntax == NT_SCRIPT)
		return escape_json(made, text, length, syntax == NT_SCRIPT);
	if (syntax == NT_XML || syntax == NT_MARKDOWN)
		return escape_markup(made, text, length, syntax == NT_MARKDOWN);
	if (syntax == NT_URI)
		return strchr(unreserved, *text) ? NULL : each_byte(made, true, text, length);
	if (syntax == NT_CSV && *text == '"')
		return "\"\"";
	if ((syntax == NT_COMMAND && strchr("%\r\n", *text)) || (syntax == NT_PROPERTY && strchr("%\r\n:,", *text)))
		return each_byte(made, true, text, length);
	return nt_utf8_is_unsafe(text, length) ? each_byte(made, false, text, length) : NULL;
}

void nt_put_text(nt_buffer *out, nt_syntax syntax, const char *text)
{
	const char *quote = syntax == NT_JSON || syntax == NT_SCRIPT || syntax == NT_CSV ? "\"" : "";
	nt_buffer_text(out, quote);
	if (syntax == NT_CSV && *text && strchr("=+-@\t\r", *text))
		nt_buffer_text(out, "'");
	for (size_t length; *text; text += length ? length : 1) {
		char made[MADE_BYTES];
		length = nt_utf8_length(text, SIZE_MAX);
		const char *as = escape(syntax, made, text, length);
		nt_buffer_append(out, as ? as : text, as ? strlen(as) : length ? length : 1);
	}
	nt_buffer_text(out, quote);
}

/* ---- templates ---- */

/* One conversion, from behind its %. */
typedef struct conversion {
	bool as_is, is_byte, is_size, is_long; /* flag -; hh, z and l */
	int width, precision;                  /* precision -1: none */
	char letter;
} conversion;

static const char *read_conversion(const char *format, conversion *c)
{
	char *end = NULL;
	*c = (conversion){.precision = -1, .as_is = *format == '-'};
	format += c->as_is;
	c->width = (int)strtol(format, &end, 10);
	if (*end == '.')
		c->precision = (int)strtol(end + 1, &end, 10);
	for (; *end && strchr("hzl", *end); end++) {
		c->is_byte |= *end == 'h';
		c->is_size |= *end == 'z';
		c->is_long |= *end == 'l';
	}
	c->letter = *end;
	return end + (*end != '\0');
}

static void put_string(nt_buffer *out, nt_syntax syntax, conversion c, const char *text)
{
	if (c.as_is && c.width)
		nt_buffer_format(out, "%-*s", c.width, text);
	else if (c.as_is)
		nt_buffer_text(out, text);
	else if (text)
		nt_put_text(out, syntax, text);
	else
		nt_buffer_text(out, "null");
}

static void put_allocated(nt_buffer *out, nt_syntax syntax, char *text)
{
	nt_put_text(out, syntax, text ? text : "");
	out->failed |= !text;
	free(text);
}

static void put_unsigned(nt_buffer *out, bool json, conversion c, uint64_t value)
{
	const bool hexadecimal = c.letter == 'x';
	const bool none = value == (c.is_long ? UINT64_MAX : NT_NONE) && !c.is_size && !hexadecimal;
	if ((json && none) || (!value && (c.precision == 0 || (json && hexadecimal))))
		nt_buffer_text(out, json ? "null" : "");
	else if (hexadecimal)
		nt_buffer_format(out, json ? "\"%016" PRIx64 "\"" : "%016" PRIx64, value);
	else {
		char digits[20], *first = digits + sizeof digits;
		do
			*--first = (char)('0' + value % 10);
		while (value /= 10);
		nt_buffer_append(out, first, (size_t)(digits + sizeof digits - first));
	}
}

static void put_double(nt_buffer *out, bool json, conversion c, double value)
{
	char text[40];
	const int precision = c.precision >= 0 ? c.precision : json ? 9 : 6;
	if (json && !isfinite(value))
		nt_buffer_text(out, "null");
	else if (c.letter == 'f')
		nt_buffer_format(out, "%.*f", precision, value);
	else /* once, since reports are made of numbers */
		nt_buffer_append(out, text,
			(size_t)snprintf(text, sizeof text, "%.*g", precision, json && value == 0.0 ? 0.0 : value));
}

void nt_put(nt_buffer *out, nt_syntax syntax, const char *format, ...)
{
	const bool json = syntax == NT_JSON || syntax == NT_SCRIPT;
	const char *special = json || syntax == NT_XML ? "%'" : "%";
	if (json && *format == ',' && (!out->size || strchr("{[", out->data[out->size - 1])))
		format += format[1] == ' ' ? 2 : 1;
	va_list a;
	va_start(a, format);
	for (size_t plain; *format;) {
		conversion c;
		plain = strcspn(format, special);
		nt_buffer_append(out, format, plain);
		format += plain;
		if (!*format)
			break;
		if (*format++ == '\'') {
			nt_buffer_text(out, "\"");
			continue;
		}
		format = read_conversion(format, &c);
		if (c.letter == 's')
			put_string(out, syntax, c, va_arg(a, const char *));
		else if (c.letter == 'p')
			put_allocated(out, syntax, va_arg(a, char *));
		else if (c.letter == 'g' || c.letter == 'f')
			put_double(out, json, c, va_arg(a, double));
		else if (c.letter == 'd' && c.is_byte)
			nt_buffer_text(out, va_arg(a, int) ? "true" : "false");
		else if (c.letter == 'd')
			nt_buffer_format(out, "%d", va_arg(a, int));
		else if (c.letter == '%')
			nt_buffer_text(out, "%");
		else if (!c.letter)
			break; /* the template ends in a conversion: compilers refuse it, unless it is no literal */
		else if (c.is_size)
			put_unsigned(out, json, c, va_arg(a, size_t));
		else if (c.is_long)
			put_unsigned(out, json, c, va_arg(a, uint64_t));
		else
			put_unsigned(out, json, c, va_arg(a, unsigned));
	}
	va_end(a);
}
