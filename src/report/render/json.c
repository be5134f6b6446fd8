/* SPDX-License-Identifier: MIT */
/*
 * The report as JSON: everything that was found, for programs. data/nmtan-report.schema.json describes it.
 * Objects of the same kind always have the same members; what is unknown is null or an empty array.
 * Each mesh, island, seam and finding is on a line of its own, so that two reports can be compared by
 * diff.
 */
#include "report/render/writers.h"

#include <math.h>

enum { SHOWN_SEAMS = 1000, SHOWN_ISLANDS = 1000 };

static void put_place(nt_buffer *out, const char *name, const nt_report *report, const nt_place_view *place)
{
	nt_buffer file = {0};
	nt_report_show_path(report, place->file, &file);
	nt_member_open(out, name, "{");
	nt_member_text(out, "file", place->file[0] && file.data ? file.data : NULL);
	nt_buffer_free_into(&file, out);
	nt_member_key(out, NT_SAME_LINE, "line");
	nt_buffer_format(out, place->line ? "%zu" : "null", place->line);
	nt_member_key(out, NT_SAME_LINE, "offset");
	if (place->offset == NT_NO_OFFSET)
		nt_buffer_text(out, "null");
	else
		nt_buffer_format(out, "%llu", (unsigned long long)place->offset);
	nt_member_text(out, "pointer", place->pointer[0] ? place->pointer : NULL);
	nt_member_text(out, "object", place->object[0] ? place->object : NULL);
	nt_buffer_text(out, "}");
}

static void put_totals(nt_buffer *out, int indent, const nt_totals *totals)
{
	nt_member_key(out, indent, "totals");
	nt_buffer_text(out, "{");
	nt_member_count(out, "errors", totals->by_severity[NT_SEVERITY_ERROR]);
	nt_member_count(out, "warnings", totals->by_severity[NT_SEVERITY_WARNING]);
	nt_member_count(out, "infos", totals->by_severity[NT_SEVERITY_INFO]);
	nt_member_count(out, "known", nt_known_count(totals));
	nt_member_count(out, "dropped", totals->dropped);
	nt_buffer_text(out, "}");
	nt_member_key(out, indent, "truncated");
	nt_buffer_text(out, totals->dropped ? "true" : "false");
}

/* ---- meshes ---- */

static void by_orientation(nt_buffer *out, const char *name, const size_t counts[3])
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_format(out, "{\"normal\":%zu,\"mirrored\":%zu,\"degenerate\":%zu}", counts[2], counts[0],
		counts[1]);
}

static void area_shares(nt_buffer *out, const double areas[3])
{
	const double total = areas[0] + areas[1] + areas[2];
	const double scale = total > 0.0 ? 1.0 / total : 0.0;
	nt_member_open(out, "area_share", "{");
	nt_member_float(out, "normal", areas[2] * scale);
	nt_member_float(out, "mirrored", areas[0] * scale);
	nt_member_float(out, "degenerate", areas[1] * scale);
	nt_buffer_text(out, "}");
}

/* Median and worst; null where nothing was measured. */
static void put_measure(nt_buffer *out, const char *name, const double values[2])
{
	nt_member_key(out, NT_SAME_LINE, name);
	if (isnan(values[0])) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_text(out, "{");
	nt_member_float(out, "median", values[0]);
	nt_member_float(out, "worst", values[1]);
	nt_buffer_text(out, "}");
}

static void put_island(nt_buffer *out, const nt_island *island)
{
	nt_buffer_text(out, "{");
	nt_member_text(out, "kind", nt_island_kind_name(island->kind));
	by_orientation(out, "triangles", island->triangles);
	nt_member_float(out, "area", island->area);
	nt_member_float(out, "covered_share", island->covered);
	nt_member_bool(out, "twin", island->overlaps_itself);
	put_measure(out, "texel_density", island->texel_density);
	put_measure(out, "stretch", island->stretch);
	nt_member_key(out, NT_SAME_LINE, "uv_box");
	nt_json_rows((const float[]){island->minimum[0], island->minimum[1], island->maximum[0], island->maximum[1]},
		2, 2, out);
	nt_buffer_text(out, "}");
}

static void put_pairs(nt_buffer *out, const char *name, const uint32_t pairs[2][2])
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_format(out, "[[%u,%u],[%u,%u]]", pairs[0][0], pairs[0][1], pairs[1][0], pairs[1][1]);
}

