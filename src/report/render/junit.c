/* SPDX-License-Identifier: MIT */
/*
 * JUnit XML, for test dashboards: a suite per file, a case per rule. A case fails when its findings are of
 * the severity from which on the run fails; others are told in its output. An input that could not be
 * read is an error.
 */
#include "report/render/writers.h"

static bool is_failure(const nt_report_list *reports, const nt_report_finding *finding)
{
	return !finding->known && (int)finding->severity >= reports->style.least_failure;
}

/* The findings of one code, one per line. */
static void put_findings(const nt_report_list *reports, const nt_report *report, nt_code code,
	bool failures, nt_buffer *out)
{
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		if (finding->code != code || is_failure(reports, finding) != failures)
			continue;
		nt_buffer_format(out, "%s: ", nt_severity_name(finding->severity));
		nt_xml_text(finding->message, out);
		if (finding->mesh != NT_NONE) {
			nt_buffer_text(out, ", in ");
			nt_put_label(report, finding->mesh, nt_xml_text, out);
		}
		if (finding->spot_count && finding->spots[0].line)
			nt_buffer_format(out, ", line %zu", finding->spots[0].line);
		nt_buffer_text(out, finding->known ? " (known)\n" : "\n");
	}
}

/* How many findings a code has, failures and others. */
static void count_findings(const nt_report_list *reports, const nt_report *report, nt_code code,
	size_t counts[2])
{
	counts[0] = counts[1] = 0;
	for (size_t i = 0; i < report->finding_count; i++)
		if (report->findings[i].code == code)
			counts[is_failure(reports, &report->findings[i])]++;
}

static void put_case(const nt_report_list *reports, const nt_report *report, nt_code code, nt_buffer *out)
{
	const nt_code_row *row = nt_code_info(code);
	size_t counts[2];
	count_findings(reports, report, code, counts);
	nt_buffer_text(out, "\t\t<testcase classname=\"");
	nt_xml_text(report->shown, out);
	nt_buffer_format(out, "\" name=\"%s\"", row->name);
	if (!counts[0] && !counts[1]) {
		nt_buffer_text(out, "/>\n");
		return;
	}
	nt_buffer_text(out, ">\n");
	if (counts[1]) {
		nt_buffer_format(out, "\t\t\t<failure type=\"%s\" message=\"%zu finding%s\">", row->name,
			counts[1], counts[1] == 1 ? "" : "s");
		put_findings(reports, report, code, true, out);
		nt_xml_text(row->remedy, out);
		nt_buffer_text(out, "</failure>\n");
	}
	if (counts[0]) {
		nt_buffer_text(out, "\t\t\t<system-out>");
		put_findings(reports, report, code, false, out);
		nt_buffer_text(out, "</system-out>\n");
	}
	nt_buffer_text(out, "\t\t</testcase>\n");
}

static size_t failed_cases(const nt_report_list *reports, const nt_report *report)
{
	size_t failed = 0;
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		size_t counts[2];
		count_findings(reports, report, (nt_code)code, counts);
		failed += counts[1] > 0;
	}
	return failed;
}

static void put_suite(const nt_report_list *reports, const nt_report *report, nt_buffer *out)
{
	nt_buffer_text(out, "\t<testsuite name=\"");
	nt_xml_text(report->shown, out);
	if (report->failure) {
		nt_buffer_text(out, "\" tests=\"1\" failures=\"0\" errors=\"1\">\n\t\t<testcase classname=\"");
		nt_xml_text(report->shown, out);
		nt_buffer_text(out, "\" name=\"can be read\">\n\t\t\t<error message=\"");
		nt_xml_text(report->failure, out);
		nt_buffer_text(out, "\"/>\n\t\t</testcase>\n\t</testsuite>\n");
		return;
	}
	nt_buffer_format(out, "\" tests=\"%d\" failures=\"%zu\" errors=\"0\">\n", NT_CODE_COUNT,
		failed_cases(reports, report));
	for (unsigned code = 0; code < NT_CODE_COUNT; code++)
		put_case(reports, report, (nt_code)code, out);
	nt_buffer_text(out, "\t</testsuite>\n");
}

void nt_write_junit(const nt_report_list *reports, nt_buffer *out)
{
	size_t tests = 0, failures = 0, errors = 0;
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		tests += report->failure ? 1 : NT_CODE_COUNT;
		errors += report->failure != NULL;
		failures += failed_cases(reports, report);
	}
	nt_buffer_format(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
		"<testsuites name=\"nmtan\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\">\n",
		tests, failures, errors);
	for (size_t i = 0; i < reports->count; i++)
		put_suite(reports, reports->items[i], out);
	nt_buffer_text(out, "</testsuites>\n");
}
