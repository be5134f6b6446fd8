/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "report/codes.h"

TEST(every_code_has_a_complete_row_and_is_found_by_its_name)
{
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		assert_non_null(row->name);
		assert_true(row->message && row->meaning && row->remedy && row->example);
		/* somebody sees it, with the severity of the table or a higher one */
		const char *severities = "-iwe", *worst = severities;
		assert_int_equal(strlen(row->profiles), 3);
		for (int profile = 0; profile < 3; profile++) {
			const char *letter = strchr(severities, row->profiles[profile]);
			assert_non_null(letter);
			worst = letter > worst ? letter : worst;
		}
		assert_true(worst - severities >= 1 + (int)row->severity);
		for (int k = 0; k < (int)i; k++)
			assert_string_not_equal(nt_code_info((nt_code)k)->name, row->name);
	}
}

/* A remedy that is neither nothing nor another export says where that is in a program. */
TEST(remedies_of_texture_coordinates_name_a_program)
{
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		if (strncmp(row->name, "UV_", 3) == 0 && strncmp(row->remedy, "Nothing", 7) != 0 &&
			strncmp(row->remedy, "Export", 6) != 0 && !strstr(row->remedy, "Blender: "))
			fail_msg("%s: %s", row->name, row->remedy);
	}
	/* nobody can make tangents without them */
	assert_null(strstr(nt_code_info(NT_CODE_TAN_NO_UV)->remedy, "Convert the file with nmtan"));
	assert_null(strstr(nt_code_info(NT_CODE_NMAP_GREEN_DOWN)->remedy, "OBJ"));
}

static void sentence_is(nt_code code, size_t count, const char *detail, const char *expected)
{
	nt_buffer out = {0};
	nt_code_sentence(code, count, detail, &out);
	assert_string_equal(out.data, expected);
	nt_buffer_free(&out);
}

TEST(sentences_count_and_carry_the_detail)
{
	sentence_is(NT_CODE_TAN_ZERO, 1, NULL, "1 tangent has no length");
	sentence_is(NT_CODE_TAN_ZERO, 7, "", "7 tangents have no length");
	sentence_is(NT_CODE_TAN_EXISTING_BAD, 1, NULL, "1 tangent that was kept is invalid");
	sentence_is(NT_CODE_TAN_EXISTING_BAD, 2, NULL, "2 tangents that were kept are invalid");
	sentence_is(NT_CODE_MTL_MISSING, 1, "a.mtl", "material library cannot be read: a.mtl");
}

static void command_is(const char *options, const char *input, const char *output, const char *expected)
{
	nt_buffer out = {0};
	nt_command_text(options, NULL, input, output, &out);
	assert_string_equal(out.data, expected);
	nt_buffer_free(&out);
}

