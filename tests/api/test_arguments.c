/* SPDX-License-Identifier: MIT */
/*
 * Every misuse of the API has its status.
 */
#include "test.h"
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include "nmtan.h"

static const float rows[4][8] = {{0, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 0, 1, 1, 0},
	{1, 1, 0, 0, 0, 1, 1, 1}, {0, 1, 0, 0, 0, 1, 0, 1}};
static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};

/* The same square as interleaved rows of position, normal and texture coordinates. */
static nmtan_mesh square(void)
{
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = 2, .vertex_count = 4,
		.indices = indices,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
}

static nmtan_status solve(const nmtan_mesh *mesh, const nmtan_options *options)
{
	float tangents[8][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	return nmtan_tangents(mesh, options, &output, NULL);
}

TEST(missing_arrays_are_argument_errors)
{
	float tangents[8][4];
	nmtan_output output = NMTAN_OUTPUT_INIT;
	nmtan_mesh mesh = square();
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_ERROR_ARGUMENT);
	output.tangents = &tangents[0][0];
	assert_int_equal(nmtan_tangents(NULL, NULL, &output, NULL), NMTAN_ERROR_ARGUMENT);
	assert_int_equal(nmtan_tangents(&mesh, NULL, NULL, NULL), NMTAN_ERROR_ARGUMENT);
	const float **const arrays[] = {&mesh.positions, &mesh.normals, &mesh.texcoords};
	for (size_t i = 0; i < 3; i++) {
		mesh = square();
		*arrays[i] = NULL;
		assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
	}
}

TEST(strides_must_hold_a_row_and_keep_alignment)
{
	nmtan_mesh mesh = square();
	assert_int_equal(solve(&mesh, NULL), NMTAN_OK);
	mesh.position_stride_bytes = 8;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
	mesh = square();
	mesh.texcoord_stride_bytes = 30;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
	/* the last row would begin where the sum comes round to, before the array */
	for (size_t i = 0; i < 3; i++) {
		mesh = square();
		size_t *const strides[] = {&mesh.position_stride_bytes, &mesh.normal_stride_bytes,
			&mesh.texcoord_stride_bytes};
		*strides[i] = SIZE_MAX - 31;
		assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
		*strides[i] = (size_t)PTRDIFF_MAX / 4 / 4 * 4 + 4;
		assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
	}
}

TEST(options_out_of_range_are_argument_errors)
{
	const nmtan_mesh mesh = square();
	nmtan_options wrong = NMTAN_OPTIONS_INIT;
	assert_int_equal(solve(&mesh, &wrong), NMTAN_OK);
	wrong.method = (nmtan_method)99;
	assert_int_equal(solve(&mesh, &wrong), NMTAN_ERROR_ARGUMENT);
	wrong.method = NMTAN_METHOD_MIKKTSPACE;
	wrong.repair = (nmtan_repair)2;
	assert_int_equal(solve(&mesh, &wrong), NMTAN_ERROR_ARGUMENT);
	wrong.repair = NMTAN_REPAIR_ON;
	const float degrees[] = {-1, 181, NAN, INFINITY};
	for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
		wrong.angular_threshold_degrees = degrees[i];
		assert_int_equal(solve(&mesh, &wrong), NMTAN_ERROR_ARGUMENT);
	}
	wrong.angular_threshold_degrees = 180;
	assert_int_equal(solve(&mesh, &wrong), NMTAN_OK);
}

TEST(stored_offset_must_be_finite)
{
	nmtan_stored_uv stored = NMTAN_STORED_UV_INIT;
	nmtan_mesh mesh = square();
	mesh.stored = &stored;
	assert_int_equal(solve(&mesh, NULL), NMTAN_OK);
	stored.v_offset = NAN;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
	stored.v_offset = -INFINITY;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_ARGUMENT);
}

