/* SPDX-License-Identifier: MIT */
/* Deltas that count as none, integers for the others, and their storage. */
#include "gltf/quantize.h"

#include "ext/gltf_numbers.h"
#include "test.h"

/* 8 units in the last place of a number near 1 are nothing, 9 are something. */
TEST(deltas_of_rounding_are_zero)
{
	static const float ulp = 0x1p-24f;
	const float base[8] = {0, 1, 0, 1, 0, 1, 0, 1}, moved[6] = {8 * ulp, 1, 0, 9 * ulp, 1, 0};
	float deltas[6];
	uint32_t type = NT_GLTF_FLOAT;
	assert_int_equal(nt_morph_deltas(moved, base, 2, nt_morph_least(NT_PRECISION_FLOAT), &type, deltas), 1);
	assert_true(deltas[0] == 0 && deltas[3] == 9 * ulp);
	assert_int_equal(nt_morph_deltas(moved, base, 2, nt_morph_least(NT_PRECISION_BYTE), &type, deltas), 0);
}

/* 0.6 is 76.2 of 127 steps and 19660.2 of 32767. */
TEST(integers_round_and_end_at_one)
{
	const float base[4] = {0, 0, 0, 1}, moved[3] = {0.6f, -1, 0}, far[3] = {0.6f, -1.01f, 0};
	float delta[3];
	uint32_t type = NT_GLTF_BYTE;
	assert_int_equal(nt_morph_deltas(moved, base, 1, 0, &type, delta), 1);
	assert_int_equal(type, NT_GLTF_BYTE);
	assert_true(delta[0] == 76.0f / 127.0f && delta[1] == -1 && delta[2] == 0);
	type = NT_GLTF_SHORT;
	nt_morph_deltas(moved, base, 1, 0, &type, delta);
	assert_true(delta[0] == 19660.0f / 32767.0f);
	nt_morph_deltas(far, base, 1, 0, &type, delta);
	assert_int_equal(type, NT_GLTF_FLOAT);
	assert_true(delta[0] == 0.6f && delta[1] == -1.01f);
}

/* The 3 of 100 elements of 12 bytes that are not zero take 3 numbers, padded to 4, and 36 bytes. */
TEST(few_are_stored_sparse)
{
	float deltas[300] = {0};
	unsigned char bytes[40] = {0};
	deltas[3 * 7] = 1;
	deltas[3 * 8 + 1] = 2;
	deltas[3 * 99 + 2] = 3;
	const nt_morph_storage s = nt_morph_choose_storage(NT_GLTF_FLOAT, 100, 3);
	assert_true(s.sparse && s.element_count == 3 && s.index_type == NT_GLTF_UBYTE && s.value_offset == 4 &&
		s.size == sizeof bytes);
	nt_morph_store(&s, deltas, 100, bytes);
	assert_true(bytes[0] == 7 && bytes[1] == 8 && bytes[2] == 99);
	float values[9];
	memcpy(values, bytes + 4, sizeof values);
	assert_true(values[0] == 1 && values[4] == 2 && values[8] == 3);
	assert_int_equal(nt_morph_choose_storage(NT_GLTF_FLOAT, 70000, 0).element_count, 1);
	assert_int_equal(nt_morph_choose_storage(NT_GLTF_FLOAT, 70000, 3).index_type, NT_GLTF_UINT);
	const nt_morph_storage dense = nt_morph_choose_storage(NT_GLTF_BYTE, 100, 90);
	assert_true(!dense.sparse && dense.stride == 4 && dense.size == 400);
}
