/* SPDX-License-Identifier: MIT */
/*
 * The polynomial arc cosine against libm: every 997th float of [-1, 1], all of them with NT_ACOS_ALL in the
 * environment (make soak).
 */
#include "test.h"
#include <math.h>
#include "tangent/acos.h"

static float float_of(uint32_t bits)
{
	float value;
	memcpy(&value, &bits, sizeof value);
	return value;
}

TEST(rounds_as_libm_does)
{
	const uint32_t one = 0x3f800000, step = getenv("NT_ACOS_ALL") ? 1 : 997;
	size_t wrong = 0;
	for (uint32_t sign = 0; sign < 2; sign++)
		for (uint32_t bits = 0; bits <= one; bits += step) {
			const float c = float_of(bits | sign << 31);
			wrong += nt_acos(c) != (float)acos((double)c);
		}
	assert_int_equal(wrong, 0);
}

TEST(ends_and_nan)
{
	assert_true(nt_acos(1.0f) == 0.0f);
	assert_true(nt_acos(-1.0f) == (float)M_PI);
	assert_true(nt_acos(0.0f) == (float)M_PI_2);
	assert_true(isnan(nt_acos(NAN)));
}
