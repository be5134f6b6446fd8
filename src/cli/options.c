/* SPDX-License-Identifier: MIT */
/*
 * The parser of the command line: see options.h. The options are in option_table.c.
 *
 * Only --update takes an optional value (after =), names are not abbreviated, and a number is a whole word of digits:
 * what is not understood is refused with the word that was wrong, because a tool that guesses turns a
 * slip of the finger into a wrong file.
 */
#include "cli/options.h"

#include <fnmatch.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include "file/input.h"
#include "report/report.h"
#include "scene/values.h"

/* The parser's memory: which rows were given. */
typedef struct parser {
	nt_command *command;
	nt_error *error;
	bool given[NT_MOST_OPTIONS];
} parser;

static const nt_option_row *find_long(const char *name, size_t length)
{
	for (size_t i = 0; i < nt_option_row_count; i++) {
		const nt_option_row *row = &nt_option_rows[i];
		if (row->kind != NT_OPTION_HEADING && strlen(row->name) == length &&
			memcmp(row->name, name, length) == 0)
			return row;
	}
	return NULL;
}

/* A whole word of digits, at most `most`; -1 for anything else. */
static int number_of(const char *word, int most)
{
	int number = 0;
	if (!*word)
		return -1;
	for (; *word; word++) {
		if (*word < '0' || *word > '9')
			return -1;
		number = number * 10 + (*word - '0');
		if (number > most)
			return -1;
	}
	return number;
}

/* The number of a word among the values; -1: it is none. For a value that ends in :N *count becomes N, up to most. */
static int choice_of(const char *values, const char *word, int most, int *count)
{
	const size_t length = strlen(word);
	int number = 0;
	for (const char *v = values;; number++) {
		const size_t here = strcspn(v, "|");
		if (here == length && memcmp(v, word, length) == 0 && v[here - 1] != 'N')
			return number;
		if (here > 2 && v[here - 2] == ':' && strncmp(v, word, here - 1) == 0) {
			*count = number_of(word + here - 1, most);
			return *count < 0 ? -1 : number;
		}
		if (!v[here])
			return -1;
		v += here + 1;
	}
}

/* "64M": a whole number, and what it counts, as GNU's tools have it: nothing for bytes; K, M, G, T or KiB, MiB, GiB,
 * TiB for powers of 1024; kB, KB, MB, GB, TB for powers of 1000. UINT64_MAX for anything else. */
static uint64_t size_of(const char *word)
{
	static const char units[] = "KMGT";
	uint64_t number = 0;
	const char *at = word;
	for (; *at >= '0' && *at <= '9'; at++)
		if (__builtin_mul_overflow(number, 10, &number) ||
			__builtin_add_overflow(number, (uint64_t)(*at - '0'), &number))
			return UINT64_MAX;
	if (at == word)
		return UINT64_MAX;
	if (!*at)
		return number;
	const char *unit = strchr(units, *at == 'k' ? 'K' : *at);
	const bool binary = !at[1] || strcmp(at + 1, "iB") == 0;
	if (!unit || (*at == 'k' && binary) || (!binary && strcmp(at + 1, "B") != 0))
		return UINT64_MAX;
	for (const char *u = units; u <= unit; u++)
		if (__builtin_mul_overflow(number, binary ? 1024 : 1000, &number))
			return UINT64_MAX;
	return number;
}

static nt_status refuse_value(parser *p, const nt_option_row *row, const char *word)
{
	if (row->kind == NT_OPTION_CHOICE || row->kind == NT_OPTION_MAYBE_CHOICE) {
		char list[128];
		int count;
		const char *colon = strchr(word, ':');
		snprintf(list, sizeof list, "%.*s0", colon ? (int)(colon - word) + 1 : 0, word);
		if (colon && choice_of(row->values, list, row->most, &count) >= 0)
			return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '%s': '%s' is not a number from 0 to %d",
				row->name, word, colon + 1, row->most);
		snprintf(list, sizeof list, "%s", row->values);
		for (char *c = list; *c; c++)
			*c = *c == '|' ? ' ' : *c;
		return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '%s' is none of: %s", row->name, word,
			list);
	}
	if (row->kind == NT_OPTION_SIZE)
		return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '%s' is not a size, as 500M, 2GiB or 2GB",
			row->name, word);
	return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '%s' is not %sa number from 0 to %d",
		row->name, word, row->kind == NT_OPTION_AUTO_NUMBER ? "auto or " : "", row->most);
}

