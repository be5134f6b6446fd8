/* SPDX-License-Identifier: MIT */
/*
 * The table of findings and the few functions that read it: see report.h.
 *
 * Severities: an error is data that breaks glTF's rules or certainly renders wrong; a warning is worth
 * a look in the DCC tool; an info says what is there (mirroring itself is legitimate). A fact that nobody would ever
 * act on is a number of the mesh and no finding.
 */
#include "report/report.h"

#include <assert.h>
#include <string.h>
#include <strings.h>
#include "base/text.h"

#define ROW(name, severity, profiles, advice, repair, message, meaning, remedy, example) \
	[NT_CODE_##name] = {#name, NT_SEVERITY_##severity, profiles, NT_ADVICE_##advice, repair, message, meaning, \
		remedy, example}

static const nt_code_row code_table[NT_CODE_COUNT] = {
	ROW(MTL_MISSING, WARNING, "--w", FILE, NULL, "material library cannot be read",
		"The OBJ names an MTL file that is not there, or is no text. The meshes are converted, their materials "
		"get default values.",
		"Put the MTL file beside the OBJ, or take the mtllib line out.",
		"an OBJ with \"mtllib nowhere.mtl\""),
	ROW(MATERIAL_UNKNOWN, WARNING, "--w", EXPORT, NULL, "material is defined by no material library",
		"usemtl names a material that no MTL file defines. It becomes a default material of that name.",
		"Export the material library again, or correct the name.",
		"an OBJ with \"usemtl ghost\" and no mtllib"),
	ROW(MATERIAL_FIRST, INFO, "--i", LOOK, NULL, "no usemtl: all faces have the first material of the library",
		"The OBJ names a material library and takes no material of it. obj2gltf and others give the library's "
		"first material to all faces then, and so does nmtan.",
		"Nothing, or write usemtl before the faces.",
		"an OBJ with \"mtllib m.mtl\" and no usemtl"),
	ROW(BUFFER_MISSING, ERROR, "e--", FILE, NULL, "buffer cannot be opened",
		"A buffer of the glTF has a URI, and no file that can be read is there. Nothing is converted or "
		"judged, whether the buffer is needed or not: the output would be as broken. The exit code is 2.",
		"Put the file beside the glTF under the name that its URI has.",
		"a glTF whose .bin was not copied with it"),
	ROW(IMAGE_MISSING, WARNING, "w--", FILE, NULL, "image cannot be read",
		"A material refers to an image file that is not there. The output is without it, or, of a glTF, has "
		"the same name; with --images=link it refers to where the file should be.",
		"Put the image where the file names it. For an OBJ, --texture-path names more folders.",
		"an MTL with \"map_Kd missing.png\""),
	ROW(LINK_LEAVES, WARNING, "w--", LOOK, NULL, "reference leaves the folder of the output",
		"A URI of the output begins with \"..\", as --images=link or --buffers=link asks, or because a buffer "
		"that nothing needs cannot be copied. Other programs refuse such names, and moving the folder breaks "
		"them.",
		"Leave the option away: files are copied then.",
		"nmtan --images=link a/in.gltf b/out.gltf"),
	ROW(IMAGE_TYPE, WARNING, "w--", EXPORT, NULL, "image has a type that glTF does not carry",
		"glTF carries PNG and JPEG (others by extension). TGA, BMP, PSD, HDR and TIFF become PNG, unless "
		"--textures=keep is given; anything else is left out, or stays a file if a glTF refers to it.",
		"Convert the image to PNG and name that in the material.",
		"an MTL with \"map_Kd wood.exr\""),
	ROW(IMAGE_DAMAGED, WARNING, "w--", EXPORT, NULL, "image cannot be decoded",
		"An image had to be decoded, to be converted or to see whether it is a height map, and that failed. "
		"PNG and JPEG are used as they are, other types are left out.",
		"Write the image again.",
		"a TGA that ends before its last pixel"),
	ROW(IMAGE_ELSEWHERE, WARNING, "w--", LOOK, NULL, "image was found elsewhere",
		"The file that a material names is not there, but one whose path ends alike is: in the folder "
		"of the material library or of the OBJ, in a folder of --texture-path, or under a name in "
		"another case.",
		"If it is the wrong one, correct the name in the material.",
		"an MTL with \"map_Kd C:/art/wood.png\" beside wood.png"),
	ROW(IMAGE_CONVERTED, INFO, "i--", LOOK, NULL, "image was converted",
		"An image was converted to what glTF carries: another type to PNG, a height map to a normal map.",
		"Nothing. --textures and --bump say what is converted, --bump-height how high heights are.",
		"an MTL with \"map_Kd wood.tga\""),
	ROW(BUMP_AS_NORMAL, INFO, "i--", LOOK, NULL, "bump map was taken as a normal map",
		"map_Bump and bump are height maps by definition, but most files put a normal map there. An "
		"image whose pixels are not all grey is taken as one. Nothing is said of Blender's, which always are.",
		"Nothing if it is a normal map. If it is a height map, use --bump=height.",
		"an MTL with \"map_Bump n.png\""),
	ROW(NMAP_NOT_TURNED, WARNING, "w--", LOOK, NULL, "normal map is not turned",
		"--flip-green and --bump turn PNG and JPEG of a glTF. KTX2 and WebP stay as they are, and so does the "
		"PNG or JPEG of a texture that has one of these too.",
		"Turn it before it is compressed.",
		"a KTX2 in normalTexture, and --flip-green=on"),
	ROW(NMAP_HEIGHTS, WARNING, "w--", CONVERT, "--bump=height", "normal map that is a height map",
		"Every pixel of a normalTexture is grey. As a normal map that tilts the surface one way everywhere.",
		"Make a normal map of it.",
		"a grey PNG in normalTexture"),
	ROW(MATERIAL_LOST, WARNING, "w--", LOOK, NULL,
		"{count} {property of a material is|properties of materials are} not carried over",
		"A texture, a texture's place or a layer that a material names is not in the output, which "
		"will look different; nor is a statement whose numbers cannot be read. The detail names the "
		"statement.",
		"Correct the statement if it is broken. Else set it again in the output, or bake it into a texture "
		"that is carried over.",
		"an MTL with \"disp height.png\""),
	ROW(MATERIAL_DOUBTFUL, WARNING, "w--", EXPORT, NULL,
		"{count} {property of a material is|properties of materials are} not taken at {its|their} word",
		"Properties of a material contradict each other, or say what programs write without meaning "
		"it: d 0, which would make all of it invisible, a black Kd beside a map. The detail says what "
		"was taken instead.",
		"Correct the material if something else was meant.",
		"an MTL with \"d 0\""),
	ROW(NMAP_BESIDE, INFO, "i--", LOOK, "--normal-map=FILE",
		"no normal map, but an image beside the input is named like one",
		"An OBJ, PLY or Draco file with texture coordinates names no normal map, and in its folder is an "
		"image with its name and an ending of normal maps: _nm_tangent, _normal, _nrm, _nm, _n, _ddn and the "
		"like. nmtan does not use it by itself, and looks for it only if one input is named.",
		"If it is the normal map, name it.",
		"head.obj beside head_n.png"),
	ROW(NMAP_GREEN_DOWN, WARNING, "w--", CONVERT, "--fix", "normal map whose green points down",
		"glTF's normal maps have green up. The slopes p = -x/z and q = y/z of a real surface have equal mixed "
		"derivatives, dp/dv = dq/du with rows counted down; in this map they are opposite. The figures are "
		"their correlation (-1: green down, 1: up) at the size of detail that shows it best, the share of the "
		"map where it has this sign, and how many of 12 x 12 blocks say what, over all sizes. "
		"Bumps and dents are exchanged along one direction.",
		"Invert the green channel.",
		"a map baked for DirectX"),
	ROW(NMAP_GREEN_MIXED, INFO, "i--", BAKE, NULL,
		"parts or details of the normal map say that green points down, others that it points up",
		"Some blocks of the map, or some sizes of its detail, say that green points down, and others that it "
		"points up or nothing: a detail map or a decal of the other convention was painted in. No "
		"convention is right for all of it, and --flip-green=auto leaves it. The figures are those of "
		"NMAP_GREEN_DOWN.",
		"Look at the blocks that say down. If their dents and bumps are exchanged, bake or paint them again.",
		"a map of which one half was baked for DirectX"),
	ROW(NMAP_NOT_UNIT, INFO, "i--", BAKE, NULL, "normal map whose vectors are not of unit length",
		"More than a hundredth of the pixels have a length that differs from 1 by more than a tenth: "
		"padding, a map that was painted or blended, or no normal map at all. Renderers normalize them.",
		"Normalize the map after editing.",
		"a normal map whose blue channel was overwritten"),
	ROW(NMAP_BLUE_BELOW_HALF, WARNING, "w--", BAKE, NULL, "normal map with vectors that point into the surface",
		"Pixels of a tangent-space map point out of the surface: blue is above one half. More than one "
		"in a hundred do not.",
		"Bake the map again with a larger cage, or look for painted pixels.",
		"a map with a pixel of (128, 128, 0)"),
	ROW(NMAP_OBJECT_SPACE, WARNING, "w--", BAKE, NULL, "normal map in object space",
		"The vectors have unit length and point into all directions, as in a map that was baked in "
		"object space. glTF's are in tangent space.",
		"Bake the map in tangent space.",
		"a map whose vectors are the normals of a sphere"),
	ROW(NMAP_CONSTANT, INFO, "w--", BAKE, NULL, "normal map of one colour",
		"All pixels are alike: the map says nothing, and costs a texture. A warning if the colour is not that "
		"of a flat surface, about (128, 128, 255): the surface is lit as if it were tilted.",
		"Take it out of the material, or bake it again.",
		"a map of (128, 128, 255) alone"),
	ROW(NMAP_BANDED, INFO, "i--", BAKE, NULL, "normal map of 8 bits on a smooth surface",
		"Most of the sloped pixels lie in runs of one value with steps of one level between them: "
		"reflections show bands.",
		"Bake with 16 bits, or with dithering.",
		"an 8-bit map of a large sphere"),
	ROW(NMAP_SRGB, INFO, "i--", BAKE, NULL, "normal map that is marked as sRGB",
		"The PNG says that its samples are sRGB. glTF's loaders ignore it; others convert the values, "
		"which bends every normal.",
		"Export the map as linear, or raw, data.",
		"a PNG with an sRGB chunk in normalTexture"),
	ROW(NMAP_JPEG, INFO, "i--", BAKE, NULL, "normal map compressed with loss",
		"JPEG, and WebP with loss, average colours over 2 x 2 pixels and add rings at edges, which light "
		"shows.",
		"Use PNG, or WebP without loss.",
		"a JPEG in normalTexture"),
	ROW(NMAP_NOT_EXAMINED, INFO, "i--", LOOK, NULL, "normal map was not examined",
		"KTX2 is not decoded here, and files above 16 MB only with --check-maps=on.",
		"Nothing, or --check-maps=on.",
		"a KTX2 in normalTexture"),
	ROW(STATEMENT_IGNORED, INFO, "iii", LOOK, NULL, "{count} {statement was|statements were} not used",
		"The input has a statement that nmtan does not know or does not need.",
		"Nothing, unless you expected it to matter.",
		"an OBJ with a \"bevel\" line"),
	ROW(COLORS_DOUBTFUL, WARNING, "-ww", EXPORT, NULL, "colours of vertices are not what they should be",
		"A block of #MRGB comments in an OBJ has more or fewer colours than there are vertices before "
		"it, or something that is no colour; or a vertex has a colour that is NaN or infinite. The last "
		"vertices before a block got its colours; what is missing or malformed is white.",
		"Export the mesh again.",
		"#MRGB ff0000 (six digits) in an OBJ"),
	ROW(POLYGON_DEGENERATE, WARNING, "-ww", EXPORT, NULL,
		"{count} {polygon|polygons} could not be triangulated properly",
		"A face of five or more corners crosses itself, is collinear or not finite. It was cut into "
		"triangles, but they may overlap.",
		"Cut the polygon in the modelling tool.",
		"an OBJ face of five corners in the order of a star"),
	ROW(POLYGON_CUT, INFO, "-ii", LOOK, NULL, "{count} {polygon was|polygons were} written as triangles",
		"The triangles of these polygons (or strips) need different tangents at one corner, but a vertex has "
		"only one. PLY output keeps polygons if it can; these became triangles.",
		"Nothing, unless the polygons matter: then cut or unwrap them differently.",
		"a PLY pentagon with one corner's texture coordinates mirrored"),
	ROW(NORMALS_MADE, INFO, "i-i", LOOK, NULL, "{count} {corner|corners} got a computed normal",
		"Tangents need normals, which the input lacks, or which have no direction: (0, 0, 0). For OBJ they are "
		"made by its smoothing groups, or smooth if it has none, for PLY smooth, for glTF only if --normals "
		"asks for them; a glTF keeps normals that have no direction, and its tangents are made for smooth "
		"ones.",
		"Export normals if these are not what you want.",
		"a PLY triangle with s and t but no nx, ny, nz"),
	ROW(NORMALS_REPLACED, INFO, "i-i", LOOK, NULL, "{count} {normal|normals} of the input {was|were} replaced",
		"--normals=replace-flat or replace-smooth asks for it. The finding counts corners that had a normal.",
		"Nothing; --normals=flat and smooth make only those that are missing.",
		"a PLY triangle with nx, ny, nz and --normals=replace-flat"),
	ROW(NORMALS_CANCELLED, WARNING, "w-w", EXPORT, NULL,
		"{count} made {normal is|normals are} flat: the faces around cancel out",
		"The faces of one smoothing group at these corners look in opposite directions, as on a sheet whose "
		"triangles are there twice, once reversed. The sum of their normals is nothing but rounding; the "
		"corners have the normals of their own faces.",
		"Give front and back smoothing groups of their own, export normals, or take the back away and make the "
		"material double-sided.",
		"an OBJ triangle and its reverse, without vn"),
	ROW(NORMALS_NOT_THERE, WARNING, "-ww", EXPORT, NULL, "faces refer to normals, but the file has none",
		"The file has faces with numbers of normals and not a single vn. Normals are made as if the "
		"numbers were not there.",
		"Export the normals, or faces without them.",
		"an OBJ triangle of corners like 1/1/1 without vn"),
	ROW(NORMALS_SCALED, INFO, "i-i", LOOK, NULL, "{count} {normal was|normals were} made unit for the tangents",
		"The length differs from 1 by more than 2^-12. Tangents lie across the unit normal, which is what "
		"renderers make of it. The output has the unit normal too, but a glTF that is made from a glTF, or a "
		"PLY from a PLY whose normals are integers, keeps those that it has.",
		"Harmless. To silence it, export unit normals.",
		"an OBJ triangle with \"vn 0 0 .5\""),
	ROW(REFERENCE_LOST, WARNING, "www", LOOK, NULL,
		"{count} {part of the input is|parts of the input are} not in the output",
		"Something that the input has or refers to has no place in the output's format, or none that nmtan "
		"knows: animations in PLY, an OBJ's lines and a PLY's property \"quality\" in glTF.",
		"Choose another output format, or add it again by hand.",
		"a glTF with animations that is written as PLY"),

	ROW(WELD_LEFT, WARNING, "w--", LOOK, NULL, "{count} {primitive is|primitives are} not welded: {detail}",
		"--weld leaves primitives that share vertices as they are if a vertex has meaning by its number: "
		"EXT_mesh_features with implicit ids, CESIUM_primitive_outline, EXT_mesh_manifold, FB_ngon_encoding, "
		"an extension that names an accessor with one element for each vertex, an animation that uses an "
		"attribute's accessor; if Draco compresses primitives that get no tangents; if no bufferView has "
		"the positions of more than 65 536 vertices; and if an accessor cannot be read.",
		"Leave --weld away, or take the extension out before.",
		"nmtan --weld of a primitive with CESIUM_primitive_outline"),
	ROW(EXTENSION_STALE, WARNING, "w--", LOOK, NULL, "{detail} refers to vertices, and vertices were copied",
		"Vertices that need several tangents are copied, and attributes and indices follow. This "
		"extension seems to refer to vertices as well, in a way that nmtan does not know or cannot "
		"follow, and was left as it is.",
		"Make what the extension holds again from the output, or split the vertices before nmtan does.",
		"a primitive whose extension names an accessor with one element for each vertex"),
	ROW(POLYGONS_DROPPED, INFO, "i--", LOOK, NULL,
		"{detail} is not in the output: it would not say the same polygons",
		"The extension marks triangles that follow each other as one polygon if their first index is equal. A "
		"first vertex that needs several tangents is copied, or Draco gives triangles another order.",
		"Nothing, unless polygons are read from the output; the input still has them.",
		"two triangles with equal first index and a mirror seam between them, marked by FB_ngon_encoding"),
	ROW(DRACO_PLAIN, WARNING, "w--", LOOK, NULL, "the primitive is written without Draco compression",
		"--draco asks for compression, or the input's primitive is compressed, but a Draco block cannot hold "
		"what it has now: vertices shared with other primitives, strips or fans, sparse accessors, or "
		"vertices that no face uses and whose order matters. The detail says which.",
		"Nothing if the size does not matter; --draco=off then avoids the warning. Else give the primitive "
		"accessors of its own, and separate triangles.",
		"converting two normal-mapped primitives with one POSITION accessor, --draco=sequential"),
	ROW(DRACO_SEQUENTIAL, INFO, "i--", LOOK, NULL,
		"the primitive is compressed by Draco's sequential method, which gives larger files",
		"Edgebreaker was asked for, or the input has it. It takes time in the square of the triangles at one "
		"vertex, which is bounded, and some meshes it does not give back as they are: it drops faces of which "
		"two corners are at one position. Such faces go only if the grid of the input's block has made them.",
		"Nothing if the size does not matter. Else remove repeated triangles and faces without area, and cut "
		"fans of thousands.",
		"converting 100 000 times the same triangle, --draco=edgebreaker"),
	ROW(NOT_VERIFIED, WARNING, "www", LOOK, NULL,
		"tinygltf refuses the output",
		"--verify has tinygltf read the output, which refuses it: the detail has its message. nmtan's own "
		"reader alone compared the meshes. If tinygltf refuses the input too, the reason was there before: "
		"nmtan keeps what has nothing to do with tangents. It refuses some valid documents as well, such as "
		"those with KHR_animation_pointer.",
		"Correct the input if it has a fault and programs that use tinygltf are to read it.",
		"a glTF with a skin without inverseBindMatrices, --verify"),
	ROW(MESH_NOT_READ, ERROR, "e--", EXPORT, NULL, "the geometry is faulty and was not judged",
		"A conversion leaves a primitive that needs no tangents as it is, even one that cannot be read. The "
		"detail says what is wrong with it; --check fails there.",
		"Export the mesh again.",
		"a primitive without a material whose indices go beyond its vertices, converted with --report"),

	ROW(UV_MIRROR_SEAM, INFO, "i-i", EXPORT, NULL,
		"texture coordinates are mirrored across a seam of {count} {edge|edges}",
		"The two triangles at each of these edges are wound in opposite directions in UV space, so w changes "
		"its sign here and vertices cannot be shared. Legitimate and frequent, but normal maps show seams "
		"here first. It is visible on edges whose two sides look up the same texels although their tangents "
		"differ: no map can hide that. There is one finding for each loop or chain, numbered as it shows.",
		"Nothing if the mirroring is meant. Keep the seam off prominent edges, and bake with mirrored "
		"islands a whole tile away.",
		"two triangles that share an edge and have the same UV at their third corners"),
	ROW(UV_MIRROR_OVERLAP, INFO, "i-i", EXPORT, NULL,
		"{count} {island has|islands have} mirrored triangles on texels that others show unmirrored",
		"Mirrored islands, or parts of an island, that share their texture with a twin: the usual way to "
		"texture a symmetric model at half the cost. Judged as the sampler wraps: repeated coordinates "
		"modulo 1, mirrored ones folded, clamped ones as they stand.",
		"Nothing. When baking, have the mirrored islands a whole tile away so that only one of two is baked.",
		"two separate quads with the same four UVs, the second one wound the other way"),
	ROW(UV_MIRROR_LONE, INFO, "i-i", EXPORT, NULL,
		"{detail} ({count} {triangle|triangles}) is mirrored and shares no texels with an unmirrored one",
		"A mirrored island that shares its texture with nothing: mirroring gains nothing here, and "
		"text or asymmetric detail in the texture shows reversed. Often an accident. If all islands of a mesh "
		"are mirrored, that is one finding: v may point the other way in the file.",
		"Flip the island in the UV editor (Blender: UV > Mirror > X Axis) unless the texture was painted for "
		"it.",
		"one triangle whose UVs are clockwise"),
	ROW(UV_MIXED_WINDING_ISLAND, WARNING, "w-i", EXPORT, NULL,
		"island of {count} {triangle|triangles} is folded: both windings are connected",
		"Inside one connected island some triangles are wound the other way, and they do not lie on a twin "
		"point by point: a fold. Texture is mirrored there and tangents flip within the island. An info if no "
		"material of a glTF needs tangents (of an OBJ: of its glTF), and up to a thousandth of the mesh's "
		"area.",
		"Unfold the island (Blender: UV > Minimize Stretch, or UV > Unwrap), or cut it along the fold (Edge "
		"> Mark Seam) and unwrap it again.",
		"three quads in a row with u = 0, 1, 0.4, 1.4"),
	ROW(UV_FLIPPED_TRIANGLE, WARNING, "w-i", EXPORT, NULL,
		"{count} {triangle is|triangles are} flipped: {detail}",
		"A few triangles in a row are wound against their island: at most 5 % of its triangles, of its area "
		"and of its texels, or a single one up to 10 %, if all triangles that are wound so are at most 15 % "
		"of each. Texture is mirrored there. They make no seam and no fold. Nothing is said of what rounding "
		"may have turned, to float or to a grid on which all coordinates of the mesh lie, as Draco, "
		"KHR_mesh_quantization and texts with few decimals have them: heights up to 1.4 steps. Nor of what "
		"nobody sees: less than eight texels high (of 2048 x 2048), thinner in space than a twentieth of the "
		"length, or in a row below a hundred-thousandth of the mesh's area. Nor of faces that are reversed "
		"among their neighbours (MESH_INCONSISTENT_WINDING), or folded back by more than 90 degrees: their "
		"layout is right. "
		"Nor in a mesh whose layout is out of order anyway: where more of its area has the rarer winding of an "
		"island and is not flipped (UV_MIXED_WINDING_ISLAND), or, in the same island, flipped and too small to "
		"be told or without area in UV space (UV_DEGENERATE_TRIANGLE), or more edges have inconsistent "
		"winding. An info if no texture of a glTF uses the coordinates or no material of it needs tangents "
		"(of an OBJ: of its glTF), and up to a thousandth of the mesh's area.",
		"Look for them in the UV editor (Blender: Overlays > Display Stretch). If the triangle bridges two "
		"parts of the layout, a seam is missing: mark it (Edge > Mark Seam), and unwrap again. If a corner "
		"lies on the wrong side of its neighbours, move it back, or relax the knot (UV > Minimize Stretch).",
		"a grid of 4 x 4 quads in which one inner corner's UVs were moved over the opposite edge"),
	ROW(UV_HARD_EDGE, WARNING, "w-i", LOOK, NULL,
		"{count} hard {edge lies inside a UV island|edges lie inside UV islands}: {detail}",
		"The normals of both sides differ by more than 20 degrees, and the texture coordinates go on across "
		"the edge. A bake has other directions in neighbouring texels then, which filtering and mipmaps mix: a "
		"line shows along the edge. All of a mesh are one finding. Its places begin with the longest of those "
		"that hang together: a loop, a chain or, if three edges meet, a net. An info if no material has a "
		"normal map. A cut in the texture coordinates along which normals are smooth is no fault.",
		"Cut the texture coordinates along these edges (Blender: Select > Select Sharp Edges, Edge > Mark "
		"Seam, UV > Unwrap) or shade them smooth, and bake again.",
		"two quads at a right angle with normals of their own and one strip of texture coordinates"),
	ROW(UV_DEGENERATE_TRIANGLE, INFO, "w-i", EXPORT, NULL,
		"{count} {triangle has|triangles have} no area in UV space",
		"The three texture coordinates are collinear: there is no direction in which u grows, so the tangent "
		"comes from a neighbour or from the normal. Nothing is said of triangles that have no area in space "
		"either (POS_DEGENERATE_TRIANGLE), below a hundred-thousandth of the mesh's area, and of a glTF's mesh "
		"that neither has nor needs tangents, if no texture uses the coordinates. A warning when such "
		"triangles are more than 1 % of the mesh's area, unless no material of a glTF needs tangents (of an "
		"OBJ: of its glTF).",
		"Unwrap these triangles (Blender: UV > Smart UV Project) if they are visible and normal mapped.",
		"two triangles, of which one has UVs (0,0), (1,0), (2,0)"),
	ROW(UV_NEAR_DEGENERATE, INFO, "w-i", EXPORT, NULL,
		"{count} {triangle has|triangles have} next to no area in UV space: {detail}",
		"Rounding of the texture coordinates to float alone may turn the tangent of these triangles by more "
		"than one degree. It decides a tangent if it may turn the triangle over in UV space or its tangent by "
		"90 degrees. The coordinates are coincident if rounding may turn a side between them by one degree, "
		"else collinear. The finding gives the smallest relative determinant |det| / (|e1| |e2|) of a "
		"triangle's two longest sides. Nothing is said of triangles that are as thin in space, up to twice as "
		"wide by their length, below a hundred-thousandth of the mesh's area, and of a glTF's mesh that "
		"neither has nor needs tangents. A warning when they are more than 1 % of the mesh's area, unless no "
		"material of a glTF needs tangents (of an OBJ: of its glTF).",
		"If they are normal mapped, give them more room in the texture (Blender: UV > Unwrap, or UV > Smart UV "
		"Project). Move an island that is tiles away from the origin back (Blender: UV > Pack Islands).",
		"a triangle with UVs (0,1000), (1,1000), (0,1000.001)"),
	ROW(UV_FOLDED_QUAD, WARNING, "w-i", EXPORT, NULL,
		"{count} {quad crosses itself|quads cross themselves} in UV space",
		"Cut along either diagonal, its triangles are wound in opposite directions. Written as two triangles, "
		"in a glTF, each gets its own sign and vertices of its own. MikkTSpace, and with it a bake of quads, "
		"has one sign for both, that of the larger one: --raw writes that. PLY keeps the quad and this "
		"sign, and the smaller triangle is lit from the wrong side. An info if no material of the glTF "
		"needs tangents.",
		"Straighten the quad in the UV editor, or triangulate it (Blender: Face > Triangulate Faces).",
		"a quad with UVs (0,0), (1,1), (1,0), (0,1): a bowtie"),
	ROW(UV_UNMAPPED, WARNING, "w-i", EXPORT, NULL,
		"the mesh is not unwrapped: {count} {triangle has|triangles have} no area in UV space",
		"All texture coordinates are alike, or on a line. Tangents are made from normals, and mean nothing. "
		"An info if no material of a glTF needs tangents (of an OBJ: of its glTF).",
		"Unwrap the mesh (Blender: UV > Smart UV Project).",
		"a quad whose corners have one vt"),
	ROW(UV_ROUNDED_AWAY, INFO, "--i", EXPORT, NULL,
		"{count} {triangle changes|triangles change} orientation when v becomes 1 - v",
		"glTF stores 1 - v, which rounds: tiny triangles lose their area or turn over. w is right for "
		"the coordinates as stored.",
		"Give the triangles more room (Blender: UV > Pack Islands), or keep v near 1.",
		"an OBJ triangle with UVs (0,0), (1,0), (0,1e-9)"),
	ROW(UV_NOT_FINITE, ERROR, "eee", EXPORT, NULL,
		"{count} {vertex has texture coordinates|vertices have texture coordinates} that are not finite",
		"NaN or infinity. Nothing can be textured there. In a mesh of another format than glTF they become "
		"(0, 0).",
		"Export the mesh again.",
		"a PLY vertex with s = nan"),
	ROW(UV_MISSING, WARNING, "w-i", EXPORT, NULL, "{detail}",
		"An OBJ, PLY or Draco mesh gets tangents if it has texture coordinates. This one has none, other "
		"meshes of the file have some; or some of its triangles have none (an info up to 1 % of its area, and "
		"if no material of the glTF needs tangents): tangents that are made for these follow their normals. "
		"TAN_NO_UV is reported instead if no mesh has any, or if a material's "
		"normal map needs them.",
		"Unwrap it if it is to be normal mapped (Blender: UV > Smart UV Project); else --only=needed, or "
		"--ignore=UV_MISSING.",
		"an OBJ with two objects of which one has faces like 1 2 3"),
	ROW(UV_NOT_THERE, WARNING, "-ww", EXPORT, NULL, "faces refer to texture coordinates, but the file has none",
		"The file has faces with numbers of texture coordinates and not a single vt. It is read as if "
		"the numbers were not there, so that it gets no tangents.",
		"Export the texture coordinates, or faces without them.",
		"an OBJ triangle of corners like 1/1 without vt"),

	ROW(POS_DEGENERATE_TRIANGLE, INFO, "iii", EXPORT, NULL, "{count} {triangle has|triangles have} no area",
		"Corners coincide or are collinear. The triangle cannot be seen, and MikkTSpace gives its "
		"corners the tangents of a neighbour.",
		"Remove it (Blender: Mesh > Clean Up > Degenerate Dissolve), or merge its vertices.",
		"a triangle with two corners at one position"),
	ROW(POS_NOT_FINITE, ERROR, "eee", EXPORT, NULL,
		"{count} {vertex has a position|vertices have positions} that are not finite",
		"NaN or infinity. The triangles there cannot be drawn.",
		"Export the mesh again.",
		"a PLY vertex with x = inf"),
	ROW(POS_ORIGIN, INFO, "-ii", LOOK, NULL, "positions are computed relative to an origin",
		"Coordinates of the OBJ or PLY are so large that float would move vertices by more than a hundredth "
		"of the median edge, or --origin names an origin. Normals, tangents and findings are made of the "
		"positions as doubles minus the origin, which has the form that --origin takes. A glTF stores those, "
		"and its nodes add the origin as their translation; a PLY has the file's own coordinates, as doubles. "
		"Places in a report are the file's, too.",
		"Nothing. With --origin=keep positions are rounded instead; with --origin=X,Y,Z several files have "
		"one origin.",
		"an OBJ with edges of 2 cm at \"v 431234.12 5412345.67 101.05\""),
	ROW(POS_ROUNDED, WARNING, "-ww", CONVERT, "--origin=auto",
		"{count} {vertex is|vertices are} moved by more than a hundredth of an edge where positions become "
		"float",
		"Coordinates of the OBJ or PLY are so large that the floats there are far apart: triangles bend or "
		"collapse, and the normals and tangents made of them are wrong. --origin=keep asked for that, or the "
		"origin does not help, because a few vertices lie far from the rest. Triangles without area are not "
		"counted then: the file may have none. A PLY of a PLY keeps its numbers, and only the normals and "
		"tangents that it gets are wrong: an info if it has both already and keeps them.",
		"If the origin is auto already, the objects are too far from each other for float: export them as "
		"files of their own. Otherwise let nmtan choose an origin.",
		"an OBJ with edges of 2 cm at \"v 431234.12 5412345.67 101.05\", with --origin=keep"),
	ROW(MESH_NON_MANIFOLD_EDGE, WARNING, "wii", EXPORT, NULL,
		"{count} {edge belongs|edges belong} to more than two triangles",
		"After vertices at one position are welded, three or more triangles meet at an edge. Which of them "
		"are neighbours is then a matter of order, and programs differ in their tangents. An info if nothing "
		"asks for tangents, and up to a thousandth of the mesh's area.",
		"Separate the surfaces, or delete doubled and inner faces.",
		"three triangles that share one edge"),
	ROW(MESH_INCONSISTENT_WINDING, WARNING, "www", EXPORT, NULL,
		"{count} {edge has|edges have} two triangles that run along it in the same direction",
		"The two triangles at these edges face opposite sides. A flipped face, or a surface that has "
		"one side only (a Moebius strip), which cannot be wound consistently. An info up to a thousandth of "
		"the mesh's area: slivers.",
		"Recalculate the normals outside (Blender: Mesh > Normals > Recalculate Outside), or flip the faces "
		"that are wrong.",
		"triangles 0 1 2 and 0 1 3"),
	ROW(MESH_NORMAL_NON_UNIT, WARNING, "wii", EXPORT, NULL, "{count} {normal is|normals are} not of unit length",
		"The length differs from 1 by more than 0.00674, the tolerance of the Khronos validator. "
		"nmtan makes tangents for the normal made unit; programs that take it as it is tilt them. An info of "
		"other formats than glTF: what is made of them has unit normals.",
		"Normalise the normals on export.",
		"a vertex with the normal (0,0,2)"),
	ROW(MESH_NORMAL_ZERO, ERROR, "eww", EXPORT, NULL, "{count} {normal is|normals are} zero or not finite",
		"A normal without a direction cannot be lit and has no tangent plane. A warning of other formats than "
		"glTF, unless it is NaN or infinite: what is made of them has another normal there.",
		"Recalculate the normals, and remove triangles without area.",
		"a vertex with the normal (0,0,0)"),
	ROW(MESH_NORMAL_AGAINST_FACE, WARNING, "www", EXPORT, NULL,
		"{count} {triangle has|triangles have} normals that point against {its|their} winding",
		"All three corner normals lie on the back side of the triangle: it is lit as if seen from behind, and "
		"the bitangent runs against v there. An info if these are at most 1 % of the mesh's area.",
		"Flip the winding (Blender: Mesh > Normals > Flip) or recalculate the normals.",
		"a counterclockwise triangle in the xy plane with the normal (0,0,-1)"),

	ROW(TAN_MIRROR_SHARED_VERTEX, WARNING, "w--", CONVERT, "--fix",
		"{count} {vertex is|vertices are} shared by mirrored and unmirrored triangles",
		"One vertex holds one tangent and one w, but the triangles on its two sides need opposite signs: "
		"tangents stored in this file cannot be right on both sides. An info if it stores none or no material "
		"uses them. A conversion splits such vertices and counts them.",
		"Split them.",
		"two triangles that share two vertices and mirror their UVs across them"),
	ROW(TAN_MIXED_W_TRIANGLE, WARNING, "w--", CONVERT, "--fix",
		"{count} {triangle has|triangles have} corners with different w",
		"The three corners must agree: if w changes its sign inside a triangle, the interpolated bitangent "
		"passes through zero and the shading breaks.",
		"Compute the tangents again.",
		"a triangle with w = 1, 1, -1"),
	ROW(TAN_SIGN_MISMATCH, ERROR, "e--", CONVERT, "--fix",
		"{count} {triangle has|triangles have} a bitangent that runs the wrong way",
		"In glTF the bitangent cross(N, T) * w runs along -dP/dv, that is, w is +1 if the stored UVs have a "
		"negative determinant. Here w is the opposite, or T and the bitangent are both reversed, and the "
		"normal map's green channel is inverted; its red one if T alone is reversed. The finding gives the "
		"share: 100 % by w means that the exporter's convention is inverted, which is what happens when V is "
		"not flipped; reversed tangents were made for other texture coordinates. An info if no material uses "
		"the tangents; a warning if only a texture transform makes them wrong, which mirrors or turns, and "
		"up to two thousandths of the triangles and of their area.",
		"Compute the tangents again.",
		"a glTF quad, upright and not mirrored, with w = -1"),
	ROW(TAN_DIRECTION_MISMATCH, WARNING, "w--", LOOK, "--existing=replace",
		"{count} {corner has a tangent|corners have tangents} more than 30 degrees off",
		"Compared with a fresh MikkTSpace solve of the same mesh. The histogram of angles says what "
		"kind of difference it is: all near 90 degrees means u and v exchanged, a broad one means tangents of "
		"other texture coordinates. The finding says so if they are right without the material's texture "
		"transform: Blender's exporter, glTF-Transform and gltfpack write those, and most renderers show them "
		"turned (nmtan-engines(7)). An info below 1 % of the corners.",
		"If they were made for another UV set, select that with --uv; if the map was baked with MikkTSpace, "
		"compute them again.",
		"a quad in the xy plane with tangents along y"),
	ROW(TAN_NOT_ORTHOGONAL, WARNING, "w--", CONVERT, "--fix",
		"{count} {tangent is|tangents are} more than one degree off perpendicular to {its|their} normal",
		"The frame is sheared. Renderers differ in whether they straighten it, so the model looks "
		"different in each.",
		"Compute the tangents again.",
		"a vertex with N = (0,0,1) and T = (0.8,0,0.6)"),
	ROW(TAN_PARALLEL_NORMAL, ERROR, "e--", CONVERT, "--fix",
		"{count} {tangent is|tangents are} parallel to {its|their} normal",
		"Within one degree of the normal or its opposite: the bitangent is zero or noise, and the "
		"normal map has no direction there.",
		"Compute the tangents again.",
		"a vertex with N = T = (0,0,1)"),
	ROW(TAN_ZERO, ERROR, "e--", CONVERT, "--fix", "{count} {tangent has|tangents have} no length",
		"Many tools write this for sliver triangles. Normalising it gives NaN in the shader: black or "
		"flashing pixels.",
		"Compute the tangents again.",
		"a vertex with T = (0,0,0,1)"),
	ROW(TAN_NOT_FINITE, ERROR, "e--", CONVERT, "--fix", "{count} {tangent is|tangents are} not finite",
		"NaN or infinity in one of the four numbers.",
		"Compute the tangents again.",
		"a vertex with T = (NaN,0,0,1)"),
	ROW(TAN_NON_UNIT, ERROR, "e--", CONVERT, "--fix", "{count} {tangent is|tangents are} not of unit length",
		"The length differs from 1 by more than 0.00674, the tolerance of the Khronos validator, which "
		"calls it an error.",
		"Compute the tangents again.",
		"a vertex with T = (2,0,0,1)"),
	ROW(TAN_BAD_W, ERROR, "e--", CONVERT, "--fix",
		"{count} {tangent has a w that is|tangents have a w that is} neither 1 nor -1",
		"w is a sign. Any other value scales or removes the bitangent.",
		"Compute the tangents again.",
		"a vertex with T = (1,0,0,0)"),
	ROW(TAN_MISSING_REQUIRED, ERROR, "e--", CONVERT, "--fix", "there are no tangents, {detail}",
		"Clearcoat normal maps and anisotropy demand a tangent space: TANGENT, or a normalTexture from which "
		"a client can make it. Here there is neither. If a normalTexture lets the client make tangents, this "
		"is an info: clients differ in how well they do it.",
		"Make them.",
		"a material with KHR_materials_anisotropy on a primitive with NORMAL only"),
	ROW(TAN_UNUSED, INFO, "i-i", CONVERT, "--existing=drop", "the mesh has tangents that no material uses",
		"Without a normal texture, clearcoat normal texture or anisotropy nothing reads them: 16 bytes "
		"per vertex for nothing. A glTF may have them, and one that is made of another format gets them.",
		"Nothing if a normal map is set later. Else write the mesh without them.",
		"a glTF primitive with TANGENT and the default material"),
	ROW(TAN_ACCESSOR, ERROR, "e--", CONVERT, "--fix", "tangents that cannot be read",
		"TANGENT of a glTF primitive is not an accessor of as many VEC4 as there are positions, or its place "
		"is outside of its buffer view. A renderer refuses the file or shows the mesh without normal map. "
		"Tangents that are computed get an accessor of their own; the faulty one stays in the file, unused.",
		"Compute the tangents.",
		"a glTF quad whose TANGENT is a VEC3 accessor"),
	ROW(TAN_NO_NORMAL, WARNING, "w--", CONVERT, "--normals=smooth",
		"tangents are needed but there are no normals",
		"A client must use flat normals then and ignore TANGENT, so none are written.",
		"Export normals, or make them (--normals=flat if the surface has facets).",
		"a glTF primitive with POSITION, TEXCOORD_0 and a normal-mapped material"),
	ROW(TAN_NO_UV, INFO, "eii", EXPORT, NULL, "there are no texture coordinates to make tangents by",
		"No mesh of an OBJ, PLY or Draco file has texture coordinates: a scan, say, or a model without "
		"textures. An error in a glTF whose material looks up a normal map, or shades by anisotropy, with "
		"coordinates that the primitive lacks: no renderer can get that right. A warning if an OBJ's material "
		"does: the output is without the map. If --uv asks for a set that a primitive lacks, its tangents stay "
		"as they are, and none are made; the finding then tells which sets there are.",
		"Nothing, if the mesh is to have no normal map; if a material names one, take it out there. Else "
		"unwrap the mesh (Blender: UV > Smart UV Project) and export its texture coordinates. If the finding "
		"tells other sets, choose one with --uv.",
		"a normal-mapped glTF primitive without TEXCOORD_0"),
	ROW(TAN_UVSET_CONFLICT, WARNING, "w--", EXPORT, NULL,
		"two textures want tangents of different texture coordinates",
		"One TANGENT attribute serves one set of texture coordinates. The normal texture's set wins; "
		"the other texture is lit in a wrong frame.",
		"Use one UV set for the normal, clearcoat normal and anisotropy textures.",
		"normalTexture with texCoord 0 and clearcoatNormalTexture with texCoord 1"),
	ROW(TAN_UV_TRANSFORM_ANIMATED, WARNING, "w--", EXPORT, NULL,
		"the texture transform of a normal map is animated",
		"Tangents follow the transform at rest. When an animation rotates it they no longer fit.",
		"Do not animate the rotation of a normal texture's transform.",
		"KHR_animation_pointer on a normalTexture's KHR_texture_transform"),
	ROW(TAN_MORPH_MISSING, WARNING, "w--", CONVERT, "--fix",
		"{count} morph {target has|targets have} no tangents",
		"The base mesh has TANGENT, so clients no longer compute tangents for its morph targets; "
		"without deltas of their own the targets are lit with the base's tangents.",
		"Write the deltas.",
		"a primitive with TANGENT and a target with POSITION only"),
	ROW(TAN_MORPH_TURNED, WARNING, "w--", EXPORT, NULL,
		"{count} {triangle is|triangles are} turned to the other side of {its|their} normals by a morph target",
		"Morph targets have no w of their own. If a target turns a triangle over and its normals do not "
		"follow, the bitangent that w gives runs the wrong way, and bumps look like dents while the target "
		"acts. The finding counts a triangle once for each target that turns it.",
		"Let the target move the normals too, or leave the triangle on its side.",
		"a flat triangle with normals along z and a target that moves x to -x"),
	ROW(TAN_MORPH_HALFWAY, WARNING, "w--", EXPORT, NULL,
		"{count} {triangle has|triangles have} wrong tangents when a morph target acts by half",
		"Clients add the deltas of TANGENT times the weight. That is exact at weights 0 and 1; between them "
		"it is not if a target stretches what it turns. At weight 0.5 it is more than 5 degrees from the "
		"tangents of the mesh as it then is. The detail names the target and the largest angle; 90 degrees "
		"means that a tangent and its delta cancel. Targets that turn no tangent by more than 5 degrees are "
		"not looked at.",
		"Add a target for the pose in between, so that none turns the surface far.",
		"a square whose target turns it by a quarter and doubles its width"),
	ROW(TAN_PRIMITIVE_BORDER, INFO, "i--", CONVERT, "--across=mesh",
		"{count} {tangent|tangents} at borders to other primitives would turn if the mesh were solved as one",
		"glTF defines tangents per primitive. A baker computes them over the whole object, so that a mesh "
		"which is divided by material shows a seam although the surface goes on with the same normals and "
		"texture coordinates. The finding counts corners whose tangents differ by more than 5 degrees between "
		"the two, and tells the largest angle.",
		"If the normal map was baked for the whole mesh, solve it so.",
		"two squares of one mesh, of which the second's texture is sheared, with a material each"),
	ROW(TAN_QUANTIZED, INFO, "i-i", CONVERT, "--precision=float",
		"{count} {tangent was|tangents were} stored as integers",
		"--precision=short or byte rounds tangents to the nearest direction that normalized integers can "
		"represent; they are rounded too if meshopt compresses their normals as integers. The detail has the "
		"largest and the mean angle between what was computed and what is stored.",
		"Nothing if the angle is too small to be seen; else --precision=float.",
		"converting any quad with --precision=byte"),
	ROW(TAN_REPAIRED, INFO, "i-i", LOOK, NULL,
		"{count} {corner|corners} got a tangent that MikkTSpace could not give",
		"MikkTSpace leaves zero vectors, defaults or mixed signs at degenerate triangles. nmtan "
		"replaced them by the nearest usable frame.",
		"Nothing; --raw gives the raw result. Degenerate triangles are the cause.",
		"converting one triangle with UVs (0,0), (1,0), (2,0)"),
	ROW(TAN_EXISTING_BAD, WARNING, "w--", CONVERT, "--fix",
		"{count} {tangent that was kept is|tangents that were kept are} invalid",
		"--existing=keep leaves authored tangents as they are, and some of them are not usable. A report says "
		"what is wrong with each: TAN_ZERO, TAN_NOT_FINITE and so on in place of this.",
		"Repair them.",
		"converting a normal-mapped glTF with a tangent (0,0,0,1)"),
	ROW(TAN_EXISTING_REPAIRED, INFO, "i--", LOOK, NULL,
		"{count} {corner|corners} got another tangent than the input has",
		"With --existing=repair a face with an invalid tangent gets those that are computed. Without texture "
		"coordinates nothing can be computed: an invalid tangent becomes the nearest unit vector across the "
		"normal, or any across the normal if it has no direction, and w becomes 1 if the corners of a "
		"triangle do not agree; --existing=replace does the same there.",
		"Nothing; --existing=keep leaves them as they are.",
		"a triangle whose TANGENT is its NORMAL, converted with --existing=repair --only=all"),
	ROW(TAN_EXISTING_LEFT, INFO, "i--", LOOK, NULL,
		"{count} {corner has|corners have} a tangent that repair cannot make better",
		"With --existing=repair a face that is not valid as a whole stays as it is if a solve gives the same "
		"tangents, or no valid ones either: a triangle without area in UV space may have corners of either w.",
		"Unwrap these triangles.",
		"a triangle without area in UV space between a mirrored and another triangle, converted twice"),
	ROW(TAN_KEPT_SIGN, WARNING, "w--", CONVERT, "--fix",
		"{count} {triangle keeps|triangles keep} tangents whose bitangent runs the wrong way",
		"The input's tangents stay, a material uses them or the output is a PLY, and w is not that of the "
		"texture coordinates, or T and the bitangent are reversed: bumps look like dents there. On --check "
		"this is TAN_SIGN_MISMATCH, and TAN_MIXED_W_TRIANGLE where corners of a triangle have different w.",
		"Repair them.",
		"DamagedHelmet after gltfpack -gt, converted"),
	ROW(TAN_GREEN_PAIR, INFO, "w--", LOOK, "--existing=repair --flip-green=auto",
		"w is inverted on all triangles and green points down in the normal map, which cancel",
		"The exporter turned both around (Unity's do). Renderers show the surface right; to repair one of the "
		"two alone turns bumps into dents. It stands in the place of TAN_SIGN_MISMATCH and NMAP_GREEN_DOWN, "
		"and only if all meshes over the map, and all maps of these meshes, agree. A warning if a conversion "
		"changes one half.",
		"Nothing. For a program that reads the map or the tangents alone, change both.",
		"a glTF square with w = -1 and a map that was baked for DirectX"),
	ROW(TAN_MADE_BY, INFO, "i--", CONVERT, "--existing=replace",
		"the tangents are not those of MikkTSpace, which most maps are baked with",
		"The input's tangents are compared with those of the methods that exporters and engines use, on "
		"triangles and on the quads that these are halves of. A normal map is right with the tangents that "
		"it was baked with, and most are baked with MikkTSpace.",
		"If the map was baked with MikkTSpace, replace these tangents.",
		"DamagedHelmet, converted with --method=area and checked"),
	ROW(TAN_QUAD_SIGN, INFO, "i--", LOOK, NULL,
		"{count} {triangle has|triangles have} the sign of the folded quad of which {it is|they are} the "
		"smaller half",
		"The tangents were solved on quads. A quad whose halves are wound in opposite directions in texture "
		"space has one orientation to MikkTSpace, that of the larger half.",
		"Nothing if the map was baked on quads too. If on triangles, --existing=replace --quads=off "
		"solves those of a glTF; cut the quads of a PLY into triangles first.",
		"a quad with one corner folded over its diagonal in texture space, from Blender"),
	ROW(TAN_QUADS_LIKELY, INFO, "i--", CONVERT, "--quads=pairs",
		"{count} {pair|pairs} of triangles may have been {one quad|quads} when the map was baked",
		"The program that wrote the input solves tangents on quads and writes their halves as triangles. "
		"Without tangents in the input nothing proves that the map was baked so.",
		"If the normal map was baked in the program that wrote the file (Blender), solve quads.",
		"a grid from Blender without tangents, converted with --only=all"),
	ROW(TAN_QUADS_NONE, WARNING, "w-w", LOOK, NULL, "--quads=pairs changes nothing",
		"Two triangles that follow each other are a quad a b c d if they have equal vertices along their "
		"common edge and are written as (a b c)(a c d), (a b d)(b c d) or (a b c)(c d a), or as the first two "
		"with two corners of each exchanged, as exporters of Unity and Godot do. No pair of the file is; or "
		"it is no glTF: its quads are there as such.",
		"Leave the option away, or export the quads' halves one after the other.",
		"one triangle of a glTF, converted with --quads=pairs --only=all"),
};

