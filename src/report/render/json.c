/* SPDX-License-Identifier: MIT */
/*
 * The report as JSON: everything that was found, for programs. data/nmtan-report.schema.json describes it.
 * Objects of the same kind always have the same members; what is unknown is null or an empty array.
 * Each mesh, island, seam and finding is on a line of its own, so that two reports can be compared by
 * diff.
 */
#include "report/render/writers.h"

#include <math.h>

enum { SAME_LINE = -1, SHOWN_SEAMS = 1000, SHOWN_ISLANDS = 1000 };

/* A comma where one is due, and a new line with `indent` tabs unless that is SAME_LINE. */
static void separate(nt_buffer *out, int indent)
{
	const char last = out->size ? out->data[out->size - 1] : '{';
	if (last != '{' && last != '[')
		nt_buffer_text(out, ",");
	if (indent == SAME_LINE)
		return;
	nt_buffer_text(out, "\n");
	for (int i = 0; i < indent; i++)
		nt_buffer_text(out, "\t");
}

static void key(nt_buffer *out, int indent, const char *name)
{
	separate(out, indent);
	nt_buffer_format(out, "\"%s\":", name);
}

/* An object or array as a member. */
static void open(nt_buffer *out, const char *name, const char *bracket)
{
	key(out, SAME_LINE, name);
	nt_buffer_text(out, bracket);
}

static void close_with(nt_buffer *out, int indent, const char *bracket)
{
	nt_buffer_text(out, "\n");
	for (int i = 0; i < indent; i++)
		nt_buffer_text(out, "\t");
	nt_buffer_text(out, bracket);
}

static void put_text(nt_buffer *out, const char *name, const char *text)
{
	key(out, SAME_LINE, name);
	if (text)
		nt_json_string(text, out);
	else
		nt_buffer_text(out, "null");
}

static void put_count(nt_buffer *out, const char *name, size_t count)
{
	key(out, SAME_LINE, name);
	nt_buffer_format(out, "%zu", count);
}

/* An index, null for NT_NONE. */
static void put_index(nt_buffer *out, const char *name, uint32_t index)
{
	key(out, SAME_LINE, name);
	nt_json_index(index, out);
}

static void put_bool(nt_buffer *out, const char *name, bool value)
{
	key(out, SAME_LINE, name);
	nt_buffer_text(out, value ? "true" : "false");
}

static void put_float(nt_buffer *out, const char *name, double value)
{
	key(out, SAME_LINE, name);
	nt_json_float(value, out);
}

static void put_doubles(nt_buffer *out, const char *name, const double *values, size_t count)
{
	open(out, name, "[");
	for (size_t i = 0; i < count; i++) {
		separate(out, SAME_LINE);
		nt_json_float(values[i], out);
	}
	nt_buffer_text(out, "]");
}

/* 16 digits, null for 0. */
static void put_digest(nt_buffer *out, const char *name, uint64_t digest)
{
	key(out, SAME_LINE, name);
	nt_buffer_format(out, digest ? "\"%016llx\"" : "null", (unsigned long long)digest);
}

static void put_place(nt_buffer *out, const char *name, const nt_report *report, const nt_place_view *place)
{
	nt_buffer file = {0};
	nt_report_show_path(report, place->file, &file);
	open(out, name, "{");
	put_text(out, "file", place->file[0] && file.data ? file.data : NULL);
	nt_buffer_free_into(&file, out);
	key(out, SAME_LINE, "line");
	nt_buffer_format(out, place->line ? "%zu" : "null", place->line);
	key(out, SAME_LINE, "offset");
	if (place->offset == NT_NO_OFFSET)
		nt_buffer_text(out, "null");
	else
		nt_buffer_format(out, "%llu", (unsigned long long)place->offset);
	put_text(out, "pointer", place->pointer[0] ? place->pointer : NULL);
	put_text(out, "object", place->object[0] ? place->object : NULL);
	nt_buffer_text(out, "}");
}

