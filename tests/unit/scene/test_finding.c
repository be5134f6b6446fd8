/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <time.h>
#include "scene/finding.h"

static void add_in(nt_finding_list *list, nt_code code, const char *file, const char *object, size_t count,
	const char *detail)
{
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.file, sizeof place.file, "%s", file);
	snprintf(place.object, sizeof place.object, "%s", object);
	nt_finding_add(list, code, &place, count, "%s", detail);
}

static void add(nt_finding_list *list, nt_code code, const char *object, size_t count, const char *detail)
{
	add_in(list, code, "", object, count, detail);
}

TEST(equal_findings_are_one_with_the_sum_of_their_counts)
{
	nt_finding_list list = {0};
	add(&list, NT_CODE_TAN_ZERO, "a", 1, "x");
	add(&list, NT_CODE_TAN_ZERO, "b", 1, "x");
	add(&list, NT_CODE_TAN_ZERO, "a", 1, "y");
	add(&list, NT_CODE_TAN_BAD_W, "a", 1, "x");
	/* the texts "a" and "x" in another distribution */
	add(&list, NT_CODE_TAN_ZERO, "ax", 1, "");
	add(&list, NT_CODE_TAN_ZERO, "a", 41, "x");
	assert_int_equal(list.count, 5);
	assert_int_equal(list.items[0].count, 42);
	for (size_t i = 1; i < 5; i++)
		assert_int_equal(list.items[i].count, 1);
	nt_finding_add(&list, NT_CODE_TAN_ZERO, NULL, 2, NULL);
	nt_finding_add(&list, NT_CODE_TAN_ZERO, NULL, 3, NULL);
	assert_int_equal(list.count, 6);
	assert_int_equal(list.items[5].count, 5);
	add_in(&list, NT_CODE_TAN_ZERO, "a.mtl", "a", 1, "x");
	assert_int_equal(list.count, 7);
	nt_finding_list_free(&list);
	assert_int_equal(list.count, 0);
}

/* A finding has its texts itself: the caller's are gone when it is shown. */
TEST(places_are_kept)
{
	nt_finding_list list = {0};
	nt_place place = {.file = "a.obj", .line = 3, .offset = 4, .pointer = "/meshes/5", .object = "mesh 5"};
	char detail[] = "norm";
	nt_finding_add(&list, NT_CODE_TAN_ZERO, &place, 1, "%s", detail);
	memset(&place, 'x', sizeof place);
	memset(detail, 'x', sizeof detail - 1);
	nt_finding_add(&list, NT_CODE_TAN_ZERO, NULL, 1, NULL);
	const nt_finding *kept = &list.items[0], *nowhere = &list.items[1];
	assert_string_equal(kept->place.file, "a.obj");
	assert_string_equal(kept->place.pointer, "/meshes/5");
	assert_string_equal(kept->place.object, "mesh 5");
	assert_string_equal(kept->detail, "norm");
	assert_int_equal(kept->place.line, 3);
	assert_int_equal(kept->place.offset, 4);
	assert_string_equal(nowhere->place.file, "");
	assert_string_equal(nowhere->place.object, "");
	assert_string_equal(nowhere->detail, "");
	assert_true(nowhere->place.offset == NT_NO_OFFSET);
	nt_finding_list_free(&list);
}

/* Compared one with another these would be 2 * 10^10 pairs of texts. */
TEST(two_hundred_thousand_objects_are_no_burden)
{
	enum { COUNT = 200000 };
	nt_finding_list list = {0};
	const clock_t begin = clock();
	for (int round = 0; round < 2; round++)
		for (int i = 0; i < COUNT; i++) {
			char object[64];
			snprintf(object, sizeof object, "mesh %d, primitive 0", i);
			add(&list, NT_CODE_TAN_REPAIRED, object, 1, "");
		}
	assert_true(clock() - begin < 20 * CLOCKS_PER_SEC);
	assert_int_equal(list.count, COUNT);
	for (int i = 0; i < COUNT; i++)
		assert_int_equal(list.items[i].count, 2);
	nt_finding_list_free(&list);
}