static nt_status refuse_empty(parser *p, const nt_option_row *row)
{
	return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '' is no %s", row->name, row->values);
}

/* Names of files that the system does not take: what is made of them step by step would take long. */
static nt_status refuse_long(parser *p, const char *word)
{
	return nt_fail(p->error, NT_ERROR_USAGE, "'%.*s...' has %zu bytes, which no file's name has", NT_CUT(40, word),
		strlen(word));
}

bool nt_option_is_name(const nt_option_row *row)
{
	static const char *const names[] = {"FILE", "DIR", "ROOT", "GLOB"};
	for (size_t i = 0; i < sizeof names / sizeof *names; i++)
		if (row->values && strcmp(row->values, names[i]) == 0)
			return true;
	return false;
}

static nt_status append_word(parser *p, const nt_option_row *row, nt_words *words, const char *word)
{
	if (!*word)
		return refuse_empty(p, row);
	if (words->count == NT_MOST_WORDS)
		return nt_fail(p->error, NT_ERROR_USAGE, "--%s is there more than %d times: '%s'", row->name,
			NT_MOST_WORDS, word);
	words->items[words->count++] = word;
	return NT_OK;
}

/* Stores what one option says; word is NULL where it takes none. */
static nt_status apply(parser *p, const nt_option_row *row, const char *word)
{
	char *field = (char *)p->command + row->offset;
	int value = row->first, count = -1;
	uint64_t size;
	p->given[row - nt_option_rows] = true;
	if (word && nt_option_is_name(row) && nt_name_is_too_long(word))
		return refuse_long(p, word);
	switch (row->kind) {
	case NT_OPTION_HEADING:
		break;
	case NT_OPTION_FLAG:
		*(bool *)field = true;
		break;
	case NT_OPTION_SET:
		memcpy(field, &value, sizeof value);
		break;
	case NT_OPTION_CHOICE:
	case NT_OPTION_MAYBE_CHOICE:
		value = word ? choice_of(row->values, word, row->most, &count) : 0;
		if (value < 0)
			return refuse_value(p, row, word);
		if (count >= 0)
			memcpy(field + sizeof value, &count, sizeof count);
		value += row->first;
		memcpy(field, &value, sizeof value);
		break;
	case NT_OPTION_AUTO_NUMBER:
	case NT_OPTION_NUMBER:
		value = number_of(word, row->most);
		if (value < 0 && !(row->kind == NT_OPTION_AUTO_NUMBER && strcmp(word, "auto") == 0))
			return refuse_value(p, row, word);
		memcpy(field, &value, sizeof value);
		break;
	case NT_OPTION_SIZE:
		size = size_of(word);
		if (size == UINT64_MAX)
			return refuse_value(p, row, word);
		memcpy(field, &size, sizeof size);
		break;
	case NT_OPTION_TEXT:
		if (!*word)
			return refuse_empty(p, row);
		/* of two choices the last one counts, but a name or a list would be lost */
		if (*(const char **)(void *)field)
			return nt_fail(p->error, NT_ERROR_USAGE, "--%s is there twice: '%s' and '%s'%s", row->name,
				*(const char **)(void *)field, word,
				strcmp(row->name, "report") == 0 ? "; another run writes the other" : "");
		*(const char **)(void *)field = word;
		break;
	case NT_OPTION_LIST:
		return append_word(p, row, (nt_words *)(void *)field, word);
	}
	return NT_OK;
}

/* How many letters have to be added, taken away, changed or exchanged with their neighbour to get from one word to
 * the other (the restricted Damerau-Levenshtein distance); words beyond MOST_LETTERS are far from all. */
