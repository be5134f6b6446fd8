/* SPDX-License-Identifier: MIT */
/*
 * The report as JSON: everything that was found, for programs. data/nmtan-report.schema.json describes it.
 * Objects of the same kind always have the same members; what is unknown is null or an empty array.
 * Each mesh, island, seam and finding is on a line of its own, so that two reports can be compared by
 * diff.
 */
#include <math.h>
#include "report/render/inside.h"

enum { SHOWN_SEAMS = 1000, SHOWN_ISLANDS = 1000 };

static void put_place(nt_buffer *out, const char *name, const nt_report *report, const nt_place_view *place)
{
	nt_buffer file = {0};
	if (place->file[0])
		nt_report_show_path(report, place->file, &file);
	nt_put(out, NT_JSON, ",'%-s':{'file':%s,'line':%.0zu,'offset':%" PRIu64 ",'pointer':%s,'object':%s}", name,
		file.data, place->line, place->offset, place->pointer[0] ? place->pointer : NULL,
		place->object[0] ? place->object : NULL);
	nt_buffer_free_into(&file, out);
}

/* tabs: how far members are indented. */
static void put_totals(nt_buffer *out, const char *tabs, const nt_totals *totals)
{
	nt_put(out, NT_JSON, ",\n%-s'totals':{'errors':%zu,'warnings':%zu,'infos':%zu,'known':%zu,'dropped':%zu},\n"
		"%-s'truncated':%hhd", tabs, totals->by_severity[NT_SEVERITY_ERROR],
		totals->by_severity[NT_SEVERITY_WARNING], totals->by_severity[NT_SEVERITY_INFO],
		nt_known_count(totals), totals->dropped, tabs, (bool)totals->dropped);
}

/* ---- meshes ---- */

static void by_orientation(nt_buffer *out, const size_t counts[3])
{
	nt_put(out, NT_JSON, ",'triangles':{'normal':%zu,'mirrored':%zu,'degenerate':%zu}", counts[2], counts[0],
		counts[1]);
}

/* Median and worst; null where nothing was measured. */
static void put_measure(nt_buffer *out, const char *name, const double values[2])
{
	if (isnan(values[0]))
		nt_put(out, NT_JSON, ",'%-s':null", name);
	else
		nt_put(out, NT_JSON, ",'%-s':{'median':%g,'worst':%g}", name, values[0], values[1]);
}

static void put_box(nt_buffer *out, const nt_report *report, const nt_box *box)
{
	const float *low = box->minimum, *high = box->maximum;
	nt_buffer_text(out, low[0] <= high[0] ? ",\"box\":" : ",\"box\":null");
	if (low[0] <= high[0])
		nt_put_rows((const float[]){low[0], low[1], low[2], high[0], high[1], high[2]}, 2, 3, report->origin,
			out);
}

static void put_island(nt_buffer *out, const nt_island *island)
{
	nt_put(out, NT_JSON, ",\n\t\t\t\t{'kind':%s", nt_island_kind_name(island->kind));
	by_orientation(out, island->triangles);
	nt_put(out, NT_JSON, ",'area':%g,'covered_share':%g,'twin':%hhd", island->area, island->covered,
		island->overlaps_itself);
	put_measure(out, "texel_density", island->texel_density);
	put_measure(out, "stretch", island->stretch);
	nt_put(out, NT_JSON, ",'uv_box':[[%g,%g],[%g,%g]]}", (double)island->minimum[0], (double)island->minimum[1],
		(double)island->maximum[0], (double)island->maximum[1]);
}

static void put_edge(nt_buffer *out, const nt_report *report, const nt_seam_edge *edge)
{
	const uint32_t *a = edge->vertices[0], *b = edge->vertices[1], *c = edge->output[0], *d = edge->output[1];
	nt_put(out, NT_JSON, ",{'triangles':[%u,%u],'vertices':[[%u,%u],[%u,%u]],"
		"'output_vertices':[[%u,%u],[%u,%u]],'positions':", edge->triangles[0], edge->triangles[1],
		a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]);
	nt_put_rows(edge->positions[0], 2, 3, report->origin, out);
	nt_buffer_text(out, ",\"texcoords\":[");
	nt_put_rows(edge->texcoords[0][0], 2, 2, NULL, out);
	nt_buffer_text(out, ",");
	nt_put_rows(edge->texcoords[1][0], 2, 2, NULL, out);
	nt_put(out, NT_JSON, "],'dihedral_degrees':%g,'tangent_angle_degrees':%g}", (double)edge->dihedral,
		(double)edge->tangent_angle);
}

