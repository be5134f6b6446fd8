/* SPDX-License-Identifier: MIT */
/*
 * Many inputs: which output each gets (outputs.c), all of them run, several at once, and told about in their order
 * (batch.c).
 *
 * One input has all threads; several inputs share them, which uses a machine better than many threads on one small
 * file after the other. Every input is tried, whatever became of the others, unless the caller wants to stop.
 */
#ifndef NT_BATCH_BATCH_H
#define NT_BATCH_BATCH_H

#include "base/memory.h"
#include "base/text.h"
#include "file/input.h"
#include "pipeline/run.h"

/* ---- inputs: inputs.c ---- */

/* The files that a run of many is about: names as they are given, names that are listed in files, and the meshes in
 * folders. The order is that of giving, of the lists, and of the names in a folder by their bytes. */

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

/* ---- what is up to date: update.c ---- */

/*
 * Only what is needed is done: which outputs are up to date is known by the records in their folders or one that is
 * named.
 *
 * A record has JSON lines, one for each time an output was made; the last one of an output counts. Files in it are
 * URIs relative to its folder, so that a tree can be moved with its record. A line is
 *
 *   {"output":"a.glb","nmtan":"0.1.0","options":"--method=area","files":[FILE,...],"sum":"0123456789abcdef"}
 *
 * and a FILE one of these, in the order in which the run met them:
 *
 *   {"read":"../a.obj","bytes":10,"modified":T,"changed":T,"inode":N}   T: nanoseconds since 1970
 *   {"read":"../a.obj","bytes":10,"xxh128":D}         by its digest, with NT_UPDATE_BY_CONTENT
 *   {"read":"../a.gltf"}                              it was written, too, and counts as that
 *   {"written":"a.glb",...}                           as what was read
 *   {"missing":"../a.mtl"}                            it was looked for
 *   {"searched":"../n.png","found":"N.PNG",...}       its folder was, for the name in any case; the folder's times
 *   {"link":"../tex","to":"../v1"}                    what the path is by links; without "to": nothing is there
 *   {"outside":"../in/tex/n.png","to":"tex/n.png"}    this name leaves its folder by links
 *
 * A file that changed so shortly before it was read that it may have changed again within one tick of the clock has
 * a digest, too, and a folder no times: it is searched anew. An output is up to date if all is still so, and was made
 * by this version and these options; if anything cannot be told, it is not. If a line would have other times now,
 * that one follows when the record is closed.
 *
 * "judged" is the highest severity of the findings, or "none", and "judging" the options that decide on that; a run
 * that nobody judged has neither. "wrong" is 1 if the output keeps tangents that are known to be wrong: a run that
 * leaves it alone says so again.
 *
 * The line is written when the output has its name. If a run is killed in between, the output is made again.
 */

/* The comparison of files: by size, times and inode, or by size and digest. */
typedef enum nt_update_by { NT_UPDATE_BY_TIME, NT_UPDATE_BY_CONTENT } nt_update_by;

typedef struct nt_update_options {
	bool look;           /* leave alone what is up to date; else records are only written */
	nt_update_by by;
	const char *record;  /* the record's file; NULL: .nmtan-record in `folder` */
	const char *folder;  /* that of all outputs; NULL: each output's own */
	bool dry_run;        /* records stay as they are */
	const char *options; /* what shapes outputs, in one way for each meaning */
	/* Findings that fail a run fail it again: an output that was judged by other options, or not at all, is not up
	 * to date. */
	const char *judging; /* options that decide on findings, in words; NULL: nobody judges */
	int least_failure;   /* the nt_severity that fails; above the highest: none does */
} nt_update_options;

/* The records of one batch; for any number of threads. */
typedef struct nt_update nt_update;

/* Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY. */
nt_status nt_update_begin(nt_update **update, const nt_update_options *options, nt_error *error);

/* Writes the lines of files that are the same at other times, as far as that goes. NULL is allowed. */
void nt_update_end(nt_update *update);

/* Counts outputs of the records that are there although their input is gone, and names the first by name: beside the
 * record, as that was spelled. Looks only if this run has not looked at every output of a record. NULL is allowed. */
size_t nt_update_left_over(const nt_update *update, nt_buffer *first);

/* One input on its way through the records. */
typedef struct nt_update_job {
	nt_update *update;
	struct nt_open_record *record; /* NULL: the output is a stream, or the input is */
	const char *input, *output;
	struct stat input_info;
	nt_buffer options; /* what shapes this output */
	int worst;         /* of what was made: the highest nt_severity of its findings; -1: there are none */
	bool keeps_wrong;  /* and it keeps tangents that are known to be wrong */
} nt_update_job;

/*
 * Decides whether an output is up to date, without reading the input; job->keeps_wrong says what the record does. If
 * it is not, changes `settings`: an output that has its bytes already will keep its time of change if a record says
 * what it was made of, else get a new one. `job` must live until nt_update_done().
 *
 *   trace  receives what the output was made of, as far as known, with paths that can be opened
 *
 * Returns NT_OK, NT_ERROR_IO, NT_ERROR_MISSING or NT_ERROR_MEMORY.
 */
nt_status nt_update_look(nt_update *update, const char *input, const char *output, nt_update_job *job,
	nt_settings *settings, bool *current, nt_trace *trace, nt_error *error);

