/* SPDX-License-Identifier: MIT */
/*
 * Texts about options: --help, the completions of bash and zsh, and which options shape outputs.
 */
#include "cli/options.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include "file/input.h"
#include "file/path.h"
#include "report/report.h"

enum { HELP_COLUMN = 30, HELP_WIDTH = 80 };

static bool shown(const nt_option_row *row)
{
	return row->kind != NT_OPTION_HEADING && row->help;
}

/* Appends `text` in lines that start at `column` and end before `width`; the cursor is at `at`. */
static void wrap(nt_buffer *out, const char *text, size_t at)
{
	while (*text) {
		const size_t length = strcspn(text, " ");
		if (at > HELP_COLUMN && at + 1 + length > HELP_WIDTH) {
			nt_buffer_format(out, "\n%*s", HELP_COLUMN, "");
			at = HELP_COLUMN;
		} else if (at > HELP_COLUMN) {
			nt_buffer_text(out, " ");
			at++;
		}
		nt_buffer_append(out, text, length);
		at += length;
		text += length + (text[length] == ' ');
	}
}

static void help_row(nt_buffer *out, const nt_option_row *row)
{
	char left[96], text[512];
	if (row->letter)
		snprintf(left, sizeof left, "  -%c, --%s", row->letter, row->name);
	else
		snprintf(left, sizeof left, "      --%s", row->name);
	if (row->values) {
		const size_t used = strlen(left);
		snprintf(left + used, sizeof left - used, row->kind == NT_OPTION_MAYBE_CHOICE ? "[=%s]" : "=%s",
			row->values);
	}
	nt_buffer_text(out, left);
	if (strlen(left) + 2 > HELP_COLUMN)
		nt_buffer_format(out, "\n%*s", HELP_COLUMN, "");
	else
		nt_buffer_format(out, "%*s", HELP_COLUMN - (int)strlen(left), "");
	snprintf(text, sizeof text, "%s%s%s%s", row->help, row->standard ? " (default: " : "",
		row->standard ? row->standard : "", row->standard ? ")" : "");
	wrap(out, text, HELP_COLUMN);
	nt_buffer_text(out, "\n");
}

static const char usage[] =
	"nmtan adds tangents to meshes. It reads OBJ, PLY, glTF, GLB and DRC and writes\n"
	"glTF, GLB and PLY.\n\n"
	"  nmtan [options] INPUT OUTPUT\n"
	"  nmtan [options] -d DIR INPUT...       convert many files, several at once\n"
	"  nmtan [options] --in-place INPUT...   the same, each file in its place\n"
	"  nmtan --check [options] INPUT...      report what is wrong, write no mesh\n\n";

static const char exit_codes[] =
	"\nExit code: 0 done, 1 usage, 2 cannot read or write, 3 invalid input, 4 out of\n"
	"memory or internal error, 5 unsupported, 6 findings (--fail-on), 7 a limit.\n";

/* Answers to the first questions: examples, and the ten options that they use. */
void nt_options_first_help(nt_buffer *out)
{
	nt_buffer_text(out, usage);
	nt_buffer_text(out,
		"Examples:\n"
		"  nmtan head.obj head.glb                  an OBJ with materials and images\n"
		"  nmtan in.glb out.glb                     the primitives that need tangents\n"
		"  nmtan --check in.glb                     what is wrong with a file\n"
		"  nmtan --check --report=in.html in.glb    the same, as a page with pictures\n"
		"  nmtan --fix in.glb out.glb               repair what is wrong\n"
		"  nmtan --quads=pairs in.glb out.glb       missing tangents, if baked on quads\n"
		"  nmtan --normal-map=n.png in.ply out.glb  a normal map and no material\n"
		"  nmtan --update -r -d out assets          a folder; again, only what changed\n"
		"\nOptions:\n"
		"  --fix                           repair what is proven wrong\n"
		"  --existing=keep|repair|replace  tangents of the input (default: keep)\n"
		"  --normals=smooth|flat|...       how to make missing normals\n"
		"  --quads=pairs                   solve pairs of triangles as quads\n"
		"  --normal-map=FILE               the normal map of a mesh without a material\n"
		"  -d DIR                          write each input into DIR\n"
		"  -r                              take folders as the meshes in them\n"
		"  --report=FILE                   write a report: .txt .json .html .sarif ...\n"
		"  --fail-on=error|warning|info    exit with 6 on such findings\n"
		"  -q                              print only errors, losses, wrong tangents\n"
		"\nnmtan --help prints all options, man nmtan explains them.\n");
	nt_buffer_text(out, exit_codes);
}