enum { MOST_LETTERS = 31 };
static size_t distance_of(const char *a, size_t a_length, const char *b, size_t b_length)
{
	size_t rows[3][MOST_LETTERS + 1];
	if (a_length > MOST_LETTERS || b_length > MOST_LETTERS)
		return SIZE_MAX;
	for (size_t k = 0; k <= b_length; k++)
		rows[0][k] = k;
	for (size_t i = 1; i <= a_length; i++) {
		size_t *row = rows[i % 3];
		const size_t *above = rows[(i - 1) % 3], *top = rows[(i + 1) % 3];
		row[0] = i;
		for (size_t k = 1; k <= b_length; k++) {
			const size_t change = above[k - 1] + (a[i - 1] != b[k - 1]);
			const size_t shorter = above[k] < row[k - 1] ? above[k] : row[k - 1];
			row[k] = change < shorter + 1 ? change : shorter + 1;
			if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1] && top[k - 2] + 1 < row[k])
				row[k] = top[k - 2] + 1;
		}
	}
	return rows[a_length % 3][b_length];
}

static const char *option_name(size_t number)
{
	const nt_option_row *row = &nt_option_rows[number];
	return row->kind == NT_OPTION_HEADING || !row->help ? "" : row->name;
}

static const char *code_name(size_t number)
{
	return nt_code_info((nt_code)number)->name;
}

/* Whether a name has a word, of those between its hyphens. */
static bool has_word(const char *name, const char *word, size_t length)
{
	for (size_t n = strcspn(name, "-"); *name; name += n + (name[n] == '-'), n = strcspn(name, "-"))
		if (n == length && strncmp(name, word, n) == 0)
			return true;
	return false;
}

/* The name that was probably meant: one that begins so, or at most a third of the letters away; else one that is a
 * word of it, or has one. NULL: none. */
static const char *find_nearest(const char *name, size_t length, const char *(*name_of)(size_t number), size_t count)
{
	const char *nearest = NULL;
	size_t least = length / 3 + 1;
	for (size_t i = 0; i < count; i++) {
		const char *other = name_of(i);
		const bool begins = length >= 3 && strncmp(other, name, length) == 0;
		const size_t distance = begins ? 0 : distance_of(name, length, other, strlen(other));
		if (distance < least) {
			least = distance;
			nearest = other;
		}
	}
	for (int whole = 1; !nearest && whole >= 0; whole--)
		for (size_t begin = 0, n; !nearest && begin < length; begin += n + 1) {
			n = strcspn(name + begin, "-=");
			for (size_t i = 0; i < count && !nearest; i++)
				if (has_word(name_of(i), name + begin, n) && (!whole || strlen(name_of(i)) == n))
					nearest = name_of(i);
		}
	return nearest;
}

/* One word of a list. */
static nt_status match_code(const char *option, const char *spelled, bool chosen[NT_CODE_COUNT], nt_error *error)
{
	bool found = false;
	char word[128];
	snprintf(word, sizeof word, "%s", spelled);
	for (char *c = word; *c; c++)
		*c = (char)(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
	for (size_t code = 0; code < NT_CODE_COUNT; code++) {
		const bool matches = fnmatch(word, code_name(code), 0) == 0;
		chosen[code] |= matches;
		found |= matches;
	}
	if (found)
		return NT_OK;
	const char *nearest = find_nearest(word, strlen(word), code_name, NT_CODE_COUNT);
	return nt_fail(error, NT_ERROR_USAGE, "--%s: '%s' is no code of a finding; %s%s%s", option, spelled,
		nearest ? "did you mean " : "--list-codes shows them all", nearest ? nearest : "", nearest ? "?" : "");
}

nt_status nt_match_codes(const char *option, const char *list, bool chosen[NT_CODE_COUNT], nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t length; *list && !status; list += length + (list[length] == ',')) {
		char word[128];
		length = strcspn(list, ",");
		snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), list);
		status = match_code(option, word, chosen, error);
	}
	return status;
}

/* Whether the next word is the value of an option that needs one. One that is an option itself is none, as in
 * --baseline --check; "-" is a name, and -1 a number that is wrong. */
