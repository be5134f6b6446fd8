/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "tangent/frames.h"

/* Two quads that meet at a right angle along the y axis: one in z = 0 (normal +z), one in x = 0 below
 * it (normal +x). Vertices of the edge are separate, as at a texture seam. */
static const float positions[8][3] = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0, 0}, {0, 0, -1},
	{0, 1, -1}, {0, 1, 0}};
static const uint8_t quads[2] = {4, 4};
static const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 8,
	.face_sizes = quads,
	.positions = &positions[0][0], .position_stride_bytes = 12};

static void make(const uint32_t *smoothing, float (*normals)[4])
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_corner_normals(&mesh, 8, smoothing, NULL, &scratch, normals), NMTAN_OK);
	nt_scratch_free(&scratch);
}

static void assert_near(const float *n, float x, float y, float z)
{
	assert_true(fabsf(n[0] - x) < 1e-6f && fabsf(n[1] - y) < 1e-6f && fabsf(n[2] - z) < 1e-6f);
}

/* Both corner angles are 90 degrees: the edge's normal is the bisector. */
TEST(smooth_normals_meet_across_separate_vertices)
{
	float n[8][4];
	const float h = sqrtf(0.5f);
	make(NULL, n);
	assert_near(n[0], 0, 0, 1);
	assert_near(n[1], h, 0, h);
	assert_near(n[4], h, 0, h);
	assert_near(n[2], h, 0, h);
	assert_near(n[7], h, 0, h);
	assert_near(n[5], 1, 0, 0);
}

TEST(groups_keep_apart_and_group_zero_is_flat)
{
	const uint32_t apart[2] = {1, 2}, flat[2] = {0, 0};
	const uint32_t *both[2] = {apart, flat};
	for (int i = 0; i < 2; i++) {
		float n[8][4];
		make(both[i], n);
		for (int c = 0; c < 4; c++)
			assert_near(n[c], 0, 0, 1);
		for (int c = 4; c < 8; c++)
			assert_near(n[c], 1, 0, 0);
	}
}

static void make_by_angle(double degrees, float (*normals)[4])
{
	uint32_t groups[8];
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_crease_groups(&mesh, 8, degrees, &scratch, groups), NMTAN_OK);
	assert_int_equal(nt_corner_normals(&mesh, 8, NULL, groups, &scratch, normals), NMTAN_OK);
	nt_scratch_free(&scratch);
}

/* They meet at 90 degrees. */
TEST(faces_that_meet_at_less_than_the_angle_share_a_normal)
{
	const float h = sqrtf(0.5f);
	for (int degrees = 0; degrees <= 180; degrees += 1) {
		const bool smooth = degrees > 90;
		float n[8][4];
		make_by_angle(degrees, n);
		assert_near(n[0], 0, 0, 1);
		assert_near(n[1], smooth ? h : 0, 0, smooth ? h : 1);
		assert_near(n[4], smooth ? h : 1, 0, smooth ? h : 0);
		assert_near(n[7], smooth ? h : 1, 0, smooth ? h : 0);
		assert_near(n[5], 1, 0, 0);
	}
}

/* Around the apex (0, 0, 1) of a pyramid over a square of half side 1, neighbours meet at 60 degrees: their normals are
 * (1, 0, 1) / sqrt 2 and (0, 1, 1) / sqrt 2, whose product is 1/2. A face that is missing leaves a fan, whose ends meet
 * through the others; one that is turned over meets both neighbours at 120 degrees and is alone. */