void nt_options_help(nt_buffer *out)
{
	nt_buffer_text(out, usage);
	nt_buffer_text(out, "- is standard input or output (GLB or PLY). -- ends the options.\n");
	for (size_t i = 0; i < nt_option_row_count; i++) {
		const nt_option_row *row = &nt_option_rows[i];
		if (row->kind == NT_OPTION_HEADING)
			nt_buffer_format(out, "\n%s:\n", row->name);
		else if (row->help)
			help_row(out, row);
	}
	nt_buffer_text(out, exit_codes);
}

void nt_options_usage(nt_buffer *out)
{
	nt_buffer_text(out, "usage: nmtan [options] INPUT OUTPUT\n"
		"       nmtan -h shows examples, nmtan --help all options\n");
}

void nt_options_explain(const nt_command *command, nt_buffer *out)
{
	bool chosen[NT_CODE_COUNT] = {false}, first = true;
	nt_error unused;
	for (size_t i = 0; i < command->explain.count; i++)
		nt_match_codes("explain", command->explain.items[i], chosen, &unused);
	for (size_t i = 0; i < command->operand_count; i++)
		nt_match_codes("explain", command->operands[i], chosen, &unused);
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		const nt_code_row *row = nt_code_info((nt_code)code);
		if (!chosen[code])
			continue;
		nt_buffer_format(out, "%s%s (%s)\n  %s\n  Remedy: ", first ? "" : "\n", row->name,
			nt_severity_name(row->severity), row->meaning);
		nt_remedy_text((nt_code)code, row->repair, NULL, NULL, out);
		nt_buffer_format(out, "\n  Smallest example: %s\n", row->example);
		first = false;
	}
}

/* Completions of a value: the words of a choice; nothing for numbers; files elsewhere. */
static bool has_words(const nt_option_row *row)
{
	return row->kind == NT_OPTION_CHOICE || row->kind == NT_OPTION_MAYBE_CHOICE ||
		row->kind == NT_OPTION_AUTO_NUMBER || (row->kind == NT_OPTION_TEXT && strchr(row->values, '|'));
}

/* A list of codes, perhaps each with a severity. */
static bool has_codes(const nt_option_row *row)
{
	return row->values && strncmp(row->values, "CODE", 4) == 0;
}

static void append_codes(nt_buffer *out)
{
	for (unsigned code = 0; code < NT_CODE_COUNT; code++)
		nt_buffer_format(out, "%s%s", code ? " " : "", nt_code_info((nt_code)code)->name);
}

/* The words of a row with blanks between them; N and X,Y,Z, which stand for numbers, are left out. */
static void append_words(nt_buffer *out, const nt_option_row *row)
{
	for (const char *v = row->values; *v;) {
		const size_t length = strcspn(v, "|");
		if (!(length == 1 && *v == 'N') && *v != 'X') {
			nt_buffer_text(out, v == row->values ? "" : " ");
			nt_buffer_append(out, v, length > 2 && v[length - 2] == ':' ? length - 1 : length);
		}
		v += length + (v[length] == '|');
	}
}

