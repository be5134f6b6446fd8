/* SPDX-License-Identifier: MIT */
/*
 * Evidence in normal maps that are made from formulas. make bench-green has many more.
 */
#include "image/image.h"

#include <math.h>
#include "fail_alloc.h"
#include "test.h"

enum { SIDE = 128 };

typedef void (*slope_fn)(double x, double y, double *p, double *q);

/* sin(x/7 + y/9) + sin(x/5 - y/6) */
static void hills(double x, double y, double *p, double *q)
{
	const double a = cos(x / 7 + y / 9), b = cos(x / 5 - y / 6);
	*p = a / 7 + b / 5;
	*q = a / 9 - b / 6;
}

static void flat(double x, double y, double *p, double *q)
{
	(void)x, (void)y;
	*p = *q = 0;
}

/* sin(x/5) + sin(y/6): no mixed derivative */
static void grid(double x, double y, double *p, double *q)
{
	*p = cos(x / 5) / 5;
	*q = cos(y / 6) / 6;
}

/* A swirl: no surface has these slopes. */
static void swirl(double x, double y, double *p, double *q)
{
	*p = 0.3 * sin(y / 6) + 0.3 * cos(x / 4 + y / 5);
	*q = 0.3 * sin(x / 9) + 0.3 * sin(x / 5 - y / 4);
}

static nt_pixels make(slope_fn slopes, double green, unsigned bits)
{
	nt_pixels p;
	nt_error error;
	const double most = (1u << bits) - 1;
	assert_int_equal(nt_pixels_create(&p, SIDE, SIDE, 3, bits, &error), NT_OK);
	for (size_t i = 0; i < SIDE * SIDE; i++) {
		double s, t;
		slopes((double)(i % SIDE), (double)(i / SIDE), &s, &t);
		const double length = sqrt(s * s + t * t + 1), n[] = {-s / length, green * t / length, 1 / length};
		for (size_t c = 0; c < 3; c++) {
			const unsigned value = (unsigned)((n[c] + 1) / 2 * most + 0.5);
			if (bits == 8)
				((uint8_t *)p.samples)[3 * i + c] = (uint8_t)value;
			else
				((uint16_t *)p.samples)[3 * i + c] = (uint16_t)value;
		}
	}
	return p;
}

static nt_normal_facts facts_of(nt_pixels p)
{
	nt_normal_facts facts;
	nt_error error;
	assert_int_equal(nt_examine_normals(&p, &facts, &error), NT_OK);
	nt_pixels_free(&p);
	return facts;
}

TEST(green_is_told_by_the_curl)
{
	for (unsigned bits = 8; bits <= 16; bits += 8) {
		const nt_normal_facts up = facts_of(make(hills, 1, bits)), down = facts_of(make(hills, -1, bits));
		assert_int_equal(up.green, NT_GREEN_UP);
		assert_int_equal(down.green, NT_GREEN_DOWN);
		assert_true(up.correlation > 0.95 && down.correlation < -0.95);
		assert_true(up.agreement == 1 && down.agreement == 1);
		assert_true(up.not_unit == 0 && up.blue_below == 0 && !up.constant && !up.object_space);
	}
}

TEST(nothing_is_told_by_weak_evidence)
{
	for (int green = -1; green <= 1; green += 2) {
		assert_int_equal(facts_of(make(grid, green, 8)).green, NT_GREEN_UNKNOWN);
		assert_int_equal(facts_of(make(swirl, green, 8)).green, NT_GREEN_MIXED);
	}
	const nt_normal_facts facts = facts_of(make(flat, 1, 8));
	assert_int_equal(facts.green, NT_GREEN_UNKNOWN);
	assert_true(facts.constant);
	for (size_t i = 0; i < 2; i++) { /* one pixel is another one: the first, the last */
		nt_pixels p = make(flat, 1, 8);
		((uint8_t *)p.samples)[i * (3 * SIDE * SIDE - 1)]--;
		assert_false(facts_of(p).constant);
	}
}

/* Long waves, and grain upon them. */
static void forms(double x, double y, double *p, double *q)
{
	const double a = 0.6 * cos(x / 9 + y / 11), b = 0.6 * cos(x / 10 - y / 9);
	*p = a / 9 + b / 10;
	*q = a / 11 - b / 9;
}

