/* SPDX-License-Identifier: MIT */
/*
 * Stored values are decoded here after appendix B of KHR_meshopt_compression, and compared with what
 * nt_tangents_store() says that readers will have.
 */
#include "test.h"
#include <math.h>
#include "gltf/document.h"
#include "gltf/quantize.h"

enum { COUNT = 3000 };

static float tangents[4 * COUNT], before[4 * COUNT];
static unsigned char stored[16 * COUNT], values[16 * COUNT], again[16 * COUNT];

/* Directions all over the sphere, and the axes. */
static void make_tangents(void)
{
	for (int i = 0; i < COUNT; i++) {
		const double z = 1 - 2 * (i + 0.5) / COUNT, turn = i * 2.399963, r = sqrt(1 - z * z);
		const double t[3] = {r * cos(turn), r * sin(turn), z};
		for (int k = 0; k < 3; k++)
			tangents[4 * i + k] = i < 6 ? (i / 2 == k ? (i % 2 ? -1.0f : 1.0f) : 0) : (float)t[k];
		tangents[4 * i + 3] = i % 3 ? 1 : -1;
	}
	memcpy(before, tangents, sizeof before);
}

static int integer(const unsigned char *bytes, size_t size, size_t k)
{
	return size == 1 ? (int8_t)bytes[k] : (int16_t)(bytes[2 * k] | bytes[2 * k + 1] << 8);
}

static double component_of(size_t i, size_t k)
{
	return before[4 * i + k];
}

TEST(octahedral_elements_are_the_best_near_a_direction)
{
	(void)state;
	static const struct {
		nt_precision precision;
		int bits;
		double degrees; /* a step's diagonal on the sphere, and that of an integer */
	} cases[] = {{NT_PRECISION_BYTE, 8, 1.2}, {NT_PRECISION_BYTE, 6, 4}, {NT_PRECISION_SHORT, 16, 0.01},
		{NT_PRECISION_SHORT, 10, 0.25}};
	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		const nt_tangent_filter filter = {cases[c].precision, "OCTAHEDRAL", cases[c].bits};
		const size_t bytes = nt_precision_bytes(filter.precision), size = bytes / 4;
		const double most = size == 1 ? 127 : 32767;
		nt_rounding cost = {0};
		make_tangents();
		assert_int_equal(nt_tangents_store(&filter, tangents, COUNT, stored, values, &cost, NULL), NT_OK);
		for (size_t i = 0; i < COUNT; i++) {
			const unsigned char *s = stored + i * bytes, *q = values + i * bytes;
			const double one = integer(s, size, 2);
			double t[3] = {integer(s, size, 0) / one, integer(s, size, 1) / one, 0};
			double dot = 0, square = 0, own = 0;
			t[2] = 1 - fabs(t[0]) - fabs(t[1]);
			const double below = fmin(t[2], 0), length = (t[0] -= copysign(below, t[0]),
				t[1] -= copysign(below, t[1]), sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]));
			assert_true(one == (1 << (cases[c].bits - 1)) - 1);
			for (size_t k = 0; k < 3; k++) {
				assert_true(fabs(integer(q, size, k) - t[k] / length * most) <= 1.001);
				dot += integer(q, size, k) / most * component_of(i, k);
				square += pow(integer(q, size, k) / most, 2);
				own += pow(component_of(i, k), 2);
			}
			assert_true(integer(q, size, 3) == (int)(before[4 * i + 3] * most));
			assert_true(fabs(sqrt(square) - 1) <= 0.00674 || cases[c].bits < 8);
			assert_true(acos(fmin(dot / sqrt(square * own), 1)) * 57.29578 <= cases[c].degrees);
		}
		assert_true(cost.worst_radians * 57.29578 <= cases[c].degrees);
		assert_int_equal(nt_filter_bits("OCTAHEDRAL", stored, COUNT, bytes,
			size == 1 ? NT_GLTF_BYTE : NT_GLTF_SHORT, 4), cases[c].bits);
		/* what such a view gives stays as it is */
		assert_int_equal(nt_tangents_store(&filter, tangents, COUNT, stored, again, NULL, NULL), NT_OK);
		assert_memory_equal(again, values, COUNT * bytes);
	}
}

TEST(exponential_elements_have_w_exactly)
{
	(void)state;
	static const int bits[] = {8, 15, 23};
	for (size_t c = 0; c < sizeof bits / sizeof *bits; c++) {
		const nt_tangent_filter filter = {NT_PRECISION_FLOAT, "EXPONENTIAL", bits[c]};
		make_tangents();
		assert_int_equal(nt_tangents_store(&filter, tangents, COUNT, stored, values, NULL, NULL), NT_OK);
		for (size_t i = 0; i < 4 * COUNT; i++) {
			int32_t word;
			float value;
			memcpy(&word, stored + 4 * i, 4);
			memcpy(&value, values + 4 * i, 4);
			const int32_t mantissa = (int32_t)((uint32_t)word << 8) / 256;
			assert_true(value == (float)ldexp(mantissa, (word - (word & 0xFFFFFF)) / (1 << 24)));
			assert_true(value == tangents[i] && (i % 4 < 3 || value == before[i]));
			assert_true(fabs(value - before[i]) <= 1.0 / (1 << (bits[c] - 1)));
		}
		for (size_t i = 0; i < COUNT; i++) {
			const float *t = tangents + 4 * i;
			assert_true(fabs(sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]) - 1) <= 0.00674);
		}
		assert_int_equal(nt_filter_bits("EXPONENTIAL", stored, COUNT, 16, NT_GLTF_FLOAT, 4), bits[c]);
	}
}