static void put_totals(nt_buffer *out, int indent, const nt_totals *totals)
{
	key(out, indent, "totals");
	nt_buffer_text(out, "{");
	put_count(out, "errors", totals->by_severity[NT_SEVERITY_ERROR]);
	put_count(out, "warnings", totals->by_severity[NT_SEVERITY_WARNING]);
	put_count(out, "infos", totals->by_severity[NT_SEVERITY_INFO]);
	put_count(out, "known", nt_known_count(totals));
	put_count(out, "dropped", totals->dropped);
	nt_buffer_text(out, "}");
	key(out, indent, "truncated");
	nt_buffer_text(out, totals->dropped ? "true" : "false");
}

/* ---- meshes ---- */

static void by_orientation(nt_buffer *out, const char *name, const size_t counts[3])
{
	key(out, SAME_LINE, name);
	nt_buffer_format(out, "{\"normal\":%zu,\"mirrored\":%zu,\"degenerate\":%zu}", counts[2], counts[0],
		counts[1]);
}

static void area_shares(nt_buffer *out, const double areas[3])
{
	const double total = areas[0] + areas[1] + areas[2];
	const double scale = total > 0.0 ? 1.0 / total : 0.0;
	open(out, "area_share", "{");
	put_float(out, "normal", areas[2] * scale);
	put_float(out, "mirrored", areas[0] * scale);
	put_float(out, "degenerate", areas[1] * scale);
	nt_buffer_text(out, "}");
}

/* Median and worst; null where nothing was measured. */
static void put_measure(nt_buffer *out, const char *name, const double values[2])
{
	key(out, SAME_LINE, name);
	if (isnan(values[0])) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_text(out, "{");
	put_float(out, "median", values[0]);
	put_float(out, "worst", values[1]);
	nt_buffer_text(out, "}");
}

static void put_island(nt_buffer *out, const nt_island *island)
{
	nt_buffer_text(out, "{");
	put_text(out, "kind", nt_island_kind_name(island->kind));
	by_orientation(out, "triangles", island->triangles);
	put_float(out, "area", island->area);
	put_float(out, "covered_share", island->covered);
	put_bool(out, "twin", island->overlaps_itself);
	put_measure(out, "texel_density", island->texel_density);
	put_measure(out, "stretch", island->stretch);
	key(out, SAME_LINE, "uv_box");
	nt_json_rows((const float[]){island->minimum[0], island->minimum[1], island->maximum[0], island->maximum[1]},
		2, 2, out);
	nt_buffer_text(out, "}");
}

static void put_pairs(nt_buffer *out, const char *name, const uint32_t pairs[2][2])
{
	key(out, SAME_LINE, name);
	nt_buffer_format(out, "[[%u,%u],[%u,%u]]", pairs[0][0], pairs[0][1], pairs[1][0], pairs[1][1]);
}

static void put_edge(nt_buffer *out, const nt_report *report, const nt_seam_edge *edge)
{
	nt_buffer_text(out, "{");
	key(out, SAME_LINE, "triangles");
	nt_buffer_format(out, "[%u,%u]", edge->triangles[0], edge->triangles[1]);
	put_pairs(out, "vertices", edge->vertices);
	put_pairs(out, "output_vertices", edge->output);
	key(out, SAME_LINE, "positions");
	nt_json_positions(edge->positions[0], 2, report->origin, out);
	open(out, "texcoords", "[");
	nt_json_rows(edge->texcoords[0][0], 2, 2, out);
	separate(out, SAME_LINE);
	nt_json_rows(edge->texcoords[1][0], 2, 2, out);
	nt_buffer_text(out, "]");
	put_float(out, "dihedral_degrees", edge->dihedral);
	put_float(out, "tangent_angle_degrees", edge->tangent_angle);
	nt_buffer_text(out, "}");
}

