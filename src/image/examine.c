/* SPDX-License-Identifier: MIT */
/*
 * Facts of normal maps: see image.h.
 *
 * Which way is green: the map of a surface h has the slopes p = -x/z = dh/du and, if green is up, q = y/z = dh/dv, with
 * rows counted down as glTF's v is. Both mixed derivatives are then one: dp/dv = dq/du. If green is down, q has the
 * other sign, and they are opposite. So the correlation of the two is near 1 for one convention and near -1 for the
 * other; rounding, painting and seams bring it nearer to 0. A surface without mixed derivatives (straight grooves along
 * the axes, bricks without corners) has only noise there.
 *
 * A pixel counts where it and its neighbours are unit vectors that look out of the surface and lie close together:
 * padding and the borders of islands do not. The image is cut into blocks; a verdict needs many of them, and most of
 * their weight, to agree. And it is asked at several sizes, each half of the one before. Most of those that have enough
 * to tell must say the same and none the opposite: large forms veto what a fine grain says that was painted over them
 * (tinyrenderer's african head, the rivets of DamagedHelmet). Then the map is mixed, as it is if a sixth of its blocks
 * say up and as many down (fewer are rings around what was painted, and streaks of padding), and is left as it is.
 */
#include "image/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

enum { MOST_SIDE = 1024, LEAST_SIDE = 48, BLOCKS = NT_GREEN_BLOCKS, LEAST_BLOCKS = 12, LEAST_MIXED = 24 };

/* Tuned on maps of known heights and on public ones: make bench, "green". */
static const double least_correlation = 0.2, least_agreement = 0.75;

/* A curvature is a difference over two pixels. */
static const double least_curvature = 0.004;

/* Normals that point less out of the surface than this have no reliable slope; neighbours differ by less than that. */
static const float least_z = 0.2f, most_jump = 0.5f;

/* A slope of five levels of 8 bits. */
static const float most_flat = 0.04f;

/* The map at one size. */
typedef struct slopes {
	size_t width, height;
	float (*rows)[3]; /* [height][width] p, q, and 1 where they count, else 0 */
} slopes;

static bool read_normal(const nt_pixels *p, size_t x, size_t y, float n[3])
{
	const size_t i = (y * p->width + x) * p->channels;
	const uint8_t *narrow = p->samples;
	const uint16_t *wide = p->samples;
	const float scale = 2.0f / (float)((1u << p->bits) - 1);
	for (int c = 0; c < 3; c++)
		n[c] = (float)(p->bits == 8 ? narrow[i + c] : wide[i + c]) * scale - 1;
	return p->channels == 3 || (p->bits == 8 ? narrow[i + 3] != 0 : wide[i + 3] != 0);
}

/* ---- pixel by pixel ---- */

typedef struct tally {
	size_t counted, not_unit, blue_below, sloped, banded;
} tally;

/* Runs of equal pixels between steps of one level, which is what rounding makes of a slope. */
static void count_bands(const nt_pixels *p, size_t y, tally *t)
{
	enum { LEAST_RUN = 6 };
	const uint8_t *row = (const uint8_t *)p->samples + y * p->width * p->channels;
	const size_t step = p->channels;
	bool after_step = false;
	for (size_t begin = 0, x = 1; x <= p->width; x++) {
		const uint8_t *now = row + begin * step, *next = row + x * step;
		if (x < p->width && now[0] == next[0] && now[1] == next[1])
			continue;
		const bool before_step = x < p->width && abs(now[0] - next[0]) <= 1 && abs(now[1] - next[1]) <= 1;
		const size_t run = x - begin;
		if (after_step || before_step || now[0] != 128 || now[1] != 128)
			t->sloped += run;
		if (after_step && before_step && run >= LEAST_RUN)
			t->banded += run;
		after_step = before_step;
		begin = x;
	}
}

static bool is_constant(const nt_pixels *p)
{
	const size_t step = p->channels * (p->bits / 8), count = (size_t)p->width * p->height;
	const char *samples = p->samples;
	return memcmp(samples, samples + step, (count - 1) * step) == 0; /* each is the next one */
}

static void count_pixels(const nt_pixels *p, tally *t)
{
	for (size_t y = 0; y < p->height; y++) {
		for (size_t x = 0; x < p->width; x++) {
			float n[3];
			if (!read_normal(p, x, y, n))
				continue;
			const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
			t->counted++;
			const bool is_unit = fabsf(length - 1) <= 0.1f;
			t->not_unit += !is_unit;
			t->blue_below += is_unit && n[2] < 0;
		}
		if (p->bits == 8)
			count_bands(p, y, t);
	}
}

