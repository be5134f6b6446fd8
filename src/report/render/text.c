/* SPDX-License-Identifier: MIT */
/*
 * The report for people: per file what it is made of, then its findings, the most severe first, each with
 * the places where it occurs and, once per code, what to do.
 */
#include <math.h>
#include "report/render/inside.h"

enum { SHOWN_SPOTS = 3 };

static const char *paint(const nt_walk *w, const char *code)
{
	return w->reports->style.colour ? code : "";
}

static const char *const bold = "\x1b[1m", *const dim = "\x1b[2m", *const plain = "\x1b[0m";

/* ---- meshes ---- */

static double share(const double areas[3], int which)
{
	const double total = areas[0] + areas[1] + areas[2];
	return total > 0.0 ? 100.0 * areas[which] / total : 0.0;
}

static void write_islands(const nt_report_mesh *mesh, nt_buffer *out)
{
	nt_buffer_format(out, "%zu UV island%s", mesh->island_count, nt_plural(mesh->island_count));
	for (unsigned kind = NT_ISLAND_MIRRORED; kind <= NT_ISLAND_DEGENERATE; kind++)
		if (mesh->island_kinds[kind])
			nt_buffer_format(out, ", %zu %s", mesh->island_kinds[kind],
				nt_island_kind_name((nt_island_kind)kind));
	if (mesh->seam_count)
		nt_buffer_format(out, "; %zu mirror seam%s of length %.4g", mesh->seam_count,
			nt_plural(mesh->seam_count), mesh->seam_length);
	if (mesh->maker.known) {
		nt_buffer_text(out, "; tangents of ");
		nt_maker_text(&mesh->maker, out);
	}
}

static void write_mesh(const nt_report *report, uint32_t index, nt_buffer *out)
{
	const nt_report_mesh *mesh = &report->meshes[index];
	nt_put(out, NT_TERMINAL, "  %p: ", nt_mesh_label(report, index));
	if (!mesh->analysed) {
		nt_buffer_format(out, "%s\n", mesh->why);
		return;
	}
	nt_buffer_format(out, "%zu triangle%s", mesh->triangle_count, nt_plural(mesh->triangle_count));
	if (!mesh->has_texcoords) {
		nt_buffer_text(out, ", no texture coordinates\n");
		return;
	}
	if (mesh->triangles[0])
		nt_buffer_format(out, ", %zu mirrored (%.3g %% of the area)", mesh->triangles[0],
			share(mesh->areas, 0));
	if (mesh->triangles[1])
		nt_buffer_format(out, ", %zu degenerate (%.3g %%)", mesh->triangles[1], share(mesh->areas, 1));
	nt_buffer_text(out, "\n    ");
	write_islands(mesh, out);
	if (mesh->vertices_after != mesh->vertices_before)
		nt_buffer_format(out, "; %zu vertices became %zu", mesh->vertices_before, mesh->vertices_after);
	nt_buffer_text(out, "\n");
}

/* ---- findings ---- */

static void write_place(const nt_report *report, const nt_report_mesh *mesh, const float position[3], nt_buffer *out)
{
	double shown[3];
	nt_world_point(mesh, position, shown);
	for (int i = 0; i < 3; i++) {
		nt_buffer_text(out, i ? " " : "(");
		if (report->origin[i] != 0)
			nt_put_coordinate(position[i], report->origin[i], out);
		else
			nt_buffer_format(out, fabs(shown[i]) < 1e5 ? "%.6g" : "%.9g", shown[i]);
	}
	nt_buffer_text(out, ")");
}