static void put_edge(nt_buffer *out, const nt_report *report, const nt_seam_edge *edge)
{
	nt_buffer_text(out, "{");
	nt_member_key(out, NT_SAME_LINE, "triangles");
	nt_buffer_format(out, "[%u,%u]", edge->triangles[0], edge->triangles[1]);
	put_pairs(out, "vertices", edge->vertices);
	put_pairs(out, "output_vertices", edge->output);
	nt_member_key(out, NT_SAME_LINE, "positions");
	nt_json_positions(edge->positions[0], 2, report->origin, out);
	nt_member_open(out, "texcoords", "[");
	nt_json_rows(edge->texcoords[0][0], 2, 2, out);
	nt_member_next(out, NT_SAME_LINE);
	nt_json_rows(edge->texcoords[1][0], 2, 2, out);
	nt_buffer_text(out, "]");
	nt_member_float(out, "dihedral_degrees", edge->dihedral);
	nt_member_float(out, "tangent_angle_degrees", edge->tangent_angle);
	nt_buffer_text(out, "}");
}

static void put_seam(nt_buffer *out, const nt_report *report, const nt_seam *seam)
{
	nt_buffer_text(out, "{");
	nt_member_bool(out, "closed", seam->closed);
	nt_member_count(out, "edge_count", seam->edge_count);
	nt_member_float(out, "length", seam->length);
	nt_member_doubles(out, "dihedral_degrees", seam->dihedral, 2);
	nt_member_doubles(out, "tangent_angle_degrees", seam->tangent_angle, 2);
	nt_member_open(out, "islands", "{");
	nt_member_index(out, "normal", seam->islands[0]);
	nt_member_index(out, "mirrored", seam->islands[1]);
	nt_buffer_text(out, "}");
	nt_member_count(out, "edges_sharing_vertices", seam->shared_count);
	nt_member_doubles(out, "frame_angle_degrees", seam->frame_angle, 2);
	nt_member_count(out, "edges_sharing_texels", seam->same_texel_count);
	nt_member_count(out, "unhidden_edges", seam->unhidden_count);
	nt_member_count(out, "non_manifold_edges", seam->non_manifold_count);
	nt_member_key(out, NT_SAME_LINE, "plane");
	if (seam->has_plane) {
		nt_buffer_text(out, "{");
		nt_member_text(out, "text", seam->plane_text);
		nt_member_doubles(out, "normal", seam->plane, 3);
		nt_member_float(out, "distance", seam->plane[3]);
		nt_buffer_text(out, "}");
	} else {
		nt_buffer_text(out, "null");
	}
	nt_member_key(out, NT_SAME_LINE, "box");
	nt_json_box(&seam->box, report->origin, out);
	nt_member_bool(out, "edges_truncated", seam->edge_count > NT_SEAM_EDGES);
	nt_member_open(out, "edges", "[");
	for (size_t i = 0; i < seam->edge_count && i < NT_SEAM_EDGES; i++) {
		nt_member_next(out, NT_SAME_LINE);
		put_edge(out, report, &seam->edges[i]);
	}
	nt_buffer_text(out, "]}");
}

static void put_slots(nt_buffer *out, unsigned slots)
{
	static const char *const names[3] = {"normal", "clearcoat_normal", "anisotropy"};
	nt_member_open(out, "slots", "[");
	for (unsigned i = 0; i < 3; i++) {
		if (slots >> i & 1u) {
			nt_member_next(out, NT_SAME_LINE);
			nt_buffer_format(out, "\"%s\"", names[i]);
		}
	}
	nt_buffer_text(out, "]");
}

static void put_maker(nt_buffer *out, const nt_maker *maker)
{
	static const char *const methods[] = {"mikktspace", "area", "lengyel", "robust", "mikktspace-sorted"};
	if (maker->agreement < 0.0)
		return;
	nt_member_open(out, "made_by", "{");
	nt_member_next(out, NT_SAME_LINE);
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
	nt_member_key(out, NT_SAME_LINE, "split_cost");
	if (mesh->vertex_bytes)
		nt_buffer_format(out, "{\"vertices\":%zu,\"bytes_each\":%zu,\"bytes\":%zu}", added, mesh->vertex_bytes,
			added * mesh->vertex_bytes);
	else
		nt_buffer_text(out, "null");
	nt_member_key(out, NT_SAME_LINE, "texture_size");
	if (mesh->texture_size[0])
		nt_buffer_format(out, "[%u,%u]", mesh->texture_size[0], mesh->texture_size[1]);
	else
		nt_buffer_text(out, "null");
}

