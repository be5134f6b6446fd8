/* SPDX-License-Identifier: MIT */
/*
 * The table of options.
 */
#ifndef NT_CLI_OPTION_TABLE_H
#define NT_CLI_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>

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

#endif
