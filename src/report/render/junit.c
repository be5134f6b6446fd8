/* SPDX-License-Identifier: MIT */
/*
 * JUnit XML, for test dashboards: one case for each file, which fails if the run fails by a finding of the file.
 * Findings that fail nothing are the output of their case.
 */
#include "report/render/inside.h"

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

/* A line, of those that fail or of the others, with the mesh of a file that has one, too. */
static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const bool fails = is_failure(w->reports, finding);
	nt_buffer *to = &w->parts[fails];
	nt_put(to, NT_XML, "%-s: %-s: %s", nt_severity_name(finding->severity), nt_finding_name(finding),
		finding->message);
	const size_t before = to->size + strlen(", in ");
	nt_put(to, NT_XML, ", in %p", nt_finding_where(w->report, finding, true));
	if (to->size == before)
		to->size -= strlen(", in ");
	if (finding->mesh != NT_NONE && finding->place.pointer[0])
		nt_put(to, NT_XML, ", %s", finding->place.pointer);
	nt_put(to, NT_XML, ". %p%-s\n", nt_finding_remedy(w->report, finding), finding->known ? " (known)" : "");
	w->first = w->first || !fails ? w->first : finding;
	w->rows += fails;
	out->failed |= to->failed;
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	const nt_report *report = w->report;
	const bool empty = !report->failure && !report->finding_count;
	nt_put(out, NT_XML, "\t\t<testcase classname='nmtan' name='%s'%-s>\n", report->shown, empty ? "/" : "");
	if (is_error(w->reports, report))
		nt_put(out, NT_XML, "\t\t\t<error type='not judged' message='%p'/>\n", nt_failure_text(report, true));
	/* the type and the sentence of the first are what dashboards list */
	if (w->first)
		nt_put(out, NT_XML, "\t\t\t<failure type='%-s' message='%p", nt_finding_name(w->first),
			nt_finding_sentence(report, w->first, NULL));
	if (w->rows > 1)
		nt_buffer_format(out, "; and %zu more", w->rows - 1);
	if (w->first)
		nt_put(out, NT_XML, "'>%-s</failure>\n", w->parts[1].data ? w->parts[1].data : "");
	if (w->parts[0].size)
		nt_put(out, NT_XML, "\t\t\t<system-out>%-s</system-out>\n", w->parts[0].data);
	if (!empty)
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
