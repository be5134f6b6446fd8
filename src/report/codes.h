/* SPDX-License-Identifier: MIT */
/*
 * The table of findings: one row for each nt_code. It is what --list-codes prints, what
 * man/nmtan-report.5 and data/nmtan-report.schema.json are checked against, and where every writer of
 * reports takes its sentences from.
 */
#ifndef NT_REPORT_CODES_H
#define NT_REPORT_CODES_H

#include "base/text.h"
#include "scene/finding.h"

/* Actions for a finding. The greatest comes first: what has to be exported again, all else is made
 * from. */
typedef enum nt_advice {
	NT_ADVICE_LOOK,
	NT_ADVICE_CONVERT,
	NT_ADVICE_BAKE,
	NT_ADVICE_FILE, /* one is missing */
	NT_ADVICE_EXPORT
} nt_advice;

typedef struct nt_code_row {
	const char *name;     /* UV_MIRROR_SEAM: what users write */
	nt_severity severity; /* unless --severity, or the finding's own numbers, say otherwise */
	/* The most severe that it gets in a game prop (glTF whose materials use tangents), a scan (no texture
	 * coordinates) and an OBJ without materials: e, w, i, or - where it is not found there. */
	char profiles[4];
	nt_advice advice;
	const char *repair; /* options with which nmtan repairs it, "--fix" for what that does; NULL: it cannot */
	/* One sentence without a full stop. {count} is the number of occurrences, {one|many} chooses by
	 * it, {detail} is the finding's detail; without {detail} a detail that is not empty follows behind
	 * a colon. */
	const char *message;
	const char *meaning; /* what it is and why it matters */
	const char *remedy;  /* what to do about it; the command follows: nt_remedy_text() */
	const char *example; /* the smallest input that shows it */
} nt_code_row;

/* The row of a code; a code that is out of range is our mistake. */
const nt_code_row *nt_code_info(nt_code code);

/* The severity of a scene's finding: its own, or that of the table. */
nt_severity nt_finding_severity(const nt_finding *finding);

/* "info", "warning" or "error". */
const char *nt_severity_name(nt_severity severity);
bool nt_severity_find(const char *name, nt_severity *severity);

/* "if the map was baked with MikkTSpace": else the command of a finding is wrong; NULL: it is always right. */
const char *nt_code_condition(nt_code code);

/* Whether --fix mends it; whether it mends tangents that are there. */
bool nt_code_mends(nt_code code);
bool nt_code_is_of_kept(nt_code code);

/* Appends a word of a shell: as it is if nothing in it is special, else in quotes. False: no terminal takes it. */
bool nt_shell_word(const char *text, nt_buffer *out);

/* Appends a command that a shell takes as it stands: "nmtan --fix in.glb in-repaired.glb". given: options of the user,
 * words of a shell with line ends between them, which the command has too unless `options` say otherwise; NULL: none.
 * output: "": none; NULL: a name beside the input. "IN OUT" stand for names that a terminal does not take, or for an
 * input of NULL. */
void nt_command_text(const char *options, const char *given, const char *input, const char *output, nt_buffer *out);

/* Appends the remedy, and at its end the command with these options; options NULL: there is none here. */
void nt_remedy_text(nt_code code, const char *options, const char *given, const char *input, nt_buffer *out);

/* Appends the sentence of a finding. detail may be NULL. */
void nt_code_sentence(nt_code code, size_t count, const char *detail, nt_buffer *out);

/* Appends what --list-codes prints: one row per code, its severity and its meaning. */
void nt_codes_list(nt_buffer *out);

#endif
