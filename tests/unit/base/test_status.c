/* SPDX-License-Identifier: MIT */
/*
 * Each status has words of its own, and what the compute library says passes into nt_status unchanged.
 */
#include "base/error.h"
#include "test.h"

TEST(statuses_have_texts)
{
	for (int s = NT_ERROR_USAGE; s <= NT_ERROR_INTERNAL; s++) {
		assert_string_not_equal(nt_status_text((nt_status)s), "unknown status");
		assert_string_equal(nmtan_status_text((nmtan_status)s), "unknown status");
	}
	assert_string_equal(nt_status_text((nt_status)(NT_ERROR_INTERNAL + 1)), "unknown status");
	assert_string_equal(nt_status_text((nt_status)(NT_ERROR_USAGE - 1)), "unknown status");
}

TEST(statuses_of_the_compute_library_pass)
{
	static const struct {
		nmtan_status computed;
		nt_status expected;
	} rows[] = {{NMTAN_OK, NT_OK}, {NMTAN_ERROR_ARGUMENT, NT_ERROR_ARGUMENT},
		{NMTAN_ERROR_INDEX, NT_ERROR_INDEX}, {NMTAN_ERROR_FACE_SIZE, NT_ERROR_FACE_SIZE},
		{NMTAN_ERROR_TOO_LARGE, NT_ERROR_TOO_LARGE}, {NMTAN_ERROR_MEMORY, NT_ERROR_MEMORY},
		{NMTAN_ERROR_CAPACITY, NT_ERROR_CAPACITY}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		assert_int_equal(nt_status_of(rows[i].computed), rows[i].expected);
		assert_string_equal(nt_status_text(rows[i].expected), nmtan_status_text(rows[i].computed));
	}
}
