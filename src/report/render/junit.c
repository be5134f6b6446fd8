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

/* The findings that fail, or the others: one per line. */
static void put_findings(const nt_report_list *reports, const nt_report *report, bool failures, nt_buffer *out)
{
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		if (is_failure(reports, finding) != failures)
			continue;
		nt_buffer_format(out, "%s: %s: ", nt_severity_name(finding->severity),
			nt_code_info(finding->code)->name);
		nt_put_sentence(report, finding, nt_xml_text, out);
		nt_put_line(finding, ", ", nt_xml_text, out);
		nt_buffer_text(out, finding->known ? " (known)\n" : "\n");
	}
}

/* The type and the sentence of the first are what dashboards list. */
static void put_failure(const nt_report_list *reports, const nt_report *report, size_t count, nt_buffer *out)
{
	size_t first = 0;
	while (!is_failure(reports, &report->findings[first]))
		first++;
	nt_buffer_format(out, "\t\t\t<failure type=\"%s\" message=\"",
		nt_code_info(report->findings[first].code)->name);
	nt_put_sentence(report, &report->findings[first], nt_xml_text, out);
	if (count > 1)
		nt_buffer_format(out, "; and %zu more", count - 1);
	nt_buffer_text(out, "\">");
	put_findings(reports, report, true, out);
	nt_buffer_text(out, "</failure>\n");
}

static void put_case(const nt_report_list *reports, const nt_report *report, nt_buffer *out)
{
	const size_t failures = count_failures(reports, report);
	nt_buffer_text(out, "\t\t<testcase classname=\"nmtan\" name=\"");
	nt_xml_text(report->shown, out);
	if (!report->failure && !report->finding_count) {
		nt_buffer_text(out, "\"/>\n");
		return;
	}
	nt_buffer_text(out, "\">\n");
	if (report->failure) {
		nt_buffer_text(out, "\t\t\t<error type=\"not judged\" message=\"");
		nt_xml_text(report->failure, out);
		nt_buffer_text(out, "\"/>\n");
	}
	if (failures)
		put_failure(reports, report, failures, out);
	if (report->finding_count > failures) {
		nt_buffer_text(out, "\t\t\t<system-out>");
		put_findings(reports, report, false, out);
		nt_buffer_text(out, "</system-out>\n");
	}
	nt_buffer_text(out, "\t\t</testcase>\n");
}

void nt_write_junit(const nt_report_list *reports, nt_buffer *out)
{
	size_t failures = 0, errors = 0;
	for (size_t i = 0; i < reports->count; i++) {
		errors += reports->items[i]->failure != NULL;
		failures += count_failures(reports, reports->items[i]) > 0;
	}
	nt_buffer_text(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
	for (int level = 0; level < 2; level++)
		nt_buffer_format(out, "%s name=\"nmtan\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\">\n",
			level ? "\t<testsuite" : "<testsuites", reports->count, failures, errors);
	for (size_t i = 0; i < reports->count; i++)
		put_case(reports, reports->items[i], out);
	nt_buffer_text(out, "\t</testsuite>\n</testsuites>\n");
}
