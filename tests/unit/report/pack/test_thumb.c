/* SPDX-License-Identifier: MIT */
/*
 * Thumbnails: where islands come to lie, by hand.
 */
#include "test.h"

#include <math.h>
#include "report/pack/thumb.h"

/* A square of u and v from 2 to 4, and a mirrored one beside it from 4 to 6. */
static float squares[] = {2, 2, 4, 2, 4, 4, 2, 4, 6, 2, 4, 2, 4, 4, 6, 4};
static uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
static int8_t orientation[] = {1, 1, -1, -1};
static uint32_t islands[] = {0, 0, 1, 1};

static nt_report_geometry two_squares(void)
{
	return (nt_report_geometry){.vertex_count = 8, .triangle_count = 4, .texcoords = squares, .indices = indices,
		.orientation = orientation, .islands = islands};
}

static void draw(const nt_report_geometry *g, bool v_down, nt_buffer paths[2])
{
	paths[0] = paths[1] = (nt_buffer){0};
	assert_int_equal(nt_thumb(g, v_down, paths), NT_OK);
}

/* The extent of a path of "M10 20 30 40 ...z". */
static void assert_extent(const nt_buffer *path, long x0, long y0, long x1, long y1)
{
	long low[2] = {1000, 1000}, high[2] = {-1000, -1000};
	size_t count = 0;
	assert_non_null(path->data);
	for (const char *at = path->data; *at;) {
		if (*at == 'M' || *at == 'z' || *at == ' ') {
			at++;
			continue;
		}
		char *end;
		const long value = strtol(at, &end, 10);
		assert_true(end > at);
		at = end;
		low[count % 2] = value < low[count % 2] ? value : low[count % 2];
		high[count % 2] = value > high[count % 2] ? value : high[count % 2];
		count++;
	}
	const long expected[] = {x0, y0, x1, y1}, found[] = {low[0], low[1], high[0], high[1]};
	for (int i = 0; i < 4; i++)
		assert_int_equal(found[i], expected[i]);
}

/* The layout is 4 by 2: as wide as the picture, and in its middle. */
TEST(layout_fills_the_picture)
{
	const nt_report_geometry g = two_squares();
	nt_buffer paths[2];
	draw(&g, true, paths);
	assert_extent(&paths[0], 0, 20, 104, 124);
	assert_extent(&paths[1], 104, 20, 208, 124);
	nt_buffer_free(&paths[0]);
	nt_buffer_free(&paths[1]);
}

/* The corner of one triangle with the largest v is above where v points up. */
TEST(v_points_up_or_down)
{
	float corner[] = {0, 0, 1, 0, 0, 1};
	uint32_t one[] = {0, 1, 2};
	int8_t plain[] = {1};
	const nt_report_geometry g = {.vertex_count = 3, .triangle_count = 1, .texcoords = corner,
		.indices = one, .orientation = plain};
	nt_buffer paths[2];
	for (int v_down = 0; v_down < 2; v_down++) {
		draw(&g, v_down, paths);
		assert_non_null(strstr(paths[0].data, v_down ? "32 144" : "32 0"));
		assert_null(strstr(paths[0].data, v_down ? "176 144" : "176 0"));
		nt_buffer_free(&paths[0]);
		assert_null(paths[1].data);
	}
}

TEST(nothing_to_draw_is_nothing)
{
	nt_buffer paths[2];
	nt_report_geometry g = two_squares();
	g.texcoords = NULL;
	draw(&g, false, paths);
	assert_null(paths[0].data);
	/* an island that is a point beside another one */
	float far[] = {0, 0, 1e-6f, 0, 0, 1e-6f, 1, 1, 2, 1, 1, 2};
	uint32_t two[] = {0, 1, 2, 3, 4, 5}, apart[] = {0, 1};
	int8_t plain[] = {1, 1};
	g = (nt_report_geometry){.vertex_count = 6, .triangle_count = 2, .texcoords = far, .indices = two,
		.orientation = plain,
		.islands = apart};
	draw(&g, false, paths);
	assert_int_equal(strchr(paths[0].data, 'M') - paths[0].data, 0);
	assert_null(strchr(paths[0].data + 1, 'M'));
	nt_buffer_free(&paths[0]);
}
