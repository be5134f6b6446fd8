/* SPDX-License-Identifier: MIT */
/*
 * The options of the command line: one table, from which the parser, --help and the completions come.
 * A new option is a new row in option_table.c and, where it is not one of the pipeline's settings,
 * a field of nt_command.
 */
#ifndef NT_CLI_OPTIONS_H
#define NT_CLI_OPTIONS_H

#include "base/text.h"
#include "batch/update.h"
#include "pipeline/run.h"

/* Actions that words ask for. */
enum nt_action {
	NT_ACTION_RUN,
	NT_ACTION_HELP,
	NT_ACTION_FIRST_HELP,
	NT_ACTION_VERSION,
	NT_ACTION_LIST_CODES,
	NT_ACTION_EXPLAIN,
	NT_ACTION_COMPLETION_BASH,
	NT_ACTION_COMPLETION_ZSH
};

/* From which severity on findings make the exit code 6, as the option names them. */
enum nt_fail_on { NT_FAIL_ON_ERROR, NT_FAIL_ON_WARNING, NT_FAIL_ON_INFO, NT_FAIL_ON_NEVER };

enum nt_progress_mode { NT_PROGRESS_AUTO, NT_PROGRESS_ON, NT_PROGRESS_OFF };

/* Values of an option that may be given several times. */
enum { NT_MOST_WORDS = 32 };

typedef struct nt_words {
	const char *items[NT_MOST_WORDS];
	size_t count;
} nt_words;

/* The meaning of the words. */
typedef struct nt_command {
	nt_settings settings;
	int action;            /* enum nt_action */
	int verbosity;         /* -1 quiet, 0, 1 verbose */
	int fail_on;           /* enum nt_fail_on; without --check only an explicit one counts */
	int progress;          /* enum nt_progress_mode */
	bool timing;
	const char *report;    /* file, "-"; NULL: none */
	int report_format;     /* 1 + nt_report_format; 0: by name */
	nt_words explain, ignore; /* lists of codes or patterns: CODE,CODE */
	nt_words severity;     /* lists CODE=LEVEL,CODE=LEVEL */
	const char *baseline;  /* file; NULL: none */
	const char *path_prefix; /* before the names of files in reports; NULL: nothing */
	nt_words texture_paths;  /* those of the settings */
	const char *max_seconds; /* a number, parsed into the settings; NULL: no limit */
	const char *bump_height; /* a number, parsed into the settings; NULL: the default */
	const char *origin;    /* keep or X,Y,Z, parsed into the settings; NULL: auto */
	const char *draco_bits; /* POS,NRM,UV,TAN, parsed into the settings; NULL: defaults */
	int min_severity;      /* enum nt_fail_on, but never */
	int max_issues;        /* 0: all; -1: as many as the report's format has by default */
	const char *directory; /* -d; NULL: none */
	const char *keep_tree; /* folder whose tree outputs keep; NULL: none */
	const char *files_from; /* list of inputs; NULL: none */
	bool recursive;
	nt_words include, exclude; /* patterns */
	int jobs;              /* inputs at a time; 0: as threads */
	uint64_t memory;       /* bytes for them; 0: of what is available */
	int update;            /* leave alone what is up to date: 1 + nt_update_by; 0: no */
	const char *record;    /* file; NULL: by default */
	const char *depfile;   /* file; NULL: none */
	const char *manifest;  /* file, "-"; NULL: none */
	bool fail_fast;        /* stop after a failure */
	bool diff;             /* of two inputs */
	const char *output;    /* -o, but with --check also the last operand; NULL: none */
	const char **operands; /* in argv, which is reordered for it */
	size_t operand_count;
} nt_command;

/* The meaning of a command line without words. */
extern const nt_command nt_default_command;

/*
 * Reads the words of a command line.
 *
 *   argc, argv  as main gets them; argv's pointers are reordered
 *   command     required
 *   error       names the word that is wrong
 *
 * Returns NT_OK or NT_ERROR_USAGE.
 */
nt_status nt_options_parse(int argc, char **argv, nt_command *command, nt_error *error);

/* Whether the operands are inputs, any number of them; else they are an input and an output. */
bool nt_command_is_many(const nt_command *command);

/* Appends the options on which the bytes of outputs depend, in one way for each meaning; defaults are left out. Without
 * `folders` those of images are too: a record names them from its own folder on. */
void nt_options_shaping(const nt_command *command, bool folders, nt_buffer *out);

/* Appends those that a command for the same input repeats, each as a word of a shell, with line ends between them. */
void nt_options_given(const nt_command *command, nt_buffer *out);

/* The options on which the severities of findings depend, as nt_options_shaping() has others; of a baseline also what
 * is in it, which is empty if that cannot be read. */
void nt_options_judging(const nt_command *command, nt_buffer *out);

/* Text of --help, the one screen of -h, and the two lines that follow a mistake. */
void nt_options_help(nt_buffer *out);
void nt_options_first_help(nt_buffer *out);
void nt_options_usage(nt_buffer *out);

/* Sets what the words of a list mean, which are codes of findings, in any case, or patterns with * and ?, separated by
 * commas. An unknown one is NT_ERROR_USAGE, which names the option and, if there is one, the code that was probably
 * meant. */
nt_status nt_match_codes(const char *option, const char *list, bool chosen[NT_CODE_COUNT], nt_error *error);

/* Appends what there is to know of the codes that --explain and the operands mean, which nt_options_parse() checked. */
void nt_options_explain(const nt_command *command, nt_buffer *out);

/* Completion scripts for the two shells. */
void nt_options_bash(nt_buffer *out);
void nt_options_zsh(nt_buffer *out);

#endif