static nt_status take_next(parser *p, const char *option, const nt_option_row *row, const char *next)
{
	if (next && (next[0] != '-' || !next[1] || (next[1] >= '0' && next[1] <= '9')))
		return NT_OK;
	return next ? nt_fail(p->error, NT_ERROR_USAGE, "%s needs a value: %s; if that is '%s': --%s=%s", option,
			      row->values, next, row->name, next)
		    : nt_fail(p->error, NT_ERROR_USAGE, "%s needs a value: %s", option, row->values);
}

/* --name, --name=value, --name value. *used becomes 2 if the next word belongs to it. */
static nt_status parse_long(parser *p, const char *word, const char *next, int *used)
{
	const char *name = word + 2;
	const size_t length = strcspn(name, "=");
	const nt_option_row *row = find_long(name, length);
	if (!row) {
		const char *nearest = find_nearest(name, length, option_name, nt_option_row_count);
		return nt_fail(p->error, NT_ERROR_USAGE, "unknown option '%.*s'%s%s%s", (int)length + 2, word,
			nearest ? "; did you mean --" : "", nearest ? nearest : "", nearest ? "?" : "");
	}
	const char *value = name[length] ? name + length + 1 : NULL;
	if (!row->values) {
		if (value)
			return nt_fail(p->error, NT_ERROR_USAGE, "--%s takes no value, here it has '%s'",
				row->name, value);
		return apply(p, row, NULL);
	}
	if (!value && row->kind != NT_OPTION_MAYBE_CHOICE) {
		char option[64];
		snprintf(option, sizeof option, "--%s", row->name);
		if (take_next(p, option, row, next))
			return p->error->status;
		value = next;
		*used = 2;
	}
	return apply(p, row, value);
}

/* -q, -qv, -j8, -j 8. */
static nt_status parse_short(parser *p, const char *word, const char *next, int *used)
{
	for (const char *letter = word + 1; *letter; letter++) {
		const nt_option_row *row = nt_option_rows, *end = row + nt_option_row_count;
		while (row < end && row->letter != *letter)
			row++;
		if (row == end) {
			/* A whole character, should it be one of several bytes. */
			int bytes = 1;
			while (((unsigned char)letter[bytes] & 0xc0) == 0x80)
				bytes++;
			return nt_fail(p->error, NT_ERROR_USAGE, "unknown option '-%.*s'%s%s%s%s", bytes, letter,
				word[2] ? " in '" : "", word[2] ? word : "", word[2] ? "'" : "",
				*letter == 'V' ? "; did you mean --version?" : "");
		}
		if (!row->values) {
			if (apply(p, row, NULL))
				return p->error->status;
			if (*letter == 'h')
				p->command->action = NT_ACTION_FIRST_HELP; /* one screen; --help has all */
			continue;
		}
		if (letter[1])
			return apply(p, row, letter + 1);
		const char option[] = {'-', *letter, '\0'};
		if (take_next(p, option, row, next))
			return p->error->status;
		*used = 2;
		return apply(p, row, next);
	}
	return NT_OK;
}

static bool given(const parser *p, const char *name)
{
	return p->given[find_long(name, strlen(name)) - nt_option_rows];
}

/* "14,12,12,12": four whole numbers. Tangents of less than 12 bits can be seen; more than 24 a float does not have. */
static nt_status parse_draco(parser *p)
{
	static const struct {
		const char *what;
		int least;
	} parts[NT_DRACO_BITS_COUNT] = {{"positions", 1}, {"normals", 2}, {"texture coordinates", 1},
		{"tangents", 12}};
	enum { MOST = NT_DRACO_MOST_BITS };
	const char *word = p->command->draco_bits;
	for (size_t i = 0; word && i < NT_DRACO_BITS_COUNT; i++) {
		char number[16] = "";
		const size_t length = strcspn(word, ",");
		const bool last = i + 1 == NT_DRACO_BITS_COUNT;
		if (last != !word[length])
			return nt_fail(p->error, NT_ERROR_USAGE,
				"--draco-bits: '%s' is not four numbers", p->command->draco_bits);
		if (length < sizeof number)
			memcpy(number, word, length);
		const int bits = number_of(number, MOST);
		if (bits < parts[i].least)
			return nt_fail(p->error, NT_ERROR_USAGE,
				"--draco-bits: '%.*s' for %s is not a number from %d to %d", (int)length, word,
				parts[i].what, parts[i].least, MOST);
		p->command->settings.io.draco_bits[i] = bits;
		word += length + 1;
	}
	if (p->command->draco_bits && p->command->settings.io.draco == NT_DRACO_OFF)
		return nt_fail(p->error, NT_ERROR_USAGE, "--draco=off leaves nothing for --draco-bits");
	return NT_OK;
}

