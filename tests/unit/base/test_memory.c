/* SPDX-License-Identifier: MIT */
#include "base/memory.h"
#include "test.h"

#include <inttypes.h>

TEST(size_mul_overflow_is_told)
{
	size_t product;
	assert_true(nt_size_mul(SIZE_MAX / 8, 8, &product));
	assert_int_equal(product, SIZE_MAX - 7);
	assert_false(nt_size_mul(SIZE_MAX / 8 + 1, 8, &product));
	assert_null(nt_alloc(SIZE_MAX / 8 + 1, 8));
	assert_null(nt_calloc(SIZE_MAX / 8 + 1, 8));
}

TEST(grow_keeps_content_and_refuses_overflow)
{
	uint32_t *block = NULL;
	size_t capacity = 0;
	for (uint32_t i = 0; i < 1000; i++) {
		assert_true(nt_grow((void **)&block, &capacity, i + 1, sizeof *block));
		block[i] = i;
	}
	for (uint32_t i = 0; i < 1000; i++)
		assert_int_equal(block[i], i);
	const size_t before = capacity;
	assert_false(nt_grow((void **)&block, &capacity, SIZE_MAX / 2, sizeof *block));
	assert_int_equal(capacity, before);
	free(block);
}

/* The sanitizers of addresses and threads end a program that asks for more than there can be. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { MAY_ASK_FOR_ALL = false };
#elif defined(__has_feature)
enum { MAY_ASK_FOR_ALL = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer) };
#else
enum { MAY_ASK_FOR_ALL = true };
#endif

/* Whether the system was asked for large pages at an address. */
static bool is_advised(const char *at)
{
	char line[1024];
	bool here = false, advised = false;
	FILE *maps = fopen("/proc/self/smaps", "r");
	while (maps && fgets(line, sizeof line, maps)) {
		uintptr_t begin, end;
		if (sscanf(line, "%" SCNxPTR "-%" SCNxPTR " ", &begin, &end) == 2)
			here = (uintptr_t)at >= begin && (uintptr_t)at < end;
		else if (here && strncmp(line, "VmFlags:", 8) == 0)
			advised = strstr(line, " hg");
	}
	if (maps)
		fclose(maps);
	return advised;
}

TEST(large_blocks_end_with_a_large_page_where_that_is_little_more)
{
	enum { PAGE = 2 * 1024 * 1024 };
	const size_t bytes[] = {4 * PAGE, 4 * PAGE - 4096, 7 * PAGE - PAGE / 2 /* a thirteenth more */};
	char *blocks[3];
	for (size_t i = 0; i < 3; i++) {
		blocks[i] = nt_alloc_large(bytes[i]);
		assert_non_null(blocks[i]);
		/* a system without large pages, or without that file, says nothing */
		assert_true(!is_advised(blocks[i]) || is_advised(blocks[i] + (bytes[i] + PAGE - 1) / PAGE * PAGE - 1));
	}
	for (size_t i = 0; i < 3; i++)
		free(blocks[i]);
	if (MAY_ASK_FOR_ALL)
		assert_null(nt_alloc_large(SIZE_MAX - 4096));
}

TEST(arena_blocks_are_apart_and_aligned)
{
	nt_arena arena = {0};
	unsigned char *blocks[300];
	for (size_t i = 0; i < 300; i++) {
		blocks[i] = nt_arena_alloc(&arena, i * 7, 1);
		assert_non_null(blocks[i]);
		assert_int_equal((uintptr_t)blocks[i] % 16, 0);
		memset(blocks[i], (int)(i & 255), i * 7);
	}
	for (size_t i = 0; i < 300; i++)
		for (size_t k = 0; k < i * 7; k++)
			assert_int_equal(blocks[i][k], i & 255);
	assert_true(nt_arena_adopt(&arena, malloc(100)));
	assert_true(nt_arena_adopt(&arena, NULL));
	assert_string_equal(nt_arena_text(&arena, "seamless", 4), "seam");
	assert_null(nt_arena_alloc(&arena, SIZE_MAX, 2));
	/* what is large or adopted does not keep small requests from the block that they are taken from */
	char *const one = nt_arena_alloc(&arena, 16, 1);
	assert_non_null(nt_arena_alloc(&arena, 1 << 20, 1));
	assert_true(nt_arena_adopt(&arena, malloc(100)));
	assert_ptr_equal(nt_arena_alloc(&arena, 16, 1), one + 16);
	/* what was adopted goes, the block of small requests stays */
	nt_arena_clear(&arena);
	assert_non_null(arena.blocks);
	char *const again = nt_arena_alloc(&arena, 16, 1);
	assert_ptr_equal(nt_arena_alloc(&arena, 16, 1), again + 16);
	nt_arena_free(&arena);
	assert_null(arena.blocks);
}

/* 64 MB in small requests lie in few blocks; one large request does not make the next block large. */
TEST(large_arenas_have_large_blocks)
{
	enum { REQUESTS = 64 * 1024, BYTES = 1024 };
	nt_arena arena = {0};
	size_t blocks = 0;
	char *last = NULL;
	for (size_t i = 0; i < REQUESTS; i++) {
		char *const at = nt_arena_alloc(&arena, BYTES, 1);
		assert_non_null(at);
		blocks += !last || last + BYTES != at;
		last = at;
	}
	assert_in_range(blocks, 17, 40);
	nt_arena_free(&arena);
	assert_non_null(nt_arena_alloc(&arena, 1 << 24, 1));
	assert_int_equal(arena.block_bytes, 0);
	assert_non_null(nt_arena_alloc(&arena, 16, 1));
	assert_in_range(arena.block_bytes, 1, 65536);
	nt_arena_free(&arena);
}
