/* SPDX-License-Identifier: MIT */
#include "cli/options.h"
#include "test.h"

enum { MOST_WORDS = 24 };

/* Parses "nmtan" and these words, which end with NULL. */
static nt_status parse(nt_command *command, nt_error *error, const char *const *words)
{
	static char *argv[MOST_WORDS + 1];
	static char name[] = "nmtan";
	int argc = 0;
	argv[argc++] = name;
	for (; *words && argc < MOST_WORDS; words++)
		argv[argc++] = (char *)(uintptr_t)*words;
	argv[argc] = NULL;
	nt_error_clear(error);
	return nt_options_parse(argc, argv, command, error);
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

static void accepts(nt_command *command, const char *const *words)
{
	nt_error error;
	if (parse(command, &error, words))
		fail_msg("refused: %s", error.message);
}

/* Refused as usage, with this text in the message. */
static void refuses(const char *text, const char *const *words)
{
	nt_command command;
	nt_error error;
	assert_int_equal(parse(&command, &error, words), NT_ERROR_USAGE);
	if (!strstr(error.message, text))
		fail_msg("'%s' does not say '%s'", error.message, text);
}

#define FIELD(name) offsetof(nt_command, name), sizeof(((nt_command *)0)->name)

/* Scripts of tests/cli use the others. */
TEST(options_set_their_fields)
{
	static const struct {
		const char *word;
		size_t offset, size;
		int value;
	} rows[] = {
		{"--method=lengyel", FIELD(settings.method), NMTAN_METHOD_LENGYEL},
		{"--uv=3", FIELD(settings.io.texcoord_set), 3},
		{"--bump=ignore", FIELD(settings.bump), NT_BUMP_IGNORE},
		{"--draco=off", FIELD(settings.io.draco), NT_DRACO_OFF},
		{"--threads=5", FIELD(settings.io.threads), 5},
		{"--output-format=gltf", FIELD(settings.output_format), NT_FORMAT_GLTF},
		{"--outside=root", FIELD(settings.io.outside), NT_OUTSIDE_ROOT},
		{"--bitangents", FIELD(settings.io.bitangents), true},
		{"--timing", FIELD(timing), true},
		{"--update=time", FIELD(update), 1 + NT_UPDATE_BY_TIME},
		{"--update=content", FIELD(update), 1 + NT_UPDATE_BY_CONTENT},
		{"--progress=off", FIELD(progress), NT_PROGRESS_OFF},
		{"-q", FIELD(verbosity), -1},
		{"--completion=zsh", FIELD(action), NT_ACTION_COMPLETION_ZSH},
	};
	nt_command c;
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		int value = 0;
		accepts(&c, WORDS(rows[i].word, "a", "b"));
		memcpy(&value, (const char *)&c + rows[i].offset, rows[i].size);
		if (value != rows[i].value)
			fail_msg("%s: %d", rows[i].word, value);
	}
	accepts(&c, WORDS("--bump-height=1/32", "--texture-path=x", "--texture-path", "y", "a", "b"));
	assert_true(c.settings.bump_height == 1.0 / 32);
	assert_int_equal(c.settings.texture_path_count, 2);
	assert_string_equal(c.settings.texture_paths[1], "y");
	accepts(&c, WORDS("--origin=1e3,-2.5,+.5", "a", "b"));
	assert_int_equal(c.settings.io.origin.choice, NT_ORIGIN_GIVEN);
	assert_memory_equal(c.settings.io.origin.at, ((double[]){1000, -2.5, 0.5}), 3 * sizeof(double));
	accepts(&c, WORDS("--origin=0,-0,0.0", "a", "b"));
	assert_int_equal(c.settings.io.origin.choice, NT_ORIGIN_KEEP);
	accepts(&c, WORDS("--draco=edgebreaker", "--draco-bits=16,10,1,24", "a", "b"));
	assert_memory_equal(c.settings.io.draco_bits, ((int[]){16, 10, 1, 24}), 4 * sizeof(int));
	accepts(&c, WORDS("--in-place", "a"));
	assert_true(c.settings.in_place);
	accepts(&c, WORDS("--check", "--fail-on=info", "a", "b", "c"));
	assert_int_equal(c.fail_on, NT_FAIL_ON_INFO);
}

