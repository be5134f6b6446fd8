/* SPDX-License-Identifier: MIT */
/*
 * Reports as text and files, and what changed between two of them. All formats come from the same data; each is
 * deterministic: no time, no absolute path, no order that depends on threads.
 */
#ifndef NT_REPORT_RENDER_RENDER_H
#define NT_REPORT_RENDER_RENDER_H

#include "report/report.h"

typedef enum nt_report_format {
	NT_REPORT_TEXT,     /* for people */
	NT_REPORT_JSON,     /* everything; data/nmtan-report.schema.json */
	NT_REPORT_SARIF,    /* 2.1.0, for code scanning */
	NT_REPORT_JUNIT,    /* XML, for test dashboards */
	NT_REPORT_CSV,      /* a row per finding */
	NT_REPORT_MARKDOWN, /* for comments on pull requests */
	NT_REPORT_HTML,     /* one page with UV layouts and the meshes in space */
	NT_REPORT_LINES,    /* a line per finding, as compilers print */
	NT_REPORT_GITHUB,   /* the same as commands of GitHub's workflows */
	NT_REPORT_FORMAT_COUNT
} nt_report_format;

/* The format that a file name's extension means; false when it is none of them. */
bool nt_report_format_of_path(const char *path, nt_report_format *format);

/* ---- two versions ---- */

/* A corner of both versions is compared where a triangle has the same three positions in both. Index 0 is the old
 * version, 1 the new one, throughout. */
typedef struct nt_mesh_change {
	uint32_t meshes[2];          /* index into each report's meshes; NT_NONE: only the other has it */
	size_t matched;              /* triangles at the same place in both */
	size_t moved_texcoords;      /* corners of these with other texture coordinates */
	size_t compared;             /* corners of these with a tangent in both */
	size_t turned;               /* of these, tangents that turned by more than NT_TURNED_DEGREES */
	size_t reversed;             /* and those whose w has the other sign */
	size_t histogram[NT_ANGLE_BINS]; /* of the compared corners, by nt_angle_bins */
	double worst_degrees;        /* NaN: nothing was compared */
	float worst_position[3];
} nt_mesh_change;

/* Less is what rounding tangents to 16-bit integers does. */
#define NT_TURNED_DEGREES 0.01

typedef struct nt_report_diff {
	const nt_report *reports[2]; /* not owned */
	nt_mesh_change *meshes;      /* those of the new version in its order, then those that are gone */
	size_t mesh_count;
	/* [findings of each report] whether the other version has it too; the reports' order */
	bool *known[2];
	size_t unchanged;            /* findings that both have */
	size_t by_severity[2][3];    /* findings that only one has */
} nt_report_diff;

/*
 * Compares two reports, made with keep_geometry, that stay until the diff is freed.
 *
 * Meshes are the same by name and glTF primitive, else by their triangles, else by their order where they have as many
 * triangles. Findings are the same by fingerprint, else by geometry.
 *
 *   exchange  what a page shows: in the geometry of both reports `authored` becomes the tangents that are compared, and
 *             `computed` those of the other version at the same place, of a vertex's corners the one that turned most;
 *             zero where there is none
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_report_compare(nt_report_diff *diff, nt_report *before, nt_report *after, bool exchange);

/* Zero-initialised is allowed. */
void nt_report_diff_free(nt_report_diff *diff);

/* Whether differences are written in a format: text, JSON, Markdown and HTML. */
bool nt_diff_has_format(nt_report_format format);

/* ---- writing ---- */

typedef struct nt_report_style {
	bool colour;       /* text: for a terminal */
	int least_failure; /* JUnit: the nt_severity from which on a finding is a failure; 3: none */
	const char *index; /* HTML: the page that lists all files, as a URI; beside it are the parts that pages share.
	                      NULL: there is none but this one */
} nt_report_style;

/* A document: reports, one for each input; or what differs between two; or an index of pages. */
typedef struct nt_report_list {
	const nt_report *const *items; /* NULL: none of this input, which is passed over */
	size_t count;
	nt_report_style style;
	const nt_report_diff *diff; /* of the two reports, for HTML made with exchanged tangents; NULL: none */
	const nt_buffer *rows;      /* HTML: the index whose rows nt_report_index_row() made; NULL: none */
} nt_report_list;

/* Takes a piece of the output. */
typedef nt_status (*nt_report_sink)(void *user, const void *bytes, size_t size, nt_error *error);

/* Writes one document, a difference in a format that has them. Returns NT_OK, NT_ERROR_MEMORY, or what the sink
 * returned. */
nt_status nt_report_write(const nt_report_list *what, nt_report_format format, nt_report_sink sink, void *user,
	nt_error *error);

/* A mark that tells an HTML report from other files: it is in the first 1000 bytes. */
extern const char nt_html_mark[];

/* Shared parts of a folder's pages, a file each beside them. */
typedef enum nt_html_part_kind { NT_HTML_STYLE, NT_HTML_SCRIPT, NT_HTML_PART_COUNT } nt_html_part_kind;

/* The text of a part. Appends the name of its file, which depends on the text: a page has the parts that it was made
 * for, whatever other versions put beside them. */
const char *nt_html_part(nt_html_part_kind kind, nt_buffer *name);

/* Appends the row of a report in an HTML index of many pages: its counts, the codes that it has and a thumbnail of its
 * first layout. `page` is the report's own page, as a URI. */
void nt_report_index_row(const nt_report *report, const char *page, nt_buffer *rows);

/* ---- text of any bytes, as a format writes it ---- */

typedef enum nt_syntax {
	NT_PLAIN,    /* as it is */
	NT_TERMINAL, /* what must not reach a terminal is shown: nt_buffer_clean() */
	NT_JSON,     /* with quotes; what is no UTF-8 becomes U+FFFD */
	NT_SCRIPT,   /* JSON in a script element of HTML: no name can end it */
	NT_XML,      /* XML and HTML: markup escaped, and U+FFFD for what is unsafe (nt_utf8_is_unsafe()) */
	NT_MARKDOWN, /* all that Markdown or HTML could take for markup is escaped */
	NT_CSV,      /* a cell with quotes; an apostrophe is in front of what a spreadsheet would take for a formula */
	NT_URI,      /* a relative reference: all but unreserved characters and slashes is percent-encoded */
	NT_COMMAND,  /* the message of a workflow command of GitHub, which ends with its line */
	NT_PROPERTY  /* a property of one, which ends at a comma or a colon too */
} nt_syntax;

void nt_put_text(nt_buffer *out, nt_syntax syntax, const char *text);

/*
 * Appends as printf() does, so that the compiler checks the arguments, but for these:
 *
 *   '      in JSON and XML stands for "
 *   ,      at the beginning of JSON is left out behind a bracket, with a space behind it
 *   %s     a text as the syntax writes it; JSON: null for NULL
 *   %-s    a text as it is
 *   %p     a text that was allocated: as %s, and freed. NULL fails the buffer
 *   %u     JSON: null for NT_NONE; the same of PRIu64 for NT_NO_OFFSET
 *   %.0zu  nothing for 0, JSON: null
 *   %g     JSON: a number that reads back as the same float; null for NaN and infinities
 *   %hhd   JSON: true or false
 *   %PRIx64  JSON: a string of 16 digits; null for 0
 */
void nt_put(nt_buffer *out, nt_syntax syntax, const char *format, ...) NT_PRINTF(3, 4);

#endif