static void put_seam(nt_buffer *out, const nt_report *report, const nt_seam *seam)
{
	nt_buffer_text(out, "{");
	put_bool(out, "closed", seam->closed);
	put_count(out, "edge_count", seam->edge_count);
	put_float(out, "length", seam->length);
	put_doubles(out, "dihedral_degrees", seam->dihedral, 2);
	put_doubles(out, "tangent_angle_degrees", seam->tangent_angle, 2);
	open(out, "islands", "{");
	put_index(out, "normal", seam->islands[0]);
	put_index(out, "mirrored", seam->islands[1]);
	nt_buffer_text(out, "}");
	put_count(out, "edges_sharing_vertices", seam->shared_count);
	put_doubles(out, "frame_angle_degrees", seam->frame_angle, 2);
	put_count(out, "edges_sharing_texels", seam->same_texel_count);
	put_count(out, "unhidden_edges", seam->unhidden_count);
	put_count(out, "non_manifold_edges", seam->non_manifold_count);
	key(out, SAME_LINE, "plane");
	if (seam->has_plane) {
		nt_buffer_text(out, "{");
		put_text(out, "text", seam->plane_text);
		put_doubles(out, "normal", seam->plane, 3);
		put_float(out, "distance", seam->plane[3]);
		nt_buffer_text(out, "}");
	} else {
		nt_buffer_text(out, "null");
	}
	key(out, SAME_LINE, "box");
	nt_json_box(&seam->box, report->origin, out);
	put_bool(out, "edges_truncated", seam->edge_count > NT_SEAM_EDGES);
	open(out, "edges", "[");
	for (size_t i = 0; i < seam->edge_count && i < NT_SEAM_EDGES; i++) {
		separate(out, SAME_LINE);
		put_edge(out, report, &seam->edges[i]);
	}
	nt_buffer_text(out, "]}");
}

static void put_slots(nt_buffer *out, unsigned slots)
{
	static const char *const names[3] = {"normal", "clearcoat_normal", "anisotropy"};
	open(out, "slots", "[");
	for (unsigned i = 0; i < 3; i++) {
		if (slots >> i & 1u) {
			separate(out, SAME_LINE);
			nt_buffer_format(out, "\"%s\"", names[i]);
		}
	}
	nt_buffer_text(out, "]");
}

static void put_histogram(nt_buffer *out, const nt_report_mesh *mesh)
{
	open(out, "direction_histogram", "[");
	for (int i = 0; i < NT_ANGLE_BINS; i++) {
		separate(out, SAME_LINE);
		nt_buffer_format(out, "{\"up_to_degrees\":%g,\"corners\":%zu}", nt_angle_bins[i],
			mesh->angle_histogram[i]);
	}
	nt_buffer_text(out, "]");
}

static void put_maker(nt_buffer *out, const nt_maker *maker)
{
	static const char *const methods[] = {"mikktspace", "area", "lengyel", "robust", "mikktspace-sorted"};
	if (maker->agreement < 0.0)
		return;
	open(out, "made_by", "{");
	separate(out, SAME_LINE);
	nt_buffer_format(out,
		"\"method\":\"%s\",\"faces\":\"%s\",\"across\":\"%s\",\"transform\":\"%s\",\"w\":\"%s\","
		"\"agreement\":%.6g,\"within_degrees\":%g}",
		maker->known ? methods[maker->method] : "unknown", maker->quads ? "quads" : "triangles",
		maker->across ? "mesh" : "primitive", maker->untransformed ? "keep" : "bake",
		maker->inverted ? "inverted" : "right", maker->agreement, maker->degrees);
}

/* The cost of splitting, and the texture that density is measured by. */
static void put_costs(nt_buffer *out, const nt_report_mesh *mesh)
{
	const size_t added = mesh->split_vertices;
	key(out, SAME_LINE, "split_cost");
	if (mesh->vertex_bytes)
		nt_buffer_format(out, "{\"vertices\":%zu,\"bytes_each\":%zu,\"bytes\":%zu}", added, mesh->vertex_bytes,
			added * mesh->vertex_bytes);
	else
		nt_buffer_text(out, "null");
	key(out, SAME_LINE, "texture_size");
	if (mesh->texture_size[0])
		nt_buffer_format(out, "[%u,%u]", mesh->texture_size[0], mesh->texture_size[1]);
	else
		nt_buffer_text(out, "null");
}