static void grain(double x, double y, double *p, double *q)
{
	*p = 0.02 * cos(x * 1.5 + y * 1.3);
	*q = 0.02 * cos(x * 1.5 + y * 1.3);
}

/* A map like DamagedHelmet's: forms with green up, and grain upon them with green down, whose curl is the larger. */
static void opposed(double x, double y, double *p, double *q)
{
	double p2, q2;
	forms(x, y, p, q);
	grain(x, y, &p2, &q2);
	*p += p2;
	*q -= q2;
}

TEST(large_forms_veto_a_fine_grain)
{
	const nt_normal_facts facts = facts_of(make(opposed, 1, 16));
	assert_true(facts.blocks_down > 100);
	assert_int_equal(facts.green, NT_GREEN_MIXED);
	assert_int_equal(facts_of(make(forms, 1, 16)).green, NT_GREEN_UP);
	const nt_normal_facts down = facts_of(make(grain, -1, 16)); /* dp/dv is -dq/du everywhere */
	assert_int_equal(down.green, NT_GREEN_DOWN);
	assert_int_equal(down.votes[NT_GREEN_BLOCKS * NT_GREEN_BLOCKS / 2], -100);
}

/* One half with green up and one with green down, as where two maps were joined: the blocks say which. */
TEST(halves_that_contradict_are_mixed)
{
	nt_pixels a = make(hills, 1, 8), b = make(hills, -1, 8);
	memcpy(a.samples, b.samples, nt_pixels_row_bytes(&a) * SIDE / 2);
	nt_pixels_free(&b);
	const nt_normal_facts facts = facts_of(a);
	assert_int_equal(facts.green, NT_GREEN_MIXED);
	for (int i = 0; i < NT_GREEN_BLOCKS * NT_GREEN_BLOCKS; i++)
		assert_true(i < NT_GREEN_BLOCKS * NT_GREEN_BLOCKS / 2 ? facts.votes[i] < -50 : facts.votes[i] > 50);
	assert_int_equal(facts.blocks_up + facts.blocks_down, NT_GREEN_BLOCKS * NT_GREEN_BLOCKS);
}

/* Flat but for an eighth of the map above and below, which contradict: rings around what was painted, say. */
TEST(a_map_with_next_to_no_relief_is_not_mixed)
{
	nt_pixels p = make(flat, 1, 8), up = make(hills, 1, 8), down = make(hills, -1, 8);
	const size_t size = nt_pixels_row_bytes(&p) * SIDE, part = size / 8;
	memcpy(p.samples, up.samples, part);
	memcpy((char *)p.samples + size - part, (char *)down.samples + size - part, part);
	nt_pixels_free(&up);
	nt_pixels_free(&down);
	const nt_normal_facts facts = facts_of(p);
	assert_in_range(facts.blocks_up, 12, 24);
	assert_in_range(facts.blocks_down, 12, 24);
	assert_int_equal(facts.green, NT_GREEN_UNKNOWN);
}

TEST(shares_are_counted)
{
	nt_pixels p = make(hills, 1, 8);
	uint8_t *samples = p.samples;
	for (size_t i = 0; i < SIDE * SIDE / 4; i++)
		samples[3 * i + 2] = 128; /* the length is that of x and y */
	for (size_t i = SIDE * SIDE / 2; i < SIDE * SIDE / 2 + SIDE * SIDE / 8; i++) {
		samples[3 * i] = samples[3 * i + 1] = 128;
		samples[3 * i + 2] = 0; /* straight into the surface */
	}
	const nt_normal_facts facts = facts_of(p);
	assert_true(facts.not_unit == 0.25);
	assert_true(facts.blue_below == 0.125);
	assert_false(facts.object_space);
}

/* Runs of pixels, the same in each row: red, green and length. A band has steps of one level at both ends and six
 * pixels or more; its share is that of all pixels that are part of a slope, as (128, 128) between jumps is not. */