void nt_options_bash(nt_buffer *out)
{
	nt_buffer_text(out,
		"# bash completion for nmtan, printed by nmtan --completion=bash\n"
		"_nmtan()\n{\n"
		"\tlocal word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]} list= value=\n"
		"\tCOMPREPLY=()\n"
		"\t# bash takes = for a word of its own\n"
		"\tif [[ $word == = ]]; then\n\t\tword= value=1\n"
		"\telif [[ $option == = ]]; then\n\t\toption=${COMP_WORDS[COMP_CWORD-2]} value=1\n\tfi\n"
		"\tcase $option in\n");
	for (size_t i = 0; i < nt_option_row_count; i++) {
		const nt_option_row *row = &nt_option_rows[i];
		if (!shown(row) || !row->values)
			continue;
		nt_buffer_format(out, "\t--%s", row->name);
		if (row->letter)
			nt_buffer_format(out, " | -%c", row->letter);
		nt_buffer_text(out, ")\n");
		if (row->kind == NT_OPTION_MAYBE_CHOICE) {
			nt_buffer_text(out, "\t\tif [[ $value ]]; then\n\t\t\tCOMPREPLY=($(compgen -W '");
			append_words(out, row);
			nt_buffer_text(out, "' -- \"$word\"))\n\t\t\treturn\n\t\tfi ;;\n");
			continue;
		}
		if (has_words(row)) {
			nt_buffer_text(out, "\t\tCOMPREPLY=($(compgen -W '");
			append_words(out, row);
			nt_buffer_text(out, "' -- \"$word\"))\n");
		} else if (has_codes(row)) {
			/* behind what is there of the list */
			nt_buffer_text(out, "\t\t[[ $word == *,* ]] && list=${word%,*},\n"
				"\t\tcompopt -o nospace\n\t\tCOMPREPLY=($(compgen -P \"$list\" -W '");
			append_codes(out);
			nt_buffer_text(out, "' -- \"${word##*,}\"))\n");
		} else if (nt_option_is_name(row)) {
			nt_buffer_format(out, "\t\tCOMPREPLY=($(compgen -%c -- \"$word\"))\n",
				strcmp(row->values, "DIR") == 0 ? 'd' : 'f');
		}
		nt_buffer_text(out, "\t\treturn ;;\n");
	}
	/* bash takes the = of CODE=LEVEL for a word of its own, too */
	nt_buffer_text(out, "\t[A-Z]*_*)\n\t\tCOMPREPLY=($(compgen -W 'error warning info off' -- \"$word\"))\n"
		"\t\treturn ;;\n");
	nt_buffer_text(out, "\tesac\n\tif [[ $word == -* ]]; then\n\t\tCOMPREPLY=($(compgen -W '");
	bool first = true;
	for (size_t i = 0; i < nt_option_row_count; i++) {
		const nt_option_row *row = &nt_option_rows[i];
		if (!shown(row))
			continue;
		nt_buffer_format(out, "%s--%s%s", first ? "" : " ", row->name,
			row->values && row->kind != NT_OPTION_MAYBE_CHOICE ? "=" : "");
		first = false;
	}
	nt_buffer_text(out,
		"' -- \"$word\"))\n"
		"\t\t[[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace\n"
		"\telse\n\t\tCOMPREPLY=($(compgen -f -- \"$word\"))\n\tfi\n}\n"
		"complete -o filenames -F _nmtan nmtan\n");
}

/* Inside '...[help]': brackets, colons and apostrophes mean something to zsh. */
static void append_zsh(nt_buffer *out, const char *text)
{
	for (; *text; text++) {
		if (*text == '\'')
			nt_buffer_text(out, "'\\''");
		else if (strchr("[]:\\", *text))
			nt_buffer_format(out, "\\%c", *text);
		else
			nt_buffer_append(out, text, 1);
	}
}

static void zsh_spec(nt_buffer *out, const nt_option_row *row, bool letter)
{
	if (letter)
		nt_buffer_format(out, "\t'-%c%s[", row->letter, row->values ? "+" : "");
	else
		nt_buffer_format(out, "\t'--%s%s[", row->name,
			row->kind == NT_OPTION_MAYBE_CHOICE ? "=-" : row->values ? "=" : "");
	append_zsh(out, row->help);
	nt_buffer_text(out, "]");
	if (has_words(row)) {
		nt_buffer_format(out, "%s:%s:(", row->kind == NT_OPTION_MAYBE_CHOICE ? ":" : "", row->name);
		append_words(out, row);
		nt_buffer_text(out, ")");
	} else if (has_codes(row)) {
		nt_buffer_format(out, ":%s:_values -s , code ", row->values);
		append_codes(out);
	} else if (row->values) {
		nt_buffer_format(out, ":%s:%s", row->values, !nt_option_is_name(row) ? " "
			: strcmp(row->values, "DIR") == 0 ? "_files -/" : "_files");
	}
	nt_buffer_text(out, "' \\\n");
}

void nt_options_zsh(nt_buffer *out)
{
	nt_buffer_text(out, "#compdef nmtan\n# printed by nmtan --completion=zsh\n_arguments -s -S \\\n");
	for (size_t i = 0; i < nt_option_row_count; i++) {
		const nt_option_row *row = &nt_option_rows[i];
		if (!shown(row))
			continue;
		if (row->letter)
			zsh_spec(out, row, true);
		zsh_spec(out, row, false);
	}
	nt_buffer_text(out, "\t'*:mesh:_files'\n");
}

/* ---- what shapes outputs ---- */

