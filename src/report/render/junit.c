/* SPDX-License-Identifier: MIT */
/*
 * JUnit XML, for test dashboards: one case for each file, which fails if the run fails by a finding of the file.
 * Findings that fail nothing are the output of their case.
 */
#include "report/render/writers.h"

static bool is_failure(const nt_report_list *reports, const nt_report_finding *finding)
{
	return !finding->known && (int)finding->severity >= reports->style.least_failure;
}

static size_t count_failures(const nt_report_list *reports, const nt_report *report)
{
	size_t count = 0;
	for (size_t i = 0; i < report->new_count; i++)
		count += is_failure(reports, &report->findings[i]);
	return count;
}

/* Not judged, and no finding that fails says why. */
static bool is_error(const nt_report_list *reports, const nt_report *report)
{
	return report->failure && !(count_failures(reports, report) && nt_failure_is_found(report));
}

static void begin(nt_walk *w, nt_buffer *out)
{
	size_t failures = 0, errors = 0;
	for (size_t i = 0; i < w->count; i++) {
		errors += is_error(w->reports, w->items[i]);
		failures += count_failures(w->reports, w->items[i]) > 0;
	}
	nt_buffer_text(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
	for (int level = 0; level < 2; level++)
		nt_buffer_format(out, "%s name=\"nmtan\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\">\n",
			level ? "\t<testsuite" : "<testsuites", w->count, failures, errors);
}

/* ", in mesh "head", /meshes/0/primitives/0", of a file with one mesh, too; and the remedy. */
static void put_rest(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	nt_buffer where = {0}, remedy = {0};
	nt_put_where(report, finding, true, nt_xml_text, &where);
	if (where.size)
		nt_buffer_format(out, ", in %s", where.data);
	if (finding->mesh != NT_NONE && finding->place.pointer[0]) {
		nt_buffer_text(out, ", ");
		nt_xml_text(finding->place.pointer, out);
	}
	nt_remedy_text(finding->code, finding->repair, report->given, report->path, &remedy);
	nt_buffer_text(out, ". ");
	nt_xml_text(remedy.data ? remedy.data : "", out);
	nt_buffer_free_into(&where, out);
	nt_buffer_free_into(&remedy, out);
}

/* A line, of those that fail or of the others. */
static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const bool fails = is_failure(w->reports, finding);
	nt_buffer *to = &w->parts[fails];
	nt_buffer_format(to, "%s: %s: ", nt_severity_name(finding->severity), nt_code_info(finding->code)->name);
	nt_xml_text(finding->message, to);
	put_rest(w->report, finding, to);
	nt_buffer_text(to, finding->known ? " (known)\n" : "\n");
	w->first = w->first || !fails ? w->first : finding;
	w->rows += fails;
	out->failed |= to->failed;
}

/* The type and the sentence of the first are what dashboards list. */
static void put_failure(const nt_walk *w, nt_buffer *out)
{
	nt_buffer_format(out, "\t\t\t<failure type=\"%s\" message=\"", nt_code_info(w->first->code)->name);
	nt_put_sentence(w->report, w->first, nt_xml_text, out);
	if (w->rows > 1)
		nt_buffer_format(out, "; and %zu more", w->rows - 1);
	nt_buffer_format(out, "\">%s</failure>\n", w->parts[1].data ? w->parts[1].data : "");
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_buffer_text(out, "\t\t<testcase classname=\"nmtan\" name=\"");
	nt_xml_text(report->shown, out);
	nt_buffer_text(out, report->failure || report->finding_count ? "\">\n" : "\"/>\n");
	if (is_error(w->reports, report)) {
		nt_buffer_text(out, "\t\t\t<error type=\"not judged\" message=\"");
		nt_put_failure(report, true, nt_xml_text, out);
		nt_buffer_text(out, "\"/>\n");
	}
	if (w->first)
		put_failure(w, out);
	if (w->parts[0].size)
		nt_buffer_format(out, "\t\t\t<system-out>%s</system-out>\n", w->parts[0].data);
	if (report->failure || report->finding_count)
		nt_buffer_text(out, "\t\t</testcase>\n");
	nt_buffer_free_into(&w->parts[0], out);
	nt_buffer_free_into(&w->parts[1], out);
	w->first = NULL;
	w->rows = 0;
}

static void end(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "\t</testsuite>\n</testsuites>\n");
}

const nt_report_writer nt_junit_writer = {
	.known = true, .begin = begin, .put_finding = put_finding, .end_file = end_file, .end = end};