/* The run of a job, or the look at it, has ended; if it was `made`, the record says of what. Returns NT_OK or
 * NT_ERROR_IO, or NT_ERROR_MEMORY from the system. */
nt_status nt_update_done(nt_update_job *job, bool made, const nt_trace *trace, nt_error *error);

/* ---- jobs: outputs.c and batch.c ---- */

/* The outcome of an input, while somebody may want to know. */
typedef struct nt_outcome {
	nt_error error; /* when the job's status is not NT_OK */
	nt_summary summary;
} nt_outcome;

/* How a job ended. */
typedef enum nt_job_end {
	NT_JOB_RAN,     /* well or not, as its status says */
	NT_JOB_CURRENT, /* its output was up to date; the summary has the trace, and keeps_wrong */
	NT_JOB_UNTRIED  /* an earlier one failed, and nothing was to be done after that */
} nt_job_end;

/* One input, and what became of it. */
typedef struct nt_job {
	const char *input;
	const char *root; /* the folder of the user's that it is below, for settings.root; NULL: none */
	char *output; /* NULL: nothing is written */
	char *refused; /* why it is not run: a usage error; NULL: it is */
	bool reason_is_told; /* another job is refused for the same reason, and says it */
	nt_outcome *outcome; /* until the job has been told about; NULL: untried, or no memory for it */
	nt_status status;
	nt_job_end end;
	bool ended;
	bool deferred; /* until the others have ended */
} nt_job;

typedef struct nt_batch {
	nt_job *jobs;
	size_t count;
} nt_batch;

/*
 * Prepares one input and its output, or inputs that are checked only (output NULL). The names of inputs
 * must outlive the batch.
 *
 * Returns NT_OK or NT_ERROR_MEMORY. The batch is to be freed after failure too.
 */
nt_status nt_batch_pair(nt_batch *batch, const char *input, const char *output, nt_error *error);
nt_status nt_batch_check(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error);

/*
 * Prepares inputs whose outputs get their names in a folder: the input's name with the ending of
 * settings->output_format; without that .ply for PLY, .gltf for .gltf and .glb for all others. With `tree` (NULL:
 * none), a folder that has all inputs below it, the name below the output folder is the input's name below that one.
 * The folder is made when it is missing (not in a dry run), with its parents, and those below it that are needed.
 *
 * Jobs that would have the same output, and those whose output would replace another input, are refused.
 * Nothing runs when an input is not below `tree`: NT_ERROR_USAGE. Else NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY.
 */
nt_status nt_batch_into(nt_batch *batch, const char *const *inputs, size_t count, const char *directory,
	const char *tree, const nt_settings *settings, nt_error *error);

/* Prepares inputs that are replaced by their outputs. Jobs are refused whose input is there twice, also by another
 * name. Returns NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_batch_in_place(nt_batch *batch, const char *const *inputs, size_t count, nt_error *error);

/* The function that runs a job: nt_run, or something else in tests. */
typedef nt_status (*nt_runner)(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error);

/* How the jobs of a batch are run. */
typedef struct nt_batch_options {
	nt_runner run;
	unsigned jobs;  /* so many at a time; 0: as many as there are threads */
	/* Bytes that jobs at a time may need together, as is guessed; who needs more runs alone, with all threads.
	 * 0: half of what is available. */
	uint64_t memory;
	nt_update *update; /* what is up to date is left alone, and records are written; NULL: every input runs */
	bool fail_fast; /* after a failure no further job begins */
	/* Called once per job, in the order of the inputs, by one thread at a time, as soon as the job and all before
	 * it have ended. It may take the summary's report, leaving NULL. */
	void (*done)(void *user, nt_job *job);
	/* Called before that as soon as a job has ended, by one thread at a time; NULL: nobody wants to know. */
	void (*ended)(void *user, const nt_job *job);
	void *user;
} nt_batch_options;

/* Runs all jobs: files first, then what is read from pipes and sockets. */
void nt_batch_run(nt_batch *batch, const nt_settings *settings, const nt_batch_options *options);

void nt_batch_free(nt_batch *batch);

/* ---- depfiles, the rules that tell make and Ninja which files an output was made of: depfile.c ---- */

/* The text of a depfile; zeroed: no rules yet. */
typedef struct nt_depfile {
	nt_buffer text;
	nt_buffer current; /* the current folder */
} nt_depfile;

/*
 * Appends a rule: the output depends on everything in the trace that was read, and on the folders in which something
 * was looked for in vain, unless the run wrote to them: whatever arrives there changes their times. Files below the
 * current folder are named from there on if the output is. A dependency that is not the input gets a rule without
 * files, so that make goes on when it is gone.
 *
 * Returns NT_OK; NT_ERROR_UNSUPPORTED where a name has a line feed, for which neither has a spelling; NT_ERROR_IO or
 * NT_ERROR_MEMORY.
 */
nt_status nt_depfile_add(nt_depfile *depfile, const char *output, const nt_trace *trace, nt_error *error);

/* Writes the file whole or not at all, and not over one of the inputs. */
nt_status nt_depfile_write(const nt_depfile *depfile, const char *path, const char *const *inputs, size_t input_count,
	nt_error *error);

void nt_depfile_free(nt_depfile *depfile);

#endif