TEST(groups_are_joined_through_edges)
{
	static const float p[5][3] = {{0, 0, 1}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}};
	static const struct {
		uint32_t corners[12];
		size_t faces;
		double degrees;
		uint32_t groups[4]; /* of the apex in each face */
	} rows[] = {
		{{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}, 4, 61, {1, 1, 1, 1}},
		{{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1}, 4, 59, {1, 4, 7, 10}},
		{{0, 1, 2, 0, 2, 3, 0, 3, 4}, 3, 61, {1, 1, 1}},
		{{0, 1, 2, 0, 3, 4}, 2, 61, {1, 4}},                     /* opposite faces have no common edge */
		{{0, 1, 2, 0, 3, 2, 0, 3, 4}, 3, 61, {1, 4, 7}},         /* the middle one is turned over */
		{{0, 1, 2, 0, 2, 2, 0, 2, 3}, 3, 61, {1, 1, 1}},         /* one without area */
		{{0, 1, 2, 0, 2, 2, 0, 2, 3}, 3, 59, {1, 1, 1}},         /* which joins what it touches */
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		const nmtan_mesh m = {.struct_bytes = sizeof m, .face_count = rows[i].faces, .vertex_count = 5,
			.indices = rows[i].corners, .positions = &p[0][0], .position_stride_bytes = 12};
		uint32_t groups[12];
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		assert_int_equal(nt_crease_groups(&m, 3 * m.face_count, rows[i].degrees, &scratch, groups), NMTAN_OK);
		for (size_t f = 0; f < m.face_count; f++)
			if (groups[3 * f] != rows[i].groups[f])
				fail_msg("row %zu, face %zu: group %u", i, f, groups[3 * f]);
		nt_scratch_free(&scratch);
	}
}

/* A cube's corner: one face is cut into two triangles at it, which must not weigh twice. With angle weights
 * the normal is the diagonal (1,1,1)/sqrt 3. */
