/* SPDX-License-Identifier: MIT */
#include "report/report.h"
#include "scene/scene.h"
#include "test.h"

/* How a mesh differs from a reachable one of triangles with everything a solve takes. */
enum { UNLIT = 1, HIDDEN = 2, LINES = 4, EMPTY = 8, BARE = 16, NO_NORMALS = 32, TANGENTS = 64, CONFLICT = 128,
	MADE_NORMALS = 256, UNREADABLE = 512 | 64, ASKED = 1024 | 16, ALL_MISSING = 2048, ALL_MADE = 4096,
	PACKED = 8192, NO_POSITIONS = 16384, OTHERS = 32768, MENDED = 65536, REMADE = 131072 };

typedef struct row {
	unsigned slots, but;
	nt_format format;
	nt_only only;
	nt_existing existing;
	nt_decision expected;
	const char *findings;
} row;

static void decide(const row *r)
{
	nt_mesh meshes[2] = {{.name = "", .slots = r->slots, .triangles = !(r->but & LINES),
		.reachable = !(r->but & HIDDEN),
		.has_positions = !(r->but & NO_POSITIONS), .compressed = r->but & PACKED,
		.fix = r->but & MENDED ? NT_EXISTING_REPAIR : r->but & REMADE ? NT_EXISTING_REPLACE : 0,
		.has_normals = !(r->but & NO_NORMALS), .has_texcoords = !(r->but & BARE),
		.has_tangents = r->but & TANGENTS, .tangents_fault = r->but & (UNREADABLE & ~TANGENTS) ? "" : NULL,
		.asked_set = r->but & (ASKED & ~BARE) ? "" : NULL,
		.unlit = r->but & UNLIT, .face_count = !(r->but & EMPTY),
		.texcoord_conflict = r->but & CONFLICT, .texcoord_other_set = r->but & CONFLICT ? 1 : 0},
		{.name = "", .triangles = true, .face_count = 1, .has_texcoords = true, .has_normals = true}};
	nt_scene scene;
	nt_scene_init(&scene, "test");
	scene.format = r->format;
	scene.judged = r->but & OTHERS ? NT_FORMAT_GLTF : r->format;
	scene.meshes = meshes;
	scene.mesh_count = r->but & OTHERS ? 2 : 1;
	nt_select(&scene, r->only, r->existing, r->but & ALL_MADE ? NT_MAKING_ALL
		: r->but & ALL_MISSING ? NT_MAKING_ALL_MISSING
		: r->but & MADE_NORMALS ? NT_MAKING_MISSING : NT_MAKING_NONE);
	char findings[100] = "";
	for (size_t i = 0; i < scene.findings.count; i++) {
		const nt_finding *found = &scene.findings.items[i];
		strcat(strcat(findings, i ? " " : ""), nt_severity_name(nt_finding_severity(found)));
		strcat(strcat(findings, " "), nt_code_info(found->code)->name);
	}
	nt_finding_list_free(&scene.findings);
	if (meshes[0].decision != r->expected || strcmp(findings, r->findings) != 0)
		fail_msg("slots %u, but %u: %s; %s", r->slots, r->but, nt_decision_text(meshes[0].decision), findings);
}

#define N    NT_SLOT_NORMAL
#define GLTF NT_FORMAT_GLTF
#define AUTO NT_ONLY_AUTO
#define KEEP NT_EXISTING_KEEP

