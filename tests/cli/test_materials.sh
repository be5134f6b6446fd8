# SPDX-License-Identifier: MIT
# Materials of an OBJ: what the statements of an MTL become in glTF. Expected numbers are those of the formulas in the man
# page, worked out in materials.tsv or here.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/support/mtl.sh"

# Converts the quad with these lines; the validator has nothing to say against it.
convert() {
	quad "$@"
	run --verify quad.obj quad.glb
	exits 0
	echo "$PWD/quad.glb" >pairs
	valid --pairs pairs
}

# The images that materials.tsv names: width and height, and the samples.
mkdir "$WORK/images"
while read -r name width height samples; do
	images write "$WORK/images/$name" "$width" "$height" "$samples"
done <<'END'
r.png 4 4 10 * x + y
m.tga 4 4 (5 * y, 5 * y, 5 * y)
o.png 4 4 (99, 20 * x, 0)
x.tga 4 4 (x, x, x)
orm.png 8 8 (9 * x, 9 * y, x * y)
grey.png 8 8 9 * x
small.png 2 2 (200 if x else 100)
flat.png 4 1 40 * x
wide.png 4 4 ("16", 1000 * x)
10x.png 4 4 10 * x
10y.png 4 4 10 * y
51x.png 4 4 51 * x
c.png 4 4 (10 * x, 20 * y, 100)
c30.png 4 4 (10 * x, 20 * y, 30)
d.tga 4 4 (60 * x, 60 * x, 60 * x)
holes.png 4 4 255 * (x % 2)
white.png 4 4 255
late.png 4 4 255 if y < 3 or x < 2 else 128
leaf.png 8 8 (9, 8, 7, 255 * (x > y))
solid.png 4 4 (60 * x, 60 * x, 60 * x, 255)
last.png 4 4 (99, 99, 99, 0 if x == y == 3 else 255)
rim.png 8 8 128 if y == 0 and x < 3 else 15 if x < 4 else 240
column.png 1 4 0
two.png 1 2 200 * y
rims.png 8 8 128 if y == 0 and x < 4 else 15 if x < 4 else 240
near.png 8 8 (9 * x, 9 * x, 9 * x + y % 2)
orm.tga 8 8 (9 * x, 9 * y, x * y)
20000x1.png 20000 1 (9, 9, 9)
1x20000.png 1 20000 (9, 9, 9)
END
cp "$data/grey.jpg" "$WORK/images/"
head -c 30 "$WORK/images/10x.png" >"$WORK/images/short.png"

