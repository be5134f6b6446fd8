/* SPDX-License-Identifier: MIT */
/*
 * Which files a run of many is about: names as they are given, names that are listed in files, and the meshes in
 * folders. The order is that of giving, of the lists, and of the names in a folder by their bytes.
 */
#ifndef NT_BATCH_INPUTS_H
#define NT_BATCH_INPUTS_H

#include "base/memory.h"
#include "base/text.h"

/* Zeroed: empty. */
typedef struct nt_inputs {
	nt_arena arena;
	const char **names;
	const char **roots; /* the folder that was named and has the input in or below it; NULL: the input was named */
	size_t count, capacity, root_capacity;
	nt_error nothing; /* the first folder in which no file was taken, and why; status NT_OK: there is none */
} nt_inputs;

/*
 * Rules for files in folders. A file is taken if its name has the ending of a format that is read, one of `include`
 * matches (or there is none) and none of `exclude` does; a folder in which nothing is looked for if one of `exclude`
 * matches. A pattern (fnmatch) with a slash is compared with the path below the folder that was named, else with the
 * last name of it.
 */
typedef struct nt_folder_rules {
	bool recursive; /* else a folder is a name like others, which cannot be read */
	const char *const *include, *const *exclude;
	size_t include_count, exclude_count;
	const char *leave_out; /* a folder below those named in which nothing is looked for: the outputs'; NULL: none */
} nt_folder_rules;

/* Adds a name that outlives the inputs, or with rules->recursive what is in the folder that has it; links to folders
 * are not followed below it, and a link that leads nowhere is an input that will fail (but for .#NAME, which Emacs
 * locks with). Returns NT_OK, NT_ERROR_IO (a folder that cannot be read) or NT_ERROR_MEMORY. */
nt_status nt_inputs_add(nt_inputs *inputs, const char *name, const nt_folder_rules *rules, nt_error *error);

/* Adds the names in a file, or from standard input ("-"). They are separated by NUL if the file contains one, else by
 * line feeds. They are relative to the current folder; empty ones are passed over, and "-" is a file. seconds: that
 * reading may take; 0: any time. Returns as nt_inputs_add(), NT_ERROR_MISSING or NT_ERROR_LIMIT. */
nt_status nt_inputs_add_list(nt_inputs *inputs, const char *path, double seconds, const nt_folder_rules *rules,
	nt_error *error);

/* Takes away names that are there again, but for how "." and "..", and "//" are spelled. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_inputs_drop_repeated(nt_inputs *inputs, nt_error *error);

void nt_inputs_free(nt_inputs *inputs);

#endif