static void put_counts(nt_buffer *out, const nt_report_mesh *mesh)
{
	nt_member_count(out, "faces", mesh->face_count);
	by_orientation(out, "triangles", mesh->triangles);
	area_shares(out, mesh->areas);
	nt_member_open(out, "vertices", "{");
	nt_member_count(out, "before", mesh->vertices_before);
	nt_member_count(out, "added_normals", mesh->added_normals);
	nt_member_count(out, "added_mirror", mesh->added_mirror);
	nt_member_count(out, "added_direction", mesh->added_direction);
	nt_member_count(out, "after", mesh->vertices_after);
	nt_buffer_text(out, "}");
	put_costs(out, mesh);
	nt_member_open(out, "edges", "{");
	nt_member_count(out, "all", mesh->edge_count);
	nt_member_count(out, "boundary", mesh->boundary_edges);
	nt_member_count(out, "boundary_loops", mesh->boundary_loops);
	nt_member_count(out, "boundary_chains", mesh->boundary_chains);
	nt_member_count(out, "non_manifold", mesh->non_manifold_edges);
	nt_member_count(out, "inconsistent_winding", mesh->inconsistent_edges);
	nt_member_count(out, "uv_cut", mesh->uv_seam_edges);
	nt_member_count(out, "mirror", mesh->seam_edges);
	nt_buffer_text(out, "}");
	nt_member_count(out, "triangles_left_out", mesh->left_out);
	nt_member_open(out, "islands_by_kind", "{");
	for (unsigned kind = 0; kind < 4; kind++)
		nt_member_count(out, nt_island_kind_name((nt_island_kind)kind), mesh->island_kinds[kind]);
	nt_buffer_text(out, "}");
	nt_member_count(out, "seam_count", mesh->seam_count);
	nt_member_float(out, "seam_length", mesh->seam_length);
}

static void put_mesh(nt_buffer *out, const nt_report *report, const nt_report_mesh *mesh)
{
	nt_buffer_text(out, "{");
	nt_member_text(out, "name", mesh->name);
	put_place(out, "place", report, &mesh->place);
	nt_member_index(out, "gltf_mesh", mesh->gltf_mesh);
	nt_member_index(out, "gltf_primitive", mesh->gltf_primitive);
	nt_member_index(out, "same_as", mesh->same_as);
	nt_member_text(out, "why", mesh->why);
	put_slots(out, mesh->slots);
	nt_member_count(out, "texcoord_set", mesh->texcoord_set);
	nt_member_bool(out, "has_normals", mesh->has_normals);
	nt_member_bool(out, "has_texcoords", mesh->has_texcoords);
	nt_member_bool(out, "has_tangents", mesh->checked_tangents);
	nt_member_bool(out, "analysed", mesh->analysed);
	put_counts(out, mesh);
	nt_member_float(out, "worst_orthogonality_degrees", mesh->worst_orthogonality);
	nt_member_doubles(out, "relative_determinant", mesh->relative_determinant, 3);
	put_maker(out, &mesh->maker);
	nt_member_histogram(out, "direction_histogram", mesh->angle_histogram);
	nt_member_count(out, "instances", mesh->instance_count);
	nt_member_count(out, "negative_instances", mesh->negative_instances);
	nt_member_key(out, NT_SAME_LINE, "box");
	nt_json_box(&mesh->box, report->origin, out);
	nt_member_bool(out, "islands_truncated", mesh->island_count > SHOWN_ISLANDS);
	nt_member_open(out, "islands", "[");
	for (size_t i = 0; mesh->islands && i < mesh->island_count && i < SHOWN_ISLANDS; i++) {
		nt_member_next(out, 4);
		put_island(out, &mesh->islands[i]);
	}
	nt_buffer_text(out, "]");
	nt_member_bool(out, "seams_truncated", mesh->seam_count > SHOWN_SEAMS);
	nt_member_open(out, "seams", "[");
	for (size_t i = 0; mesh->seams && i < mesh->seam_count && i < SHOWN_SEAMS; i++) {
		nt_member_next(out, 4);
		put_seam(out, report, &mesh->seams[i]);
	}
	nt_buffer_text(out, "]}");
}

/* ---- findings ---- */