TEST(faces_and_indices_are_checked)
{
	nmtan_mesh mesh = square();
	const uint32_t beyond[6] = {0, 1, 2, 0, 2, 4};
	mesh.indices = beyond;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_INDEX);
	mesh.indices = NULL;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_INDEX); /* 6 corners, 4 vertices */
	const uint8_t five[1] = {5}, quad[1] = {4};
	mesh.face_count = 1;
	mesh.face_sizes = five;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_FACE_SIZE);
	mesh.face_sizes = quad;
	assert_int_equal(solve(&mesh, NULL), NMTAN_OK);
	mesh.face_count = NMTAN_MAX_FACES + 1;
	assert_int_equal(solve(&mesh, NULL), NMTAN_ERROR_TOO_LARGE);
	mesh = square();
	mesh.face_count = 0;
	assert_int_equal(solve(&mesh, NULL), NMTAN_OK);
}

TEST(split_checks_its_arguments_too)
{
	const nmtan_mesh mesh = square();
	float tangents[6][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {-1, 0, 0, 1}, {1, 0, 0, 1},
		{1, 0, 0, 1}};
	uint32_t out[6], sources[1];
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out};
	assert_int_equal(nmtan_split(&mesh, NULL, NULL, &split), NMTAN_ERROR_ARGUMENT);
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_ERROR_CAPACITY);
	assert_int_equal(split.source_count, 1);
	split.source_capacity = 1;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_ERROR_ARGUMENT);
	split.sources = sources;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_OK);
	assert_int_equal(split.source_count, 1);
	assert_int_equal(sources[0], 0);
	assert_int_equal(out[3], 4);
}

TEST(vertex_tangents_check_their_arguments_too)
{
	const nmtan_mesh mesh = square();
	float tangents[4][4];
	uint32_t out[6], sources[1];
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out,
		.vertex_tangents = tangents[0]};
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_OK);
	assert_int_equal(nmtan_vertex_tangents(NULL, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, NULL, NULL), NMTAN_ERROR_ARGUMENT);
	split.vertex_tangents = NULL;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
	split.vertex_tangents = tangents[0];
	split.source_capacity = 1;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
	split.sources = sources;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &split, NULL), NMTAN_OK);
	nmtan_mesh without = square();
	without.texcoords = NULL;
	assert_int_equal(nmtan_vertex_tangents(&without, NULL, &split, NULL), NMTAN_ERROR_ARGUMENT);
}

/* Rows that nmtan_split() reads only for vertices without corners have to be sound all the same. */
TEST(split_checks_the_stride_of_normals)
{
	const float tangents[6][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1},
		{1, 0, 0, 1}};
	float vertex_tangents[4][4];
	uint32_t out[6];
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out,
		.vertex_tangents = &vertex_tangents[0][0]};
	nmtan_mesh mesh = square();
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_OK);
	mesh.normal_stride_bytes = 8;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_ERROR_ARGUMENT);
	mesh.normals = NULL;
	mesh.normal_stride_bytes = 0;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_ERROR_ARGUMENT);
	split.vertex_tangents = NULL;
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_OK);
}

/* An allocator that gives out `left` blocks and then none; it knows how much is out. */
typedef struct limited {
	size_t left, bytes_out;
} limited;

static void *limited_allocate(void *user, size_t size)
{
	limited *l = user;
	if (l->left == 0)
		return NULL;
	l->left--;
	l->bytes_out += size;
	return malloc(size);
}

static void limited_release(void *user, void *block, size_t size)
{
	((limited *)user)->bytes_out -= size;
	free(block);
}

/* A square's arrays lie on the stack, so there are many: they take blocks from the allocator. */
TEST(exhausted_memory_is_told_and_nothing_leaks)
{
	enum { SQUARES = 5000 };
	static unsigned many[SQUARES][6];
	static float tangents[6 * SQUARES][4];
	for (size_t i = 0; i < SQUARES; i++)
		memcpy(many[i], indices, sizeof many[i]);
	nmtan_mesh mesh = square();
	mesh.face_count = 2 * SQUARES;
	mesh.indices = many[0];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		nmtan_status status = NMTAN_ERROR_MEMORY;
		for (size_t blocks = 0; status != NMTAN_OK; blocks++) {
			limited l = {.left = blocks};
			const nmtan_allocator allocator = {limited_allocate, limited_release, &l};
			const nmtan_options options = {.struct_bytes = sizeof options,
				.method = (nmtan_method)method,
				.allocator = &allocator};
			status = nmtan_tangents(&mesh, &options, &output, NULL);
			assert_int_equal(l.bytes_out, 0);
			assert_true(status == NMTAN_OK || status == NMTAN_ERROR_MEMORY);
			assert_true(blocks > 0 || status == NMTAN_ERROR_MEMORY);
		}
	}
}