/* A number above 0 and at most `most`, or with `share` the quotient of two. */
static nt_status parse_number(parser *p, const char *option, const char *word, bool share, double most,
	const char *expected, double *number)
{
	char *end;
	if (!word)
		return NT_OK;
	*number = strtod(word, &end);
	if (share && *end == '/')
		*number /= strtod(end + 1, &end);
	if (!*end && *number > 0 && *number <= most)
		return NT_OK;
	return nt_fail(p->error, NT_ERROR_USAGE, "--%s: '%s' is not a number above 0%s", option, word, expected);
}

/* "431236,5412347,101". A value that means a default is replaced by it, for the record of an
 * incremental run. */
static nt_status parse_origin(parser *p)
{
	nt_origin *origin = &p->command->settings.io.origin;
	const char *word = p->command->origin;
	static const double most = 1e30; /* so that what is left of a float is one */
	if (word && strcmp(word, "auto") == 0)
		p->command->origin = NULL;
	if (!p->command->origin)
		return NT_OK;
	origin->choice = strcmp(word, "keep") == 0 ? NT_ORIGIN_KEEP : NT_ORIGIN_GIVEN;
	bool sound = strspn(word, "+-.0123456789eE,") == strlen(word);
	char *end = (char *)(uintptr_t)word;
	for (size_t k = 0; k < 3 && sound && origin->choice == NT_ORIGIN_GIVEN; k++) {
		const char *begin = end;
		origin->at[k] = strtod(begin, &end) + 0.0; /* -0 is 0 */
		sound = end > begin && fabs(origin->at[k]) <= most && *end == (k < 2 ? ',' : '\0');
		end++;
	}
	if (origin->choice == NT_ORIGIN_GIVEN && !sound)
		return nt_fail(p->error, NT_ERROR_USAGE,
			"--origin: '%s' is neither auto nor keep nor three numbers, as 431000,5412000,0", word);
	if (origin->choice == NT_ORIGIN_GIVEN && !nt_origin_is_given(origin)) {
		origin->choice = NT_ORIGIN_KEEP;
		p->command->origin = "keep";
	}
	return NT_OK;
}

/* Options that contradict each other, or of which one is nothing without the other. */
static nt_status check_clashes(parser *p)
{
	static const struct {
		const char *one, *other, *unless, *message; /* message NULL: the first needs the other */
	} clashes[] = {
		{"quiet", "verbose", NULL, " say opposite things"},
		{"check", "fix", NULL, " exclude each other: check what --fix has written"},
		{"fix", "existing", NULL, " contradict each other: --fix decides for each primitive"},
		{"fix", "flip-green", NULL, " contradict each other: --fix turns the maps that need it"},
		{"in-place", "no-clobber", NULL, " contradict each other"},
		{"keep-tree", "directory", NULL, NULL},
		{"include", "recursive", NULL, NULL},
		{"exclude", "recursive", NULL, NULL},
		/* what is not read has no findings */
		{"update", "report", "check", " do not go together: a report needs inputs that --update skips"},
		{"diff", "check", NULL, NULL},
		{"output", "directory", NULL, " both say where to write"},
		{"output", "in-place", "directory", " both say where to write"},
	};
	for (size_t i = 0; i < sizeof clashes / sizeof *clashes; i++) {
		const bool needs = !clashes[i].message;
		if (!given(p, clashes[i].one) || given(p, clashes[i].other) == needs ||
			(clashes[i].unless && given(p, clashes[i].unless)))
			continue;
		return nt_fail(p->error, NT_ERROR_USAGE, "--%s %s --%s%s", clashes[i].one, needs ? "needs" : "and",
			clashes[i].other, !needs ? clashes[i].message
			: strcmp(clashes[i].one, "diff") == 0 ? ": nmtan --check --diff OLD NEW" : "");
	}
	/* findings that are not reported do not count */
	if (given(p, "fail-on") && p->command->fail_on != NT_FAIL_ON_NEVER &&
		p->command->fail_on > p->command->min_severity)
		return nt_fail(p->error, NT_ERROR_USAGE,
			"--fail-on counts what --min-severity shows: let --min-severity name the same "
			"severity or a lower one");
	return NT_OK;
}

