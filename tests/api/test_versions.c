/* SPDX-License-Identifier: MIT */
/*
 * Callers that were compiled with another version of nmtan.h: older ones pass smaller structs, newer ones
 * larger structs. A member that an older header did not have is simulated by a size that ends before it.
 */
#include "test.h"
#include <stdbool.h>
#include "nmtan.h"

/* Two triangles, the second mirrored. */
static const float rows[6][8] = {{0, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 0, 1, 1, 0}, {1, 1, 0, 0, 0, 1, 1, 1},
	{2, 0, 0, 0, 0, 1, 0, 0}, {3, 0, 0, 0, 0, 1, -1, 0}, {3, 1, 0, 0, 0, 1, -1, 1}};

/* Everything a call takes, each with a tail that a newer header might have. */
#define WITH_TAIL(type, name) \
	struct { \
		type name; \
		size_t tail[2]; \
	} name

typedef struct call {
	WITH_TAIL(nmtan_stored_uv, stored);
	WITH_TAIL(nmtan_mesh, mesh);
	WITH_TAIL(nmtan_timing, timing);
	WITH_TAIL(nmtan_options, options);
	WITH_TAIL(nmtan_output, output);
	WITH_TAIL(nmtan_split_output, split);
	WITH_TAIL(nmtan_counts, counts);
	float tangents[6][4], vertex_tangents[12][4];
	uint32_t indices[6], sources[6];
} call;

static void call_init(call *c)
{
	memset(c, 0, sizeof *c);
	c->stored.stored.struct_bytes = sizeof c->stored.stored;
	c->mesh.mesh = (nmtan_mesh){.struct_bytes = sizeof c->mesh.mesh, .face_count = 2, .vertex_count = 6,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32,
		.stored = &c->stored.stored};
	c->timing.timing.struct_bytes = sizeof c->timing.timing;
	c->options.options = (nmtan_options){.struct_bytes = sizeof c->options.options, .threads = 1,
		.timing = &c->timing.timing};
	c->output.output = (nmtan_output){.struct_bytes = sizeof c->output.output,
		.tangents = &c->tangents[0][0]};
	c->split.split = (nmtan_split_output){.struct_bytes = sizeof c->split.split, .indices = c->indices,
		.sources = c->sources, .source_capacity = 6, .vertex_tangents = &c->vertex_tangents[0][0]};
	c->counts.counts.struct_bytes = sizeof c->counts.counts;
}

static nmtan_status solve(call *c)
{
	return nmtan_tangents(&c->mesh.mesh, &c->options.options, &c->output.output, &c->counts.counts);
}

static nmtan_status solve_vertices(call *c)
{
	return nmtan_vertex_tangents(&c->mesh.mesh, &c->options.options, &c->split.split, &c->counts.counts);
}

static nmtan_status split(call *c)
{
	return nmtan_split(&c->mesh.mesh, &c->tangents[0][0], &c->options.options, &c->split.split);
}

/* Each struct of a call, and which functions take it. */
enum { STRUCTS = 7 };

typedef struct taken {
	size_t *struct_bytes, *tail, bytes;
	bool by_solve, by_vertices, by_split;
} taken;

static taken struct_of(call *c, int which)
{
#define TAKEN(name) &c->name.name.struct_bytes, c->name.tail, sizeof c->name.name
	const taken all[STRUCTS] = {{TAKEN(stored), true, true, false}, {TAKEN(mesh), true, true, true},
		{TAKEN(timing), true, true, false}, {TAKEN(options), true, true, true},
		{TAKEN(output), true, false, false},
		{TAKEN(split), false, true, true}, {TAKEN(counts), true, true, false}};
	return all[which];
}

/* The status of each function if one struct has this size and that number in its tail: 1 first, others last. */
static void expect(int which, size_t struct_bytes, size_t tail, nmtan_status expected)
{
	call c;
	call_init(&c);
	const taken t = struct_of(&c, which);
	*t.struct_bytes = struct_bytes == SIZE_MAX ? t.bytes + 2 * sizeof(size_t) : struct_bytes;
	t.tail[tail != 1] = tail;
	assert_int_equal(solve(&c), t.by_solve ? expected : NMTAN_OK);
	assert_int_equal(solve_vertices(&c), t.by_vertices ? expected : NMTAN_OK);
	assert_int_equal(split(&c), t.by_split ? expected : NMTAN_OK);
}

TEST(size_that_is_none_is_an_argument_error)
{
	for (int which = 0; which < STRUCTS; which++) {
		expect(which, 0, 0, NMTAN_ERROR_ARGUMENT);
		expect(which, sizeof(size_t) - 1, 0, NMTAN_ERROR_ARGUMENT);
		expect(which, 4 * sizeof(size_t) + 1, 0, NMTAN_ERROR_ARGUMENT);
		expect(which, (size_t)1 << 40, 0, NMTAN_ERROR_ARGUMENT); /* not initialised: nobody looks behind it */
	}
	/* 4096 bytes are the most */
	static size_t options[4096 / sizeof(size_t) + 1];
	for (size_t more = 0; more < 2; more++) {
		call c;
		call_init(&c);
		options[0] = 4096 + more * sizeof(size_t);
		assert_int_equal(nmtan_tangents(&c.mesh.mesh, (const nmtan_options *)options, &c.output.output, NULL),
			more ? NMTAN_ERROR_ARGUMENT : NMTAN_OK);
	}
}