TEST(angle_weights_do_not_depend_on_the_cut)
{
	const float p[12][3] = {{0, 0, 0}, {0, -1, 0}, {-1, 0, 0}, /* z = 0, first half would be 45 */
		{0, 0, 0}, {0, 0, -1}, {0, -1, -1}, {0, 0, 0}, {0, -1, -1}, {0, -1, 0}, /* x = 0, cut */
		{0, 0, 0}, {-1, 0, 0}, {0, 0, -1}};                                    /* y = 0 */
	const nmtan_mesh cube = {.struct_bytes = sizeof cube, .face_count = 4, .vertex_count = 12,
		.positions = &p[0][0],
		.position_stride_bytes = 12};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	float n[12][4];
	assert_int_equal(nt_corner_normals(&cube, 12, NULL, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	const float d = fabsf(n[0][0]);
	assert_true(fabsf(d - 0.57735027f) < 1e-6f);
	for (int i = 0; i < 3; i++)
		assert_true(fabsf(fabsf(n[0][i]) - d) < 1e-6f);
}

TEST(faces_without_area_give_a_unit_vector)
{
	const float p[3][3] = {{1, 1, 1}, {1, 1, 1}, {2, 2, 2}};
	const nmtan_mesh sliver = {.struct_bytes = sizeof sliver, .face_count = 1, .vertex_count = 3,
		.positions = &p[0][0],
		.position_stride_bytes = 12};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	float n[3][4];
	assert_int_equal(nt_corner_normals(&sliver, 3, NULL, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	for (int c = 0; c < 3; c++)
		assert_near(n[c], 0, 0, 1);
}

/* The position of a corner of a face. */
static const float *corner_at(const nmtan_mesh *m, size_t corner)
{
	return m->positions + 3 * m->indices[corner];
}

/* The header's definition, by atan2 and over all pairs of corners: a's share of the sum at b's position. */
static void add_share(const nmtan_mesh *m, size_t first, size_t size, size_t k, const float *at, double sum[3])
{
	const float *p[4];
	double e[3], f[3], one[3], other[3], n[3], across[3];
	for (size_t i = 0; i < size; i++)
		p[i] = corner_at(m, first + i);
	if (memcmp(p[k], at, 12) != 0)
		return;
	for (int i = 0; i < 3; i++) {
		e[i] = (double)p[(k + 1) % size][i] - p[k][i];
		f[i] = (double)p[(k + size - 1) % size][i] - p[k][i];
		one[i] = (double)p[size == 3 ? 1 : 2][i] - p[0][i];
		other[i] = (double)p[size - 1][i] - p[size == 3 ? 0 : 1][i];
	}
	for (int i = 0; i < 3; i++) {
		const int y = (i + 1) % 3, z = (i + 2) % 3;
		n[i] = one[y] * other[z] - one[z] * other[y];
		across[i] = e[y] * f[z] - e[z] * f[y];
	}
	const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	const double angle = atan2(sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]),
		e[0] * f[0] + e[1] * f[1] + e[2] * f[2]);
	for (int i = 0; i < 3; i++)
		sum[i] += angle * n[i] / length;
}

/* More faces than are worked out together, of both sizes and several groups. */
TEST(many_faces_are_what_the_formula_says)
{
	enum { FACES = 150, VERTICES = 60 };
	float p[VERTICES][3];
	uint32_t indices[4 * FACES], smoothing[FACES];
	uint8_t sizes[FACES];
	uint64_t random = 1;
	size_t corners = 0;
	for (size_t i = 0; i < 3 * VERTICES; i++)
		p[i / 3][i % 3] =
			(float)((random = random * 6364136223846793005u + 1442695040888963407u) >> 48) / 65536;
	memcpy(p[VERTICES - 1], p[0], sizeof p[0]); /* one position, two vertices */
	for (size_t face = 0; face < FACES; face++) {
		sizes[face] = face % 3 ? 3 : 4;
		smoothing[face] = 1 + face / 7 % 3;
		for (size_t k = 0; k < sizes[face]; k++)
			indices[corners++] = (uint32_t)((face * 7 + k * 13 + face / 11) % VERTICES);
	}
	const nmtan_mesh m = {.struct_bytes = sizeof m, .face_count = FACES, .face_sizes = sizes,
		.vertex_count = VERTICES,
		.indices = indices, .positions = &p[0][0], .position_stride_bytes = 12};
	float n[4 * FACES][4];
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_corner_normals(&m, corners, smoothing, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	for (size_t face = 0, c = 0; face < FACES; face++)
		for (size_t k = 0; k < sizes[face]; k++, c++) {
			double sum[3] = {0, 0, 0};
			for (size_t other = 0, first = 0; other < FACES; first += sizes[other++])
				for (size_t i = 0; i < sizes[other] && smoothing[other] == smoothing[face]; i++)
					add_share(&m, first, sizes[other], i, corner_at(&m, c), sum);
			const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
			assert_near(n[c], (float)(sum[0] / length), (float)(sum[1] / length), (float)(sum[2] / length));
			assert_true(n[c][3] == 0.0f);
		}
}

/* A bumpy sheet of 10 x 10 quads, each triangle there twice, once reversed, from each corner in turn: at every position
 * the face normals cancel, and each corner has its own face's. */
TEST(where_faces_cancel_corners_have_their_faces)
{
	enum { N = 10, SIDE = N + 1, FACES = 4 * N * N };
	float p[SIDE * SIDE][3], n[3 * FACES][4];
	uint32_t indices[3 * FACES], (*const triangles)[3] = (uint32_t (*)[3])indices;
	for (int v = 0; v < SIDE * SIDE; v++) {
		const float x = (float)(v % SIDE) / N, y = (float)(v / SIDE) / N;
		memcpy(p[v], (float[3]){x, y, 0.1f * sinf(7 * x) * cosf(9 * y)}, sizeof p[v]);
	}
	for (uint32_t i = 0; i < N * N; i++) {
		const uint32_t a = i / N * SIDE + i % N, c = a + SIDE + 1;
		const uint32_t halves[2][3] = {{a, a + 1, c}, {a, c, c - 1}};
		for (uint32_t half = 0; half < 2; half++)
			for (uint32_t k = 0; k < 3; k++) {
				triangles[2 * i + half][k] = halves[half][k];
				triangles[FACES / 2 + 2 * i + half][(5 - k + i) % 3] = halves[half][k];
			}
	}
	const nmtan_mesh m = {.struct_bytes = sizeof m, .face_count = FACES, .vertex_count = SIDE * SIDE,
		.indices = indices, .positions = &p[0][0], .position_stride_bytes = 12};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_corner_normals(&m, 3 * FACES, NULL, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	for (size_t c = 0; c < 3 * FACES; c++) {
		double own[3] = {0, 0, 0};
		add_share(&m, c / 3 * 3, 3, c % 3, corner_at(&m, c), own);
		const double length = sqrt(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);
		assert_near(n[c], (float)(own[0] / length), (float)(own[1] / length), (float)(own[2] / length));
		assert_true(n[c][3] == 1.0f);
	}
}
