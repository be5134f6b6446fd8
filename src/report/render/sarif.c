/* SPDX-License-Identifier: MIT */
/*
 * SARIF 2.1.0, for code scanning: one result per finding. Binary files have no lines, so their results
 * stand at line 1; in an OBJ it is the line of the first face. The JSON pointer of a glTF primitive is the
 * logical location.
 *
 * GitHub takes 25 000 results of a run and shows 5000; more than that are cut, with a notification. A
 * result keeps its fingerprint, so that alerts follow a finding through edits.
 */
#include <string.h>
#include "report/render/inside.h"

enum { MOST_RESULTS = 5000 };

static const char *level_of(nt_severity severity)
{
	static const char *const levels[] = {"note", "warning", "error"};
	return levels[severity];
}

/* The remedy, and the whole of a code's row in Markdown, under headings. */
static void put_help(nt_code code, nt_buffer *out)
{
	const nt_code_row *row = nt_code_info(code);
	nt_buffer markdown = {0}, remedy = {0};
	nt_remedy_text(code, row->repair, NULL, NULL, &remedy);
	nt_put(&markdown, NT_MARKDOWN, "**Meaning**\n\n%s\n\n**Remedy**\n\n%s\n\n**The smallest example**\n\n%s",
		row->meaning, remedy.data ? remedy.data : "", row->example);
	nt_put(out, NT_JSON, "'help': {'text': %p, 'markdown': %p}", nt_text_of(&remedy), nt_text_of(&markdown));
}

static void put_rules(nt_buffer *out)
{
	nt_buffer_text(out, "\t\t\t\t\"rules\": [");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		const char *stop = strstr(row->meaning, ". ");
		nt_buffer first = {0}; /* sentence of the meaning */
		nt_buffer_append(&first, row->meaning,
			stop ? (size_t)(stop - row->meaning) + 1 : strlen(row->meaning));
		nt_put(out, NT_JSON, ",\n\t\t\t\t\t{'id': %s, 'shortDescription': {'text': %p}, "
			"'fullDescription': {'text': %s}, ", row->name, nt_text_of(&first), row->meaning);
		put_help((nt_code)i, out);
		/* where the program is, its manual is */
		nt_put(out, NT_JSON, ", 'helpUri': 'man:nmtan-report(5)', 'defaultConfiguration': {'level': '%-s'}}",
			level_of(row->severity));
	}
	nt_buffer_text(out, "\n\t\t\t\t]\n");
}

static void put_physical(const char *path, size_t line, nt_buffer *out)
{
	nt_put(out, NT_URI, "\"physicalLocation\": {\"artifactLocation\": {\"uri\": \"%s\"}, "
		"\"region\": {\"startLine\": %zu}}", path, line ? line : 1);
}

static void put_location(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_place_view *place = &finding->place;
	const bool has_object = nt_finding_has_object(finding);
	nt_buffer_text(out, "\"locations\": [{");
	put_physical(nt_finding_file(report, finding), nt_finding_line(finding), out);
	if (finding->mesh != NT_NONE || place->pointer[0] || place->object[0]) {
		nt_buffer_text(out, ", \"logicalLocations\": [{");
		if (!has_object)
			nt_put(out, NT_JSON, "'name': %p", nt_mesh_label(report, finding->mesh));
		else if (place->object[0])
			nt_put(out, NT_JSON, "'name': %s", place->object);
		if (place->pointer[0])
			nt_put(out, NT_JSON, ", 'fullyQualifiedName': %s", place->pointer);
		nt_buffer_text(out, ", \"kind\": \"object\"}]");
	}
	nt_buffer_text(out, "}]");
}

static void put_result(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_buffer text = {0};
	if (w->rows++ >= MOST_RESULTS)
		return;
	nt_buffer_format(&text, "%s. ", finding->message);
	nt_remedy_text(finding->code, finding->repair, report->given, report->path, &text);
	nt_put(out, NT_JSON, ",\n\t\t\t{'ruleId': %s, 'ruleIndex': %u, 'level': '%-s', 'message': {'text': %p},\n"
		"\t\t\t\t", nt_finding_name(finding), (unsigned)finding->code, level_of(finding->severity),
		nt_text_of(&text));
	put_location(report, finding, out);
	nt_put(out, NT_JSON, ",\n\t\t\t\t'partialFingerprints': {'nmtan/v1': %" PRIx64, finding->fingerprint);
	if (finding->geometry)
		nt_put(out, NT_JSON, ", 'geometry/v1': %" PRIx64, finding->geometry);
	nt_buffer_text(out, "}");
	if (report->compared)
		nt_put(out, NT_JSON, ", 'baselineState': '%-s'", finding->known ? "unchanged" : "new");
	nt_put(out, NT_JSON, ", 'occurrenceCount': %zu, 'properties': {", finding->count);
	for (unsigned i = 0; i < finding->number_count; i++)
		nt_put(out, NT_JSON, ", '%-s': %g", finding->numbers[i].name, finding->numbers[i].value);
	nt_buffer_text(out, "}}");
}

/* Inputs that could not be read, and findings that are not here. */
static void put_invocation(const nt_walk *w, nt_buffer *out)
{
	size_t results = 0;
	bool failed = false;
	for (size_t i = 0; i < w->count; i++) {
		results += w->items[i]->finding_count;
		failed |= w->items[i]->failure != NULL;
	}
	const size_t cut = results > MOST_RESULTS ? results - MOST_RESULTS : 0;
	const size_t missing = nt_report_totals(w->items, w->count).dropped + cut;
	nt_put(out, NT_JSON, "\t\t'invocations': [{'executionSuccessful': %hhd, 'toolExecutionNotifications': [",
		!failed);
	for (size_t i = 0; i < w->count; i++) {
		const nt_report *report = w->items[i];
		if (!report->failure)
			continue;
		nt_put(out, NT_JSON, ",\n\t\t\t{'level': 'error', 'message': {'text': %p}, 'locations': [{",
			nt_failure_text(report, false));
		put_physical(report->shown, report->failure_place.line, out);
		nt_buffer_text(out, "}]}");
	}
	if (missing)
		nt_put(out, NT_JSON, ",\n\t\t\t{'level': 'warning', 'message': {'text': "
			"'%zu findings are not in this file'}}", missing);
	nt_buffer_text(out, "]}]\n");
}

static void begin(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_put(out, NT_JSON, "{\n\t'$schema': 'https://json.schemastore.org/sarif-2.1.0.json',\n\t'version': '2.1.0',\n"
		"\t'runs': [{\n\t\t'tool': {\n\t\t\t'driver': {\n\t\t\t\t'name': 'nmtan',\n\t\t\t\t'version': '%-s',\n",
		NMTAN_VERSION_STRING);
	put_rules(out);
	nt_buffer_text(out, "\t\t\t}\n\t\t},\n\t\t\"columnKind\": \"utf16CodeUnits\",\n\t\t\"results\": [");
}

static void end(nt_walk *w, nt_buffer *out)
{
	nt_buffer_text(out, "\n\t\t],\n");
	put_invocation(w, out);
	nt_buffer_text(out, "\t}]\n}\n");
}

const nt_report_writer nt_sarif_writer = {.known = true, .begin = begin, .put_finding = put_result, .end = end};
