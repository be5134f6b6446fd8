/* SPDX-License-Identifier: MIT */
/*
 * JUnit XML, for test dashboards: a suite for each file, in it a case for "can be read" and one for each code whose
 * findings fail the run, by its severity or by what was found in one of the files: all suites have the same cases, so
 * that dashboards can follow them. What fails nothing is the suite's output.
 */
#include "report/render/writers.h"

/* The codes that have cases. */
typedef struct case_list {
	bool has[NT_CODE_COUNT];
	size_t count;
} case_list;

static bool is_failure(const nt_report_list *reports, const nt_report_finding *finding)
{
	return !finding->known && (int)finding->severity >= reports->style.least_failure;
}

static case_list list_cases(const nt_report_list *reports)
{
	static const nt_report_options defaults;
	const nt_report_options *options = reports->style.options ? reports->style.options : &defaults;
	case_list list = {.count = 0};
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		const int severity = options->severity[code] ? options->severity[code] - 1
							     : (int)nt_code_info((nt_code)code)->severity;
		list.has[code] = !options->ignore[code] && severity >= reports->style.least_failure;
	}
	for (size_t i = 0; i < reports->count; i++)
		for (size_t k = 0; k < reports->items[i]->finding_count; k++)
			if (is_failure(reports, &reports->items[i]->findings[k]))
				list.has[reports->items[i]->findings[k].code] = true;
	for (unsigned code = 0; code < NT_CODE_COUNT; code++)
		list.count += list.has[code];
	return list;
}

/* The failures of one code, or with NT_CODE_COUNT what is no failure: one per line. */
static void put_findings(const nt_report_list *reports, const nt_report *report, nt_code code, nt_buffer *out)
{
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		const bool fails = is_failure(reports, finding);
		if (code == NT_CODE_COUNT ? fails : !fails || finding->code != code)
			continue;
		nt_buffer_format(out, "%s: ", nt_severity_name(finding->severity));
		if (code == NT_CODE_COUNT)
			nt_buffer_format(out, "%s: ", nt_code_info(finding->code)->name);
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

static size_t count_failures(const nt_report_list *reports, const nt_report *report, unsigned code)
{
	size_t count = 0;
	for (size_t i = 0; i < report->finding_count; i++)
		count += report->findings[i].code == code && is_failure(reports, &report->findings[i]);
	return count;
}

static void put_case(const nt_report_list *reports, const nt_report *report, nt_code code, nt_buffer *out)
{
	const nt_code_row *row = nt_code_info(code);
	const size_t count = count_failures(reports, report, code);
	nt_buffer_text(out, "\t\t<testcase classname=\"");
	nt_xml_text(report->shown, out);
	nt_buffer_format(out, "\" name=\"%s\"", row->name);
	if (!count) {
		nt_buffer_text(out, "/>\n");
		return;
	}
	nt_buffer_format(out, ">\n\t\t\t<failure type=\"%s\" message=\"%zu finding%s\">", row->name, count,
		count == 1 ? "" : "s");
	put_findings(reports, report, code, out);
	nt_xml_text(row->remedy, out);
	nt_buffer_text(out, "</failure>\n\t\t</testcase>\n");
}

static void put_reading(const nt_report *report, nt_buffer *out)
{
	nt_buffer_text(out, "\t\t<testcase classname=\"");
	nt_xml_text(report->shown, out);
	nt_buffer_text(out, "\" name=\"can be read\"");
	if (report->failure) {
		nt_buffer_text(out, ">\n\t\t\t<error message=\"");
		nt_xml_text(report->failure, out);
		nt_buffer_text(out, "\"/>\n\t\t</testcase>\n");
	} else {
		nt_buffer_text(out, "/>\n");
	}
}

static size_t failed_cases(const nt_report_list *reports, const nt_report *report)
{
	size_t failed = 0;
	for (unsigned code = 0; code < NT_CODE_COUNT; code++)
		failed += count_failures(reports, report, code) > 0;
	return failed;
}

/* A file that cannot be read has no other case. */
static size_t case_count(const nt_report *report, const case_list *cases)
{
	return report->failure ? 1 : 1 + cases->count;
}

static void put_suite(const nt_report_list *reports, const nt_report *report, const case_list *cases, nt_buffer *out)
{
	nt_buffer_text(out, "\t<testsuite name=\"");
	nt_xml_text(report->shown, out);
	nt_buffer_format(out, "\" tests=\"%zu\" failures=\"%zu\" errors=\"%d\">\n", case_count(report, cases),
		failed_cases(reports, report), report->failure != NULL);
	put_reading(report, out);
	for (unsigned code = 0; code < NT_CODE_COUNT && !report->failure; code++)
		if (cases->has[code])
			put_case(reports, report, (nt_code)code, out);
	nt_buffer_text(out, "\t\t<system-out>");
	put_findings(reports, report, NT_CODE_COUNT, out);
	nt_buffer_text(out, "</system-out>\n\t</testsuite>\n");
}

void nt_write_junit(const nt_report_list *reports, nt_buffer *out)
{
	const case_list cases = list_cases(reports);
	size_t tests = 0, failures = 0, errors = 0;
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		tests += case_count(report, &cases);
		errors += report->failure != NULL;
		failures += failed_cases(reports, report);
	}
	nt_buffer_format(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
		"<testsuites name=\"nmtan\" tests=\"%zu\" failures=\"%zu\" errors=\"%zu\">\n",
		tests, failures, errors);
	for (size_t i = 0; i < reports->count; i++)
		put_suite(reports, reports->items[i], &cases, out);
	nt_buffer_text(out, "</testsuites>\n");
}
