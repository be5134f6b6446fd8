// SPDX-License-Identifier: MIT
//
// fast_float behind one C function, std::to_chars behind another. fast_float takes no leading '+', which
// OBJ and PLY files contain.
#include "ext/linked.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <fast_float/fast_float.h>
#include <system_error>

namespace {

// Exponents of ten from which a number has one in its text.
constexpr int least_exponent = -5, most_exponent = 15;

char *put(char *to, const char *text, size_t size)
{
	std::memcpy(to, text, size);
	return to + size;
}

char *put_zeros(char *to, int count)
{
	std::memset(to, '0', static_cast<size_t>(count));
	return to + count;
}

// The digits of d.ddde+XX with the point where JSON's readers expect it.
char *place_point(char *to, const char *digits, int count, int exponent)
{
	if (exponent <= least_exponent || exponent >= most_exponent)
		return nullptr;
	if (exponent < 0) {
		to = put(to, "0.", 2);
		return put(put_zeros(to, -exponent - 1), digits, static_cast<size_t>(count));
	}
	const int whole = exponent + 1 < count ? exponent + 1 : count;
	to = put_zeros(put(to, digits, static_cast<size_t>(whole)), exponent + 1 - whole);
	*to++ = '.';
	return whole < count ? put(to, digits + whole, static_cast<size_t>(count - whole)) : put(to, "0", 1);
}

template <typename Number> char *write_json(char *to, Number value)
{
	if (!std::isfinite(value))
		return put(to, "null", 4);
	char text[NT_NUMBER_TEXT], digits[NT_NUMBER_TEXT];
	char *const end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific).ptr;
	const char *from = text;
	if (*from == '-')
		*to++ = *from++;
	int count = 0, exponent = 0;
	const char *const begin = from;
	for (; *from != 'e'; from++)
		if (*from != '.')
			digits[count++] = *from;
	from++;
	std::from_chars(*from == '+' ? from + 1 : from, end, exponent);
	char *const placed = place_point(to, digits, count, exponent);
	return placed ? placed : put(to, begin, static_cast<size_t>(end - begin));
}

template <typename Number> const char *read(const char *begin, const char *end, Number *value)
{
	if (begin != end && *begin == '+') {
		++begin;
		if (begin != end && *begin == '-')
			return nullptr;
	}
	const auto result = fast_float::from_chars(begin, end, *value);
	return result.ec == std::errc::invalid_argument ? nullptr : result.ptr;
}

} // namespace

const char *nt_read_float(const char *begin, const char *end, float *value)
{
	return read(begin, end, value);
}

const char *nt_read_double(const char *begin, const char *end, double *value)
{
	return read(begin, end, value);
}

char *nt_write_float(char *text, float value)
{
	return std::to_chars(text, text + NT_FLOAT_TEXT - 1, value).ptr;
}

char *nt_write_json_float(char *text, float value)
{
	return write_json(text, value);
}

char *nt_write_json_double(char *text, double value)
{
	return write_json(text, value);
}
