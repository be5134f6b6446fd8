/* SPDX-License-Identifier: MIT */
/*
 * The options of the command line: one table, from which the parser, --help and the completions come, and what the
 * words mean: a command, the plan of its report, the files that it writes beside its outputs. A new option is a new
 * row in option_table.c and, where it is not one of the pipeline's settings, a field of nt_command.
 */
#ifndef NT_CLI_OPTIONS_H
#define NT_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include "base/text.h"
#include "batch/batch.h"
#include "pipeline/run.h"

/* ---- the table: option_table.c ---- */

typedef enum nt_option_kind {
	NT_OPTION_HEADING,     /* no option: a line of --help */
	NT_OPTION_FLAG,        /* bool becomes true */
	NT_OPTION_SET,         /* int becomes `first` */
	NT_OPTION_CHOICE,      /* int becomes `first` + the number of the word in `values`; a word that ends in :N there
	                          has a number 0..most, which the int behind becomes */
	NT_OPTION_MAYBE_CHOICE,/* the same, or `first` without a word, which follows = and nothing else */
	NT_OPTION_NUMBER,      /* int becomes 0..most */
	NT_OPTION_AUTO_NUMBER, /* the same; -1 for the word auto */
	NT_OPTION_SIZE,        /* uint64_t becomes so many bytes */
	NT_OPTION_TEXT,        /* const char * becomes the word */
	NT_OPTION_LIST         /* nt_words gets the word as its last */
} nt_option_kind;

/* As `first` of a heading: the bytes of outputs depend on the options below it. */
enum { NT_SHAPES_OUTPUT = 1 };

typedef struct nt_option_row {
	const char *name;   /* without the dashes */
	char letter;        /* the short form; 0: none */
	nt_option_kind kind;
	const char *values; /* "one|two|three" or a word for the value; NULL: takes no value */
	int first, most;
	const char *standard; /* the default, in words; NULL: none or off */
	const char *help;     /* NULL: a hidden option */
	size_t offset;        /* of the field in nt_command */
	bool writes;          /* says what is written, and where: with --check, what a glTF becomes is judged */
} nt_option_row;

enum { NT_MOST_OPTIONS = 128 };
extern const nt_option_row nt_option_rows[];
extern const size_t nt_option_row_count;

/* Whether the values are names of files or folders. */
bool nt_option_is_name(const nt_option_row *row);

/* ---- commands: options.c and option_texts.c ---- */

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

/* ---- --report and the options beside it: report_options.c ---- */

/* Words become the options of a report, and where it goes. */

/* The report of a command. */
typedef struct nt_report_plan {
	bool wanted;
	nt_report_options options;
	nt_baseline baseline;
	nt_shown_paths paths;    /* how reports name files */
	nt_buffer conversion;    /* options of the conversion that --check judges */
	nt_buffer given;         /* those of a command that repairs something */
	nt_buffer folder;        /* where a page will be, absolute */
	nt_report_target target; /* its path is NULL where nothing is written */
} nt_report_plan;

/* Reads --ignore, --severity, --min-severity, --max-issues, --path-prefix, --baseline, --report and --report-format.
 * With --check there is always a report; without --report its text goes to standard output. With --fail-on there is
 * one to judge by. Returns NT_OK, NT_ERROR_USAGE, or what reading the baseline returned. The plan is to be freed
 * either way. */
nt_status nt_report_plan_make(nt_report_plan *plan, const nt_command *command, bool colour,
	nt_error *error);
void nt_report_plan_free(nt_report_plan *plan);

/* ---- files that a run writes beside its outputs: own_files.c ---- */

/* A report, a manifest, a depfile, a record. None replaces another one, an output, or what a run reads or writes. */

/* Refuses files that are named twice, also by different names. With a batch (NULL: its jobs are not known yet) it also
 * refuses one that is an output or an input of a job, has no folder, or with --no-clobber is there already. Returns
 * NT_OK, NT_ERROR_USAGE, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_own_files_check(const nt_command *command, const nt_batch *batch, bool report_is_folder, nt_error *error);

/* Refuses a file that a run has read or written. Returns NT_OK or NT_ERROR_IO. */
nt_status nt_own_file_check_trace(const char *path, const nt_trace *trace, nt_error *error);

#endif