static void put_counts(nt_buffer *out, const nt_report_mesh *mesh)
{
	put_count(out, "faces", mesh->face_count);
	by_orientation(out, "triangles", mesh->triangles);
	area_shares(out, mesh->areas);
	open(out, "vertices", "{");
	put_count(out, "before", mesh->vertices_before);
	put_count(out, "added_normals", mesh->added_normals);
	put_count(out, "added_mirror", mesh->added_mirror);
	put_count(out, "added_direction", mesh->added_direction);
	put_count(out, "after", mesh->vertices_after);
	nt_buffer_text(out, "}");
	put_costs(out, mesh);
	open(out, "edges", "{");
	put_count(out, "all", mesh->edge_count);
	put_count(out, "boundary", mesh->boundary_edges);
	put_count(out, "boundary_loops", mesh->boundary_loops);
	put_count(out, "boundary_chains", mesh->boundary_chains);
	put_count(out, "non_manifold", mesh->non_manifold_edges);
	put_count(out, "inconsistent_winding", mesh->inconsistent_edges);
	put_count(out, "uv_cut", mesh->uv_seam_edges);
	put_count(out, "mirror", mesh->seam_edges);
	nt_buffer_text(out, "}");
	put_count(out, "triangles_left_out", mesh->left_out);
	open(out, "islands_by_kind", "{");
	for (unsigned kind = 0; kind < 4; kind++)
		put_count(out, nt_island_kind_name((nt_island_kind)kind), mesh->island_kinds[kind]);
	nt_buffer_text(out, "}");
	put_count(out, "seam_count", mesh->seam_count);
	put_float(out, "seam_length", mesh->seam_length);
}

static void put_mesh(nt_buffer *out, const nt_report *report, const nt_report_mesh *mesh)
{
	nt_buffer_text(out, "{");
	put_text(out, "name", mesh->name);
	put_place(out, "place", report, &mesh->place);
	put_index(out, "gltf_mesh", mesh->gltf_mesh);
	put_index(out, "gltf_primitive", mesh->gltf_primitive);
	put_index(out, "same_as", mesh->same_as);
	put_text(out, "why", mesh->why);
	put_slots(out, mesh->slots);
	put_count(out, "texcoord_set", mesh->texcoord_set);
	put_bool(out, "has_normals", mesh->has_normals);
	put_bool(out, "has_texcoords", mesh->has_texcoords);
	put_bool(out, "has_tangents", mesh->checked_tangents);
	put_bool(out, "analysed", mesh->analysed);
	put_counts(out, mesh);
	put_float(out, "worst_orthogonality_degrees", mesh->worst_orthogonality);
	put_doubles(out, "relative_determinant", mesh->relative_determinant, 3);
	put_maker(out, &mesh->maker);
	put_histogram(out, mesh);
	put_count(out, "instances", mesh->instance_count);
	put_count(out, "negative_instances", mesh->negative_instances);
	key(out, SAME_LINE, "box");
	nt_json_box(&mesh->box, report->origin, out);
	put_bool(out, "islands_truncated", mesh->island_count > SHOWN_ISLANDS);
	open(out, "islands", "[");
	for (size_t i = 0; mesh->islands && i < mesh->island_count && i < SHOWN_ISLANDS; i++) {
		separate(out, 4);
		put_island(out, &mesh->islands[i]);
	}
	nt_buffer_text(out, "]");
	put_bool(out, "seams_truncated", mesh->seam_count > SHOWN_SEAMS);
	open(out, "seams", "[");
	for (size_t i = 0; mesh->seams && i < mesh->seam_count && i < SHOWN_SEAMS; i++) {
		separate(out, 4);
		put_seam(out, report, &mesh->seams[i]);
	}
	nt_buffer_text(out, "]}");
}

/* ---- findings ---- */

static void put_spot(nt_buffer *out, const nt_report *report, const nt_spot *spot)
{
	nt_buffer_text(out, "{");
	put_index(out, "triangle", spot->triangle);
	put_index(out, "face", spot->face);
	key(out, SAME_LINE, "line");
	nt_buffer_format(out, spot->line ? "%zu" : "null", spot->line);
	put_text(out, "source", spot->source);
	put_float(out, "value", spot->value);
	open(out, "vertices", "[");
	for (unsigned k = 0; k < spot->corner_count; k++) {
		separate(out, SAME_LINE);
		nt_buffer_format(out, "%u", spot->vertices[k]);
	}
	nt_buffer_text(out, "]");
	key(out, SAME_LINE, "positions");
	nt_json_positions(spot->positions[0], spot->corner_count, report->origin, out);
	key(out, SAME_LINE, "texcoords");
	nt_json_rows(spot->texcoords[0], spot->has_texcoords ? spot->corner_count : 0, 2, out);
	nt_buffer_text(out, "}");
}