/* ---- green ---- */

static bool is_surface(const float n[3])
{
	const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	return fabsf(length - 1) <= 0.15f && n[2] >= least_z * length;
}

/* One pixel of the averaged map: of `by` x `by`, all of which have to be of the surface. */
static void average(const nt_pixels *p, size_t x, size_t y, size_t by, float slope[3])
{
	float sum[3] = {0, 0, 0};
	memset(slope, 0, 3 * sizeof *slope);
	for (size_t j = y * by; j < (y + 1) * by; j++)
		for (size_t i = x * by; i < (x + 1) * by; i++) {
			float n[3];
			if (!read_normal(p, i, j, n) || !is_surface(n))
				return;
			for (int c = 0; c < 3; c++)
				sum[c] += n[c];
		}
	slope[0] = -sum[0] / sum[2];
	slope[1] = sum[1] / sum[2];
	slope[2] = 1;
}

static nt_status make_slopes(const nt_pixels *p, size_t by, slopes *s, nt_error *error)
{
	s->width = p->width / by;
	s->height = p->height / by;
	s->rows = nt_alloc(s->width * s->height, sizeof *s->rows);
	if (!s->rows)
		return nt_fail_memory(error);
	for (size_t y = 0; y < s->height; y++)
		for (size_t x = 0; x < s->width; x++)
			average(p, x, y, by, s->rows[y * s->width + x]);
	return NT_OK;
}

/* To half of the size. */
static void halve(slopes *s)
{
	const size_t width = s->width / 2, height = s->height / 2;
	for (size_t y = 0; y < height; y++)
		for (size_t x = 0; x < width; x++) {
			const float *a = s->rows[2 * y * s->width + 2 * x], *b = a + 3 * s->width;
			float mean[3] = {0, 0, 0};
			if (a[2] != 0 && a[5] != 0 && b[2] != 0 && b[5] != 0) {
				mean[0] = (a[0] + a[3] + b[0] + b[3]) / 4;
				mean[1] = (a[1] + a[4] + b[1] + b[4]) / 4;
				mean[2] = 1;
			}
			memcpy(s->rows[y * width + x], mean, sizeof mean);
		}
	s->width = width;
	s->height = height;
}

static bool are_close(const float a[3], const float b[3])
{
	return b[2] != 0 && fabsf(a[0] - b[0]) < most_jump && fabsf(a[1] - b[1]) < most_jump;
}

/* Sums of products of dp/dv and dq/du over one block. */
typedef struct block {
	double ab, aa, bb;
	size_t count;
} block;

static block sum_block(const slopes *s, size_t column, size_t row)
{
	block b = {0};
	const size_t x_end = (column + 1) * s->width / BLOCKS, y_end = (row + 1) * s->height / BLOCKS;
	for (size_t y = row * s->height / BLOCKS; y < y_end; y++)
		for (size_t x = column * s->width / BLOCKS; x < x_end; x++) {
			if (x == 0 || y == 0 || x + 1 >= s->width || y + 1 >= s->height)
				continue;
			const float *here = s->rows[y * s->width + x], *left = here - 3, *right = here + 3,
				    *above = here - 3 * s->width, *below = here + 3 * s->width;
			if (here[2] == 0 || !are_close(here, left) || !are_close(here, right) ||
				!are_close(here, above) ||
				!are_close(here, below))
				continue;
			const double dp = (double)(below[0] - above[0]), dq = (double)(right[1] - left[1]);
			b.ab += dp * dq;
			b.aa += dp * dp;
			b.bb += dq * dq;
			b.count++;
		}
	return b;
}

/* The evidence at one size. */
typedef struct voice {
	double correlation, agreement;
	size_t blocks;
} voice;

/* The evidence of each block at all sizes: the sum of its correlations times their weights, and of these. */
typedef struct block_sums {
	double votes[BLOCKS * BLOCKS], weights[BLOCKS * BLOCKS];
} block_sums;

static voice ask(const slopes *s, block_sums *sums)
{
	double weight = 0, positive = 0, sum = 0;
	voice v = {0};
	for (size_t row = 0; row < BLOCKS; row++)
		for (size_t column = 0; column < BLOCKS; column++) {
			const block b = sum_block(s, column, row);
			if (b.count < 9 || sqrt(sqrt(b.aa * b.bb) / (double)b.count) < least_curvature)
				continue;
			/* a few sharp edges must not outvote the rest */
			const double w = sqrt(sqrt(b.aa * b.bb) * (double)b.count);
			sums->votes[row * BLOCKS + column] += w * b.ab / sqrt(b.aa * b.bb);
			sums->weights[row * BLOCKS + column] += w;
			weight += w;
			positive += b.ab > 0 ? w : 0;
			sum += w * b.ab / sqrt(b.aa * b.bb);
			v.blocks++;
		}
	if (weight > 0) {
		v.correlation = sum / weight;
		v.agreement = (sum > 0 ? positive : weight - positive) / weight;
	}
	return v;
}

