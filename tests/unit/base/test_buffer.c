/* SPDX-License-Identifier: MIT */
#include "base/text.h"
#include "fail_alloc.h"
#include "test.h"

TEST(pieces_follow_one_another)
{
	nt_buffer buffer = {0};
	nt_buffer_text(&buffer, "");
	nt_buffer_text(&buffer, "a");
	nt_buffer_format(&buffer, "%d %s", 42, "b");
	nt_buffer_append(&buffer, "\0c", 2);
	memcpy(nt_buffer_extend(&buffer, 3), "def", 3);
	assert_int_equal(buffer.size, 10);
	assert_memory_equal(buffer.data, "a42 b\0cdef", 11);
	nt_buffer_free(&buffer);
	assert_null(buffer.data);
}

/* ESC would speak to the terminal; bytes of UTF-8 are above all controls. */
TEST(control_characters_are_shown_as_numbers)
{
	nt_buffer buffer = {0};
	nt_buffer_clean(&buffer, "\x1b[31m\t\x7f\xc3\xa4 \n");
	assert_string_equal(buffer.data, "\\x1b[31m\\x09\\x7f\xc3\xa4 \\x0a");
	nt_buffer_free(&buffer);
	/* CSI of eight bits as U+009B and as a byte, a name turned around, a line that ends */
	nt_buffer_clean(&buffer, "\xc2\x9b\x9b" "a\xe2\x80\xaetxt\xe2\x81\xa6\xe2\x80\xa8\xd7\x90");
	assert_string_equal(buffer.data, "\\xc2\\x9b\\x9ba\\xe2\\x80\\xaetxt\\xe2\\x81\\xa6\\xe2\\x80\\xa8\xd7\x90");
	nt_buffer_free(&buffer);
}

TEST(exhausted_memory_is_remembered_and_keeps_what_came_before)
{
	nt_buffer buffer = {0};
	nt_buffer_text(&buffer, "kept");
	fail_allocations_from(0);
	assert_null(nt_buffer_extend(&buffer, 100000));
	assert_true(stop_failing_allocations());
	nt_buffer_text(&buffer, "more");
	assert_true(buffer.failed);
	assert_string_equal(buffer.data, "kept");
	assert_null(nt_buffer_extend(&buffer, SIZE_MAX));
	nt_buffer_free(&buffer);
}

TEST(reserved_room_needs_no_memory_later)
{
	nt_buffer buffer = {0};
	assert_true(nt_buffer_reserve(&buffer, 100));
	assert_int_equal(buffer.size, 0);
	assert_string_equal(buffer.data, "");
	fail_allocations_from(0);
	for (int i = 0; i < 10; i++)
		nt_buffer_text(&buffer, "0123456789");
	assert_false(stop_failing_allocations());
	assert_false(buffer.failed);
	assert_int_equal(buffer.size, 100);
	fail_allocations_from(0);
	assert_false(nt_buffer_reserve(&buffer, 100000));
	assert_true(stop_failing_allocations());
	nt_buffer_free(&buffer);
}

TEST(a_failure_goes_over_to_the_other_buffer)
{
	nt_buffer inner = {0}, outer = {0};
	nt_buffer_text(&inner, "x");
	nt_buffer_free_into(&inner, &outer);
	assert_null(inner.data);
	assert_false(outer.failed);
	fail_allocations_from(0);
	nt_buffer_text(&inner, "x");
	assert_true(stop_failing_allocations());
	nt_buffer_free_into(&inner, &outer);
	assert_true(outer.failed);
}
