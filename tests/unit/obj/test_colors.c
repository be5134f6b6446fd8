/* SPDX-License-Identifier: MIT */
/*
 * Many colours in comments; tests/cli/texts.tsv has few.
 */
#include "obj_file.h"

#include <math.h>

/* Findings of nonsense do not grow with it. */
TEST(many_blocks_are_few_findings)
{
	enum { COUNT = 1000 };
	char *text = malloc(COUNT * 32 + 64), *to = text;
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "v %d 0 0\n#MRGB zz\n#MRGB 0\n", i);
	sprintf(to, "f 1 2 3\n");
	reading r;
	only_mesh(&r, text);
	assert_int_equal(r.scene.findings.count, 3);
	close_reading(&r);
	free(text);
}

/* A file of several chunks, whose colours stand in other chunks than their vertices. */
TEST(colors_reach_over_chunks)
{
	enum { COUNT = 150000, OF_LINE = 64 };
	char *text = malloc((size_t)COUNT * 64), *to = text;
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "v %d %d 0.000001\n", i, i % 7);
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "%sff%06x%s", i % OF_LINE ? "" : "#MRGB ", (unsigned)i,
			i % OF_LINE == OF_LINE - 1 ? "\n" : "");
	to += sprintf(to, "\n");
	for (int i = 1; i + 2 <= COUNT; i++)
		to += sprintf(to, "f %d %d %d\n", i, i + 1, i + 2);
	for (unsigned threads = 1; threads <= 4; threads += 3) {
		reading r;
		open_bytes(&r, text, (size_t)(to - text), threads);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.findings.count, 0);
		for (size_t i = 0; i < COUNT; i++) {
			const float expected[] = {(float)(i >> 16), (float)(i >> 8 & 255), (float)(i & 255)};
			for (size_t k = 0; k < 3; k++) {
				const float c = expected[k] / 255;
				const float linear = c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
				assert_true(fabsf(r.scene.meshes[0].colors[4 * i + k] - linear) < 1e-5f);
			}
		}
		close_reading(&r);
	}
	free(text);
}