const nt_code_row *nt_code_info(nt_code code)
{
	assert((unsigned)code < NT_CODE_COUNT);
	return &code_table[code];
}

nt_severity nt_finding_severity(const nt_finding *finding)
{
	return finding->severity ? (nt_severity)(finding->severity - 1) : nt_code_info(finding->code)->severity;
}

static const char *const severity_names[] = {"info", "warning", "error"};

const char *nt_severity_name(nt_severity severity)
{
	return severity_names[severity];
}

bool nt_severity_find(const char *name, nt_severity *severity)
{
	for (unsigned i = 0; i < 3; i++) {
		if (strcmp(severity_names[i], name) == 0) {
			*severity = (nt_severity)i;
			return true;
		}
	}
	return false;
}

/* ---- commands ---- */

const char *nt_code_condition(nt_code code)
{
	switch ((int)code) {
	case NT_CODE_NMAP_BESIDE:
		return "if it is the normal map";
	case NT_CODE_TAN_DIRECTION_MISMATCH:
	case NT_CODE_TAN_MADE_BY:
		return "if the map was baked with MikkTSpace";
	case NT_CODE_TAN_PRIMITIVE_BORDER:
		return "if the map was baked for the whole mesh";
	case NT_CODE_TAN_QUADS_LIKELY:
		return "if the map was baked in the program that wrote the file";
	case NT_CODE_TAN_UNUSED:
		return "if no normal map is set later";
	default:
		return NULL;
	}
}