static void write_spot(const nt_report *report, const nt_report_mesh *mesh, const nt_spot *spot, nt_buffer *out)
{
	static const char *const kinds[] = {"vertex", "edge", "corners"};
	nt_buffer_text(out, "            ");
	if (spot->line)
		nt_buffer_format(out, "line %zu, ", spot->line);
	if (spot->triangle != NT_NONE)
		nt_buffer_format(out, "triangle %u, ", spot->triangle);
	nt_put(out, NT_TERMINAL, spot->source ? "f %s" : "%-s",
		spot->source ? spot->source : kinds[spot->corner_count - 1]);
	for (unsigned k = 0; k < spot->corner_count && !spot->source; k++)
		nt_buffer_format(out, " %u", spot->vertices[k]);
	nt_buffer_text(out, " at ");
	write_place(report, mesh, spot->positions[0], out);
	for (unsigned k = 0; k < spot->corner_count && spot->has_texcoords; k++)
		nt_buffer_format(out, "%s(%.6g %.6g)", k ? "" : " uv ", (double)spot->texcoords[k][0],
			(double)spot->texcoords[k][1]);
	nt_buffer_text(out, "\n");
}

static void write_finding(const nt_walk *w, const nt_report_finding *finding, bool remedy, nt_buffer *out)
{
	static const char *const colours[] = {"\x1b[36m", "\x1b[33m", "\x1b[31;1m"};
	const nt_report *report = w->report;
	nt_put(out, NT_TERMINAL, "  %-s%-7s%-s   %-s%-s%-s  %s\n", paint(w, colours[finding->severity]),
		nt_severity_name(finding->severity), paint(w, plain), paint(w, bold), nt_finding_name(finding),
		paint(w, plain), finding->message);
	const size_t before = out->size;
	nt_buffer_text(out, "            in ");
	const size_t begin = out->size;
	if (!finding->spot_count)
		nt_put(out, NT_TERMINAL, "%p", nt_finding_where(report, finding, report->mesh_count > 1));
	else if (report->mesh_count > 1) /* each spot has its line */
		nt_put(out, NT_TERMINAL, "%p", nt_mesh_label(report, finding->mesh));
	if (out->size > begin)
		nt_buffer_text(out, "\n");
	else
		out->size = before;
	for (unsigned i = 0; i < finding->spot_count && i < SHOWN_SPOTS; i++)
		write_spot(report, &report->meshes[finding->mesh], &finding->spots[i], out);
	if (finding->spot_count > SHOWN_SPOTS)
		nt_buffer_text(out, "            and others\n");
	if (remedy)
		nt_put(out, NT_PLAIN, "%-s            %p\n%-s", paint(w, dim), nt_finding_remedy(report, finding),
			paint(w, plain));
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	const nt_report *report = w->report;
	const nt_totals totals = nt_report_totals(&report, 1);
	memset(w->told, 0, sizeof w->told);
	nt_put(out, NT_TERMINAL, "%-s%s%-s: ", paint(w, bold), report->shown, paint(w, plain));
	if (report->failure)
		nt_put(out, NT_TERMINAL, "not judged: %p", nt_failure_text(report, true));
	if (report->failure && report->finding_count) /* found before */
		nt_buffer_text(out, "\n  ");
	if (!report->failure || report->finding_count)
		nt_totals_text(&totals, out);
	if (!report->failure)
		nt_put(out, NT_TERMINAL, "\n  %p", nt_verdict(report));
	nt_buffer_text(out, "\n");
	for (size_t i = 0; i < report->mesh_count && !report->failure; i++)
		write_mesh(report, (uint32_t)i, out);
}

/* Remedies, each with its command once. */
static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const char *repair = finding->repair ? finding->repair : "", **last = &w->told[finding->code];
	const bool remedy = !*last || (*repair && strcmp(*last, repair) != 0);
	write_finding(w, finding, remedy, out);
	*last = remedy ? repair : *last;
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	nt_put_together(w->report, "  ", NT_TERMINAL, out);
	nt_dropped_text(w->report, "  and ", "; --max-issues=0 shows all\n", out);
}

static void end(nt_walk *w, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(w->items, w->count);
	if (w->count < 2)
		return;
	nt_buffer_format(out, "%zu files: ", w->count);
	nt_totals_text(&totals, out);
	nt_buffer_text(out, "\n");
}

const nt_report_writer nt_text_writer = {
	.begin_file = begin_file, .put_finding = put_finding, .end_file = end_file, .end = end};
