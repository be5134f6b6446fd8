/* SPDX-License-Identifier: MIT */
/*
 * Names of sidecars, and which files are ours, in a folder of our own. "somebody\n" has the digest that
 * `xxhsum -H2` gives for it.
 */
#include "fail_alloc.h"
#include "file/output.h"
#include "folder.h"
#include "test.h"

#include <sys/stat.h>
#include <unistd.h>

#define SOMEBODY "da44bf30a9ce9c985c29cf2b20168f87"

static unsigned asked; /* how often for what is ours */

static nt_status own_old(nt_output *output, const char *path, nt_error *error)
{
	(void)path;
	asked++;
	return nt_output_add_ownership(output, "a.bin", SOMEBODY, NULL, error);
}

static nt_status own_staging(nt_output *output, const char *path, nt_error *error)
{
	(void)path;
	return nt_output_add_ownership(output, "a.new-0123456789abcdef.bin", "0123456789abcdef0123456789abcdef",
		SOMEBODY, error);
}

static nt_output *start(const nt_output_options *options, nt_sink **main)
{
	nt_output *output;
	nt_error error;
	assert_int_equal(nt_output_create(&output, options, &error), NT_OK);
	assert_int_equal(nt_output_add(output, in_folder("a.gltf"), NT_ROLE_MAIN, main, &error), NT_OK);
	assert_int_equal(nt_sink_write(*main, "{}", 2, &error), NT_OK);
	return output;
}

static nt_sink *sidecar(nt_output *output, const char *name, nt_role role, const char *text)
{
	nt_sink *sink;
	nt_error error;
	assert_int_equal(nt_output_add(output, in_folder(name), role, &sink, &error), NT_OK);
	assert_int_equal(nt_sink_write(sink, text, strlen(text), &error), NT_OK);
	assert_int_equal(nt_output_settle(output, sink, &error), NT_OK);
	return sink;
}

/* The name, of a sidecar of a set that is dropped, that a text gets. */
static void assert_named(const nt_output_options *options, const char *wanted, nt_role role, const char *text,
	const char *expected)
{
	nt_sink *main;
	nt_output *output = start(options, &main);
	assert_string_equal(nt_sink_name(sidecar(output, wanted, role, text), false), expected);
	nt_output_abort(output);
}

TEST(another_file_stays_and_the_name_is_of_the_bytes)
{
	put_text_file("a.bin", "theirs");
	put_text_file("n", "theirs");
	put_text_file(".hidden", "theirs");
	mkdir(in_folder("d.png"), 0777);
	assert_int_equal(symlink("nowhere", in_folder("l.png")), 0);
	assert_named(NULL, "a.bin", NT_ROLE_BUFFER, "somebody\n", "a-" "da44bf30a9ce9c98" ".bin");
	assert_named(NULL, "n", NT_ROLE_IMAGE, "somebody\n", "n-" "da44bf30a9ce9c98");
	assert_named(NULL, ".hidden", NT_ROLE_IMAGE, "somebody\n", ".hidden-" "da44bf30a9ce9c98");
	assert_named(NULL, "d.png", NT_ROLE_IMAGE, "somebody\n", "d-" "da44bf30a9ce9c98" ".png");
	assert_named(NULL, "l.png", NT_ROLE_IMAGE, "somebody\n", "l-" "da44bf30a9ce9c98" ".png");
	/* the main file's own name, and that name taken by other bytes */
	assert_named(NULL, "a.gltf", NT_ROLE_BUFFER, "somebody\n", "a-" "da44bf30a9ce9c98" ".gltf");
	put_text_file("a-" "da44bf30a9ce9c98" ".bin", "forged");
	assert_named(NULL, "a.bin", NT_ROLE_BUFFER, "somebody\n", "a-" "da44bf30a9ce9c98" "-1.bin");
}

TEST(a_long_name_is_cut_between_characters)
{
	char name[256], path[512];
	/* a letter, 124 of two bytes and an ending make 253 */
	name[0] = 'a';
	for (int i = 0; i < 124; i++)
		memcpy(name + 1 + 2 * i, "\xC3\xA9", 2);
	strcpy(name + 249, ".bin");
	put_text_file(name, "theirs");
	nt_sink *main;
	nt_output *output = start(NULL, &main);
	snprintf(path, sizeof path, "%s", nt_sink_name(sidecar(output, name, NT_ROLE_BUFFER, "somebody\n"), false));
	nt_output_abort(output);
	/* 255 - 4 - 17 = 234 bytes have a letter, 116 of two bytes and half of one */
	assert_int_equal(strlen(path), 233 + 17 + 4);
	assert_memory_equal(path, name, 233);
	assert_string_equal(path + 233, "-" "da44bf30a9ce9c98" ".bin");
	/* an ending of 241 bytes leaves no room */
	nt_sink *sink;
	nt_error error;
	memset(name, 'x', 242);
	strcpy(name + 242, "");
	name[1] = '.';
	put_text_file(name, "theirs");
	output = start(NULL, &main);
	assert_int_equal(nt_output_add(output, in_folder(name), NT_ROLE_BUFFER, &sink, &error), NT_OK);
	assert_int_equal(nt_output_settle(output, sink, &error), NT_ERROR_IO);
	assert_string_equal(error.message, "cannot write: File name too long");
	nt_output_abort(output);
}