bool nt_code_mends(nt_code code)
{
	const char *repair = nt_code_info(code)->repair;
	return repair && strcmp(repair, "--fix") == 0;
}

bool nt_code_is_of_kept(nt_code code)
{
	return nt_code_mends(code) && code != NT_CODE_NMAP_GREEN_DOWN && code != NT_CODE_TAN_MISSING_REQUIRED;
}

bool nt_shell_word(const char *text, nt_buffer *out)
{
	static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.,:@%+/=-";
	for (const char *c = text; *c;) {
		const size_t length = nt_utf8_length(c, SIZE_MAX);
		if (nt_utf8_is_unsafe(c, length))
			return false;
		c += length;
	}
	if (strspn(text, plain) == strlen(text)) {
		nt_buffer_text(out, text);
		return true;
	}
	nt_buffer_text(out, "'");
	for (; *text; text++)
		if (*text == '\'')
			nt_buffer_text(out, "'\\''");
		else
			nt_buffer_append(out, text, 1);
	nt_buffer_text(out, "'");
	return true;
}

static const char format_option[] = "--output-format=";

/* in.glb: "in-repaired.glb"; head.obj: "head.glb"; of standard input "OUT.glb"; or as --output-format says. */
static void put_output(const char *input, const char *given, nt_buffer *out)
{
	static const char *const endings[] = {".gltf", ".glb", ".ply"};
	const char *slash = strrchr(input, '/'), *dot = strrchr(slash ? slash : input, '.'), *ending = ".glb";
	const char *asked = given ? strstr(given, format_option) : NULL;
	asked = asked ? asked + sizeof format_option - 1 : dot ? dot + 1 : "";
	const size_t length = strcspn(asked, "\n");
	for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
		if (strlen(endings[i]) == length + 1 && strncasecmp(asked, endings[i] + 1, length) == 0)
			ending = endings[i];
	const bool stream = strcmp(input, "-") == 0, alike = dot && strcasecmp(dot, ending) == 0;
	nt_buffer_append(out, stream ? "OUT" : input, stream ? 3 : dot ? (size_t)(dot - input) : strlen(input));
	nt_buffer_format(out, "%s%s", alike ? "-repaired" : "", alike ? dot : ending);
}