static void put_seam(nt_buffer *out, const nt_report *report, const nt_seam *seam)
{
	nt_put(out, NT_JSON, ",\n\t\t\t\t{'closed':%hhd,'edge_count':%zu,'length':%g,'dihedral_degrees':[%g,%g],"
		"'tangent_angle_degrees':[%g,%g],'islands':{'normal':%u,'mirrored':%u},'edges_sharing_vertices':%zu,"
		"'frame_angle_degrees':[%g,%g],'edges_sharing_texels':%zu,'unhidden_edges':%zu,"
		"'non_manifold_edges':%zu", seam->closed, seam->edge_count, seam->length, seam->dihedral[0],
		seam->dihedral[1], seam->tangent_angle[0], seam->tangent_angle[1], seam->islands[0], seam->islands[1],
		seam->shared_count, seam->frame_angle[0], seam->frame_angle[1], seam->same_texel_count,
		seam->unhidden_count, seam->non_manifold_count);
	if (seam->has_plane)
		nt_put(out, NT_JSON, ",'plane':{'text':%s,'normal':[%g,%g,%g],'distance':%g}", seam->plane_text,
			seam->plane[0], seam->plane[1], seam->plane[2], seam->plane[3]);
	else
		nt_buffer_text(out, ",\"plane\":null");
	put_box(out, report, &seam->box);
	nt_put(out, NT_JSON, ",'edges_truncated':%hhd,'edges':[",
		(bool)(seam->edge_count > NT_SEAM_EDGES));
	for (size_t i = 0; i < seam->edge_count && i < NT_SEAM_EDGES; i++)
		put_edge(out, report, &seam->edges[i]);
	nt_buffer_text(out, "]}");
}

static void put_slots(nt_buffer *out, unsigned slots)
{
	static const char *const names[3] = {"normal", "clearcoat_normal", "anisotropy"};
	nt_buffer_text(out, ",\"slots\":[");
	for (unsigned i = 0; i < 3; i++)
		if (slots >> i & 1u)
			nt_put(out, NT_JSON, ",%s", names[i]);
	nt_buffer_text(out, "]");
}

static void put_maker(nt_buffer *out, const nt_maker *maker)
{
	static const char *const methods[] = {"mikktspace", "area", "lengyel", "robust", "mikktspace-sorted"};
	if (maker->agreement >= 0.0)
		nt_put(out, NT_JSON, ",'made_by':{'method':%s,'faces':%s,'across':%s,'transform':%s,'w':%s,"
			"'agreement':%.6g,'within_degrees':%.6g}", maker->known ? methods[maker->method] : "unknown",
			maker->quads ? "quads" : "triangles", maker->across ? "mesh" : "primitive",
			maker->untransformed ? "keep" : "bake", maker->inverted ? "inverted" : "right",
			maker->agreement, maker->degrees);
}