# Asked is what the run says or does not say, which file image 0 has the bytes of, a Python expression over the rows of its
# samples, or a JavaScript expression over the document g and its material m.
while IFS=$'\t' read -r name statements question answer; do
	case $name in "#"*) continue ;; .) ;; *)
		scene "$name"
		cp "$WORK"/images/* .
		;;
	esac
	if [ "$statements" != . ]; then
		IFS='|' read -ra lines <<<"$statements"
		convert "${lines[@]}"
	fi
	case $question in
	says | says_not) "$question" "$answer" ;;
	copy)
		images embedded quad.glb 0 made.png
		same "$answer" made.png
		;;
	samples*)
		images embedded quad.glb 0 made.png
		is "$(images rows made.png "${question#samples }")" "$answer"
		;;
	*) is "$(gltf quad.glb "((m) => $question)(g.materials[0])")" "$answer" ;;
	esac
done <"$ROOT/tests/cli/materials.tsv"

scene "a packed image is told with all images that it is made of"
cp "$WORK"/images/* .
quad "map_Pr r.png" "map_ao -imfchan g o.png" "map_Pm r.png"
run -q --check --report-format=lines --report=lines --fail-on=never quad.obj
grep -q "image was converted: channels of o.png, r.png put together as o-orm.png" lines || wrong "$(grep CONVERTED lines)"

scene "anisotropy asks for tangents, in the OBJ and in what is made of it"
quad "aniso 0.5"
run --check --report-format=json --report=r.json quad.obj
is "$(value r.json 'r["files"][0]["meshes"][0]["slots"]')" "['anisotropy']"
run quad.obj quad.glb
is "$(gltf quad.glb 'g.meshes[0].primitives[0].attributes.TANGENT !== undefined')" true
run --check --fail-on=warning quad.glb
exits 0
sed '/^vt/d; s|^f .*|f 1 2 3 4|' quad.obj >bare.obj
run bare.obj bare.glb
says "TAN_NO_UV"
is "$(gltf bare.glb 'g.materials[0].extensions')" undefined

scene "images that no texture coordinates lay on the faces are told, of a library and of options"
cp "$WORK/images/51x.png" .
quad "map_Kd 51x.png" "norm 51x.png"
sed '/^vt/d; s|^f .*|f 1 2 3 4|' quad.obj >bare.obj
run bare.obj bare.glb
exits 0
says 'm.mtl:2: material "m": warning: 2 properties of materials are not carried over: 51x.png and the others: the faces have no texture coordinates, by which images lie on them [MATERIAL_LOST]'
is "$(gltf bare.glb 'g.images')" undefined
run -q bare.obj bare.glb
says 'material "m" has none of its images'
sed -i '/mtl/d' bare.obj
run bare.obj bare.ply
for option in --base-color --normal-map --occlusion; do
	for input in bare.obj bare.ply; do
		run $option=51x.png $input bare.glb
		says "$input: warning: 1 property of a material is not carried over: 51x.png: the faces have no texture coordinates"
	done
done

scene "materials whose maps are the same share the image, others do not"
cp "$WORK"/images/* .
while IFS='|' read -r count first second; do
	mapfile -t lines < <(printf '%s\n' "$first" "newmtl second" "$second" | tr ';' '\n')
	quad "${lines[@]}"
	{ cat quad.obj; echo "usemtl second"; grep '^f' quad.obj; } >both.obj
	run both.obj both.glb
	exits 0
	is "$first|$second: $(gltf both.glb '[g.images.length, g.materials.length]')" "$first|$second: [$count,2]"
done <<'END'
1|map_Pr m.tga;map_Pm x.tga|map_Pm ./x.tga;map_Pr ./m.tga;Pr 0.5
1|norm orm.tga;map_Ke orm.tga|norm ./orm.tga
1|map_Pr -mm 0 0.5 x.tga|map_Pr -mm -0 0.5 x.tga
1|map_Pr -mm 0.5 0 x.tga|map_Pr -mm 0.5 -0 x.tga
1|map_Bump -bm 0 10x.png|map_Bump -bm -0 10x.png
2|map_Pr -mm 0 0.5 x.tga|map_Pr -mm 0.1 0.5 x.tga
2|map_Pr -mm 0 0.5 x.tga|map_Pr -mm 0 0.25 x.tga
2|map_Pr -imfchan r c.png|map_Pr -imfchan g c.png
2|Ns 1000;map_Ns 51x.png|Ns 100;map_Ns 51x.png
2|map_Ps 51x.png|map_Pr 51x.png
2|map_Pr small.png;map_Pm flat.png|map_Pr -clamp on small.png;map_Pm -clamp on flat.png
2|map_Pr x.tga;map_Pm m.tga|map_Pr m.tga;map_Pm x.tga
2|map_Bump -bm 2 10x.png|map_Bump -bm 3 10x.png
2|map_Bump 10x.png|map_Bump -clamp on 10x.png
END

scene "damaged values without which a material can do are not used, with a finding"
quad "Ka a b c" "Ns big" "Ni"
run -v quad.obj quad.glb
exits 0
for word in Ka Ns Ni; do says "info: 1 statement was not used: MTL: $word [STATEMENT_IGNORED]"; done
is "$(gltf quad.glb 'g.materials[0].pbrMetallicRoughness')" '{"metallicFactor":0}'

scene "texture coordinates that a map's scale makes infinite do not end a check"
printf 'newmtl m\nnorm -s 4 4 n.png\n' >m.mtl
printf '%s\n' 'mtllib m.mtl' 'usemtl m' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 1 1 0' 'vt 0 0' 'vt 3e38 0' 'vt 0 3e38' 'vt 0 1' 'vt 1 0' \
	'f 1/1 2/3 3/2' 'f 2/1 4/5 3/4' >far.obj
run --check --fail-on=never far.obj
exits 0
prints "2 UV islands"

scene "if normal maps are mirrored in other ways, their faces are meshes of their own"
for case in '-s 2 3:1' '-s -1 1:2' '-s 1 -2:2' '-s -1 -1:2' '-o 0.5 0:1'; do
	quad "norm n.png" "newmtl second" "norm ${case%:*} n.png"
	{ cat quad.obj; echo "usemtl second"; grep '^f' quad.obj; } >both.obj
	run both.obj both.glb
	exits 0
	is "${case%:*}:$(gltf both.glb 'g.meshes.length')" "$case"
done

scene "libraries of Blender have its own formula, and its maps"
cp "$WORK/images/51x.png" .
quad "Ns 250" "Pm 0" "map_refl 51x.png"
sed -i '1i # Blender 3.6.5 MTL File: "x.blend"' m.mtl
run quad.obj quad.glb
exits 0
is "$(gltf quad.glb 'g.materials[0].pbrMetallicRoughness')" '{"metallicRoughnessTexture":{"index":0},"roughnessFactor":0.5}'

scene "a bump map of one channel is that channel's"
images write h.png 8 8 '(0, abs(4 - x) * 16, 0)'
convert "bump -imfchan g h.png"
images embedded quad.glb 0 first.png
images write g.png 8 8 'abs(4 - x) * 16'
convert "bump g.png"
images embedded quad.glb 0 second.png
images write twice.png 8 8 'abs(4 - x) * 32'
convert "bump -mm 0 0.5 twice.png"
images embedded quad.glb 0 third.png
same first.png second.png
same first.png third.png

scene "a check of the OBJ finds what its conversion finds"
images write r.tga 4 4 '(x, x, x)'
head -c 20 r.tga >short.tga
quad "map_Kd gone.png" "map_Pr r.tga" "d 0" "disp h.png" "map_Pm short.tga"
run --fail-on=warning quad.obj quad.glb
exits 6
grep -o '\[[A-Z_]*\]' ../err.txt | sort >converted
run --check --fail-on=warning quad.obj
exits 6
grep -o '^  warning  *[A-Z_]*' ../out.txt | sed 's/.* \(.*\)/[\1]/' | sort >checked
same converted checked

scene "without its coat a roughness of the coat is in no image, and nothing is said to have become one"
images write c.png 4 4 '10 * x'
head -c 30 c.png >short.png
for coat in gone.png short.png; do
	for place in "" "-s 2 2 1"; do
		convert "map_Pc $coat" "map_Pcr $place c.png"
		says "$coat"
		says_not "c-clearcoat.png"
		is "$(gltf quad.glb '"images" in g')" false
		convert "Pc 0.5" "map_Pc $coat" "map_Pcr $place c.png"
		is "$(gltf quad.glb 'g.images.length')" 1
	done
done

scene "an image that is used as a colour and as a normal map that stays is one image"
images write n.png 16 16 '(128, 128, 255)'
quad "map_Kd n.png" "norm n.png"
for how in auto:1 on:2; do
	run --flip-green=${how%:*} quad.obj quad.glb
	is "$how $(gltf quad.glb 'g.images.length')" "$how ${how#*:}"
done

scene "a library of which no usemtl takes anything gives its first material"
quad "Kd 1 0 0" "newmtl second" "Kd 0 1 0"
sed -i /^usemtl/d quad.obj
run -v --verify quad.obj quad.glb
exits 0
says 'm.mtl:1: info: no usemtl: all faces have the first material of the library: m, the first of 2 [MATERIAL_FIRST]'
is "$(gltf quad.glb '[g.materials.length, g.materials[0].name, g.materials[0].pbrMetallicRoughness, g.meshes[0].primitives[0].material]')" \
	'[1,"m",{"baseColorFactor":[1,0,0,1],"metallicFactor":0},0]'
sed -i '$i usemtl ghost' quad.obj
run quad.obj quad.glb
is "$(gltf quad.glb 'g.materials[0].name')" ghost

scene "what has no material gets a neutral one, since glTF's default is metal"
grep -v '^mtllib\|^usemtl' "$data/quad.obj" >quad.obj
grep -v '^vt' quad.obj | sed 's|^f .*|f 1 2 3 4|' >bare.obj
cp "$data/quad_ascii.ply" quad.ply
for file in quad.obj bare.obj quad.ply; do
	run --verify "$file" "${file%.*}.gltf"
	exits 0
	is "$(gltf "${file%.*}.gltf" '[g.materials, g.meshes[0].primitives[0].material]')" \
		'[[{"pbrMetallicRoughness":{"metallicFactor":0}}],0]'
done

# Quads around (0.5, 0.5), (1.5, 0.5), (3.5, 2.5), (-0.5, 0.5): tiles 1001, 1002, 1024 and none. A line has its corners on
# both borders of 1002. The fan of four triangles has them in 1001, too: each face goes where its centre lies. The last quad
# lies elsewhere if that is said.
udim_obj() {
	echo 'mtllib m.mtl'
	for corner in '0.1 0.1' '1.0 0.1' '3.2 2.2' "${1--0.8 0.3}"; do
		set -- $corner
		awk -v u="$1" -v v="$2" 'BEGIN { for (i = 0; i < 4; i++) {
			x = (i == 1 || i == 2); y = (i > 1); printf "v %g %g 0\nvt %g %g\n", u + x, v + y, u + x * (u == 1 ? 1 : 0.5), v + y * 0.5 } }'
	done
	printf 'usemtl m\nf 5/5 6/6 7/7 8/8\nf 1/1 2/2 3/3\nf 9/9 10/10 11/11 12/12\nusemtl plain\nf 1/1 3/3 4/4\nusemtl m\nf 13/13 14/14 15/15 16/16\n'
}
drawn='g.meshes[0].primitives.map((p) => [g.materials[p.material].name, g.accessors[p.indices].count / 3, (g.images[g.textures[g.materials[p.material].pbrMetallicRoughness.baseColorTexture?.index]?.source] ?? {}).uri])'

scene "UDIM: a material for each tile that faces lie in, with its images"
udim_obj >t.obj
for tile in 1001 1002 1024; do
	images write body.$tile.png 4 4 "($tile - 1000, 0, 0)"
	mkdir -p nrm.$tile
	images write nrm.$tile/$tile.png 4 4 '(128, 128, 255)'
done
printf 'newmtl m\nmap_Kd -clamp on body.<UDIM>.png\nnorm nrm.<UDIM>/<UDIM>.png\nnewmtl plain\n' >m.mtl
for threads in 1 2; do
	run --threads=$threads t.obj t.gltf
	exits 0
	says "m.mtl:2: warning: 1 property of a material is not taken at its word: MTL: body.<UDIM>.png has no tile for 1 face, which shows tile 1001: u is not in 0 to 10, or v is below 0 [MATERIAL_DOUBTFUL]"
	is "$(gltf t.gltf "$drawn")" \
		'[["m.1002",2,"body.1002.png"],["m.1001",3,"body.1001.png"],["m.1024",2,"body.1024.png"],["plain",1,null]]'
	is "$(gltf t.gltf '[g.images.length, (g.samplers ?? []).length, g.materials[0].normalTexture.index]')" '[6,0,1]'
done
rm body.1024.png
run t.obj t.gltf
says 'm.mtl:2: material "m.1024": warning: image cannot be read: body.1024.png'
while read -r u v last; do
	udim_obj "$u $v" >t.obj
	run t.obj t.gltf
	is "$u $v $(gltf t.gltf 'g.materials.slice(4).map((m) => m.name)') $(grep -c 'has no tile for 1 face' ../err.txt)" "$u $v $last"
done <<'END'
9.1 0.1 ["m.1010"] 0
10.1 0.1 [] 1
0.1 99.1 ["m.1991"] 0
0.1 100.1 [] 1
0.1 -0.8 [] 1
END

scene "a tile's number in a name is taken at its word, and faces in other tiles are a finding"
udim_obj >t.obj
images write body.1001.png 4 4 '(1, 0, 0)'
printf 'newmtl m\nmap_Kd body.1001.png\nnewmtl plain\n' >m.mtl
run t.obj t.gltf
exits 0
says "m.mtl:2: warning: 1 property of a material is not taken at its word: MTL: body.1001.png is the image of one tile, and faces in the tiles 1001 to 1024 show it; for an image each, write <UDIM> in place of 1001 [MATERIAL_DOUBTFUL]"
is "$(gltf t.gltf "$drawn")" '[["m",7,"body.1001.png"],["plain",1,null]]'
{ sed '/^f/d' t.obj; echo 'usemtl m'; grep '^f [159]' t.obj | tac; } >back.obj
run back.obj t.gltf
says "faces in the tiles 1001 to 1024 show it"
printf 'mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 0\nvt 2 0\nvt 1 1\nf 1/1 2/2 3/3\n' >one.obj
run one.obj t.gltf
says_not warning
for name in body.1001.png:1 body_1001.png:1 body1001.png:0 body.10011.png:0 body.2001.png:0 body.1001-a.png:0 1001.png:0; do
	printf 'newmtl m\nmap_Kd %s\nnewmtl plain\n' "${name%:*}" >m.mtl
	run t.obj t.gltf
	is "$name $(grep -c 'is the image of one tile' ../err.txt)" "$name ${name#*:}"
done

scene "mirrored islands share texels with those that show the same image, not with another tile or material"
for tile in 1001 1002; do images write body.$tile.png 4 4 "($tile - 1000, 0, 0)"; done
for row in 'body.<UDIM>.png|body.<UDIM>.png|0 1' 'body.1001.png|body.1002.png|0 1' 'body.1001.png|body.1001.png|1 0'; do
	IFS='|' read -r first second want <<<"$row"
	printf 'newmtl a\nmap_Kd %s\nnewmtl b\nmap_Kd %s\n' "$first" "$second" >m.mtl
	printf '%s\n' 'mtllib m.mtl' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'v 3 0 0' 'v 4 0 0' 'v 4 1 0' 'v 3 1 0' \
		'vt 0.1 0.1' 'vt 0.9 0.1' 'vt 0.9 0.9' 'vt 0.1 0.9' 'vt 1.9 0.1' 'vt 1.1 0.1' 'vt 1.1 0.9' 'vt 1.9 0.9' \
		'usemtl a' 'f 1/1 2/2 3/3 4/4' 'usemtl b' 'f 5/5 6/6 7/7 8/8' >tiles.obj
	run -q --check --report=r.json tiles.obj
	codes=$(value r.json '[f["code"] for f in r["files"][0]["findings"]]')
	is "$second $(grep -o UV_MIRROR_OVERLAP <<<"$codes" | wc -l) $(grep -o UV_MIRROR_LONE <<<"$codes" | wc -l)" "$second $want"
done

scene "the same bytes for every number of threads"
for i in 1 2 3 4; do images write "$i.tga" 64 $((i * 16)) '(x + y, x, y)'; done
quad "map_Kd 1.tga" "map_d 2.tga" "map_Pr 3.tga" "map_Pm 4.tga" "map_Ke 2.tga"
run -j1 quad.obj one.glb
exits 0
run -j8 quad.obj eight.glb
same one.glb eight.glb

scene "a map that names no file is told as that"
for name in . .. tex/; do
	quad "map_Kd $name"
	run quad.obj quad.glb
	exits 0
	says "image cannot be read: $name (no file is named) [IMAGE_MISSING]"
done

done_testing