TEST(commands_name_outputs_of_the_format_that_was_asked_for)
{
	static const char *const rows[][4] = { /* given, input, output, command */
		{"--output-format=glb", "k.ply", NULL, "nmtan --fix k.ply k.glb"},
		{"--weld\n--output-format=gltf", "k.glb", NULL, "nmtan --weld --fix k.glb k.gltf"},
		{"--output-format=ply", "k.PLY", NULL, "nmtan --fix k.PLY k-repaired.PLY"},
		{"--output-format=ply", "-", NULL, "nmtan --fix - OUT.ply"},
		{"--output-format=gltf", "in.g", NULL, "nmtan --fix in.g in.gltf"},
		{"", "in.g", NULL, "nmtan --fix in.g in.glb"},
		/* what the name does not say */
		{"--output-format=ply", "k.ply", "-", "nmtan --output-format=ply --fix k.ply -"},
		{"--output-format=glb", "k.ply", "out.bin", "nmtan --output-format=glb --fix k.ply out.bin"},
		{"--output-format=glb", "k.ply", "out.glb", "nmtan --fix k.ply out.glb"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		nt_command_text("--fix", rows[i][0], rows[i][1], rows[i][2], &out);
		assert_string_equal(out.data, rows[i][3]);
		nt_buffer_free(&out);
	}
}

TEST(commands_repeat_what_the_user_gave_but_for_what_they_say_themselves)
{
	static const char *const rows[][3] = { /* options, given, both */
		{"--fix", "--weld\n'--texture-path=a b'", "--weld '--texture-path=a b' --fix"},
		{"--fix", "--existing=keep\n--weld\n--flip-green=on", "--weld --fix"},
		{"--existing=replace", "--fix", "--existing=replace"},
		{"--quads=pairs", "--fix", "--fix --quads=pairs"},
		{"--existing=replace --only=all", "--only=needed\n--uv=1", "--uv=1 --existing=replace --only=all"},
		{"--bump=height", "--bump-height=0.1", "--bump-height=0.1 --bump=height"},
		{"--normals=smooth", "'--normals=angle:30'\n--raw", "--raw --normals=smooth"},
		{"", "--raw", "--raw"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		char expected[200];
		snprintf(expected, sizeof expected, "nmtan %s a.glb b.glb", rows[i][2]);
		nt_command_text(rows[i][0], rows[i][1], "a.glb", "b.glb", &out);
		assert_string_equal(out.data, expected);
		nt_buffer_free(&out);
	}
}

TEST(commands_are_words_of_a_shell)
{
	command_is("--fix", "a/in.glb", NULL, "nmtan --fix a/in.glb a/in-repaired.glb");
	command_is("--fix", "a.b/in.GLTF", "out.glb", "nmtan --fix a.b/in.GLTF out.glb");
	command_is("", "head.obj", NULL, "nmtan head.obj head.glb");
	command_is("--fix", "a.b/in", NULL, "nmtan --fix a.b/in a.b/in.glb");
	command_is("--fix", "-it's.ply", NULL, "nmtan --fix './-it'\\''s.ply' './-it'\\''s-repaired.ply'");
	command_is("--fix", "-", NULL, "nmtan --fix - OUT.glb");
	command_is("--fix", "a\nb.glb", NULL, "nmtan --fix IN OUT");
	command_is("--fix", NULL, NULL, "nmtan --fix IN OUT");
}

TEST(severities_have_names)
{
	nt_severity severity;
	assert_true(nt_severity_find("warning", &severity));
	assert_int_equal(severity, NT_SEVERITY_WARNING);
	assert_false(nt_severity_find("fatal", &severity));
	assert_string_equal(nt_severity_name(NT_SEVERITY_ERROR), "error");
}

/* ---- the manual ---- */

static const char manual_head[] =
	".\\\" SPDX-License-Identifier: MIT\n"
	".\\\" Checked against src/report/codes.c by tests/unit/report/test_codes.c, which writes it anew when\n"
	".\\\" NMTAN_UPDATE is set.\n"
	".TH NMTAN\\-REPORT 5 \"\" \"nmtan %s\" \"File formats\"\n"
	".SH NAME\n"
	"nmtan\\-report \\- what nmtan finds in a mesh, and how reports are written\n"
	".SH DESCRIPTION\n"
	".B nmtan \\-\\-check\n"
	"and\n"
	".B nmtan \\-\\-report\n"
	"report findings. A finding has a code, a severity, a count, the places where it occurs (the first "
	"eight), the\n"
	"numbers behind it, and a fingerprint. Each mirror seam, each folded island and each mirrored\n"
	"one that shares its texels with no other is a finding of its own, up to 1000 of a code in a mesh; those\n"
	"beyond are one finding together. Other\n"
	"occurrences of one kind in a mesh are one finding.\n"
	".PP\n"
	"The fingerprint is made from the code, the name of the mesh and the place in the mesh, in steps of 1/128\n"
	"of the mesh's extent. It stays the same when vertices and triangles get other numbers, which is what\n"
	".B \\-\\-baseline\n"
	"relies on. In JSON,\n"
	".B geometry\n"
	"is made from the code and the positions of the places, or, if a finding has no places, of all\n"
	"triangles of its mesh; it stays the same when meshes get other names or none.\n"
	".PP\n"
	"Numbers count from 0: triangles as they are after triangulation, vertices and faces as they are in "
	"the source.\n"
	"\\(lqMirrored\\(rq means that the texture coordinates of a triangle run clockwise where v points up;\n"
	"the sign is computed exactly. An island is a set of triangles that are connected in UV space: two triangles\n"
	"are connected by an edge if its two ends have the same texture coordinates on both sides. Vertices at "
	"one position\n"
	"count as one point, so that a seam between split vertices is a seam too; front and back of a sheet that is "
	"there twice,\nwith opposite normals, are two.\n"
	".SH FORMATS\n"
	".TP\n.B text\nFor people; in colour on a terminal unless\n.B NO_COLOR\nis set.\n"
	"At most ten findings are shown of a file, as in markdown; the codes of the others are counted, and all other\n"
	"formats have them.\n.B \\-\\-max\\-issues\nsets another number.\n"
	".TP\n.B json\nEverything. The schema is data/nmtan\\-report.schema.json.\n"
	".IP\n.B verdict\nof a file is one sentence, which text, Markdown and HTML have as well.\n"
	"If there is no new error or warning it is \\(lqReady to use\\(rq, \\(lqNothing new: 1 known error\\(rq if a "
	"baseline knows some,\n\\(lqNot shown by \\-\\-min\\-severity: 1 warning\\(rq if that hides some, \\(lqNothing "
	"to judge\\(rq if there are no triangles.\nElse it says what to do and why: \\(lqExport "
	"again\\(rq, \\(lqA file "
	"is missing\\(rq, \\(lqBake again\\(rq, \\(lqConvert with nmtan\\(rq\n"
	"(after a conversion \\(lqRepair with nmtan\\(rq) or \\(lqLook at this\\(rq.\n"
	"Errors count before warnings; of these what is to be exported again comes first, since all else is made from "
	"it.\n"
	".B repair\nof a finding has the command that repairs it; it is null if nmtan cannot. The verdict and the\n"
	"remedy end with it. A command that is right under a condition alone, as that the map was baked with "
	"MikkTSpace, has it in front,\nand the verdict does not join it to one that is always right.\n"
	".IP\n.B made_by\nof a mesh whose tangents are the input's says whose they are: the\n.B method\n"
	"(MikkTSpace as published and sorted, area, lengyel and robust are tried) and the\n.B faces\n"
	"(triangles, or the quads that these are halves of) with which the largest share of the corners,\n"
	".BR agreement ,\nis\n.B within_degrees\nof them; of equals the first.\n"
	"Below 0.99 the method is unknown. The angle is 0.1, and 1 where tangents are stored as bytes.\n"
	".B w\nis inverted where most of the signs are the others.\n"
	"Corners of triangles without area in texture space do not count.\n"
	".B across\nis mesh where those at the border of a primitive disagree and all others agree: "
	"the tangents were made for all primitives of\n"
	"the glTF mesh at once, as Blender does, and its border is left out here and in the check of directions.\n"
	"Text and HTML say the same in a sentence where the method is known.\n"
	".TP\n.B sarif\nSARIF 2.1.0, one result for each finding. In an OBJ a result is at the line of its "
	"first face,\n"
	"in other files at line 1; the JSON pointer of a glTF primitive is its logical location.\n"
	"At most 5000 results; a notification says how many there are more.\n"
	".TP\n.B junit\nJUnit XML, one case for each file. It fails by findings at or above\n"
	".BR \\-\\-fail\\-on ,\n"
	"of which the first is its message; a file that cannot be judged is an error.\n"
	"All other findings are the output of the case.\n"
	".TP\n.B csv\nOne row for each finding.\n"
	".TP\n.B markdown\nTwo tables, for comments on pull requests.\n"
	".TP\n.B html\nOne file that needs no network: findings, islands in the texture and meshes in space, "
	"whole up to three million\ntriangles in one page; above that each mesh is shown around its findings, "
	"and the page says so. If there are several files, the first\npage is a table. The keys j and k go through the "
	"findings, / filters, Escape chooses nothing; #finding-N behind the\naddress leads to a finding, and n and p "
	"go through its places. Below a finding that nmtan can repair is the command, to be copied.\n"
	"Normal maps are in the page, up to 16 MB together, and base colours, up to 16 MB, as JPEGs of at most 1024\n"
	"pixels on the longer side if their files are larger than 64 KB. The page refers to other images (KTX2,\n"
	"and those without room) by a relative path, and reads one when it is chosen. It cannot show an image "
	"if the\nimage or the page was moved, or if both have no folder in common but the root.\n"
	"With\n.BI \\-\\-report= DIR/\neach file has a page of its own, up to three million triangles each, "
	"and index.html is the table; they share the\n"
	"files nmtan\\-NUMBER.js and nmtan\\-NUMBER.css beside them, and need no network either.\n"
	".TP\n.B lines\nOne line for each finding that is new, as compilers print them, for a log:\n"
	"file:line: severity: CODE: text. Remedy.\n"
	"The line is missing if the format has none. A file that cannot be judged has a line without a code.\n"
	".TP\n.B github\nThe same as workflow commands, of which GitHub makes annotations: ::error, ::warning\n"
	"and ::notice with file, line and, as the title, the code. Run it in the top folder of the repository, or say "
	"with\n"
	".B \\-\\-path\\-prefix\nwhere it runs.\n"
	".B \\-\\-min\\-severity=warning\nleaves infos out of both.\n"
	".PP\n"
	"With\n.B \\-\\-baseline\ntext, Markdown, lines and github leave out what is known; "
	"text and Markdown count it. The other formats mark it.\n"
	".PP\n"
	"All are deterministic: they contain no time and no absolute path. Files have names relative to the folder of\n"
	"the run, or else to the one that the inputs have in common;\n"
	".B \\-\\-path\\-prefix\n"
	"puts a folder in front.\n"
	".SH CODES\n"
	"The severity in parentheses is the default;\n"
	".B \\-\\-severity\n"
	"changes it. Facts that nobody would act on have no code: copied vertices, say, are a number of a "
	"mesh in\nJSON.\n"
	".PP\n"
	"Severities follow what is written: what shows only in the light of tangents is an info if no material of the\n"
	"glTF needs them, be it checked itself or the OBJ or Draco file of which it is made. A PLY names no material:\n"
	"there it is a warning. So the check of an input and that of its output agree, but for what only the input\n"
	"has (normals that are missing, polygons, materials and images that are lost) and what rounding to\n"
	".I 1 \\- v\n"
	"moves.\n"
	".PP\n"
	"The columns say the worst severity for three kinds of files: a game prop is a glTF whose materials use\n"
	"tangents, or that is made of an OBJ with a normal map; a scan is a mesh without texture coordinates; "
	"the last column is an OBJ that has\n"
	"them, without materials; a dot means never.\n"
	"Tangents that are made with\n.B \\-\\-raw\nhave findings of the first column.\n"
	".PP\n.nf\n.ft CW\n";

static const char manual_tail[] =
	".SH SEE ALSO\n"
	".BR nmtan (1)\n";

/* Text for troff: backslashes and hyphens escaped, a line per sentence not needed. */
static void put_troff(const char *text, nt_buffer *out)
{
	for (; *text; text++) {
		if (*text == '-')
			nt_buffer_text(out, "\\-");
		else if (*text == '\\')
			nt_buffer_text(out, "\\e");
		else
			nt_buffer_append(out, text, 1);
	}
}

static const char *profile_word(char letter)
{
	for (nt_severity s = NT_SEVERITY_INFO; s <= NT_SEVERITY_ERROR; s++)
		if (*nt_severity_name(s) == letter)
			return nt_severity_name(s);
	assert_int_equal(letter, '-');
	return ".";
}

static void write_manual(nt_buffer *out)
{
	nt_buffer_format(out, manual_head, nmtan_version());
	nt_buffer_text(out, "                             prop     scan     OBJ\n");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		nt_buffer_format(out, "%-28s %-8s %-8s %s\n", row->name, profile_word(row->profiles[0]),
			profile_word(row->profiles[1]), profile_word(row->profiles[2]));
	}
	nt_buffer_text(out, ".ft\n.fi\n");
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = nt_code_info((nt_code)i);
		nt_buffer_format(out, ".SS %s (%s)\n", row->name, nt_severity_name(row->severity));
		put_troff(row->meaning, out);
		nt_buffer_text(out, "\n.br\n.I Remedy:\n");
		nt_buffer remedy = {0};
		nt_remedy_text((nt_code)i, row->repair, NULL, NULL, &remedy);
		put_troff(remedy.data, out);
		nt_buffer_free(&remedy);
		nt_buffer_text(out, "\n.br\n.I Smallest example:\n");
		put_troff(row->example, out);
		nt_buffer_text(out, ".\n");
	}
	nt_buffer_text(out, manual_tail);
}

TEST(manual_lists_every_code_as_the_table_has_it)
{
	static const char path[] = "man/nmtan-report.5";
	nt_buffer expected = {0};
	write_manual(&expected);
	if (getenv("NMTAN_UPDATE")) {
		FILE *file = fopen(path, "wb");
		assert_non_null(file);
		assert_int_equal(fwrite(expected.data, 1, expected.size, file), expected.size);
		fclose(file);
	}
	FILE *file = fopen(path, "rb");
	assert_non_null(file);
	char *found = calloc(1, expected.size + 2);
	assert_non_null(found);
	const size_t size = fread(found, 1, expected.size + 1, file);
	fclose(file);
	assert_int_equal(size, expected.size);
	assert_string_equal(found, expected.data);
	free(found);
	nt_buffer_free(&expected);
}