bool nt_command_is_many(const nt_command *command)
{
	return command->settings.check || command->directory || command->settings.in_place;
}

/* Which option names more inputs than the words do; NULL: none. */
static const char *list_option(const nt_command *c)
{
	return c->files_from ? "files-from" : c->recursive ? "recursive" : NULL;
}

static bool is_dash(const char *name)
{
	return name && strcmp(name, "-") == 0;
}

/* With what the user may mean; an OBJ or Draco file is not written in place, and standard input has no name. */
static nt_status fail_without_output(const parser *p, const char *input)
{
	nt_buffer command = {0};
	const char *dot = strrchr(input, '.');
	const bool stays = !dot || (strcasecmp(dot, ".obj") != 0 && strcasecmp(dot, ".drc") != 0);
	nt_command_text("", NULL, input, "OUT.glb", &command);
	nt_fail(p->error, NT_ERROR_USAGE, "OUTPUT is missing: %s%s%s or --check",
		command.data ? command.data : "nmtan IN OUT", is_dash(input) ? "" : ", -d DIR",
		stays && !is_dash(input) ? ", --in-place" : "");
	nt_buffer_free(&command);
	return p->error->status;
}

/* Too few or too many names. */
static nt_status check_count(const parser *p)
{
	const nt_command *c = p->command;
	const size_t count = c->operand_count;
	const bool many = nt_command_is_many(c);
	const char *first = count && !many ? c->operands[0] : "";
	const nt_option_row *meant = find_long(first, strlen(first));
	if (meant && strcmp(meant->name, first) == 0 && access(first, F_OK))
		return nt_fail(p->error, NT_ERROR_USAGE, "there is no file '%s'; did you mean --%s?", first, first);
	if (list_option(c) && !many)
		return nt_fail(p->error, NT_ERROR_USAGE, "--%s is for many inputs: use -d DIR, --in-place or --check",
			list_option(c));
	if (count == 0 && !c->files_from)
		return nt_fail(p->error, NT_ERROR_USAGE, "INPUT is missing");
	if (!many && count == 1)
		return fail_without_output(p, c->operands[0]);
	if (c->settings.check && c->output && (count > 1 || list_option(c)))
		return nt_fail(p->error, NT_ERROR_USAGE, "--output names the output of one input; for many use -d DIR");
	/* -o comes last of the operands */
	const size_t extra = c->output && !c->settings.check ? 1 : 2;
	if (!many && count > 2)
		return nt_fail(p->error, NT_ERROR_USAGE,
			"'%s' is one name too many; for many inputs use -d DIR or --in-place", c->operands[extra]);
	return NT_OK;
}

/* "-" where a name is needed. */
static nt_status check_dashes(const parser *p)
{
	const nt_command *c = p->command;
	const bool many = nt_command_is_many(c);
	size_t dashes = 0;
	const size_t inputs = many ? c->operand_count : 1;
	for (size_t i = 0; i < inputs; i++)
		dashes += is_dash(c->operands[i]);
	if (dashes && (c->directory || c->settings.in_place))
		return nt_fail(p->error, NT_ERROR_USAGE, "'-' has no name to write under: not with --%s",
			c->directory ? "directory" : "in-place");
	if (dashes + is_dash(c->files_from) > 1)
		return nt_fail(p->error, NT_ERROR_USAGE, "'-' can be read once only");
	if (many || !is_dash(c->operands[1]))
		return NT_OK;
	if (c->settings.output_format == NT_FORMAT_GLTF && c->settings.io.buffers != NT_BUFFERS_EMBED)
		return nt_fail(p->error, NT_ERROR_USAGE,
			"'-' has no place for the .bin of --output-format=gltf: add --buffers=embed");
	if (c->depfile)
		return nt_fail(p->error, NT_ERROR_USAGE, "--depfile is about files; '-' is none");
	if (c->settings.verify)
		return nt_fail(p->error, NT_ERROR_USAGE, "--verify reads the output back, which '-' does not allow");
	return NT_OK;
}