static void append_shaping(nt_buffer *out, const nt_option_row *row, const void *field)
{
	nt_buffer_format(out, "%s--%s", out->size ? " " : "", row->name);
	if (row->kind == NT_OPTION_CHOICE) {
		nt_buffer_text(out, "=");
		const char *word = row->values;
		for (int number = *(const int *)field - row->first; number > 0; number--)
			word += strcspn(word, "|") + 1;
		const size_t length = strcspn(word, "|");
		const bool numbered = length > 2 && memcmp(word + length - 2, ":N", 2) == 0;
		nt_buffer_append(out, word, numbered ? length - 1 : length);
		if (numbered)
			nt_buffer_format(out, "%d", ((const int *)field)[1]); /* see option_table.c */
	} else if (row->kind == NT_OPTION_TEXT) {
		nt_buffer_format(out, "=%s", *(const char *const *)field);
	} else if (row->kind == NT_OPTION_LIST) {
		const nt_words *words = field;
		for (size_t i = 0; i < words->count; i++)
			nt_buffer_format(out, "%s%s=%s", i ? " --" : "", i ? row->name : "", words->items[i]);
	} else if (row->kind == NT_OPTION_SIZE) {
		nt_buffer_format(out, "=%" PRIu64, *(const uint64_t *)field);
	} else if (row->kind != NT_OPTION_FLAG && row->kind != NT_OPTION_SET) {
		nt_buffer_format(out, "=%d", *(const int *)field);
	}
}

/* How many bytes of the command a row's value takes. */
static size_t field_bytes(const nt_option_row *row)
{
	switch (row->kind) {
	case NT_OPTION_FLAG: return sizeof(bool);
	case NT_OPTION_TEXT: return sizeof(char *);
	case NT_OPTION_LIST: return sizeof(nt_words);
	case NT_OPTION_SIZE: return sizeof(uint64_t);
	default: return sizeof(int);
	}
}

static bool is_one_of(const nt_option_row *row, const char *const *names, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (strcmp(row->name, names[i]) == 0)
			return true;
	return false;
}

/* Whether an option has a value that is not the default. */
static bool is_given(const nt_command *command, const nt_option_row *row)
{
	return row->kind != NT_OPTION_HEADING && memcmp((const char *)command + row->offset,
		(const char *)&nt_default_command + row->offset, field_bytes(row)) != 0;
}

/* The next row that shapes outputs and is given; *i: 0 before the first. */
static const nt_option_row *next_shaping(const nt_command *command, size_t *i, bool *shapes)
{
	/* options about the output that change when and how it is written, but not what */
	static const char *const writing[] = {"output", "in-place", "no-clobber", "sync", "verify", "dry-run"};
	while (*i < nt_option_row_count) {
		const nt_option_row *row = &nt_option_rows[(*i)++];
		if (row->kind == NT_OPTION_HEADING)
			*shapes = row->first == NT_SHAPES_OUTPUT;
		else if (*shapes && is_given(command, row) &&
			!is_one_of(row, writing, sizeof writing / sizeof *writing))
			return row;
	}
	return NULL;
}

void nt_options_shaping(const nt_command *command, bool folders, nt_buffer *out)
{
	bool shapes = false;
	size_t i = 0;
	for (const nt_option_row *row; (row = next_shaping(command, &i, &shapes)) != NULL;)
		if (folders || row->kind != NT_OPTION_LIST)
			append_shaping(out, row, (const char *)command + row->offset);
}

void nt_options_given(const nt_command *command, nt_buffer *out)
{
	bool shapes = false;
	size_t i = 0;
	for (const nt_option_row *row; (row = next_shaping(command, &i, &shapes)) != NULL;) {
		const nt_words *words = (const void *)((const char *)command + row->offset);
		const size_t count = row->kind == NT_OPTION_LIST ? words->count : 1;
		for (size_t k = 0; k < count; k++) {
			nt_buffer word = {0}, shown = {0};
			if (row->kind == NT_OPTION_LIST)
				nt_buffer_format(&word, "--%s=%s", row->name, words->items[k]);
			else
				append_shaping(&word, row, words);
			if (word.data && nt_shell_word(word.data, &shown))
				nt_buffer_format(out, "%s%s", out->size ? "\n" : "", shown.data);
			nt_buffer_free_into(&word, out);
			nt_buffer_free_into(&shown, out);
		}
	}
}

void nt_options_judging(const nt_command *command, nt_buffer *out)
{
	static const char *const judging[] = {"check-maps", "ignore", "severity", "baseline", "path-prefix",
		"min-severity"};
	char digest[NT_DIGEST_TEXT] = "";
	nt_error unused; /* who reads it says so */
	for (size_t i = 0; i < nt_option_row_count; i++)
		if (is_given(command, &nt_option_rows[i]) &&
			is_one_of(&nt_option_rows[i], judging, sizeof judging / sizeof *judging))
			append_shaping(out, &nt_option_rows[i], (const char *)command + nt_option_rows[i].offset);
	if (command->baseline && nt_digest_of_file(command->baseline, digest, &unused) == NT_OK)
		nt_buffer_format(out, " %s", digest);
}
