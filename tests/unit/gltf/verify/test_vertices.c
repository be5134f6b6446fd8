/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "gltf/verify/verify.h"

enum { COUNT = 5000, HUB = 200, CHANGED = 1234 };

static const nt_verify_tolerance fine = {0.01f, 0.001f}, exact = {0, 0};

/* A wave whose tangents turn, of which some have one place. */
static void make(nt_verify_vertex *vertices)
{
	for (int i = 0; i < COUNT; i++) {
		const float x = i < HUB ? 3 : (float)(i % 60), y = i < HUB ? 2 : (float)(i / 60);
		vertices[i] = (nt_verify_vertex){{x, y, sinf(x)},
			{cosf((float)i), sinf((float)i), 0, i % 2 ? 1.0f : -1.0f}};
	}
}

/* The same in reverse order, each shaken by less than the tolerance, or not. */
static void shuffle(const nt_verify_vertex *from, nt_verify_vertex *to, bool shakes)
{
	for (int i = 0; i < COUNT; i++) {
		nt_verify_vertex *v = &to[COUNT - 1 - i];
		*v = from[i];
		v->position[i % 3] += !shakes ? 0 : i % 5 ? 0.009f : -0.009f;
		v->tangent[i % 3] += shakes ? 0.0009f : 0;
	}
}

static nt_verify_vertex a[COUNT], b[COUNT];

static size_t first_missing(size_t a_count, size_t b_count, const nt_verify_tolerance *tolerance)
{
	size_t first;
	assert_int_equal(nt_verify_vertices(a, a_count, b, b_count, tolerance, &first), NT_OK);
	return first;
}

TEST(order_does_not_matter)
{
	make(a);
	shuffle(a, b, true);
	assert_true(first_missing(COUNT, COUNT, &fine) == SIZE_MAX);
	assert_true(first_missing(COUNT, COUNT, &exact) == 0);
	shuffle(a, b, false);
	assert_true(first_missing(COUNT, COUNT, &exact) == SIZE_MAX);
	assert_true(first_missing(0, 0, &fine) == SIZE_MAX);
}

TEST(every_value_matters)
{
	for (int change = 0; change < 9; change++) {
		make(a);
		shuffle(a, b, true);
		nt_verify_vertex *v = &b[COUNT - 1 - CHANGED];
		if (change < 3)
			v->position[change] += 0.03f;
		else if (change < 7)
			v->tangent[change - 3] += 0.004f;
		else if (change < 8)
			v->position[0] = NAN;
		else
			v->tangent[3] *= 0.9995f; /* near, but no w */
		assert_int_equal(first_missing(COUNT, COUNT, &fine), CHANGED);
	}
}

TEST(a_vertex_that_only_the_second_has_is_found)
{
	make(a);
	shuffle(a, b, true);
	assert_int_equal(first_missing(COUNT - 1, COUNT, &fine), 0);
	assert_int_equal(first_missing(COUNT, COUNT - 1, &fine), 0);
	/* what is not a number in both is the same */
	a[7].tangent[0] = a[8].position[0] = NAN;
	a[9].position[1] = INFINITY;
	shuffle(a, b, true);
	assert_true(first_missing(COUNT, COUNT, &fine) == SIZE_MAX);
}
