/* SPDX-License-Identifier: MIT */
/*
 * SARIF 2.1.0, for code scanning: one result per finding. Binary files have no lines, so their results
 * stand at line 1; in an OBJ it is the line of the first face. The JSON pointer of a glTF primitive is the
 * logical location.
 *
 * GitHub takes 25 000 results of a run and shows 5000; more than that are cut, with a notification. A
 * result keeps its fingerprint, so that alerts follow a finding through edits.
 */
#include "report/render/writers.h"

#include <string.h>

enum { MOST_RESULTS = 5000 };

static const char *level_of(nt_severity severity)
{
	static const char *const levels[] = {"note", "warning", "error"};
	return levels[severity];
}

static void put_text(const char *name, const char *text, nt_buffer *out)
{
	nt_member_key(out, NT_SPACED, name);
	nt_json_string(text, out);
}

/* A relative URI reference: everything but unreserved characters and slashes is percent-encoded. */
static void put_uri(const char *path, nt_buffer *out)
{
	static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
	nt_buffer_text(out, "\"uri\": \"");
	for (const char *p = path; *p; p++) {
		if (strchr(plain, *p))
			nt_buffer_append(out, p, 1);
		else
			nt_buffer_format(out, "%%%02X", (unsigned char)*p);
	}
	nt_buffer_text(out, "\"");
}

/* A text in Markdown, under a heading. */
static void append_part(const char *heading, const char *text, nt_buffer *out)
{
	nt_buffer_format(out, "%s**%s**\n\n", out->size ? "\n\n" : "", heading);
	nt_markdown_text(text, out);
}

static void put_help(nt_code code, nt_buffer *out)
{
	const nt_code_row *row = nt_code_info(code);
	nt_buffer markdown = {0}, remedy = {0};
	nt_remedy_text(code, row->repair, NULL, NULL, &remedy);
	append_part("Meaning", row->meaning, &markdown);
	append_part("Remedy", remedy.data ? remedy.data : "", &markdown);
	append_part("The smallest example", row->example, &markdown);
	nt_buffer_text(out, "\"help\": {");
	put_text("text", remedy.data ? remedy.data : "", out);
	put_text("markdown", markdown.data ? markdown.data : "", out);
	nt_buffer_text(out, "}");
	nt_buffer_free_into(&markdown, out);
	nt_buffer_free_into(&remedy, out);
}

/* The first sentence of the meaning, and all of it. */
static void put_descriptions(const nt_code_row *row, nt_buffer *out)
{
	const char *stop = strstr(row->meaning, ". ");
	nt_buffer first = {0};
	nt_buffer_append(&first, row->meaning, stop ? (size_t)(stop - row->meaning) + 1 : strlen(row->meaning));
	nt_buffer_text(out, "\"shortDescription\": {");
	put_text("text", first.data ? first.data : "", out);
	nt_buffer_text(out, "}, \"fullDescription\": {");
	put_text("text", row->meaning, out);
	nt_buffer_text(out, "}");
	nt_buffer_free_into(&first, out);
}

static void put_rules(nt_buffer *out)
{
	nt_buffer_text(out, "\t\t\t\t\"rules\": [");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		nt_buffer_format(out, "%s\n\t\t\t\t\t{", i ? "," : "");
		put_text("id", row->name, out);
		nt_buffer_text(out, ", ");
		put_descriptions(row, out);
		nt_buffer_text(out, ", ");
		put_help((nt_code)i, out);
		/* where the program is, its manual is */
		nt_buffer_format(out, ", \"helpUri\": \"man:nmtan-report(5)\", "
			"\"defaultConfiguration\": {\"level\": \"%s\"}}", level_of(row->severity));
	}
	nt_buffer_text(out, "\n\t\t\t\t]\n");
}

static void put_physical(const char *path, size_t line, nt_buffer *out)
{
	nt_buffer_text(out, "\"physicalLocation\": {\"artifactLocation\": {");
	put_uri(path, out);
	nt_buffer_format(out, "}, \"region\": {\"startLine\": %zu}}", line);
}

static void put_location(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	const size_t line = nt_finding_line(finding);
	nt_buffer_text(out, "\"locations\": [{");
	put_physical(nt_finding_file(report, finding), line ? line : 1, out);
	if (finding->mesh != NT_NONE || finding->place.pointer[0] || finding->place.object[0]) {
		nt_buffer label = {0};
		if (nt_finding_has_object(finding))
			nt_buffer_text(&label, finding->place.object);
		else
			nt_mesh_label(report, finding->mesh, &label);
		nt_buffer_text(out, ", \"logicalLocations\": [{");
		if (label.size)
			put_text("name", label.data, out);
		if (finding->place.pointer[0])
			put_text("fullyQualifiedName", finding->place.pointer, out);
		nt_buffer_text(out, ", \"kind\": \"object\"}]");
		nt_buffer_free_into(&label, out);
	}
	nt_buffer_text(out, "}]");
}