/* A name that begins with a dash is no option; "-" itself is a stream. */
static bool put_path(const char *name, nt_buffer *out)
{
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s%s", name[0] == '-' && name[1] ? "./" : "", name);
	const bool put = path.data && nt_shell_word(path.data, out);
	nt_buffer_free_into(&path, out);
	return put;
}

/* Whether options have one of that name. */
static bool has_option(const char *options, const char *name, size_t length)
{
	for (; *options; options += strcspn(options, " "), options += *options == ' ')
		if (strncmp(options, name, length) == 0 && strchr("= ", options[length]))
			return true;
	return false;
}

/* Options of the user, but for those that are said anew or exclude what is said: --fix chooses by itself; or that the
 * name of the output (NULL: nobody knows it) says. */
static void put_given(const char *options, const char *given, const char *output, nt_buffer *out)
{
	const char *dot = output ? strrchr(output, '.') : NULL;
	static const char *const chosen[] = {"--existing", "--flip-green"};
	const bool fixes = has_option(options, "--fix", 5);
	for (size_t length; *given; given += length + (given[length] == '\n')) {
		const char *name = given + (*given == '\'');
		const size_t name_length = strcspn(name, "=\n");
		bool said = has_option(options, name, name_length);
		length = strcspn(given, "\n");
		const size_t word = sizeof format_option - 1;
		said |= dot && strncmp(given, format_option, word) == 0 &&
			strncasecmp(dot + 1, given + word, length - word) == 0;
		for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i++)
			said |= fixes ? has_option(chosen[i], name, name_length)
				: has_option("--fix", name, name_length) &&
					has_option(options, chosen[i], strlen(chosen[i]));
		if (!said) {
			nt_buffer_text(out, " ");
			nt_buffer_append(out, given, length);
		}
	}
}

