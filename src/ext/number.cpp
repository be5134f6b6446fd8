// SPDX-License-Identifier: MIT
//
// fast_float behind one C function, std::to_chars behind another. fast_float takes no leading '+', which
// OBJ and PLY files contain.
#include "ext/number.h"

#include <charconv>
#include <fast_float/fast_float.h>
#include <system_error>

const char *nt_read_float(const char *begin, const char *end, float *value)
{
	if (begin != end && *begin == '+') {
		++begin;
		if (begin != end && *begin == '-')
			return nullptr;
	}
	const auto result = fast_float::from_chars(begin, end, *value);
	return result.ec == std::errc::invalid_argument ? nullptr : result.ptr;
}

char *nt_write_float(char *text, float value)
{
	return std::to_chars(text, text + NT_FLOAT_TEXT - 1, value).ptr;
}
