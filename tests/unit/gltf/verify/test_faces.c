/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "gltf/verify/faces.h"

enum { FACES = 3000 };

static const nt_verify_tolerance fine = {0.01f, 0.001f};

/* Triangles of a wave, with tangents that turn. */
static void make(nt_verify_corner *faces)
{
	for (int f = 0; f < FACES; f++)
		for (int k = 0; k < 3; k++) {
			const float x = (float)(f % 60) + (k == 1), y = (float)(f / 60) + (k == 2);
			faces[3 * f + k] = (nt_verify_corner){{x, y, sinf(x)},
				{cosf((float)f), sinf((float)f), 0, f % 2 ? 1.0f : -1.0f}};
		}
}

/* The same in reverse order, each turned by one corner and shaken by less than the tolerance. */
static void shuffle(const nt_verify_corner *from, nt_verify_corner *to)
{
	for (int f = 0; f < FACES; f++)
		for (int k = 0; k < 3; k++) {
			nt_verify_corner *corner = &to[3 * (FACES - 1 - f) + (k + 1) % 3];
			*corner = from[3 * f + k];
			corner->position[(f + k) % 3] += f % 5 ? 0.009f : -0.009f;
			corner->tangent[k] += 0.0009f;
		}
}

static size_t first_missing(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b, size_t b_faces)
{
	size_t first;
	assert_int_equal(nt_verify_faces(a, a_faces, b, b_faces, &fine, 2, &first), NT_OK);
	return first;
}

static nt_verify_corner a[3 * FACES], b[3 * FACES];

TEST(order_and_first_corner_do_not_matter)
{
	make(a);
	shuffle(a, b);
	assert_true(first_missing(a, FACES, b, FACES) == SIZE_MAX);
	assert_true(first_missing(NULL, 0, NULL, 0) == SIZE_MAX);
}

TEST(every_value_and_the_winding_matter)
{
	for (int change = 0; change < 5; change++) {
		make(a);
		shuffle(a, b);
		const int f = FACES - 1 - 1234;
		const nt_verify_corner corner = b[3 * f];
		switch (change) {
		case 0:
			b[3 * f].position[2] += 0.03f;
			break;
		case 1:
			b[3 * f].tangent[3] = -b[3 * f].tangent[3];
			break;
		case 2: /* seen from behind */
			b[3 * f] = b[3 * f + 1];
			b[3 * f + 1] = corner;
			break;
		case 3:
			b[3 * f].position[0] = NAN;
			break;
		default: /* one twice, one not at all */
			memcpy(&b[3 * f], &b[3 * (f - 1)], 3 * sizeof *b);
		}
		assert_int_equal(first_missing(a, FACES, b, FACES), 1234);
		assert_true(first_missing(b, FACES, a, FACES) != SIZE_MAX);
	}
}

TEST(one_face_more_is_another_surface)
{
	make(a);
	shuffle(a, b);
	assert_true(first_missing(a, FACES - 1, b, FACES) != SIZE_MAX);
	assert_true(first_missing(a, FACES, b, FACES - 1) != SIZE_MAX);
	/* also where it is a copy of another */
	memcpy(&b[0], &b[3], 3 * sizeof *b);
	assert_true(first_missing(a, FACES - 1, b, FACES) != SIZE_MAX);
}

/* All have one centre and differ in where their corners stand, and in tangents. */
static void make_concentric(nt_verify_corner *faces)
{
	for (int f = 0; f < FACES; f++)
		for (int k = 0; k < 3; k++) {
			const float turn = 6.2831853f * ((float)(f / 3) * 3 / FACES + (float)k) / 3;
			faces[3 * f + k] = (nt_verify_corner){{30 * cosf(turn), 30 * sinf(turn), 0},
				{(float)(f % 3), (float)k, 0, 1}};
		}
}

TEST(triangles_with_one_centre_are_told_apart)
{
	make_concentric(a);
	shuffle(a, b);
	assert_true(first_missing(a, FACES, b, FACES) == SIZE_MAX);
	const int f = FACES - 1 - 1234;
	b[3 * f + 1].tangent[1] += 0.01f;
	assert_int_equal(first_missing(a, FACES, b, FACES), 1234);
	make_concentric(a);
	shuffle(a, b);
	b[3 * f + 2].position[0] += 0.05f;
	b[3 * f].position[0] -= 0.05f; /* the centre stays */
	assert_int_equal(first_missing(a, FACES, b, FACES), 1234);
	/* not a number, in both */
	make_concentric(a);
	a[7].tangent[0] = a[8].position[0] = NAN;
	shuffle(a, b);
	assert_true(first_missing(a, FACES, b, FACES) == SIZE_MAX);
}