const nt_command nt_default_command = {.settings = {.io.texcoord_set = -1, .io.outside = NT_OUTSIDE_ROOT},
	.fail_on = NT_FAIL_ON_NEVER, .min_severity = NT_FAIL_ON_INFO, .max_issues = -1};

/* --explain A B: operands are codes, too. */
static nt_status parse_explain(nt_command *command, nt_error *error)
{
	bool chosen[NT_CODE_COUNT] = {false};
	nt_status status = NT_OK;
	command->action = NT_ACTION_EXPLAIN;
	for (size_t i = 0; i < command->explain.count && !status; i++)
		status = nt_match_codes("explain", command->explain.items[i], chosen, error);
	for (size_t i = 0; i < command->operand_count && !status; i++)
		status = nt_match_codes("explain", command->operands[i], chosen, error);
	return status;
}

nt_status nt_options_parse(int argc, char **argv, nt_command *command, nt_error *error)
{
	parser p = {.command = command, .error = error};
	*command = nt_default_command;

	/* Operands move to the front, behind the program's name, in their order. */
	int kept = argc > 0 ? 1 : 0;
	bool options = true;
	for (int i = kept; i < argc;) {
		char *word = argv[i];
		const char *next = i + 1 < argc ? argv[i + 1] : NULL;
		int used = 1;
		nt_status status = NT_OK;
		if (!word[0])
			status = nt_fail(error, NT_ERROR_USAGE, "'' is no name of a file");
		else if (!options || word[0] != '-' || !word[1])
			status = nt_name_is_too_long(argv[kept++] = word) ? refuse_long(&p, word) : NT_OK;
		else if (strcmp(word, "--") == 0)
			options = false;
		else if (word[1] == '-')
			status = parse_long(&p, word, next, &used);
		else
			status = parse_short(&p, word, next, &used);
		if (status)
			return status;
		i += used;
	}
	const int first = argc > 0 ? 1 : 0;
	command->operands = (const char **)(void *)(argv + first);
	if (command->output && !command->settings.check) /* -o and its value left room for it */
		argv[kept++] = (char *)(uintptr_t)command->output;
	command->operand_count = (size_t)(kept - first);
	if (command->settings.check && !given(&p, "fail-on"))
		command->fail_on = NT_FAIL_ON_ERROR;
	command->settings.dry_run |= command->settings.check;
	if (command->action == NT_ACTION_RUN && command->explain.count)
		return parse_explain(command, error);
	if (command->action != NT_ACTION_RUN)
		return NT_OK;
	command->settings.texture_path_count = command->texture_paths.count;
	if (command->texture_paths.count)
		command->settings.texture_paths = command->texture_paths.items;
	for (size_t i = 0; i < nt_option_row_count && command->settings.check; i++)
		command->settings.converts |= nt_option_rows[i].writes && p.given[i];
	/* For one input an image beside it is proposed. */
	command->settings.own_input = !command->directory &&
		!command->settings.in_place && !list_option(command) &&
		command->operand_count == (command->settings.check ? 1 : 2);
	nt_status status = parse_draco(&p);
	/* a height map can be as deep as wide, which is more than anybody bakes */
	if (!status)
		status = parse_number(&p, "bump-height", command->bump_height, true, 1, " and up to 1, as 0.02 or 1/64",
			&command->settings.bump_height);
	if (!status)
		status = parse_origin(&p);
	if (!status)
		status = parse_number(&p, "max-seconds", command->max_seconds, false, 1e9, ", as 30 or 0.5",
			&command->settings.max_seconds);
	if (!status)
		status = check_clashes(&p);
	if (!status)
		status = check_count(&p);
	return status ? status : check_dashes(&p);
}