TEST(images_of_one_set_share_a_name_if_they_are_equal)
{
	static const char *const names[] = {"n.png", "n-" "da44bf30a9ce9c98" ".png"};
	for (int theirs = 0; theirs < 2; theirs++) {
		nt_error error;
		nt_sink *main;
		nt_output_result result = {0};
		nt_output *output = start(&(nt_output_options){.result = &result}, &main);
		if (theirs)
			put_text_file("n.png", "theirs");
		for (int i = 0; i < 2; i++)
			assert_string_equal(nt_sink_name(sidecar(output, "n.png", NT_ROLE_IMAGE, "somebody\n"), false),
				names[theirs]);
		assert_string_not_equal(nt_sink_name(sidecar(output, "n.png", NT_ROLE_IMAGE, "other"), false),
			names[theirs]);
		assert_int_equal(nt_output_commit(output, &error), NT_OK);
		assert_int_equal(access(in_folder(names[theirs]), F_OK), 0);
		assert_int_equal(count_in_folder(), 3 + theirs);
		nt_buffer_free(&result.note);
		remove_folder(NULL);
		make_folder(NULL);
	}
}

TEST(names_that_were_taken_are_said_up_to_three)
{
	nt_error error;
	nt_sink *main;
	nt_output_result result = {0};
	nt_output *output = start(&(nt_output_options){.result = &result}, &main);
	for (int i = 0; i < 5; i++) {
		const char name[] = {(char)('a' + i), '\0'};
		put_text_file(name, "theirs");
		sidecar(output, name, NT_ROLE_IMAGE, "somebody\n");
	}
	assert_int_equal(nt_output_commit(output, &error), NT_OK);
	assert_string_equal(result.note.data, "; a is another file, so ours is a-" "da44bf30a9ce9c98"
		"; b is another file, so ours is b-" "da44bf30a9ce9c98"
		"; c is another file, so ours is c-" "da44bf30a9ce9c98" "; 2 more names were taken");
	nt_buffer_free(&result.note);
}

TEST(a_file_of_ours_is_replaced_by_way_of_a_staging_name)
{
	nt_status (*const records[])(nt_output *, const char *, nt_error *) = {own_old, own_staging};
	for (size_t i = 0; i < 2; i++) {
		const nt_output_options options = {.find_ownership = records[i]};
		nt_sink *main;
		put_text_file("a.gltf", "old");
		put_text_file("a.bin", "somebody\n");
		nt_output *output = start(&options, &main);
		asked = 0;
		nt_sink *sink = sidecar(output, "a.bin", NT_ROLE_BUFFER, "new");
		sidecar(output, "a.bin", NT_ROLE_BUFFER, "newer");
		assert_int_equal(asked, 1 - i); /* it takes a look into the main file */
		assert_true(nt_output_has_staging(output));
		assert_string_equal(nt_sink_name(sink, false), "a.bin");
		assert_memory_equal(nt_sink_name(sink, true), "a.new-", 6);
		assert_string_equal(nt_sink_digest_before(sink), SOMEBODY);
		nt_output_abort(output);
	}
}

TEST(a_name_that_is_taken_meanwhile_is_not_replaced)
{
	nt_error error;
	nt_sink *main;
	nt_output_result result = {0};
	const nt_output_options options = {.result = &result};
	nt_output *output = start(&options, &main);
	sidecar(output, "a.bin", NT_ROLE_BUFFER, "new");
	put_text_file("a.bin", "theirs");
	assert_int_equal(nt_output_commit(output, &error), NT_ERROR_IO);
	assert_true(result.again);
	assert_int_equal(access(in_folder("a.gltf"), F_OK), -1);
	assert_int_equal(count_in_folder(), 1);
	/* nor is what was to be used, or replaced, if it changed */
	nt_buffer_free(&result.note);
	result = (nt_output_result){0};
	put_text_file("n.png", "new");
	output = start(&options, &main);
	sidecar(output, "n.png", NT_ROLE_IMAGE, "new");
	put_text_file("n.png", "changed");
	assert_int_equal(nt_output_commit(output, &error), NT_ERROR_IO);
	assert_true(result.again);
	assert_int_equal(count_in_folder(), 2);
	nt_buffer_free(&result.note);
}

TEST(every_failed_allocation_is_said)
{
	const nt_output_options options = {.find_ownership = own_old};
	bool failed = true;
	put_text_file("a.gltf", "old");
	for (size_t n = 0; failed; n++) {
		nt_sink *main, *sink;
		nt_error error;
		put_text_file("a.bin", n % 2 ? "somebody\n" : "theirs");
		nt_output *output = start(&options, &main);
		nt_trace trace = {0};
		fail_allocations_from(n);
		nt_trace_use(&trace);
		nt_trace_note(NT_TRACE_LINK, "link", "path", NULL);
		nt_trace_use(NULL);
		nt_status status = trace.failed ? NT_ERROR_MEMORY
			: nt_output_add(output, in_folder("a.bin"), NT_ROLE_BUFFER, &sink, &error);
		if (!status)
			status = nt_sink_write(sink, "new", 3, &error);
		if (!status)
			status = nt_output_settle(output, sink, &error);
		failed = stop_failing_allocations();
		assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
		nt_output_abort(output);
		assert_int_equal(trace.count, !trace.failed);
		nt_trace_free(&trace);
		assert_int_equal(count_in_folder(), 2);
	}
}

AROUND_EACH(make_folder, remove_folder)