TEST(wide_steps_are_bands)
{
	static const struct {
		int runs[8][3];
		double share;
	} rows[] = {
		{{{128, 128, 6}, {129, 128, 6}, {130, 128, 6}, {130, 129, 6}}, 12. / 24},
		{{{130, 128, 6}, {129, 128, 6}, {128, 128, 6}}, 6. / 18},
		{{{129, 128, 5}, {130, 128, 5}, {131, 128, 5}}, 0},
		{{{120, 128, 8}, {122, 128, 8}, {123, 128, 8}, {125, 128, 8}}, 0},
		{{{128, 120, 8}, {128, 122, 8}, {128, 123, 8}, {128, 125, 8}}, 0},
		{{{128, 128, 8}, {150, 128, 8}, {140, 128, 8}, {141, 128, 8}, {142, 128, 8}, {128, 150, 8},
			{128, 128, 8}}, 8. / 40},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_pixels p;
		nt_error error;
		uint32_t width = 0;
		for (size_t r = 0; r < 8; r++)
			width += (uint32_t)rows[i].runs[r][2];
		assert_int_equal(nt_pixels_create(&p, width, 2, 3, 8, &error), NT_OK);
		uint8_t *to = p.samples;
		for (size_t r = 0; r < 16; r++) {
			const int *run = rows[i].runs[r % 8];
			for (int k = 0; k < run[2]; k++, to += 3)
				memcpy(to, (uint8_t[]){(uint8_t)run[0], (uint8_t)run[1], 250}, 3);
		}
		assert_true(facts_of(p).banded == rows[i].share);
	}
}

/* Pixels that alpha leaves out may be anything. */
TEST(clear_pixels_do_not_count)
{
	for (unsigned bits = 8; bits <= 16; bits += 8) {
		nt_pixels from = make(hills, 1, bits), p;
		nt_error error;
		assert_int_equal(nt_pixels_create(&p, SIDE, SIDE, 4, bits, &error), NT_OK);
		const size_t bytes = bits / 8;
		for (size_t i = 0; i < SIDE * SIDE; i++) {
			char *to = (char *)p.samples + 4 * bytes * i;
			memcpy(to, (char *)from.samples + 3 * bytes * i, 3 * bytes);
			memset(to + 3 * bytes, 255, bytes);
			if (i % SIDE < SIDE / 4)
				memset(to, 0, 4 * bytes);
		}
		nt_pixels_free(&from);
		const nt_normal_facts facts = facts_of(p);
		assert_true(facts.not_unit == 0 && facts.blue_below == 0);
		assert_int_equal(facts.green, NT_GREEN_UP);
	}
}

/* One in four pixels points into the surface: no mean has slopes then, of an image that is halved to be looked at
 * either. */
TEST(what_is_no_surface_says_nothing)
{
	static const uint32_t sides[][2] = {{SIDE, SIDE}, {1100, 100}};
	for (size_t s = 0; s < 2; s++)
		for (int holes = 0; holes < 2; holes++) {
			nt_pixels from = make(hills, 1, 8), p;
			nt_error error;
			assert_int_equal(nt_pixels_create(&p, sides[s][0], sides[s][1], 3, 8, &error), NT_OK);
			for (size_t i = 0; i < (size_t)p.width * p.height; i++) {
				const size_t x = i % p.width, y = i / p.width;
				uint8_t *to = (uint8_t *)p.samples + 3 * i;
				memcpy(to, (uint8_t *)from.samples + 3 * (y % SIDE * SIDE + x % SIDE), 3);
				if (holes && x % 2 && y % 2)
					to[2] = 0;
			}
			nt_pixels_free(&from);
			assert_int_equal(facts_of(p).green, holes ? NT_GREEN_UNKNOWN : NT_GREEN_UP);
		}
}

/* Vectors of half the length, whose slopes are those of a surface with green down, do not count. */
TEST(what_is_no_unit_vector_says_nothing)
{
	nt_pixels p = make(hills, 1, 8), down = make(hills, -1, 8);
	for (size_t i = 0; i < 3 * SIDE * SIDE / 2; i++)
		((uint8_t *)p.samples)[i] = (uint8_t)(64 + ((uint8_t *)down.samples)[i] / 2);
	nt_pixels_free(&down);
	const nt_normal_facts facts = facts_of(p);
	assert_int_equal(facts.green, NT_GREEN_UP);
	assert_int_equal(facts.blocks_down, 0);
}

TEST(examining_without_memory_is_an_error)
{
	nt_pixels p = make(hills, 1, 8);
	nt_normal_facts facts;
	nt_error error;
	fail_allocations_from(0);
	assert_int_equal(nt_examine_normals(&p, &facts, &error), NT_ERROR_MEMORY);
	assert_true(stop_failing_allocations());
	nt_pixels_free(&p);
}
