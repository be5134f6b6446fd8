/* SPDX-License-Identifier: MIT */
/*
 * How often the convention of a normal map's green channel is told, and how often wrongly: maps of known surfaces in
 * both conventions, and any images that are named as arguments, of which only the verdict is printed.
 *
 *     green [IMAGE...]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "file/input.h"
#include "file/path.h"
#include "image/image.h"

enum { SIDE = 256, FAMILIES = 5, PER_FAMILY = 20 };

static const char *const names[FAMILIES] = {"hills", "rivets", "stones", "grain", "grooves"};

static uint32_t seed;

static double draw(void)
{
	seed = seed * 1664525 + 1013904223;
	return (double)(seed >> 8) / (1 << 24);
}

/* Sums of waves of random directions, which tile. */
static void hills(double *h, int waves, int shortest)
{
	for (int w = 0; w < waves; w++) {
		const double fx = floor((draw() * 2 - 1) * shortest), fy = floor((draw() * 2 - 1) * shortest),
			phase = draw() * 6.28,
			     amount = 1 / (1 + fx * fx + fy * fy);
		for (int i = 0; i < SIDE * SIDE; i++)
			h[i] += amount * sin(6.283185307179586 * (fx * (i % SIDE) + fy * (i / SIDE)) / SIDE + phase);
	}
}

/* Domes on a plane; or their upper envelope, as pebbles lie. */
static void domes(double *h, int count, bool envelope)
{
	for (int d = 0; d < count; d++) {
		const double cx = draw() * SIDE, cy = draw() * SIDE, radius = 6 + draw() * 24;
		for (int i = 0; i < SIDE * SIDE; i++) {
			const double dx = i % SIDE - cx, dy = i / SIDE - cy, rest = radius * radius - dx * dx - dy * dy;
			const double z = rest > 0 ? sqrt(rest) / SIDE : 0;
			h[i] = envelope ? fmax(h[i], z) : h[i] + 0.3 * z;
		}
	}
}

static void make_heights(double *h, int family)
{
	memset(h, 0, SIDE * SIDE * sizeof *h);
	if (family == 0)
		hills(h, 24, 12);
	else if (family == 1)
		domes(h, 30, false);
	else if (family == 2)
		domes(h, 200, true);
	else if (family == 3)
		hills(h, 60, 60);
	else /* no mixed derivatives: nothing can be told */
		for (int i = 0; i < SIDE * SIDE; i++)
			h[i] = sin(i % SIDE * 0.3) + cos(i / SIDE * 0.2);
}

/* A normal map of 8 bits, with noise as of painting or compression. */
static nt_pixels make_map(int family, bool down, double noise)
{
	static double h[SIDE * SIDE];
	nt_pixels heights, normals;
	nt_error error;
	double least = INFINITY, most = -INFINITY;
	make_heights(h, family);
	for (int i = 0; i < SIDE * SIDE; i++) {
		least = fmin(least, h[i]);
		most = fmax(most, h[i]);
	}
	if (nt_pixels_create(&heights, SIDE, SIDE, 1, 16, &error))
		exit(4);
	for (int i = 0; i < SIDE * SIDE; i++)
		((uint16_t *)heights.samples)[i] = (uint16_t)((h[i] - least) / (most - least) * 65535);
	if (nt_heights_to_normals(&heights, 0.02 + draw() * 0.05, false, &normals, &error))
		exit(4);
	uint16_t *wide = normals.samples;
	uint8_t *narrow = normals.samples;
	for (int i = 0; i < SIDE * SIDE * 3; i++) {
		const double value = wide[i] / 257.0 + noise * (draw() + draw() + draw() - 1.5);
		narrow[i] = (uint8_t)fmin(fmax(down && i % 3 == 1 ? 255 - value : value, 0), 255);
	}
	normals.bits = 8;
	nt_pixels_free(&heights);
	return normals;
}

static void synthetic(void)
{
	size_t found_all = 0, wrong_all = 0, down_all = 0;
	printf("%-10s %5s %9s %10s %11s %7s\n", "surface", "maps", "down told", "up told", "abstained", "wrong");
	for (int family = 0; family < FAMILIES; family++) {
		size_t counts[2][4] = {{0}};
		for (int i = 0; i < 2 * PER_FAMILY; i++) {
			const bool down = i & 1;
			nt_normal_facts facts;
			nt_error error;
			seed = (uint32_t)(family * 1000 + i / 2); /* the same surface in both conventions */
			nt_pixels map = make_map(family, down, (i / 2 % 4) * 1.5);
			if (nt_examine_normals(&map, &facts, &error))
				exit(4);
			counts[down][facts.green]++;
			nt_pixels_free(&map);
		}
		const size_t wrong = counts[0][NT_GREEN_DOWN] + counts[1][NT_GREEN_UP];
		printf("%-10s %5d %6zu/%d %7zu/%d %11zu %7zu\n", names[family], 2 * PER_FAMILY,
			counts[1][NT_GREEN_DOWN], PER_FAMILY,
			counts[0][NT_GREEN_UP], PER_FAMILY,
			counts[0][NT_GREEN_UNKNOWN] + counts[1][NT_GREEN_UNKNOWN] + counts[0][NT_GREEN_MIXED] +
				counts[1][NT_GREEN_MIXED],
			wrong);
		wrong_all += wrong;
		if (family < FAMILIES - 1) {
			found_all += counts[1][NT_GREEN_DOWN];
			down_all += PER_FAMILY;
		}
	}
	printf("green down: recall %.0f %% (grooves aside, of which nothing can be told), false alarms and "
		"misses told wrongly %zu\n",
		100.0 * (double)found_all / (double)down_all, wrong_all);
}

static void real(const char *path)
{
	static const char *const verdicts[] = {"not told", "up", "down", "mixed"};
	nt_file file;
	nt_error error;
	nt_normal_facts facts;
	nt_status status = nt_file_open(&file, path, NT_NAMED_BY_USER, &error);
	if (!status) {
		status = nt_examine_image(file.data, file.size, &facts, &error);
		nt_file_close(&file);
	}
	if (status)
		printf("%-48s %s\n", nt_last_part(path), error.message);
	else
		printf("%-48s %-9s correlation %5.2f, agreement %4.2f, blocks %3zu up, %3zu down\n", nt_last_part(path),
			verdicts[facts.green], facts.correlation, facts.agreement, facts.blocks_up, facts.blocks_down);
}

int main(int argc, char **argv)
{
	synthetic();
	for (int i = 1; i < argc; i++)
		real(argv[i]);
	return 0;
}