static void put_counts(nt_buffer *out, const nt_report_mesh *mesh)
{
	const double *areas = mesh->areas, total = areas[0] + areas[1] + areas[2];
	const double scale = total > 0.0 ? 1.0 / total : 0.0;
	const size_t *kinds = mesh->island_kinds;
	nt_put(out, NT_JSON, ",'faces':%zu", mesh->face_count);
	by_orientation(out, mesh->triangles);
	nt_put(out, NT_JSON, ",'area_share':{'normal':%g,'mirrored':%g,'degenerate':%g},'vertices':{'before':%zu,"
		"'added_normals':%zu,'added_mirror':%zu,'added_direction':%zu,'after':%zu}", areas[2] * scale,
		areas[0] * scale, areas[1] * scale, mesh->vertices_before, mesh->added_normals, mesh->added_mirror,
		mesh->added_direction, mesh->vertices_after);
	/* the cost of splitting, and the texture that density is measured by */
	nt_buffer_text(out, ",\"split_cost\":");
	if (mesh->vertex_bytes)
		nt_put(out, NT_JSON, "{'vertices':%zu,'bytes_each':%zu,'bytes':%zu}", mesh->split_vertices,
			mesh->vertex_bytes, mesh->split_vertices * mesh->vertex_bytes);
	else
		nt_buffer_text(out, "null");
	nt_buffer_text(out, ",\"texture_size\":");
	if (mesh->texture_size[0])
		nt_put(out, NT_JSON, "[%u,%u]", mesh->texture_size[0], mesh->texture_size[1]);
	else
		nt_buffer_text(out, "null");
	nt_put(out, NT_JSON, ",'edges':{'all':%zu,'boundary':%zu,'boundary_loops':%zu,'boundary_chains':%zu,"
		"'non_manifold':%zu,'inconsistent_winding':%zu,'uv_cut':%zu,'mirror':%zu},'triangles_left_out':%zu,"
		"'islands_by_kind':{'normal':%zu,'mirrored':%zu,'mixed':%zu,'degenerate':%zu},'seam_count':%zu,"
		"'seam_length':%g", mesh->edge_count, mesh->boundary_edges, mesh->boundary_loops, mesh->boundary_chains,
		mesh->non_manifold_edges, mesh->inconsistent_edges, mesh->uv_seam_edges, mesh->seam_edges,
		mesh->left_out, kinds[0], kinds[1], kinds[2], kinds[3], mesh->seam_count, mesh->seam_length);
}

static void put_mesh(nt_buffer *out, const nt_report *report, const nt_report_mesh *mesh)
{
	nt_put(out, NT_JSON, ",\n\t\t\t\t{'name':%s", mesh->name);
	put_place(out, "place", report, &mesh->place);
	nt_put(out, NT_JSON, ",'gltf_mesh':%u,'gltf_primitive':%u,'same_as':%u,'why':%s", mesh->gltf_mesh,
		mesh->gltf_primitive, mesh->same_as, mesh->why);
	put_slots(out, mesh->slots);
	nt_put(out, NT_JSON, ",'texcoord_set':%zu,'has_normals':%hhd,'has_texcoords':%hhd,'has_tangents':%hhd,"
		"'analysed':%hhd", (size_t)mesh->texcoord_set, mesh->has_normals, mesh->has_texcoords,
		mesh->checked_tangents, mesh->analysed);
	put_counts(out, mesh);
	nt_put(out, NT_JSON, ",'worst_orthogonality_degrees':%g,'relative_determinant':[%g,%g,%g]",
		mesh->worst_orthogonality, mesh->relative_determinant[0], mesh->relative_determinant[1],
		mesh->relative_determinant[2]);
	put_maker(out, &mesh->maker);
	nt_put_histogram("direction_histogram", mesh->angle_histogram, out);
	nt_put(out, NT_JSON, ",'instances':%zu,'negative_instances':%zu", mesh->instance_count,
		mesh->negative_instances);
	put_box(out, report, &mesh->box);
	nt_put(out, NT_JSON, ",'islands_truncated':%hhd,'islands':[",
		(bool)(mesh->island_count > SHOWN_ISLANDS));
	for (size_t i = 0; mesh->islands && i < mesh->island_count && i < SHOWN_ISLANDS; i++)
		put_island(out, &mesh->islands[i]);
	nt_put(out, NT_JSON, "],'seams_truncated':%hhd,'seams':[",
		(bool)(mesh->seam_count > SHOWN_SEAMS));
	for (size_t i = 0; mesh->seams && i < mesh->seam_count && i < SHOWN_SEAMS; i++)
		put_seam(out, report, &mesh->seams[i]);
	nt_buffer_text(out, "]}");
}

/* ---- findings ---- */