TEST(a_size_is_a_number_and_what_it_counts)
{
	static const struct {
		const char *word;
		uint64_t bytes;
	} sizes[] = {{"--memory=0", 0}, {"--memory=123", 123}, {"--memory=64M", UINT64_C(64) << 20},
		{"--memory=2GiB", UINT64_C(2) << 30}, {"--memory=3kB", 3000}, {"--memory=3KB", 3000},
		{"--memory=5K", 5 * 1024}, {"--memory=500MB", 500000000}, {"--memory=1T", UINT64_C(1) << 40},
		{"--memory=1TB", UINT64_C(1000000000000)}, {"--memory=100000000000", UINT64_C(100000000000)}};
	nt_command c;
	for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
		accepts(&c, WORDS(sizes[i].word, "a", "b"));
		assert_true(c.memory == sizes[i].bytes);
	}
	static const char *const wrong[] = {"", "M", "-1", "1.5G", "64m", "64k", "64Mb", "64MiBs", "64 M", "1P",
		"99999999999999999999", "20000000T"};
	for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
		refuses("is not a size", WORDS("--memory", wrong[i], "a", "b"));
}

TEST(values_stand_behind_equals_or_in_the_next_word)
{
	nt_command c;
	accepts(&c, WORDS("--threads", "7", "a", "b"));
	assert_int_equal(c.settings.io.threads, 7);
	accepts(&c, WORDS("-j", "7", "a", "b"));
	assert_int_equal(c.settings.io.threads, 7);
	accepts(&c, WORDS("-nvj7", "a", "b"));
	assert_int_equal(c.settings.io.threads, 7);
	assert_true(c.settings.no_clobber);
	accepts(&c, WORDS("-d", "there", "a", "b", "c"));
	assert_string_equal(c.directory, "there");
	assert_int_equal(c.operand_count, 3);
	accepts(&c, WORDS("--directory=there", "a"));
	assert_string_equal(c.directory, "there");
	accepts(&c, WORDS("--uv", "auto", "a", "b"));
	assert_int_equal(c.settings.io.texcoord_set, -1);
}

TEST(unknown_options_are_refused_by_name)
{
	refuses("'--frobnicate'", WORDS("--frobnicate", "a", "b"));
	refuses("'--frobnicate'", WORDS("--frobnicate=3", "a", "b"));
	refuses("'--thread'", WORDS("--thread=3", "a", "b"));
	refuses("'-x'", WORDS("-vxq", "a", "b"));
	refuses("'-\xc3\xa9'", WORDS("-\xc3\xa9", "a", "b"));
	refuses("'--Threads'", WORDS("--Threads=3", "a", "b"));
}