static void put_spot(nt_buffer *out, const nt_report *report, const nt_spot *spot)
{
	nt_buffer_text(out, "{");
	nt_member_index(out, "triangle", spot->triangle);
	nt_member_index(out, "face", spot->face);
	nt_member_key(out, NT_SAME_LINE, "line");
	nt_buffer_format(out, spot->line ? "%zu" : "null", spot->line);
	nt_member_text(out, "source", spot->source);
	nt_member_float(out, "value", spot->value);
	nt_member_open(out, "vertices", "[");
	for (unsigned k = 0; k < spot->corner_count; k++) {
		nt_member_next(out, NT_SAME_LINE);
		nt_buffer_format(out, "%u", spot->vertices[k]);
	}
	nt_buffer_text(out, "]");
	nt_member_key(out, NT_SAME_LINE, "positions");
	nt_json_positions(spot->positions[0], spot->corner_count, report->origin, out);
	nt_member_key(out, NT_SAME_LINE, "texcoords");
	nt_json_rows(spot->texcoords[0], spot->has_texcoords ? spot->corner_count : 0, 2, out);
	nt_buffer_text(out, "}");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_member_next(out, 4);
	nt_buffer_text(out, "{");
	nt_member_text(out, "code", nt_code_info(finding->code)->name);
	nt_member_text(out, "severity", nt_severity_name(finding->severity));
	nt_member_text(out, "message", finding->message);
	nt_member_repair(out, report, finding);
	nt_member_count(out, "count", finding->count);
	nt_member_count(out, "alike", finding->alike);
	nt_member_digest(out, "fingerprint", finding->fingerprint);
	nt_member_digest(out, "geometry", finding->geometry);
	nt_member_bool(out, "known", finding->known);
	nt_member_index(out, "mesh", finding->mesh);
	nt_member_index(out, "seam", finding->code == NT_CODE_UV_HARD_EDGE ? NT_NONE : finding->seam);
	nt_member_index(out, "island", finding->island);
	put_place(out, "place", report, &finding->place);
	nt_member_key(out, NT_SAME_LINE, "box");
	nt_json_box(&finding->box, report->origin, out);
	nt_member_open(out, "numbers", "{");
	for (unsigned i = 0; i < finding->number_count; i++)
		nt_member_float(out, finding->numbers[i].name, finding->numbers[i].value);
	nt_buffer_text(out, "}");
	nt_member_open(out, "spots", "[");
	for (unsigned i = 0; i < finding->spot_count; i++) {
		nt_member_next(out, 5);
		put_spot(out, report, &finding->spots[i]);
	}
	nt_buffer_text(out, "]");
	nt_member_votes(out, finding);
	nt_buffer_text(out, "}");
}

static void put_failure(nt_buffer *out, const nt_report *report)
{
	nt_member_key(out, 3, "failure");
	if (!report->failure) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_text(out, "{");
	nt_member_text(out, "message", report->failure);
	put_place(out, "place", report, &report->failure_place);
	nt_buffer_text(out, "}");
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_member_next(out, 2);
	const nt_report_list one = {.items = &report, .count = 1};
	const nt_totals totals = nt_report_totals(&one);
	nt_buffer_text(out, "{");
	nt_member_key(out, 3, "file");
	nt_json_string(report->shown, out);
	nt_member_key(out, 3, "format");
	nt_buffer_format(out, "\"%s\"", nt_input_format_name(report->format));
	nt_member_key(out, 3, "verdict");
	nt_put_verdict(report, nt_json_string, out);
	nt_member_text(out, "conversion", report->conversion);
	put_failure(out, report);
	if (report->origin_text) {
		nt_member_key(out, 3, "origin");
		nt_buffer_format(out, "[%s]", report->origin_text);
	}
	put_totals(out, 3, &totals);
	nt_member_key(out, 3, "meshes");
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < report->mesh_count; i++) {
		nt_member_next(out, 4);
		put_mesh(out, report, &report->meshes[i]);
		nt_list_flush(w->reports, NT_FLUSHED_BYTES, out);
	}
	nt_buffer_text(out, "]");
	nt_member_key(out, 3, "findings");
	nt_buffer_text(out, "[");
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]\n\t\t}");
}

static void begin(nt_walk *w, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(w->reports);
	nt_buffer_text(out, "{");
	nt_member_key(out, 1, "report");
	nt_buffer_text(out, "\"nmtan\"");
	nt_member_key(out, 1, "report_version");
	nt_buffer_text(out, "2");
	nt_member_key(out, 1, "generator");
	nt_buffer_format(out, "\"nmtan %s\"", NMTAN_VERSION_STRING);
	put_totals(out, 1, &totals);
	nt_member_key(out, 1, "files");
	nt_buffer_text(out, "[");
}

static void end(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]\n}\n");
}

const nt_report_writer nt_json_writer = {.known = true, .begin = begin, .begin_file = begin_file,
	.put_finding = put_finding, .end_file = end_file, .end = end};
