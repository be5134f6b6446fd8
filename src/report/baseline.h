/* SPDX-License-Identifier: MIT */
/*
 * Baselines: earlier findings, of which new ones are told apart.
 */
#ifndef NT_REPORT_BASELINE_H
#define NT_REPORT_BASELINE_H

#include "report/pairs.h"
#include "report/report.h"

typedef struct nt_baseline_entry {
	uint64_t file;                  /* a key of its name as reports show it */
	uint64_t fingerprint, geometry; /* 0: not known; both of the entry that stands for the file */
} nt_baseline_entry;

/* Each entry is one finding, but one of each file: two equal ones excuse two. */
struct nt_baseline {
	nt_baseline_entry *entries; /* [count] by file */
	size_t count;
	nt_keyed *geometries; /* [geometry_count] of entries that have one, ascending */
	size_t geometry_count;
};

/*
 * Reads the findings of a JSON report.
 *
 * Returns NT_OK, NT_ERROR_INPUT when the text is no report of nmtan, or NT_ERROR_MEMORY.
 */
nt_status nt_baseline_read(nt_baseline *baseline, const char *text, size_t size, nt_error *error);

/* Marks the findings that the baseline has. False: out of memory. */
bool nt_baseline_apply(const nt_baseline *baseline, nt_report *report);

void nt_baseline_free(nt_baseline *baseline);

#endif
