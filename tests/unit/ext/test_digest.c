/* SPDX-License-Identifier: MIT */
/*
 * Digests: the values are those of xxhsum -H2 (xxHash 0.8.1).
 */
#include "ext/linked.h"
#include "fail_alloc.h"
#include "test.h"

static void assert_digest(const char *text, const char *expected)
{
	char digest[NT_DIGEST_TEXT];
	nt_digest *d = nt_digest_create();
	assert_non_null(d);
	nt_digest_add(d, text, strlen(text));
	nt_digest_text(d, digest);
	assert_string_equal(digest, expected);
	nt_digest_free(d);
}

TEST(digest_is_that_of_xxhsum)
{
	assert_digest("", "99aa06d3014798d86001c324468d497f");
	assert_digest("somebody\n", "da44bf30a9ce9c985c29cf2b20168f87");
}

TEST(digest_does_not_depend_on_the_pieces)
{
	unsigned char bytes[5000];
	char whole[NT_DIGEST_TEXT], pieces[NT_DIGEST_TEXT];
	for (size_t i = 0; i < sizeof bytes; i++)
		bytes[i] = (unsigned char)(i * i >> 3);
	nt_digest *d = nt_digest_create();
	nt_digest_add(d, bytes, sizeof bytes);
	nt_digest_text(d, whole);
	nt_digest_free(d);
	d = nt_digest_create();
	for (size_t at = 0, size = 0; at < sizeof bytes; at += size, size = size * 2 + 1) {
		if (size > sizeof bytes - at)
			size = sizeof bytes - at;
		nt_digest_add(d, bytes + at, size);
	}
	nt_digest_text(d, pieces);
	nt_digest_free(d);
	assert_string_equal(whole, pieces);
}

TEST(digest_without_memory_is_none)
{
	for (size_t n = 0; n < 2; n++) {
		fail_allocations_from(n);
		nt_digest *d = nt_digest_create();
		assert_true(stop_failing_allocations());
		assert_null(d);
	}
	nt_digest_free(NULL);
}
