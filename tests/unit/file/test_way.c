/* SPDX-License-Identifier: MIT */
/*
 * Targets of paths, in a fresh folder that is the current one.
 */
#include "file/way.h"
#include "fail_alloc.h"
#include "folder.h"
#include "test.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include "file/trace.h"

/* in/tex -> v1, in/v1, in/out -> ../other, in/back -> ../in/v1, in/loop -> loop, other/home -> HERE/in */
static void put_links(void)
{
	static const char *const links[][2] = {{"in/tex", "v1"}, {"in/out", "../other"},
		{"in/back", "../in/v1"}, {"in/loop", "loop"}, {"in/up", ".."},
		{"in/two", "tex/../tex"}};
	char *here = realpath(".", NULL), home[4200];
	mkdir("in", 0700);
	mkdir("in/v1", 0700);
	mkdir("other", 0700);
	for (size_t i = 0; i < sizeof links / sizeof *links; i++)
		symlink(links[i][1], links[i][0]);
	snprintf(home, sizeof home, "%s/in", here);
	symlink(home, "in/home");
	free(here);
}

static void add_link(void *user, const char *path, const char *target)
{
	nt_buffer *text = user;
	nt_buffer_format(text, "%s>%s ", strrchr(path, '/') + 1, target);
}

/* The target of a path from the current folder on, and the links on the way. */
static void leads(const char *path, const char *expected, const char *links)
{
	nt_buffer real = {0}, seen = {0};
	nt_error error;
	char *here = realpath(".", NULL);
	nt_buffer_text(&seen, "");
	assert_int_equal(nt_way_follow(&real, path, add_link, &seen, &error), NT_OK);
	if (*expected == '/')
		assert_string_equal(real.data, expected);
	else
		assert_string_equal(real.data + strlen(here) + (*expected != '\0'), expected);
	nt_buffer_append(&seen, "", 1);
	assert_string_equal(seen.data, links);
	nt_buffer_free(&real);
	nt_buffer_free(&seen);
	free(here);
}

TEST(a_path_leads_where_the_system_goes)
{
	put_links();
	leads("in/v1/n.png", "in/v1/n.png", "");
	leads("in/tex/n.png", "in/v1/n.png", "tex>v1 ");
	leads("./in//out/../n.png", "n.png", "out>../other ");
	leads("in/two/n.png", "in/v1/n.png", "two>tex/../tex tex>v1 tex>v1 ");
	leads("none/../x", "x", "");
	leads("", "", "");
	leads("/", "/", "");
	leads("/../none", "/none", "");
	nt_buffer real = {0};
	nt_error error;
	assert_int_equal(nt_way_follow(&real, "in/loop/x", NULL, NULL, &error), NT_OK);
	nt_buffer_free(&real);
}

TEST(inside_is_what_links_do_not_lead_out_of)
{
	static const struct {
		const char *name;
		bool inside;
	} rows[] = {{"v1/n.png", true}, {"tex/n.png", true}, {"none/n.png", true},
		{"out/n.png", false}, {"back/n.png", true}, {"home/tex/n.png", true},
		{"up/n.png", false}, {"up/in/n.png", true}, {"../other/x", false}, {"..", false},
		{"v1/..", false}, {"two/../../x", false}, {"two/../x", true}};
	nt_error error;
	bool inside;
	put_links();
	char *in = realpath("in", NULL);
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_trace trace = {0};
		nt_trace *outer = nt_trace_use(&trace);
		assert_int_equal(nt_way_is_inside(in, rows[i].name, &inside, &error), NT_OK);
		nt_trace_use(outer);
		assert_int_equal(inside, rows[i].inside);
		assert_int_equal(trace.count, !inside);
		nt_trace_free(&trace);
	}
	assert_int_equal(nt_way_is_inside("/", "etc", &inside, &error), NT_OK);
	assert_true(inside);
	bool failed = true;
	for (size_t n = 0; failed; n++) {
		fail_allocations_from(n);
		const nt_status status = nt_way_is_inside(in, "two/../../x", &inside, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		assert_true(n < 100);
	}
	free(in);
}

AROUND_EACH(enter_folder, leave_folder)