TEST(bad_values_are_refused_whole)
{
	refuses("'8x'", WORDS("--threads=8x", "a", "b"));
	refuses("'-1'", WORDS("--threads=-1", "a", "b"));
	refuses("'-1'", WORDS("--threads", "-1", "a", "b"));
	refuses("'1025'", WORDS("-j1025", "a", "b"));
	refuses("'99999999999999999999'", WORDS("-j99999999999999999999", "a", "b"));
	refuses("'=8'", WORDS("-j=8", "a", "b"));
	refuses("' 8'", WORDS("-j 8", "a", "b"));
	refuses("'1.5'", WORDS("--uv=1.5", "a", "b"));
	refuses("''", WORDS("--uv=", "a", "b"));
	refuses("'aut'", WORDS("--uv=aut", "a", "b"));
	refuses("'Auto'", WORDS("--only=Auto", "a", "b"));
	refuses("'auto|needed'", WORDS("--only=auto|needed", "a", "b"));
	refuses("''", WORDS("--only=", "a", "b"));
	refuses("auto needed all", WORDS("--only=some", "a", "b"));
	refuses("''", WORDS("--directory=", "a", "b"));
	refuses("'11' for tangents", WORDS("--draco-bits=14,12,12,11", "a", "b"));
	refuses("'25' for positions", WORDS("--draco-bits=25,12,12,12", "a", "b"));
	refuses("'1' for normals", WORDS("--draco-bits=14,1,12,12", "a", "b"));
	refuses("''", WORDS("--draco-bits=14,12,,12", "a", "b"));
	static const char *const origins[] = {"1,2", "1,2,3,4", "1,2,3,", ",,", "x", "1,2,inf", "nan,0,0", "0x1,2,3",
		"1,2, 3", "1e31,0,0", "Auto"};
	for (size_t i = 0; i < sizeof origins / sizeof *origins; i++) {
		char word[40];
		snprintf(word, sizeof word, "--origin=%s", origins[i]);
		refuses("is neither auto nor keep nor three numbers", WORDS(word, "a", "b"));
	}
	refuses("'3'", WORDS("--bump-height=3", "a", "b"));
	refuses("'1/0'", WORDS("--bump-height=1/0", "a", "b"));
	refuses("'0.1x'", WORDS("--bump-height=0.1x", "a", "b"));
	refuses("''", WORDS("--texture-path=", "a", "b"));
	refuses("'14,12,12'", WORDS("--draco-bits=14,12,12", "a", "b"));
	refuses("'14,12,12,12,12'", WORDS("--draco-bits=14,12,12,12,12", "a", "b"));
	/* missing ones and superfluous ones */
	refuses("--threads needs a value", WORDS("a", "b", "--threads"));
	refuses("-d needs a value", WORDS("a", "b", "-d"));
	/* an option is no value of another one */
	refuses("--baseline needs a value: FILE; if that is '--check': --baseline=--check",
		WORDS("--baseline", "--check", "a"));
	refuses("-d needs a value: DIR; if that is '-q': --directory=-q", WORDS("-d", "-q", "a"));
	refuses("'400' is not a number from 0 to 180", WORDS("--normals=angle:400", "a", "b"));
	refuses("'' is not a number from 0 to 180", WORDS("--normals=replace-angle:", "a", "b"));
	refuses("'flat:3' is none of: auto flat", WORDS("--normals=flat:3", "a", "b"));
	refuses("'z' is one name too many", WORDS("-o", "o.glb", "a", "z"));
	refuses("'c' is one name too many", WORDS("a", "b", "c"));
	refuses("'yes'", WORDS("--verify=yes", "a", "b"));
	refuses("''", WORDS("--verify=", "a", "b"));
	/* a value that may be left out is never the next word */
	nt_command c;
	accepts(&c, WORDS("--update", "content", "b"));
	assert_int_equal(c.operand_count, 2);
	assert_int_equal(c.update, 1 + NT_UPDATE_BY_TIME);
	refuses("'' is none of: time content", WORDS("--update=", "a", "b"));
}

TEST(options_that_contradict_each_other_are_refused)
{
	refuses("--quiet and --verbose", WORDS("-q", "-v", "a", "b"));
	refuses("--in-place and --no-clobber", WORDS("-n", "--in-place", "a"));
	refuses("--output names the output of one input", WORDS("--check", "-o", "x", "a", "b"));
	refuses("--update and --report", WORDS("--update", "--report=r.json", "a", "b"));
	refuses("--buffers=embed", WORDS("--output-format=gltf", "a", "-"));
	refuses("--verify", WORDS("a", "-", "--verify"));
	refuses("--draco=off", WORDS("--draco=off", "--draco-bits=14,12,12,12", "a", "b"));
}

/* An option about writing a glTF has it judged as written so; an option about judging has not. */
TEST(a_check_takes_what_a_conversion_takes)
{
	static const struct {
		const char *word;
		bool converts;
	} rows[] = {{"--only=all", false}, {"--uv=1", false}, {"--quads=pairs", false}, {"--across=mesh", false},
		{"--outside=yes", false}, {"--threads=2", false}, {"--existing=keep", true}, {"--raw", true},
		{"--output-format=glb", true}, {"-ox.glb", true}, {"-dx", true}, {"--in-place", true}, {"-n", true},
		{"--update", true}, {"--dry-run", true}, {"--verify", true}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_command c;
		accepts(&c, WORDS("--check", rows[i].word, "a"));
		assert_int_equal(c.operand_count, 1);
		if (c.settings.converts != rows[i].converts)
			fail_msg("%s", rows[i].word);
	}
}