TEST(newer_caller_is_served_while_it_asks_for_nothing_new)
{
	for (int which = 0; which < STRUCTS; which++) {
		expect(which, SIZE_MAX, 0, NMTAN_OK);
		expect(which, SIZE_MAX, 1, NMTAN_ERROR_ARGUMENT);
		expect(which, SIZE_MAX, (size_t)1 << (8 * sizeof(size_t) - 1), NMTAN_ERROR_ARGUMENT);
	}
}

/* Members that the caller does not have would be a bad offset, bad pointers, an impossible threshold. */
TEST(older_caller_gets_defaults)
{
	void *const nowhere = (void *)(uintptr_t)0x10;
	call c;
	call_init(&c);
	c.mesh.mesh.struct_bytes = offsetof(nmtan_mesh, stored);
	c.mesh.mesh.stored = nowhere;
	c.options.options.struct_bytes = offsetof(nmtan_options, allocator);
	c.options.options.allocator = nowhere;
	c.options.options.timing = nowhere;
	c.options.options.workspace = nowhere;
	c.output.output.struct_bytes = offsetof(nmtan_output, bitangents);
	c.output.output.bitangents = c.output.output.magnitudes = nowhere;
	c.output.output.corner_faults = nowhere;
	assert_int_equal(solve(&c), NMTAN_OK);
	for (int i = 0; i < 6; i++)
		assert_true(c.tangents[i][0] == (i < 3 ? 1.0f : -1.0f) && c.tangents[i][3] == c.tangents[i][0]);
	float magnitudes[12];
	c.output.output.struct_bytes = offsetof(nmtan_output, corner_faults);
	c.output.output.bitangents = NULL;
	c.output.output.magnitudes = magnitudes;
	assert_int_equal(solve(&c), NMTAN_OK);
	c.split.split.struct_bytes = offsetof(nmtan_split_output, vertex_tangents);
	c.split.split.vertex_tangents = nowhere;
	assert_int_equal(split(&c), NMTAN_OK);
	assert_ptr_equal(c.split.split.vertex_tangents, nowhere);
	/* without its arrays a mesh is none */
	c.mesh.mesh.struct_bytes = sizeof(size_t);
	assert_int_equal(solve(&c), NMTAN_ERROR_ARGUMENT);
}

TEST(no_more_is_written_than_the_caller_has)
{
	call c;
	call_init(&c);
	memset(&c.counts, 0x5a, sizeof c.counts);
	c.counts.counts.struct_bytes = offsetof(nmtan_counts, stored_differently);
	c.timing.timing = (nmtan_timing){.struct_bytes = offsetof(nmtan_timing, split), .weld = 100,
		.solve = 100,
		.split = -7};
	assert_int_equal(solve(&c), NMTAN_OK);
	assert_int_equal(c.counts.counts.struct_bytes, offsetof(nmtan_counts, stored_differently));
	assert_int_equal(c.counts.counts.degenerate_texcoords, 0);
	assert_int_equal(c.counts.counts.mirrored, 1);
	const unsigned char *behind = (unsigned char *)&c.counts.counts.stored_differently;
	while (behind < (unsigned char *)(&c.counts + 1))
		assert_int_equal(*behind++, 0x5a);
	assert_true(c.timing.timing.weld >= 100 && c.timing.timing.solve > 100);
	assert_true(c.timing.timing.split == -7);
	assert_int_equal(solve_vertices(&c), NMTAN_OK);
	assert_true(c.timing.timing.split == -7);
	behind = (unsigned char *)&c.counts.counts.stored_differently;
	while (behind < (unsigned char *)(&c.counts + 1))
		assert_int_equal(*behind++, 0x5a);
}

/* A macro whose list of members is not complete is a warning of the compiler; here: they mean what they say. */
TEST(macros_are_a_size_and_defaults)
{
	const nmtan_mesh mesh = NMTAN_MESH_INIT;
	const nmtan_options options = NMTAN_OPTIONS_INIT;
	const nmtan_counts counts = NMTAN_COUNTS_INIT;
	const nmtan_output output = NMTAN_OUTPUT_INIT;
	const nmtan_split_output to = NMTAN_SPLIT_OUTPUT_INIT;
	const nmtan_timing timing = NMTAN_TIMING_INIT;
	const nmtan_stored_uv stored = NMTAN_STORED_UV_INIT;
	const struct {
		const void *value;
		size_t bytes;
	} all[STRUCTS] = {{&mesh, sizeof mesh}, {&options, sizeof options}, {&counts, sizeof counts},
		{&output, sizeof output}, {&to, sizeof to}, {&timing, sizeof timing}, {&stored, sizeof stored}};
	for (int i = 0; i < STRUCTS; i++) {
		const unsigned char *bytes = all[i].value;
		assert_memory_equal(bytes, &all[i].bytes, sizeof(size_t));
		for (size_t k = sizeof(size_t); k < all[i].bytes; k++)
			assert_int_equal(bytes[k], 0);
		assert_int_equal(all[i].bytes % sizeof(size_t), 0);
	}
}