TEST(decisions_are_those_of_the_table)
{
	static const row rows[] = {
		/* glTF needs a slot */
		{N, 0, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{NT_SLOT_CLEARCOAT_NORMAL, 0, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{NT_SLOT_ANISOTROPY, 0, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{0, 0, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, 0, GLTF, NT_ONLY_ALL, KEEP, NT_DECISION_SOLVE, ""},
		{0, UNLIT, GLTF, NT_ONLY_NEEDED, KEEP, NT_SKIP_UNLIT, ""},
		{N, HIDDEN, GLTF, AUTO, KEEP, NT_SKIP_UNREACHABLE, ""},
		{N, LINES, GLTF, NT_ONLY_ALL, KEEP, NT_SKIP_NOT_TRIANGLES, ""},
		{N, EMPTY, GLTF, NT_ONLY_ALL, KEEP, NT_SKIP_EMPTY, ""},
		/* OBJ and PLY get tangents wherever there are texture coordinates */
		{0, 0, NT_FORMAT_OBJ, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{0, 0, NT_FORMAT_PLY, NT_ONLY_NEEDED, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, BARE, NT_FORMAT_PLY, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS, "info TAN_NO_UV"},
		{N, BARE, NT_FORMAT_OBJ, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS, "warning TAN_NO_UV"},
		{0, BARE, NT_FORMAT_PLY, NT_ONLY_NEEDED, KEEP, NT_SKIP_NO_SLOT, ""},
		/* existing tangents are kept, repaired or replaced; not lost where they cannot be computed anew */
		{N, TANGENTS, GLTF, AUTO, KEEP, NT_SKIP_HAS_TANGENTS, ""},
		{N, TANGENTS, GLTF, AUTO, NT_EXISTING_REPAIR, NT_DECISION_REPAIR, ""},
		{N, TANGENTS, GLTF, AUTO, NT_EXISTING_REPLACE, NT_DECISION_SOLVE, ""},
		{N, TANGENTS | BARE, GLTF, AUTO, KEEP, NT_SKIP_HAS_TANGENTS, ""},
		{N, TANGENTS | BARE, GLTF, AUTO, NT_EXISTING_REPAIR, NT_DECISION_REPAIR, ""},
		{N, TANGENTS | BARE, GLTF, AUTO, NT_EXISTING_REPLACE, NT_DECISION_REPAIR, ""},
		/* without normals a client ignores tangents */
		{N, TANGENTS | NO_NORMALS, GLTF, AUTO, KEEP, NT_SKIP_NO_NORMALS, "warning TAN_NO_NORMAL"},
		{N, TANGENTS | NO_NORMALS | MADE_NORMALS, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{N, TANGENTS | NO_NORMALS | MADE_NORMALS, GLTF, AUTO, NT_EXISTING_REPAIR, NT_DECISION_SOLVE, ""},
		{N, TANGENTS | NO_NORMALS | BARE, GLTF, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS,
			"error TAN_NO_UV warning TAN_NO_NORMAL"},
		/* what cannot be read is told unless it is replaced */
		{N, UNREADABLE, GLTF, AUTO, KEEP, NT_SKIP_HAS_TANGENTS, "error TAN_ACCESSOR"},
		{N, UNREADABLE, GLTF, AUTO, NT_EXISTING_REPAIR, NT_DECISION_SOLVE, ""},
		{N, UNREADABLE, GLTF, AUTO, NT_EXISTING_REPLACE, NT_DECISION_SOLVE, ""},
		{0, UNREADABLE, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, "error TAN_ACCESSOR"},
		{N, UNREADABLE | BARE, GLTF, AUTO, NT_EXISTING_REPLACE, NT_SKIP_NO_TEXCOORDS,
			"error TAN_NO_UV error TAN_ACCESSOR"},
		/* what is needed and lacks is a finding; what is not needed is not worth a word */
		{N, NO_NORMALS, GLTF, AUTO, KEEP, NT_SKIP_NO_NORMALS, "warning TAN_NO_NORMAL"},
		{N, NO_NORMALS | MADE_NORMALS, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{N, NO_NORMALS | BARE, GLTF, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS,
			"error TAN_NO_UV warning TAN_NO_NORMAL"},
		{0, NO_NORMALS | BARE, GLTF, NT_ONLY_ALL, KEEP, NT_SKIP_NO_TEXCOORDS, ""},
		/* without the set that the user asks for nothing is made or mended */
		{N, ASKED, GLTF, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS, "error TAN_NO_UV"},
		{0, ASKED, GLTF, NT_ONLY_ALL, KEEP, NT_SKIP_NO_TEXCOORDS, "warning TAN_NO_UV"},
		{0, ASKED, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{N, ASKED | TANGENTS, GLTF, AUTO, KEEP, NT_SKIP_HAS_TANGENTS, "warning TAN_NO_UV"},
		{N, ASKED | TANGENTS, GLTF, AUTO, NT_EXISTING_REPAIR, NT_SKIP_NO_TEXCOORDS, "warning TAN_NO_UV"},
		{N, ASKED | TANGENTS, GLTF, AUTO, NT_EXISTING_REPLACE, NT_SKIP_NO_TEXCOORDS, "warning TAN_NO_UV"},
		/* tangents that no material uses may go, of meshes without faces, too */
		{0, TANGENTS, GLTF, AUTO, NT_EXISTING_DROP, NT_SKIP_DROPPED, ""},
		{0, TANGENTS | EMPTY, GLTF, AUTO, NT_EXISTING_DROP, NT_SKIP_DROPPED, ""},
		{0, 0, GLTF, AUTO, NT_EXISTING_DROP, NT_SKIP_NO_SLOT, ""},
		{N, TANGENTS, GLTF, AUTO, NT_EXISTING_DROP, NT_SKIP_HAS_TANGENTS, ""},
		{N, 0, GLTF, AUTO, NT_EXISTING_DROP, NT_DECISION_SOLVE, ""},
		/* normals are made of what gets no tangents, if that is asked of a glTF; tangents follow them */
		{0, NO_NORMALS | MADE_NORMALS, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, NO_NORMALS | ALL_MISSING, GLTF, AUTO, KEEP, NT_DECISION_NORMALS, ""},
		{0, UNLIT | NO_NORMALS | ALL_MISSING, GLTF, AUTO, KEEP, NT_DECISION_NORMALS, ""},
		{N, BARE | NO_NORMALS | ALL_MISSING, GLTF, AUTO, KEEP, NT_DECISION_NORMALS, "error TAN_NO_UV"},
		{0, ALL_MISSING, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, ALL_MADE, GLTF, AUTO, KEEP, NT_DECISION_NORMALS, ""},
		{0, TANGENTS | ALL_MADE, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{0, TANGENTS | BARE | ALL_MADE, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, NO_NORMALS | ALL_MISSING | PACKED, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, NO_NORMALS | ALL_MISSING | NO_POSITIONS, GLTF, AUTO, KEEP, NT_SKIP_NO_SLOT, ""},
		{0, NO_NORMALS | ALL_MISSING, NT_FORMAT_PLY, NT_ONLY_NEEDED, KEEP, NT_SKIP_NO_SLOT, ""},
		{N, HIDDEN | NO_NORMALS | ALL_MISSING, GLTF, AUTO, KEEP, NT_SKIP_UNREACHABLE, ""},
		/* --fix says of each mesh what is done with its tangents */
		{0, TANGENTS | REMADE, GLTF, AUTO, KEEP, NT_DECISION_SOLVE, ""},
		{0, HIDDEN | TANGENTS | MENDED, GLTF, AUTO, KEEP, NT_DECISION_REPAIR, ""},
		/* if others have coordinates, a mesh may lack them by mistake; a glTF that needs none does not */
		{0, BARE | OTHERS, NT_FORMAT_PLY, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS, "info UV_MISSING"},
		{N, BARE | OTHERS, NT_FORMAT_OBJ, AUTO, KEEP, NT_SKIP_NO_TEXCOORDS, "warning TAN_NO_UV"},
		{0, BARE | OTHERS, GLTF, NT_ONLY_ALL, KEEP, NT_SKIP_NO_TEXCOORDS, ""},
		/* slots that want different sets are told */
		{N | NT_SLOT_ANISOTROPY, CONFLICT, NT_FORMAT_GLB, AUTO, KEEP, NT_DECISION_SOLVE,
			"warning TAN_UVSET_CONFLICT"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		decide(&rows[i]);
}

TEST(every_decision_has_its_words)
{
	for (int i = 0; i < NT_DECISION_COUNT; i++)
		assert_string_not_equal(nt_decision_text((nt_decision)i), "unknown");
	assert_string_equal(nt_decision_text(NT_DECISION_COUNT), "unknown");
}