static void put_spot(nt_buffer *out, const nt_report *report, const nt_spot *spot)
{
	nt_put(out, NT_JSON, ",\n\t\t\t\t\t{'triangle':%u,'face':%u,'line':%.0zu,'source':%s,'value':%g,'vertices':[",
		spot->triangle, spot->face, spot->line, spot->source, spot->value);
	for (unsigned k = 0; k < spot->corner_count; k++)
		nt_buffer_format(out, k ? ",%u" : "%u", spot->vertices[k]);
	nt_buffer_text(out, "],\"positions\":");
	nt_put_rows(spot->positions[0], spot->corner_count, 3, report->origin, out);
	nt_buffer_text(out, ",\"texcoords\":");
	nt_put_rows(spot->texcoords[0], spot->has_texcoords ? spot->corner_count : 0, 2, NULL, out);
	nt_buffer_text(out, "}");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_put(out, NT_JSON, ",\n\t\t\t\t{'code':%s,'severity':%s,'message':%s", nt_finding_name(finding),
		nt_severity_name(finding->severity), finding->message);
	nt_put_repair(report, finding, NT_JSON, out);
	nt_put(out, NT_JSON, ",'count':%zu,'alike':%zu,'fingerprint':%" PRIx64 ",'geometry':%" PRIx64 ",'known':%hhd,"
		"'mesh':%u,'seam':%u,'island':%u", finding->count, finding->alike, finding->fingerprint,
		finding->geometry, finding->known, finding->mesh,
		finding->code == NT_CODE_UV_HARD_EDGE ? NT_NONE : finding->seam, finding->island);
	put_place(out, "place", report, &finding->place);
	put_box(out, report, &finding->box);
	nt_buffer_text(out, ",\"numbers\":{");
	for (unsigned i = 0; i < finding->number_count; i++)
		nt_put(out, NT_JSON, ",'%-s':%g", finding->numbers[i].name, finding->numbers[i].value);
	nt_buffer_text(out, "},\"spots\":[");
	for (unsigned i = 0; i < finding->spot_count; i++)
		put_spot(out, report, &finding->spots[i]);
	nt_buffer_text(out, "]");
	nt_put_votes(finding, out);
	nt_buffer_text(out, "}");
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	static const char *const formats[] = {"unknown", "obj", "ply", "gltf", "glb", "drc"};
	const nt_report *report = w->report;
	const nt_totals totals = nt_report_totals(&report, 1);
	nt_put(out, NT_JSON, ",\n\t\t{\n\t\t\t'file':%s,\n\t\t\t'format':%s,\n\t\t\t'verdict':%p,'conversion':%s,\n"
		"\t\t\t'failure':", report->shown, formats[report->format], nt_verdict(report), report->conversion);
	if (report->failure) {
		nt_put(out, NT_JSON, "{'message':%s", report->failure);
		put_place(out, "place", report, &report->failure_place);
	}
	nt_buffer_text(out, report->failure ? "}" : "null");
	if (report->origin_text)
		nt_put(out, NT_JSON, ",\n\t\t\t'origin':[%-s]", report->origin_text);
	put_totals(out, "\t\t\t", &totals);
	nt_buffer_text(out, ",\n\t\t\t\"meshes\":[");
	for (size_t i = 0; i < report->mesh_count; i++) {
		put_mesh(out, report, &report->meshes[i]);
		nt_walk_flush(w, NT_FLUSHED_BYTES, out);
	}
	nt_buffer_text(out, "],\n\t\t\t\"findings\":[");
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]\n\t\t}");
}

static void begin(nt_walk *w, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(w->items, w->count);
	nt_put(out, NT_JSON, "{\n\t'report':'nmtan',\n\t'report_version':2,\n\t'generator':'nmtan %-s'",
		NMTAN_VERSION_STRING);
	put_totals(out, "\t", &totals);
	nt_buffer_text(out, ",\n\t\"files\":[");
}

static void end(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]\n}\n");
}

const nt_report_writer nt_json_writer = {.known = true, .begin = begin, .begin_file = begin_file,
	.put_finding = put_finding, .end_file = end_file, .end = end};