static void put_result(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	if (w->rows == MOST_RESULTS)
		return;
	nt_buffer_text(out, w->rows++ ? ",\n\t\t\t" : "\n\t\t\t");
	nt_buffer_text(out, "{");
	put_text("ruleId", nt_code_info(finding->code)->name, out);
	nt_buffer_format(out, ", \"ruleIndex\": %u, \"level\": \"%s\", \"message\": {", (unsigned)finding->code,
		level_of(finding->severity));
	nt_buffer text = {0};
	nt_buffer_format(&text, "%s. ", finding->message);
	nt_remedy_text(finding->code, finding->repair, report->given, report->path, &text);
	put_text("text", text.data ? text.data : "", out);
	nt_buffer_free_into(&text, out);
	nt_buffer_text(out, "},\n\t\t\t\t");
	put_location(report, finding, out);
	nt_buffer_format(out, ",\n\t\t\t\t\"partialFingerprints\": {\"nmtan/v1\": \"%016llx\"",
		(unsigned long long)finding->fingerprint);
	if (finding->geometry)
		nt_buffer_format(out, ", \"geometry/v1\": \"%016llx\"", (unsigned long long)finding->geometry);
	nt_buffer_text(out, "}");
	if (report->compared)
		nt_buffer_format(out, ", \"baselineState\": \"%s\"", finding->known ? "unchanged" : "new");
	nt_buffer_format(out, ", \"occurrenceCount\": %zu, \"properties\": {", finding->count);
	for (unsigned i = 0; i < finding->number_count; i++) {
		nt_member_key(out, NT_SPACED, finding->numbers[i].name);
		nt_json_float(finding->numbers[i].value, out);
	}
	nt_buffer_text(out, "}}");
}

/* Inputs that could not be read, and findings that are not here. */
static void put_invocation(const nt_report_list *reports, nt_buffer *out)
{
	size_t count = 0, results = 0, failures = 0;
	for (size_t i = 0; i < reports->count; i++) {
		results += reports->items[i]->finding_count;
		failures += reports->items[i]->failure != NULL;
	}
	const size_t cut = results > MOST_RESULTS ? results - MOST_RESULTS : 0;
	const size_t missing = nt_report_totals(reports).dropped + cut;
	nt_buffer_format(out, "\t\t\"invocations\": [{\"executionSuccessful\": %s, "
		"\"toolExecutionNotifications\": [", failures ? "false" : "true");
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		if (!report->failure)
			continue;
		nt_buffer_format(out, "%s\n\t\t\t{\"level\": \"error\", \"message\": {", count++ ? "," : "");
		nt_member_key(out, NT_SPACED, "text");
		nt_put_failure(report, false, nt_json_string, out);
		nt_buffer_text(out, "}, \"locations\": [{");
		put_physical(report->shown, report->failure_place.line ? report->failure_place.line : 1, out);
		nt_buffer_text(out, "}]}");
	}
	if (missing)
		nt_buffer_format(out, "%s\n\t\t\t{\"level\": \"warning\", \"message\": {\"text\": "
			"\"%zu findings are not in this file\"}}", count ? "," : "", missing);
	nt_buffer_text(out, "]}]\n");
}

static void begin(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "{\n\t\"$schema\": \"https://json.schemastore.org/sarif-2.1.0.json\",\n"
		"\t\"version\": \"2.1.0\",\n\t\"runs\": [{\n\t\t\"tool\": {\n\t\t\t\"driver\": {\n");
	nt_buffer_format(out, "\t\t\t\t\"name\": \"nmtan\",\n\t\t\t\t\"version\": \"%s\",\n",
		NMTAN_VERSION_STRING);
	put_rules(out);
	nt_buffer_text(out, "\t\t\t}\n\t\t},\n\t\t\"columnKind\": \"utf16CodeUnits\",\n\t\t\"results\": [");
}

static void end(nt_walk *w, nt_buffer *out)
{
	nt_buffer_text(out, "\n\t\t],\n");
	put_invocation(w->reports, out);
	nt_buffer_text(out, "\t}]\n}\n");
}

const nt_report_writer nt_sarif_writer = {.known = true, .begin = begin, .put_finding = put_result, .end = end};