/* An allocator that knows the thread it belongs to. */
typedef struct owned {
	pthread_t thread;
	size_t calls;
	atomic_size_t by_others;
} owned;

static void *owned_allocate(void *user, size_t size)
{
	owned *o = user;
	if (pthread_equal(o->thread, pthread_self()))
		o->calls++;
	else
		o->by_others++;
	return malloc(size);
}

static void owned_release(void *user, void *block, size_t size)
{
	(void)size;
	owned *o = user;
	o->by_others += !pthread_equal(o->thread, pthread_self());
	free(block);
}

/* A mesh that is large enough for several threads: 20 000 triangles, every third one mirrored. */
TEST(allocator_is_called_by_the_calling_thread_alone)
{
	enum { TRIANGLES = 20000, CORNERS = 3 * TRIANGLES };
	float (*p)[8] = calloc(CORNERS, sizeof *p), (*tangents)[4] = malloc(2 * CORNERS * sizeof *tangents);
	uint32_t *out = malloc(CORNERS * sizeof *out), *sources = malloc(CORNERS * sizeof *sources);
	for (size_t c = 0; c < CORNERS; c++) {
		const float x = c % 3 == 1, y = c % 3 == 2;
		const float row[8] = {(float)(c / 30) + x, y, 0, 0, 0, 1, c / 3 % 3 ? x : -x, y};
		memcpy(p[c], row, sizeof row);
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = TRIANGLES, .vertex_count = CORNERS,
		.positions = p[0], .position_stride_bytes = 32, .normals = p[0] + 3, .normal_stride_bytes = 32,
		.texcoords = p[0] + 6, .texcoord_stride_bytes = 32};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out, .sources = sources,
		.source_capacity = CORNERS, .vertex_tangents = tangents[0]};
	owned o = {.thread = pthread_self()};
	const nmtan_allocator allocator = {owned_allocate, owned_release, &o};
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		const nmtan_options options = {.struct_bytes = sizeof options, .method = (nmtan_method)method,
			.threads = 4, .allocator = &allocator};
		assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
		assert_int_equal(nmtan_vertex_tangents(&mesh, &options, &split, NULL), NMTAN_OK);
	}
	assert_true(o.calls > 0);
	assert_int_equal(o.by_others, 0);
	free(p);
	free(tangents);
	free(out);
	free(sources);
}

/* A workspace keeps its memory from call to call and gives it back at its end. */
TEST(workspace_is_reused_and_returned)
{
	const nmtan_mesh mesh = square();
	limited l = {.left = 100};
	const nmtan_allocator allocator = {limited_allocate, limited_release, &l};
	nmtan_workspace *workspace = nmtan_workspace_create(&allocator);
	assert_non_null(workspace);
	const nmtan_options options = {.struct_bytes = sizeof options, .workspace = workspace};
	assert_int_equal(solve(&mesh, &options), NMTAN_OK);
	const size_t left = l.left;
	for (int i = 0; i < 5; i++)
		assert_int_equal(solve(&mesh, &options), NMTAN_OK);
	assert_int_equal(l.left, left);
	nmtan_workspace_destroy(workspace);
	nmtan_workspace_destroy(NULL);
	assert_int_equal(l.bytes_out, 0);
}

TEST(statuses_have_texts)
{
	for (int status = NMTAN_OK; status <= NMTAN_ERROR_CAPACITY; status++)
		assert_string_not_equal(nmtan_status_text((nmtan_status)status), "unknown status");
	assert_string_equal(nmtan_status_text((nmtan_status)1000), "unknown status");
	assert_string_equal(nmtan_status_text((nmtan_status)(NMTAN_ERROR_CAPACITY + 1)), "unknown status");
	assert_string_equal(nmtan_version(), NMTAN_VERSION_STRING);
}
