/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "report/report.h"

TEST(every_code_has_a_complete_row_and_is_found_by_its_name)
{
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		assert_non_null(row->name);
		assert_true(row->message && row->meaning && row->remedy && row->example);
		/* somebody sees it, with the severity of the table or a higher one */
		const char *severities = "-iwe", *worst = severities;
		assert_int_equal(strlen(row->profiles), 3);
		for (int profile = 0; profile < 3; profile++) {
			const char *letter = strchr(severities, row->profiles[profile]);
			assert_non_null(letter);
			worst = letter > worst ? letter : worst;
		}
		assert_true(worst - severities >= 1 + (int)row->severity);
		for (int k = 0; k < (int)i; k++)
			assert_string_not_equal(nt_code_info((nt_code)k)->name, row->name);
	}
}

/* A remedy that is neither nothing nor another export says where that is in a program. */
TEST(remedies_of_texture_coordinates_name_a_program)
{
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		if (strncmp(row->name, "UV_", 3) == 0 && strncmp(row->remedy, "Nothing", 7) != 0 &&
			strncmp(row->remedy, "Export", 6) != 0 && !strstr(row->remedy, "Blender: "))
			fail_msg("%s: %s", row->name, row->remedy);
	}
	/* nobody can make tangents without them */
	assert_null(strstr(nt_code_info(NT_CODE_TAN_NO_UV)->remedy, "Convert the file with nmtan"));
	assert_null(strstr(nt_code_info(NT_CODE_NMAP_GREEN_DOWN)->remedy, "OBJ"));
}

static void sentence_is(nt_code code, size_t count, const char *detail, const char *expected)
{
	nt_buffer out = {0};
	nt_code_sentence(code, count, detail, &out);
	assert_string_equal(out.data, expected);
	nt_buffer_free(&out);
}

TEST(sentences_count_and_carry_the_detail)
{
	sentence_is(NT_CODE_TAN_ZERO, 1, NULL, "1 tangent has no length");
	sentence_is(NT_CODE_TAN_ZERO, 7, "", "7 tangents have no length");
	sentence_is(NT_CODE_TAN_EXISTING_BAD, 1, NULL, "1 tangent that was kept is invalid");
	sentence_is(NT_CODE_TAN_EXISTING_BAD, 2, NULL, "2 tangents that were kept are invalid");
	sentence_is(NT_CODE_MTL_MISSING, 1, "a.mtl", "material library cannot be read: a.mtl");
}

static void command_is(const char *options, const char *input, const char *output, const char *expected)
{
	nt_buffer out = {0};
	nt_command_text(options, NULL, input, output, &out);
	assert_string_equal(out.data, expected);
	nt_buffer_free(&out);
}