void nt_command_text(const char *options, const char *given, const char *input, const char *output, nt_buffer *out)
{
	nt_buffer made = {0};
	if (input && !output)
		put_output(input, given, &made);
	nt_buffer_text(out, "nmtan");
	if (given)
		put_given(options, given, made.data ? made.data : output, out);
	nt_buffer_format(out, "%s%s ", *options ? " " : "", options);
	const size_t before = out->size;
	const bool alone = output && !*output;
	bool put = input && *input && put_path(input, out);
	nt_buffer_text(out, alone ? "" : " ");
	put = put && (alone || ((output || made.data) && put_path(output ? output : made.data, out)));
	if (!put) {
		out->size = before;
		nt_buffer_text(out, alone ? "IN" : "IN OUT");
	}
	nt_buffer_free_into(&made, out);
}

void nt_remedy_text(nt_code code, const char *options, const char *given, const char *input, nt_buffer *out)
{
	const char *remedy = nt_code_info(code)->remedy;
	const size_t length = strlen(remedy);
	if (!options) {
		nt_buffer_text(out, remedy);
		nt_buffer_text(out, nt_code_mends(code) ? " nmtan cannot do it here." : "");
		return;
	}
	nt_buffer_append(out, remedy, length - (length && remedy[length - 1] == '.'));
	nt_buffer_text(out, ": ");
	nt_command_text(options, given, input, NULL, out);
}