static bool is_sure(const voice *v)
{
	return v->blocks >= LEAST_BLOCKS && fabs(v->correlation) >= least_correlation &&
		v->agreement >= least_agreement;
}

/* Noise makes all correlations small, but not of two signs. */
static bool supports(const voice *v)
{
	return is_sure(v) || (v->blocks >= LEAST_BLOCKS && fabs(v->correlation) >= least_correlation / 2 &&
				     v->agreement >= 0.9);
}

/* Asks at every size. The figures are those of the size that is surest. */
static void tell_green(slopes *s, nt_normal_facts *facts)
{
	block_sums sums = {{0}, {0}};
	size_t asked = 0, supporting[2] = {0, 0}, sure[2] = {0, 0}; /* up, down */
	for (; s->width >= LEAST_SIDE && s->height >= LEAST_SIDE; halve(s)) {
		const voice v = ask(s, &sums);
		asked += v.blocks >= LEAST_BLOCKS;
		supporting[v.correlation < 0] += supports(&v);
		sure[v.correlation < 0] += is_sure(&v);
		if (v.blocks >= LEAST_BLOCKS && fabs(v.correlation) > fabs(facts->correlation)) {
			facts->correlation = v.correlation;
			facts->agreement = v.agreement;
		}
	}
	for (size_t i = 0; i < BLOCKS * BLOCKS; i++) {
		const double vote = sums.weights[i] > 0 ? sums.votes[i] / sums.weights[i] : 0;
		facts->votes[i] = (int8_t)lrint(100 * vote);
		facts->blocks_up += vote >= least_correlation;
		facts->blocks_down += vote <= -least_correlation;
	}
	if (sure[0] && !sure[1] && 2 * supporting[0] > asked)
		facts->green = NT_GREEN_UP;
	else if (sure[1] && !sure[0] && 2 * supporting[1] > asked)
		facts->green = NT_GREEN_DOWN;
	else if (sure[1] || (facts->blocks_up >= LEAST_MIXED && facts->blocks_down >= LEAST_MIXED))
		facts->green = NT_GREEN_MIXED;
}

nt_status nt_examine_normals(const nt_pixels *pixels, nt_normal_facts *facts, nt_error *error)
{
	*facts = (nt_normal_facts){0};
	if (pixels->channels < 3)
		return NT_OK;
	tally t = {0};
	slopes s;
	facts->constant = is_constant(pixels);
	if (facts->constant) {
		float n[3];
		read_normal(pixels, 0, 0, n);
		facts->tilted = !(fabsf(n[0]) <= most_flat * n[2] && fabsf(n[1]) <= most_flat * n[2]);
		return NT_OK;
	}
	count_pixels(pixels, &t);
	const double counted = t.counted ? (double)t.counted : 1;
	facts->not_unit = (double)t.not_unit / counted;
	facts->blue_below = (double)t.blue_below / counted;
	facts->banded = t.sloped ? (double)t.banded / (double)t.sloped : 0;
	facts->object_space = facts->not_unit < 0.3 && facts->blue_below > 0.2;
	if (facts->object_space)
		return NT_OK;
	const size_t longer = pixels->width > pixels->height ? pixels->width : pixels->height;
	const nt_status status = make_slopes(pixels, (longer + MOST_SIDE - 1) / MOST_SIDE, &s, error);
	if (status)
		return status;
	tell_green(&s, facts);
	free(s.rows);
	return NT_OK;
}

nt_status nt_examine_image(const unsigned char *bytes, size_t size, nt_normal_facts *facts, nt_error *error)
{
	nt_pixels pixels;
	*facts = (nt_normal_facts){0};
	nt_status status = nt_image_is_grey(bytes, size, &facts->heights, error);
	if (status || facts->heights)
		return status;
	status = nt_image_decode(bytes, size, &pixels, error);
	if (!status)
		status = nt_examine_normals(&pixels, facts, error);
	facts->srgb = pixels.srgb;
	facts->lossy = pixels.lossy;
	nt_pixels_free(&pixels);
	return status;
}