TEST(commands_name_outputs_of_the_format_that_was_asked_for)
{
	static const char *const rows[][4] = { /* given, input, output, command */
		{"--output-format=glb", "k.ply", NULL, "nmtan --fix k.ply k.glb"},
		{"--weld\n--output-format=gltf", "k.glb", NULL, "nmtan --weld --fix k.glb k.gltf"},
		{"--output-format=ply", "k.PLY", NULL, "nmtan --fix k.PLY k-repaired.PLY"},
		{"--output-format=ply", "-", NULL, "nmtan --fix - OUT.ply"},
		{"--output-format=gltf", "in.g", NULL, "nmtan --fix in.g in.gltf"},
		{"", "in.g", NULL, "nmtan --fix in.g in.glb"},
		/* what the name does not say */
		{"--output-format=ply", "k.ply", "-", "nmtan --output-format=ply --fix k.ply -"},
		{"--output-format=glb", "k.ply", "out.bin", "nmtan --output-format=glb --fix k.ply out.bin"},
		{"--output-format=glb", "k.ply", "out.glb", "nmtan --fix k.ply out.glb"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		nt_command_text("--fix", rows[i][0], rows[i][1], rows[i][2], &out);
		assert_string_equal(out.data, rows[i][3]);
		nt_buffer_free(&out);
	}
}

TEST(commands_repeat_what_the_user_gave_but_for_what_they_say_themselves)
{
	static const char *const rows[][3] = { /* options, given, both */
		{"--fix", "--weld\n'--texture-path=a b'", "--weld '--texture-path=a b' --fix"},
		{"--fix", "--existing=keep\n--weld\n--flip-green=on", "--weld --fix"},
		{"--existing=replace", "--fix", "--existing=replace"},
		{"--quads=pairs", "--fix", "--fix --quads=pairs"},
		{"--existing=replace --only=all", "--only=needed\n--uv=1", "--uv=1 --existing=replace --only=all"},
		{"--bump=height", "--bump-height=0.1", "--bump-height=0.1 --bump=height"},
		{"--normals=smooth", "'--normals=angle:30'\n--raw", "--raw --normals=smooth"},
		{"", "--raw", "--raw"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		char expected[200];
		snprintf(expected, sizeof expected, "nmtan %s a.glb b.glb", rows[i][2]);
		nt_command_text(rows[i][0], rows[i][1], "a.glb", "b.glb", &out);
		assert_string_equal(out.data, expected);
		nt_buffer_free(&out);
	}
}

TEST(commands_are_words_of_a_shell)
{
	command_is("--fix", "a/in.glb", NULL, "nmtan --fix a/in.glb a/in-repaired.glb");
	command_is("--fix", "a.b/in.GLTF", "out.glb", "nmtan --fix a.b/in.GLTF out.glb");
	command_is("", "head.obj", NULL, "nmtan head.obj head.glb");
	command_is("--fix", "a.b/in", NULL, "nmtan --fix a.b/in a.b/in.glb");
	command_is("--fix", "-it's.ply", NULL, "nmtan --fix './-it'\\''s.ply' './-it'\\''s-repaired.ply'");
	command_is("--fix", "-", NULL, "nmtan --fix - OUT.glb");
	command_is("--fix", "a\nb.glb", NULL, "nmtan --fix IN OUT");
	command_is("--fix", NULL, NULL, "nmtan --fix IN OUT");
}

TEST(severities_have_names)
{
	nt_severity severity;
	assert_true(nt_severity_find("warning", &severity));
	assert_int_equal(severity, NT_SEVERITY_WARNING);
	assert_false(nt_severity_find("fatal", &severity));
	assert_string_equal(nt_severity_name(NT_SEVERITY_ERROR), "error");
}

/* ---- the manual ---- */

/* Text for troff: backslashes and hyphens escaped, a line per sentence not needed. */
static void put_troff(const char *text, nt_buffer *out)
{
	for (; *text; text++) {
		if (*text == '-')
			nt_buffer_text(out, "\\-");
		else if (*text == '\\')
			nt_buffer_text(out, "\\e");
		else
			nt_buffer_append(out, text, 1);
	}
}

static const char *profile_word(char letter)
{
	for (nt_severity s = NT_SEVERITY_INFO; s <= NT_SEVERITY_ERROR; s++)
		if (*nt_severity_name(s) == letter)
			return nt_severity_name(s);
	assert_int_equal(letter, '-');
	return ".";
}

/* The tables of the page; what stands around them is written there. */
static const char manual_begin[] = ".PP\n.nf\n.ft CW\n", manual_end[] = ".SH SEE ALSO\n";

static void write_tables(nt_buffer *out)
{
	nt_buffer_text(out, "                             prop     scan     OBJ\n");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		nt_buffer_format(out, "%-28s %-8s %-8s %s\n", row->name, profile_word(row->profiles[0]),
			profile_word(row->profiles[1]), profile_word(row->profiles[2]));
	}
	nt_buffer_text(out, ".ft\n.fi\n");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		nt_buffer_format(out, ".SS %s (%s)\n", row->name, nt_severity_name(row->severity));
		put_troff(row->meaning, out);
		nt_buffer_text(out, "\n.br\n.I Remedy:\n");
		nt_buffer remedy = {0};
		nt_remedy_text((nt_code)i, row->repair, NULL, NULL, &remedy);
		put_troff(remedy.data, out);
		nt_buffer_free(&remedy);
		nt_buffer_text(out, "\n.br\n.I Smallest example:\n");
		put_troff(row->example, out);
		nt_buffer_text(out, ".\n");
	}
}

/* NMTAN_UPDATE writes them anew. */
TEST(manual_lists_every_code_as_the_table_has_it)
{
	static const char path[] = "man/nmtan-report.5";
	static char page[1 << 18];
	nt_buffer expected = {0};
	char title[100];
	FILE *file = fopen(path, "rb");
	assert_non_null(file);
	const size_t size = fread(page, 1, sizeof page - 1, file);
	fclose(file);
	snprintf(title, sizeof title, ".TH NMTAN\\-REPORT 5 \"\" \"nmtan %s\"", nmtan_version());
	assert_non_null(strstr(page, title));
	char *begin = strstr(page, manual_begin), *const end = page + size - strlen(strstr(page, manual_end));
	assert_non_null(begin);
	begin += strlen(manual_begin);
	write_tables(&expected);
	if (getenv("NMTAN_UPDATE")) {
		file = fopen(path, "wb");
		assert_non_null(file);
		fprintf(file, "%.*s%s%s", (int)(begin - page), page, expected.data, end);
		fclose(file);
	}
	*end = '\0';
	assert_string_equal(begin, expected.data);
	nt_buffer_free(&expected);
}
