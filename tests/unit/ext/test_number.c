/* SPDX-License-Identifier: MIT */
#include "ext/linked.h"
#include "test.h"

#include <float.h>
#include <math.h>

static const char *float_text(float value)
{
	static char text[NT_NUMBER_TEXT];
	*nt_write_json_float(text, value) = '\0';
	return text;
}

static const char *double_text(double value)
{
	static char text[NT_NUMBER_TEXT];
	*nt_write_json_double(text, value) = '\0';
	return text;
}

TEST(json_numbers_are_short_and_have_a_point)
{
	assert_string_equal(float_text(0), "0.0");
	assert_string_equal(float_text(-0.0f), "-0.0");
	assert_string_equal(float_text(1), "1.0");
	assert_string_equal(float_text(0.8f), "0.8");
	assert_string_equal(float_text(-120.5f), "-120.5");
	assert_string_equal(float_text(1e14f), "100000000000000.0");
	assert_string_equal(float_text(1e15f), "1e+15");
	assert_string_equal(float_text(0.0001f), "0.0001");
	assert_string_equal(float_text(0.00001f), "1e-05");
	assert_string_equal(float_text(1.25e-7f), "1.25e-07");
	assert_string_equal(float_text(FLT_MAX), "3.4028235e+38");
	/* the float nearest to 0.1 is 0x1.99999ap-4 */
	assert_string_equal(double_text(0.1f), "0.10000000149011612");
	assert_string_equal(double_text(-DBL_MAX), "-1.7976931348623157e+308");
	assert_string_equal(double_text(DBL_TRUE_MIN), "5e-324");
	assert_string_equal(double_text(123456.0), "123456.0");
	assert_string_equal(double_text((double)NAN), "null");
	assert_string_equal(double_text((double)INFINITY), "null");
}

TEST(json_numbers_read_back)
{
	uint64_t bits = 1;
	for (int i = 0; i < 100000; i++) {
		bits = bits * 6364136223846793005u + 1442695040888963407u;
		double value, back;
		memcpy(&value, &bits, sizeof value);
		if (!isfinite(value))
			continue;
		back = strtod(double_text(value), NULL);
		assert_memory_equal(&back, &value, sizeof value);
		float small, small_back;
		memcpy(&small, &bits, sizeof small);
		if (!isfinite(small))
			continue;
		small_back = strtof(float_text(small), NULL);
		assert_memory_equal(&small_back, &small, sizeof small);
	}
}