/* ---- sentences ---- */

/* Appends what stands for the braces [open, close): {count}, {detail} or {one|many}. */
static void expand_braces(const char *open, const char *close, size_t count, const char *detail,
	nt_buffer *out)
{
	const size_t length = (size_t)(close - open);
	const char *bar = memchr(open, '|', length);
	if (length == 5 && memcmp(open, "count", 5) == 0)
		nt_buffer_format(out, "%zu", count);
	else if (length == 6 && memcmp(open, "detail", 6) == 0)
		nt_buffer_text(out, detail);
	else if (bar && count == 1)
		nt_buffer_append(out, open, (size_t)(bar - open));
	else if (bar)
		nt_buffer_append(out, bar + 1, (size_t)(close - bar - 1));
}

void nt_code_sentence(nt_code code, size_t count, const char *detail, nt_buffer *out)
{
	const char *text = nt_code_info(code)->message;
	const bool detail_follows = detail && *detail && !strstr(text, "{detail}");
	for (const char *open; (open = strchr(text, '{')) != NULL;) {
		const char *close = strchr(open, '}');
		assert(close);
		nt_buffer_append(out, text, (size_t)(open - text));
		expand_braces(open + 1, close, count, detail ? detail : "", out);
		text = close + 1;
	}
	nt_buffer_text(out, text);
	if (detail_follows) {
		nt_buffer_text(out, ": ");
		nt_buffer_text(out, detail);
	}
}

void nt_codes_list(nt_buffer *out)
{
	for (unsigned i = 0; i < NT_CODE_COUNT; i++) {
		const nt_code_row *row = &code_table[i];
		nt_buffer_format(out, "%-26s %-8s %s\n", row->name, nt_severity_name(row->severity),
			row->meaning);
	}
}