/* Null where nmtan cannot repair it. */
static void put_repair(nt_buffer *out, const nt_report *report, const nt_report_finding *finding)
{
	nt_buffer command = {0};
	if (finding->repair)
		nt_command_text(finding->repair, report->given, report->path, NULL, &command);
	put_text(out, "repair", command.data);
	nt_buffer_free_into(&command, out);
}

static void put_finding(nt_buffer *out, const nt_report *report, const nt_report_finding *finding)
{
	nt_buffer_text(out, "{");
	put_text(out, "code", nt_code_info(finding->code)->name);
	put_text(out, "severity", nt_severity_name(finding->severity));
	put_text(out, "message", finding->message);
	put_repair(out, report, finding);
	put_count(out, "count", finding->count);
	put_count(out, "alike", finding->alike);
	put_digest(out, "fingerprint", finding->fingerprint);
	put_digest(out, "geometry", finding->geometry);
	put_bool(out, "known", finding->known);
	put_index(out, "mesh", finding->mesh);
	put_index(out, "seam", finding->code == NT_CODE_UV_HARD_EDGE ? NT_NONE : finding->seam);
	put_index(out, "island", finding->island);
	put_place(out, "place", report, &finding->place);
	key(out, SAME_LINE, "box");
	nt_json_box(&finding->box, report->origin, out);
	open(out, "numbers", "{");
	for (unsigned i = 0; i < finding->number_count; i++)
		put_float(out, finding->numbers[i].name, finding->numbers[i].value);
	nt_buffer_text(out, "}");
	open(out, "spots", "[");
	for (unsigned i = 0; i < finding->spot_count; i++) {
		separate(out, 5);
		put_spot(out, report, &finding->spots[i]);
	}
	nt_buffer_text(out, "]");
	key(out, SAME_LINE, "votes");
	nt_json_votes(finding, out);
	nt_buffer_text(out, "}");
}

static void put_failure(nt_buffer *out, const nt_report *report)
{
	key(out, 3, "failure");
	if (!report->failure) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_text(out, "{");
	put_text(out, "message", report->failure);
	put_place(out, "place", report, &report->failure_place);
	nt_buffer_text(out, "}");
}

static void put_report(nt_buffer *out, const nt_report *report)
{
	const nt_report_list one = {.items = &report, .count = 1};
	const nt_totals totals = nt_report_totals(&one);
	nt_buffer_text(out, "{");
	key(out, 3, "file");
	nt_json_string(report->shown, out);
	key(out, 3, "format");
	nt_buffer_format(out, "\"%s\"", nt_input_format_name(report->format));
	key(out, 3, "verdict");
	nt_put_verdict(report, nt_json_string, out);
	put_text(out, "conversion", report->conversion);
	put_failure(out, report);
	if (report->origin_text) {
		key(out, 3, "origin");
		nt_buffer_format(out, "[%s]", report->origin_text);
	}
	put_totals(out, 3, &totals);
	key(out, 3, "meshes");
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < report->mesh_count; i++) {
		separate(out, 4);
		put_mesh(out, report, &report->meshes[i]);
	}
	nt_buffer_text(out, "]");
	key(out, 3, "findings");
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < report->finding_count; i++) {
		separate(out, 4);
		put_finding(out, report, &report->findings[i]);
	}
	nt_buffer_text(out, "]");
	close_with(out, 2, "}");
}

void nt_write_json(const nt_report_list *reports, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(reports);
	nt_buffer_text(out, "{");
	key(out, 1, "report");
	nt_buffer_text(out, "\"nmtan\"");
	key(out, 1, "report_version");
	nt_buffer_text(out, "2");
	key(out, 1, "generator");
	nt_buffer_format(out, "\"nmtan %s\"", NMTAN_VERSION_STRING);
	put_totals(out, 1, &totals);
	key(out, 1, "files");
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < reports->count; i++) {
		separate(out, 2);
		put_report(out, reports->items[i]);
	}
	nt_buffer_text(out, "]");
	close_with(out, 0, "}\n");
}