TEST(of_choices_the_last_counts_but_names_and_lists_stand_once)
{
	nt_command c;
	accepts(&c, WORDS("--method=area", "--method=lengyel", "-j2", "-j3", "a", "b"));
	assert_int_equal(c.settings.method, NMTAN_METHOD_LENGYEL);
	assert_int_equal(c.settings.io.threads, 3);
	refuses("--report is there twice: 'r.xml' and 'r.sarif'; another run writes the other",
		WORDS("--check", "--report=r.xml", "--report=r.sarif", "a"));
	refuses("--directory is there twice", WORDS("-d", "x", "-dy", "a"));
}

TEST(names_must_be_as_many_as_the_form_takes)
{
	nt_command c;
	nt_error error;
	assert_int_equal(parse(&c, &error, (const char *const[]){NULL}), NT_ERROR_USAGE);
	refuses("OUTPUT is missing: nmtan a OUT.glb, -d DIR, --in-place or --check", WORDS("a"));
	refuses("OUTPUT is missing: nmtan 'it'\\''s a.OBJ' OUT.glb, -d DIR or --check", WORDS("it's a.OBJ"));
	refuses("OUTPUT is missing: nmtan ./-a.glb OUT.glb, -d DIR, --in-place or --check", WORDS("--", "-a.glb"));
	refuses("OUTPUT is missing: nmtan - OUT.glb or --check", WORDS("-"));
	refuses("'c'", WORDS("a", "b", "c"));
	refuses("there is no file 'check'; did you mean --check?", WORDS("check", "a.glb"));
	refuses("there is no file 'help'; did you mean --help?", WORDS("help"));
	refuses("counts what --min-severity shows", WORDS("--check", "--min-severity=error", "--fail-on=warning", "a"));
	refuses("INPUT is missing", WORDS("--check"));
	refuses("INPUT is missing", WORDS("-d", "x"));
	refuses("'-'", WORDS("-d", "x", "-"));
	refuses("'-'", WORDS("--in-place", "-"));
	refuses("'-'", WORDS("--check", "-", "-"));
	accepts(&c, WORDS("--check", "-"));
	char name[5000] = "";
	memset(name, '/', sizeof name - 1);
	refuses("4999 bytes", WORDS("a", name));
	refuses("4999 bytes", WORDS("a", "b.glb", "--report", name));
	name[4095] = '\0';
	accepts(&c, WORDS("a", name));
}

static void shapes(const char *expected, const char *const *words)
{
	nt_command command;
	nt_buffer text = {0};
	accepts(&command, words);
	nt_options_shaping(&command, true, &text);
	assert_string_equal(text.data ? text.data : "", expected);
	nt_buffer_free(&text);
}

TEST(options_that_shape_outputs_are_spelled_in_one_way)
{
	shapes("", WORDS("a", "b.glb"));
	shapes("", WORDS("-j3", "--method=mikktspace", "--uv=auto", "--outside=root", "--in-place", "--sync",
		"--verify", "--update", "-v",
			   "--jobs=2", "a"));
	shapes("--method=robust --raw --outside=yes --output-format=glb --draco-bits=12,12,12,12",
		WORDS("--draco-bits", "12,12,12,12", "a", "--output-format=gltf", "--output-format=glb", "b",
			"--raw", "--outside=yes",
			"--method=robust"));
	shapes("", WORDS("--origin=auto", "a", "b.glb"));
	shapes("--origin=keep", WORDS("--origin=0,0,0", "a", "b.glb"));
	shapes("--origin=1,2,3", WORDS("--origin=1,2,3", "a", "b.glb"));
	shapes("--uv=0 --bitangents", WORDS("--bitangents", "--uv=0", "--bitangents", "a", "b.glb"));
}
