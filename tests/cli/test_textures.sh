# SPDX-License-Identifier: MIT
# Images of materials: found, converted, made normal maps, linked, copied or embedded.
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/support/mtl.sh"

# A normal map of gentle bumps, by a formula.
bumps='(128 + (7 * x) % 60, 128 - (5 * y) % 60, 240)'

scene "a TGA normal map arrives, pixel by pixel as its PNG twin"
images write n.tga 32 16 "$bumps"
images write twin.png 32 16 "$bumps"
quad "norm n.tga"
run quad.obj quad.glb
exits 0
says "n.tga became n.png (embedded)"
run --check quad.obj
says_not "became"
is "$(gltf quad.glb '[g.images[0].mimeType, g.materials[0].normalTexture.index]')" '["image/png",0]'
images embedded quad.glb 0 made.png
is "$(images rows made.png)" "$(images rows twin.png)"

scene "beside a .gltf what was converted is a file, also where other images are linked"
images write n.tga 32 16 "$bumps"
images write b.bmp 8 8 '(x * 9, y * 9, 3)'
cp b.bmp .e # which is no ending
quad "norm n.tga" "map_Kd b.bmp" "map_Ke .e"
mkdir out
run quad.obj out/quad.gltf
exits 0
says "; b.bmp became b.png, .e became .e.png, n.tga became n.png"
is "$(ls out)" "b.png
n.png
quad.bin
quad.gltf"
is "$(images rows out/b.png 'rows[1][2]')" "[18, 9, 3]"
cp -r out before
run quad.obj out/quad.gltf
exits 0
same before/n.png out/n.png
is "$(ls out | wc -l)" 4

scene "--check and a dry run, which make no image, say of images what a conversion says"
images write h.tga 32 16 '(x * 8, x * 8, x * 8)'
images write n.tga 32 16 "$bumps"
images write opaque.png 4 4 '(9, 9, 9, 255)'
images write clear.png 4 4 '(9, 7, 8, x * 80)'
printf 'no image' >broken.tga
head -c 400 h.tga >short.tga
codes() {
	value r.json 'sorted((f["code"], f.get("detail", f["message"])) for f in r["files"][0]["findings"] if f["code"].startswith(("IMAGE", "BUMP")))'
}
for lines in "map_Bump -bm 3 h.tga" "map_Bump h.tga|map_Kd clear.png" "norm n.tga|map_d clear.png|map_Kd opaque.png" \
	"map_Kd opaque.png|map_d -imfchan m opaque.png" "map_Pr short.tga|map_Pm -imfchan g n.tga" "norm short.tga" \
	"map_Kd -mm 0.1 0.5 opaque.png|map_Pr broken.tga"; do
	for words in "" --flip-green=on --textures=keep --textures=png; do
		mapfile -t split < <(tr '|' '\n' <<<"$lines")
		quad "${split[@]}"
		# shellcheck disable=SC2086
		run --report=r.json $words quad.obj out.gltf
		made=$(codes)
		for how in "--check --output-format=gltf" "--dry-run"; do
			# shellcheck disable=SC2086
			run --report=r.json $words $how quad.obj $([ "$how" = --dry-run ] && echo dry.gltf)
			is "$how $lines $words: $(codes)" "$how $lines $words: $made"
		done
	done
done
[ ! -e dry.gltf ] || wrong "a dry run wrote"

scene "a TIFF with a palette has its colours"
images write p.tif 3 2 '100 * x + y'
quad "map_Kd p.tif"
run quad.obj quad.gltf
exits 0
is "$(images rows "$(gltf quad.gltf 'g.images[0].uri' | tr -d '"')")" \
	"[[[0,0,255],[100,100,155],[200,200,55]],[[1,1,254],[101,101,154],[201,201,54]]]"
# of a grey and two things more the grey
PYTHONPATH=$ROOT/tests/support python3 -c "import images
open('g.tif', 'wb').write(images.tif_of(bytes(range(12)), b'', [(256, 4, 1, 2), (257, 4, 1, 2), (258, 3, 1, 8), (259, 3, 1, 1),
	(262, 3, 1, 1), (273, 4, 1, 8), (277, 3, 1, 3), (278, 4, 1, 2), (279, 4, 1, 12)]))"
quad "map_Kd g.tif"
run quad.obj quad.gltf
is "$(images rows g.png)" "[[[0,0,0,255],[3,3,3,255]],[[6,6,6,255],[9,9,9,255]]]"

scene "a name that is taken by another file stays with that"
images write n.tga 32 16 "$bumps"
images write n.png 2 2 '(1, 2, 3)'
cp n.png before.png
quad "norm n.tga"
run quad.obj quad.gltf
exits 0
same n.png before.png
says "n.tga became n-"
is "$(gltf quad.gltf 'g.images[0].uri.length')" 22

scene "an image that needs no change is not decoded, and has the bytes that it had"
printf '\211PNG\r\n\032\n and nothing that a decoder would take' >c.png
quad "map_Kd c.png"
run quad.obj quad.glb
exits 0
is "$(wc -l <"$WORK/err.txt")" 1
images embedded quad.glb 0 made.png
same c.png made.png

scene "--textures=keep leaves out what glTF does not carry, and says so"
images write n.tga 32 16 "$bumps"
quad "norm n.tga"
run --textures=keep quad.obj quad.glb
exits 0
says "IMAGE_TYPE"
is "$(gltf quad.glb 'g.images')" undefined

scene "--textures=png makes PNG of everything that can be decoded"
cp "$data/grey.jpg" j.jpg # 8 x 8 of 100, by libjpeg
quad "map_Kd j.jpg"
run quad.obj quad.glb
is "$(gltf quad.glb 'g.images[0].mimeType')" image/jpeg
run --textures=png quad.obj quad.glb
exits 0
says "j.jpg became j.png"
is "$(gltf quad.glb 'g.images[0].mimeType')" image/png
images embedded quad.glb 0 made.png
is "$(images rows made.png | cut -c1-24)" "[[[100],[100],[100],[100"
quad "map_Pr j.jpg" # which has all channels that are looked at
run --textures=png quad.obj quad.glb
is "$(gltf quad.glb 'g.images[0].mimeType')" image/png

scene "one grey of a PNG may be clear"
images write c.png 4 4 '(10 * x, 20 * y, 30)'
for wide in 0 1; do
	PYTHONPATH=$ROOT/tests/support python3 -c "import images, struct
open('t.png', 'wb').write(images.png(4, 4, lambda x, y: ('16', 257 * 60 * x) if $wide else 60 * x,
	images.chunk(b'tRNS', struct.pack('>H', (257 * 60 if $wide else 60)))))"
	quad "map_Kd c.png" "map_d t.png"
	run quad.obj quad.glb
	images embedded quad.glb 0 made.png
	is "$(images rows made.png '[p[3] // (257 if '$wide' else 1) for p in rows[1]]')" "[255, 0, 255, 255]"
done

scene "a damaged image is left out with a finding"
images write n.tga 32 16 "$bumps"
head -c 1000 n.tga >short.tga
quad "norm short.tga" "map_Kd short.tga"
run quad.obj quad.glb
exits 0
says "IMAGE_DAMAGED"
says "ends before its last pixel"
is "$(gltf quad.glb 'g.images')" undefined
printf 'version https://git-lfs.github.com/spec/v1\noid sha256:%064d\nsize 12345\n' 0 >lfs.png
quad "norm lfs.png"
run --images=link quad.obj quad.glb
says "image cannot be read: lfs.png (Git LFS's pointer to the file, not the file itself: git lfs pull brings it)"

scene "an image of absurd size is left out before it takes memory"
printf '\0\0\2\0\0\0\0\0\0\0\0\0\377\377\377\377\30\40' >huge.tga
quad "map_Kd huge.tga"
run quad.obj quad.glb
exits 0
says "65535 x 65535"

# ---- finding ----

scene "a path of another machine is found by its longest end, and that is said"
mkdir -p art/tex tex
images write art/tex/n.png 4 4 "$bumps"
images write tex/n.png 8 8 "$bumps"
images write n.png 16 16 "$bumps"
quad 'norm D:\old\art\tex\n.png'
run quad.obj quad.gltf
exits 0
says "D:/old/art/tex/n.png is art/tex/n.png [IMAGE_ELSEWHERE]"
is "$(gltf quad.gltf 'g.images[0].uri')" art/tex/n.png
rm -r art
run quad.obj quad.gltf
is "$(gltf quad.gltf 'g.images[0].uri')" tex/n.png
quad 'norm /art/of/somebody/n.png'
run quad.obj quad.gltf
is "$(gltf quad.gltf 'g.images[0].uri')" n.png

scene "of a long path the last parts are looked for, and what no file can be called is nowhere"
mkdir tex
images write tex/n.png 4 4 "$bumps"
quad "norm /$(printf 'a/%.0s' $(seq 40))tex/n.png"
run quad.obj quad.gltf
says "IMAGE_ELSEWHERE"
is "$(gltf quad.gltf 'g.images[0].uri')" tex/n.png
quad "norm $(printf 'a/%.0s' $(seq 3000))n.png"
run quad.obj quad.gltf
exits 0
says "IMAGE_MISSING"

scene "case counts last"
mkdir Tex
images write Tex/N.PNG 4 4 "$bumps"
quad 'norm tex\n.png'
run quad.obj quad.gltf
exits 0
says "IMAGE_ELSEWHERE"
is "$(gltf quad.gltf 'g.images[0].uri')" Tex/N.PNG
images write n.png 4 4 "$bumps"
run quad.obj quad.gltf
is "$(gltf quad.gltf 'g.images[0].uri')" n.png

scene "--texture-path names more folders, in their order"
mkdir -p in a b/sub
images write a/n.png 4 4 "$bumps"
images write b/sub/n.png 8 8 "$bumps"
quad 'norm sub/n.png'
mv quad.obj m.mtl in
run in/quad.obj in/quad.gltf
exits 0
says "IMAGE_MISSING"
run --texture-path=a --texture-path=b in/quad.obj in/quad.gltf
exits 0
is "$(gltf in/quad.gltf 'g.images[0].uri')" n.png
same in/n.png a/n.png
rm in/n.png
run --images=link --texture-path=b --texture-path=a in/quad.obj in/quad.gltf
is "$(gltf in/quad.gltf 'g.images[0].uri')" ../b/sub/n.png
says "m.mtl:2: material \"m\": warning: reference leaves the folder of the output: n.png, as --images=link asks [LINK_LEAVES]"
run --texture-path=nowhere in/quad.obj in/quad.gltf
exits 1
says "nowhere"

scene "images that are named on the command line are those of a file without material, wherever they are"
mkdir in art
for name in c n o e; do images write art/$name.png 4 4 "(10 * x, 20 * y, 200)"; done
images write art/orm.png 4 4 "(9, 10 * x, 20 * y)"
grep -v "^mtllib\|^usemtl" "$data/quad.obj" >in/quad.obj
cp "$data/quad_ascii.ply" in/quad.ply
for file in quad.obj quad.ply; do
	run --verify --base-color=art/c.png --normal-map=art/n.png --metallic-roughness="$PWD/art/orm.png" \
		--occlusion=art/o.png --emissive=art/e.png in/$file "in/$file.glb"
	exits 0
	is "$(gltf "in/$file.glb" 'Object.entries(g.materials[0]).map(([k, v]) => [k, v, g.images.map((i) => i.name)[v.index]])')" \
		'[["emissiveFactor",[1,1,1],null],["emissiveTexture",{"index":1},"e"],["normalTexture",{"index":3},"n"],["occlusionTexture",{"index":2},"o-orm"],["pbrMetallicRoughness",{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":2}},null]]'
	images embedded "in/$file.glb" 2 made.png
	is "$(images rows made.png "rows[1][3]")" "[30, 30, 20]"
	is "$(gltf "in/$file.glb" 'g.meshes[0].primitives[0].attributes.TANGENT !== undefined')" true
done
run --only=needed --normal-map=art/n.png in/quad.obj in/needed.glb
is "$(gltf in/needed.glb 'g.meshes[0].primitives[0].attributes.TANGENT !== undefined')" true
run --normal-map=art/n.png in/quad.obj in/copied.gltf
is "$(gltf in/copied.gltf 'g.images[0].uri')" n.png
same in/n.png art/n.png
run --images=link --normal-map=art/n.png in/quad.obj in/linked.gltf
is "$(gltf in/linked.gltf 'g.images[0].uri')" ../art/n.png
run --bump=height --normal-map=art/c.png in/quad.obj in/heights.glb
says "c.png, taken as heights, became c-normal.png"

scene "they replace the maps of the only material, and go nowhere else"
images write n.png 4 4 "(10 * x, 20 * y, 200)"
images write o.png 4 4 "(90, 20 * y, 200)"
quad "Kd 1 0 0" "norm -s -1 1 1 o.png" "map_d o.png"
run --images=link quad.obj old.gltf
run --images=link --normal-map=n.png --base-color=n.png quad.obj new.gltf
exits 0
is "$(gltf new.gltf '[g.images[0].uri, g.materials[0].alphaMode, g.materials[0].pbrMetallicRoughness.baseColorFactor]')" '["n.png",null,[1,0,0,1]]'
is "$(gltf new.gltf 'g.materials[0].normalTexture.extensions')" "$(gltf old.gltf 'g.materials[0].normalTexture.extensions')"
same old.bin new.bin
refused() {
	local said=$1
	shift
	run "$@"
	exits 1
	says "$said"
}
refused "--normal-map: 'gone.png' is not there" --normal-map=gone.png quad.obj new.gltf
refused "--emissive: 'quad.obj' is no image" --emissive=quad.obj quad.obj new.gltf
refused "--occlusion is for glTF made from OBJ, PLY or Draco" --occlusion=n.png old.gltf new.gltf
refused "--normal-map is for glTF made" --normal-map=n.png quad.obj new.ply
printf 'newmtl two\n' >>m.mtl
sed 's/^f .*/f 1\/1 2\/2 3\/3\nusemtl two\nf 1\/1 3\/3 4\/4/' quad.obj >two.obj
refused "--base-color is for an input with one material or none; it has 2" --base-color=n.png two.obj new.gltf

scene "of several the one that the manual names first is proposed, and all are named; one that is given is looked at"
grep -v "^mtllib\|^usemtl" "$data/quad.obj" >head.obj
cp "$data/bumps.png" "head_nm.png"
cp "$data/bumps.png" "head_a b.png"
cp "$data/bumps.png" "head_nm_tangent.png"
run head.obj head.glb
says "head_nm_tangent.png, or head_nm.png [NMAP_BESIDE]; if it is the normal map: nmtan --normal-map=head_nm_tangent.png head.obj head.glb"
images write sphere.png 64 64 '(lambda a, b: tuple(round(127.5 + 127.5 * c) for c in (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a))))(x / 64 * math.pi, y / 32 * math.pi)'
run --normal-map=sphere.png head.obj head.glb
says "warning: normal map in object space [NMAP_OBJECT_SPACE]"
run --check-maps=off --normal-map=sphere.png head.obj head.glb
says_not NMAP_OBJECT_SPACE

scene "what is called like a normal map of the input is proposed, and not taken"
grep -v "^mtllib\|^usemtl" "$data/quad.obj" >head.obj
for name in head.png head2_n.png headn.png head_n.txt head_diffuse.png; do cp "$data/bumps.png" $name; done
run head.obj head.glb
says_not NMAP_BESIDE
for name in Head_NM_Tangent.tga head_normal.png head-nrm.jpg head_ddn.png head_n.png; do
	cp "$data/bumps.png" $name
	run head.obj head.glb
	says "head.obj: info: no normal map, but an image beside the input is named like one: $name [NMAP_BESIDE]; if it is the normal map: nmtan --normal-map=$name head.obj head.glb"
	is "$(gltf head.glb '"images" in g')" false
	run -d out head.obj
	says_not NMAP_BESIDE
	run --fail-on=warning head.obj head.glb
	exits 0
	run --min-severity=warning head.obj head.glb
	says_not NMAP_BESIDE
	run --normal-map=$name head.obj head.glb
	says_not NMAP_BESIDE
	rm $name
done

scene "what lies outside is not looked at without leave"
mkdir in
images write n.png 4 4 "$bumps"
ln -s ../n.png in/link.png
quad 'norm ../n.png' 'map_Kd link.png'
mv quad.obj m.mtl in
run --outside=no in/quad.obj quad.gltf
exits 0
says "--outside=yes"
is "$(gltf quad.gltf 'g.images')" undefined
run --outside=yes in/quad.obj quad.gltf
is "$(gltf quad.gltf 'g.images.length')" 2

# Names that leave the folder are refused by their text: the message is one, whatever is there.
for name in ../n.png ../gone.png "$PWD/n.png" /gone/n.png; do
	printf 'newmtl m\nnorm %s\n' "$name" >in/m.mtl
	run --outside=no in/quad.obj quad.gltf
	exits 0
	grep -o ': image .*' ../err.txt | sed "s#$name#NAME#" >>said
done
said=": image cannot be read: NAME (it is outside of the folders where it may be; --outside=yes allows it) [IMAGE_MISSING]"
is "$(sort -u said)" "$said"

# As most studios have it: obj beside tex, and what all projects share.
studio() {
	mkdir -p s/p/obj s/p/tex s/shared
	images write s/p/tex/Wood.png 4 4 "$bumps"
	images write "s/p/tex/wood n.png" 4 4 "$bumps"
	images write s/shared/n.png 4 4 "$bumps"
	quad "$@"
	mv quad.obj m.mtl s/p/obj
}

scene "the images of an OBJ lie below the folder above it, in one run or another"
studio 'map_Kd ../tex/Wood.png' 'norm ../tex/wood n.png'
cp s/p/obj/quad.obj s/p/obj/two.obj
run s/p/obj/quad.obj one.glb
exits 0
is "$(gltf one.glb 'g.images.length')" 2
for way in "-d OUT s/p/obj/quad.obj" "-d OUT s/p/obj/quad.obj s/p/obj/two.obj" "-d OUT -r s" "-d OUT -r s/p/obj" \
	"-d OUT/s/p/obj --keep-tree=s/p/obj -r s" "-d OUT --keep-tree=s s/p/obj/quad.obj" "-o OUT/quad.glb s/p/obj/quad.obj"; do
	mkdir -p OUT
	run $way
	exits 0
	says_not IMAGE_
	same "$(find OUT -name quad.glb)" one.glb
	rm -r OUT
done
run --check --check-maps=on s/p/obj/quad.obj
says_not IMAGE_MISSING
run s/p/obj/quad.obj s/p/obj/quad.gltf
is "$(gltf s/p/obj/quad.gltf 'g.images[0].uri + g.images[1].uri')" "Wood.pngwood%20n.png"
same s/p/obj/Wood.png s/p/tex/Wood.png
rm s/p/obj/*.gltf s/p/obj/*.bin s/p/obj/*.png
run --outside=no -r -d OUT s
says "image cannot be read: ../tex/Wood.png (it is outside of the folders where it may be; --outside=yes allows it)"
says "material \"m\" has none of its images"
says "2 of 2 done"
says ", 2 materials without any image"
run -q --outside=no s/p/obj/quad.obj lost.glb
is "$(cat "$WORK/err.txt")" 'nmtan: s/p/obj/quad.obj: missing from the output: 2 IMAGE_MISSING; material "m" has none of its images'

scene "and anywhere below the folder that the user names"
studio 'norm ../../shared/n.png'
for way in "-d OUT s/p/obj/quad.obj" "-d OUT -r s/p" "-d OUT --keep-tree=s/p s/p/obj/quad.obj"; do
	run $way
	says "image cannot be read: ../../shared/n.png (it is outside"
	rm -r OUT
done
for way in "-d OUT -r s" "-d OUT --keep-tree=s s/p/obj/quad.obj" "-d OUT --keep-tree=. -r s/p" "-d OUT --outside=yes s/p/obj/quad.obj"; do
	run $way
	exits 0
	says_not IMAGE_
	is "$(gltf "$(find OUT -name quad.glb)" 'g.images.length')" 1
	rm -r OUT
done
# a folder that is named later lets an output be made again
run --update -d OUT s/p/obj/quad.obj
run --update -d OUT s/p/obj/quad.obj
says "up to date"
run --update -r -d OUT --include=quad.obj s
says_not "up to date"
run --update -r -d OUT --include=quad.obj "$PWD/s"
says "up to date"
rm -r OUT

scene "a name in another case is told as what it is"
studio 'map_Kd ../tex/wood.PNG' 'norm ../TEX/Wood N.png'
run s/p/obj/quad.obj out.glb
exits 0
is "$(gltf out.glb 'g.images.length')" 2
says "../tex/wood.PNG is ../tex/Wood.png [IMAGE_ELSEWHERE]"
says "../TEX/Wood N.png is ../tex/wood n.png [IMAGE_ELSEWHERE]"

scene "no further up, by no link, no other file; and one message, whatever is there"
studio
mkdir far
images write far/n.png 4 4 "$bumps"
echo text >s/p/secret.txt
ln -s ../../far s/p/linked
mkfifo s/p/pipe.png
for name in ../../../far/n.png ../../gone/n.png ../tex/../../../far/n.png ../linked/n.png ../linked/gone.png ../LINKED/n.png \
	../LINKED/gone.png /etc/passwd /gone; do
	printf 'newmtl m\nnorm %s\n' "$name" >s/p/obj/m.mtl
	run s/p/obj/quad.obj out.glb
	exits 0
	grep -o ': image .*' ../err.txt | sed "s#$name#NAME#" >>said
done
is "$(sort said | uniq -c | sed 's/^ *//')" "9 $said"
for name in ../secret.txt ../gone.txt ../pipe.png ../tex; do
	printf 'newmtl m\nnorm %s\n' "$name" >s/p/obj/m.mtl
	run s/p/obj/quad.obj out.glb
	grep -o ': image .*' ../err.txt | sed "s#$name#NAME#" >>missing
done
is "$(sort missing | uniq -c | sed 's/^ *//')" "4 : image cannot be read: NAME (looked for beside m.mtl) [IMAGE_MISSING]"

scene "a long name is cut where a character ends"
printf 'mtllib m.mtl\nusemtl m\n' | cat - "$data/quad.obj" >quad.obj
letters=$(printf 'é%.0s' $(seq 49))
printf 'newmtl m\nnorm a%s.png\n' "$letters$letters" >m.mtl
run quad.obj out.glb
exits 0
says "image cannot be read: a$letters (looked for beside m.mtl)"
# names of an object, a material and a library, each with a byte more in front
for before in "" a; do
	name=$before$letters$letters$letters$letters
	printf 'mtllib %s.mtl gone\no %s\nusemtl %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n' "$name" "$name" "$name" >long.obj
	printf 'newmtl %s\nKd x\nnorm ../../%s\n' "$name" "$name" >m.mtl
	sed 's/^mtllib.*/mtllib m.mtl/' long.obj >material.obj
	printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float %s\nend_header\n' "$name" >p.ply
	printf '0 0 0 0\n1 0 0 0\n0 1 0 0\n' >>p.ply
	printf '{"asset": {"version": "2.0"}, "buffers": [{"uri": "%s", "byteLength": 4}]}' "$name" >long.gltf
	for file in long.obj material.obj p.ply long.gltf; do
		run -v --check --fail-on=never --report=r.json "$file"
		run -v "$file" out.glb
		says "é"
		says_not '\x'
		! grep -q $'\xef\xbf\xbd' r.json || wrong "$file: a character is cut"
	done
done

scene "a link inside the folder does not tell whether there is something outside that it leads to"
mkdir -p d/in there
cp "$data/bumps.png" there/n.png
cp "$data/plates.bin" there/
sed 's#plates.bin#l/plates.bin#' "$data/plates.gltf" >d/in/plates.gltf
{ printf 'mtllib l/m.mtl\nmtllib m.mtl\nusemtl m\n' && grep '^[vf]' "$data/quad.obj"; } >d/in/quad.obj
printf 'newmtl m\nnorm l/n.png\n' >d/in/m.mtl
echo 'newmtl m' >there/m.mtl
for target in ../../there "$PWD/there" ../../gone /gone ../../d/../gone ../../there/m.mtl; do
	ln -sfn "$target" d/in/l
	for name in quad plates; do
		run d/in/$name.* out.gltf
		grep -o 'm\.mtl: leaves.*\|: image.*\|the URI.*\|cannot.*' ../err.txt >>said
	done
done
is "$(sort said | uniq -c | awk '{ print $1 }' | sort -u)" 6
is "$(sort -u said | wc -l)" 3
# what leads back in, is in
ln -sfn "$PWD/d/in/../in/sub" d/in/l
mkdir d/in/sub
cp there/plates.bin d/in/sub
run d/in/plates.gltf out.gltf
exits 0

scene "nobody waits for a pipe that a document names, and what a document names is not overwritten"
cp "$data/plates.gltf" "$data/plates.bin" .
quad 'norm f.png' 'map_Kd -mm 0 1 f.png'
mkfifo f.png
run quad.obj out.glb
exits 0
says "f.png"
mv m.mtl before
mkfifo m.mtl
run quad.obj out.glb
exits 0
says "no regular file"
rm m.mtl
cp before m.mtl
run quad.obj m.mtl --output-format=glb
exits 2
says "the same file as the input m.mtl"
same m.mtl before
rm f.png
cp "$data/bumps.png" f.png
run quad.obj f.png --output-format=glb
exits 2
says "the same file as the input"
same f.png "$data/bumps.png"
mv plates.bin before
mkfifo plates.bin
run plates.gltf out.gltf
exits 2
says "no regular file"

scene "a missing image leaves no reference, unless links are asked for"
quad 'norm gone.png'
run quad.obj quad.gltf
exits 0
says "IMAGE_MISSING"
is "$(gltf quad.gltf '[g.images, g.materials[0].normalTexture]')" "[null,null]"
run --images=link quad.obj quad.gltf
is "$(gltf quad.gltf 'g.images[0].uri')" gone.png

# ---- height maps ----

scene "a grey bump map becomes a normal map, and -bm is in it"
images write h.png 8 8 'abs(4 - x) * 16'
quad 'map_Bump -bm 2 h.png'
run -v quad.obj quad.glb
exits 0
says "height map to normal map"
says_not "BUMP_AS_NORMAL"
is "$(gltf quad.glb 'g.materials[0].normalTexture.scale === undefined')" true
images embedded quad.glb 0 made.png
# a slope of 16 / 255 of the height in each pixel; height is 2/64 of 8 pixels: s = 0.25, p = -s 16/255 at x = 2
p='(0.25 * 16 / 255)'
is "$(images rows made.png "([row[2] for row in rows] ==
	8 * [[math.floor((v / math.hypot($p, 1) + 1) / 2 * 255 + 0.5) for v in ($p, 0, 1)]])")" True

scene "--bump says what bump maps are, --bump-height how high"
images write h.png 8 8 'abs(4 - x) * 16'
images write n.png 8 8 "$bumps"
quad 'map_Bump h.png'
run --bump=normal quad.obj quad.glb
images embedded quad.glb 0 made.png
same made.png h.png
run --bump=ignore quad.obj quad.glb
is "$(gltf quad.glb 'g.images')" undefined
run quad.obj low.glb
run --bump-height=1/32 quad.obj high.glb
exits 0
images embedded low.glb 0 low.png
images embedded high.glb 0 high.png
is "$(cmp -s low.png high.png || echo different)" different
quad 'map_Bump n.png'
run -v quad.obj quad.glb
says "info: bump map was taken as a normal map: map_Bump n.png [BUMP_AS_NORMAL]"
for line in '# Blender MTL File: "x.blend"' '# Blender 4.1.0 MTL File: "x.blend"'; do
	sed -i "1i $line" m.mtl
	run -v quad.obj quad.glb
	says_not "BUMP_AS_NORMAL"
	sed -i 1d m.mtl
done
quad 'map_Bump gone.png'
run -v quad.obj quad.glb
says_not "BUMP_AS_NORMAL"
quad 'map_Bump n.png'
run quad.obj quad.glb
images embedded quad.glb 0 made.png
same made.png n.png
run --bump=height -v quad.obj quad.glb
says "height map to normal map"
run --bump-height=2 quad.obj quad.glb
exits 1
says "--bump-height"

scene "sixteen bits stay sixteen"
images write h.png 8 8 '("16", 100 * x * (8 - x))'
quad 'bump h.png'
run quad.obj quad.gltf
exits 0
is "$(images rows h-normal.png '(rows[0][4][:2] == [32768, 32768], max(max(p) for p in rows[0]) > 65000)')" "(True, True)"

# ---- what maps say about themselves ----

# The normal map of hills, whose slopes are p and q; green up with s = 1, down with s = -1.
hills() {
	local p='(1.2 * math.cos(x / 7 + y / 9) + 0.6 * math.cos(x / 5 - y / 6)) * .3'
	local q='(0.9333 * math.cos(x / 7 + y / 9) - 0.5 * math.cos(x / 5 - y / 6)) * .3'
	images write "$1" 96 96 "(lambda n: tuple(int((v / math.hypot(*n) + 1) * 127.5 + .5) for v in n))((-($p), $2 * ($q), 1))"
}

scene "a map whose green points down is found, and turned around on demand"
hills up.png 1
hills down.png -1
quad 'norm up.png'
run --check --report-format=json --report=r.json quad.obj
exits 0
is "$(grep -c NMAP_GREEN_DOWN r.json)" 0
quad 'norm down.png'
run --check --fail-on=warning quad.obj
exits 6
prints "NMAP_GREEN_DOWN"
prints "correlation -"
run --check --check-maps=off --fail-on=warning quad.obj
exits 0
run quad.obj quad.glb
exits 0
says_not "NMAP_"
run --check-maps=on quad.obj quad.glb
says "m.mtl:2: material \"m\": warning: normal map whose green points down: down.png, correlation"
# the place of a finding about a map is the statement that names it
run --check --report-format=lines quad.obj
prints "m.mtl:2: warning: NMAP_GREEN_DOWN: normal map whose green points down: down.png, correlation"
prints ', in material "m". Invert the green channel: nmtan --fix quad.obj quad.glb'
run --check quad.obj
prints 'in material "m", line 2 of m.mtl'
run --check -q --report=r.json quad.obj
is "$(value r.json '[(f["place"]["line"], f["mesh"]) for f in r["files"][0]["findings"] if f["votes"]]')" "[(2, 0)]"
run --normal-map=down.png quad.obj quad.glb
says "down.png: material \"m\": warning: normal map whose green points down: down.png, correlation"
run --flip-green=auto quad.obj quad.glb
exits 0
says "down.png became down-green-up.png"
images embedded quad.glb 0 made.png
# 255 - round(v) is round(255 - v) but at halves
is "$(images rows made.png "max(abs(x - y) for r, s in zip(rows, $(images rows up.png)) for p, q in zip(r, s)
	for x, y in zip(p, q)) <= 1")" True
quad 'norm up.png'
run --flip-green=auto quad.obj quad.glb
images embedded quad.glb 0 made.png
same made.png up.png
run --flip-green=on quad.obj quad.glb
says "up.png became up-green-up.png"

scene "green is turned in every depth, beside every channel"
while IFS='|' read -r pixel turned; do
	images write n.png 4 4 "$pixel"
	quad 'norm n.png'
	run --bump=normal --flip-green=on quad.obj quad.glb
	images embedded quad.glb 0 made.png
	is "$(images rows made.png 'rows[1][2]')" "$turned"
done <<'END'
(10 * x, 20 * y, 200)|[20, 235, 200]
(10 * x, 20 * y, 200, 255 - x)|[20, 235, 200, 253]
("16", 10 * x, 20 * y, 60000)|[20, 65515, 60000]
("16", 10 * x, 20 * y, 60000, 65535 - x)|[20, 65515, 60000, 65533]
10 * x|[20]
END

# The upper half was made for DirectX: no turn is right for all of it.
scene "a map that is green down in places is left as it is, and the report has the blocks that say so"
hills mixed.png '(1 if y >= 48 else -1)'
quad 'norm mixed.png'
run --check --fail-on=warning --report=r.json quad.obj
exits 0
is "$(value r.json '[(f["code"], f["severity"], [min(map(min, v)) > 20 for v in (f["votes"][6:],)],
	[max(map(max, v)) < -20 for v in (f["votes"][:6],)]) for f in r["files"][0]["findings"] if f["votes"]]')" \
	"[('NMAP_GREEN_MIXED', 'info', [True], [True])]"
# a block is told by 20 % and more; the figures say of what they are
is "$(value r.json '[f["message"].split(": ", 1)[1] == "mixed.png, correlation %s of 144 blocks say up, %d down" % (f["message"].split("correlation ")[1].split(" of 144")[0],
	sum(v <= -20 for row in f["votes"] for v in row)) and "over all sizes %d of 144" % sum(v >= 20 for row in f["votes"] for v in row) in f["message"]
	and (" (green up)" if "correlation 0" in f["message"] else " (green down)") + " at the surest size of detail, where " in f["message"] for f in r["files"][0]["findings"] if f["votes"]]')" "[True]"
run --flip-green=auto quad.obj quad.glb
exits 0
images embedded quad.glb 0 made.png
same made.png mixed.png

scene "a glTF's maps are examined and stay as they are"
hills n.png -1
quad 'norm n.png'
run quad.obj quad.glb
run --check quad.glb
prints "NMAP_GREEN_DOWN"
run quad.glb again.glb
same quad.glb again.glb

# changed.py IN OUT STATEMENTS: the document g of IN after them.
cat >"$WORK/changed.py" <<'END'
import copy, json, sys
g = json.load(open(sys.argv[1]))
exec(sys.argv[3])
json.dump(g, open(sys.argv[2], "w"))
END
changed() { python3 "$WORK/changed.py" "$@"; }

scene "a glTF's normal maps are turned, wherever their bytes are, and nothing else changes"
hills up.png 1
hills down.png -1
quad 'norm down.png'
run --flip-green=auto quad.obj direct.glb
images embedded direct.glb 0 turned.png
run quad.obj quad.glb
run quad.obj quad.gltf
run --buffers=embed --images=embed quad.gltf data.gltf
for file in quad.glb data.gltf; do
	run --verify --flip-green=auto $file out.${file#*.}
	exits 0
	run --flip-green=auto out.${file#*.} again.${file#*.}
	same out.${file#*.} again.${file#*.}
done
images embedded out.glb 0 made.png
same made.png turned.png
[ "$(gltf out.gltf 'g.images[0].uri')" = "data:image/png;base64,$(base64 -w0 turned.png)" ] || wrong "another data URI"
run --verify -v --flip-green=auto quad.gltf out.gltf
exits 0
says ": 0 of 1 primitives, converted 1 normal map, "
says "/materials/0/normalTexture: info: image was converted: green turned up [IMAGE_CONVERTED]"
same down-green-up.png turned.png
sed 's/down-green-up.png/down.png/' out.gltf >undone.gltf
# the record of who owns the .bin goes with a link to it
sed 's/,"extras":{"nmtan[^}]*}//' quad.gltf >plain.gltf
same plain.gltf undone.gltf
mkdir elsewhere
run --flip-green=auto --images=embed quad.gltf elsewhere/out.glb
is "$(ls elsewhere)" out.glb
run --flip-green=on --images=copy out.gltf elsewhere/back.gltf
images rows down.png rows >expected.txt
images rows elsewhere/down-green-up-green-up.png rows >back.txt
same expected.txt back.txt
quad 'norm up.png'
run quad.obj up.gltf
run up.gltf plain.gltf
run --flip-green=auto up.gltf auto.gltf
says_not "converted"
same plain.gltf auto.gltf
changed quad.gltf bare.gltf 'g["textures"].append({}); g["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}}]'
run --only=all --report=r.html bare.gltf out.gltf # its texture has no image, and not the first one
is "$(value r.html 'r["images"]')" "[]"
changed quad.gltf bare.gltf 'g["textures"].append({}); g["materials"][0]["normalTexture"]["index"] = 1'
run --flip-green=on bare.gltf out.gltf
is "$(gltf out.gltf 'g.images')" "$(gltf quad.gltf 'g.images')"
# pictures lie where the map is looked up: u' = 2 u + 0.25, v' = 4 v + 1 - 4 - 0.5 with v down
quad 'norm -s 2 4 1 -o 0.25 0.5 0 up.png'
run quad.obj moved.gltf
changed moved.gltf far.gltf 'g["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["offset"] = [1e39, 0]'
changed moved.gltf turned.gltf 'g["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["rotation"] = 1.5707963'
for file in quad.obj moved.gltf far.gltf turned.gltf; do
	run -q --check --fail-on=never --report=r.html $file
	value r.html '[round(x, 4) + 0 for x in r["files"][0]["meshes"][0]["images"][0]["map"]]' >>places
done
is "$(uniq -c places | sed 's/^ *//')" "2 [2, 0, 0.25, 0, 4, -3.5]
1 [1, 0, 0, 0, 1, 0]
1 [0.0, 4, 0.25, -2, 0.0, -3.5]"

# colour.jpg: 16 x 16, four squares of one colour each, 4:4:4; sharp 0.35 (libjpeg-turbo through libvips) decodes them as
# (128, 127, 254), (200, 60, 219), (90, 180, 230) and (128, 40, 210)
scene "a JPEG in colour becomes a PNG of what other decoders see, green turned"
cp "$data/colour.jpg" .
quad 'norm colour.jpg'
run quad.obj quad.gltf
run quad.obj quad.glb
for ending in gltf glb; do
	run --verify --flip-green=on quad.$ending out.$ending
	exits 0
done
is "$(gltf out.gltf 'g.images[0]')" '{"name":"colour","uri":"colour-green-up.png"}'
is "$(gltf out.glb 'g.images[0].mimeType')" image/png
images embedded out.glb 0 made.png
same colour-green-up.png made.png
is "$(images rows made.png '[8 * [rows[y][0]] + 8 * [rows[y][8]] == rows[y] == rows[y - y % 8] for y in range(16)] == 16 * [True]')" True
is "$(images rows made.png '[rows[0][0], rows[0][8], rows[8][0], rows[8][8]]')" \
	"[[128, 128, 254], [200, 195, 219], [90, 75, 230], [128, 215, 210]]"

scene "what else samples the image of a normal map keeps it"
hills down.png -1
quad 'norm down.png'
run quad.obj quad.gltf
changed quad.gltf shared.gltf 'm = g["materials"]; m[0]["occlusionTexture"] = {"index": 0}
g["textures"].append({"source": 0, "name": "second"})
m.append({"normalTexture": {"index": 1}, "extensions": {"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0}}}})
g["images"][0]["name"] = "n"; g["extensionsUsed"] = ["KHR_materials_clearcoat"]'
run --verify --flip-green=auto shared.gltf out.gltf
exits 0
is "$(gltf out.gltf '[g.images, g.textures, g.materials]')" '[[{"name":"n","uri":"down.png"},{"name":"n","uri":"down-green-up.png"}],[{"source":0},{"source":1,"name":"second"},{"source":1}],[{"name":"m","normalTexture":{"index":2},"pbrMetallicRoughness":{"metallicFactor":0},"occlusionTexture":{"index":0}},{"normalTexture":{"index":1},"extensions":{"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"index":2}}}}]]'
echo "$PWD/out.gltf" >pairs
valid --pairs pairs
# VRM 0 has numbers of textures in the root; of these _BumpMap is a normal map. In VRM 1, mtoon has textures in the
# material.
changed quad.gltf vrm.gltf 'm = g["materials"]; m[0]["extensions"] = {"VRMC_materials_mtoon": {"matcapTexture": {"index": 0}}}
g["extensionsUsed"] = ["VRM", "VRMC_materials_mtoon"]; g["textures"].append({"source": 0})
m.append({"normalTexture": {"index": 1}})
g["extensions"] = {"VRM": {"meta": {"texture": 0}, "materialProperties": [{"textureProperties": {"_BumpMap": 0}},
{"textureProperties": {"_MainTex": 1, "_BumpMap": 1}}, {"textureProperties": {"_BumpMap": 1}}]}}'
run --verify --flip-green=auto vrm.gltf out.gltf
exits 0
is "$(gltf out.gltf '[g.textures, g.materials.map(m => [m.normalTexture.index, m.extensions]), g.extensions.VRM]')" '[[{"source":0},{"source":0},{"source":1},{"source":1}],[[2,{"VRMC_materials_mtoon":{"matcapTexture":{"index":0}}}],[3,null]],{"meta":{"texture":0},"materialProperties":[{"textureProperties":{"_BumpMap":2}},{"textureProperties":{"_MainTex":1,"_BumpMap":3}},{"textureProperties":{"_BumpMap":1}}]}]'
changed quad.gltf vrm.gltf 'g["extensions"] = {"VRM": {"materialProperties": [{"textureProperties": {"_BumpMap": 0}}]}}'
run --flip-green=auto vrm.gltf out.gltf
is "$(gltf out.gltf '[g.images, g.textures, g.extensions.VRM.materialProperties]')" '[[{"name":"down","uri":"down-green-up.png"}],[{"source":0}],[{"textureProperties":{"_BumpMap":0}}]]'

scene "KTX2 and WebP are named as not turned, what is damaged as that"
hills down.png -1
quad 'norm down.png'
run quad.obj quad.gltf
printf '\253KTX 20\273\r\n\032\n%080d' 0 >n.ktx2
base64 -d >n.webp <<<UklGRkQAAABXRUJQVlA4TDcAAAAvD8ADAB8gJCBOiYb4nw0SCBD+iyRoUCMkIBb5f0b3QJ7/MO8CHBBmG01ykpO89xlE9D8Kvk0/AA==
for type in "KTX2 n.ktx2 KHR_texture_basisu" "WebP n.webp EXT_texture_webp"; do
	read -r type name extension <<<"$type"
	changed quad.gltf other.gltf "g['images'].append({'uri': '$name'}); g['extensionsUsed'] = ['$extension']
g['textures'][0]['extensions'] = {'$extension': {'source': 1}}"
	run other.gltf plain.gltf
	run --flip-green=on other.gltf out.gltf
	exits 0
	says "/materials/0/normalTexture: warning: normal map is not turned: $type [NMAP_NOT_TURNED]"
	same plain.gltf out.gltf
	changed quad.gltf bare.gltf "g['images'][0]['uri'] = '$name'"
	run --flip-green=on bare.gltf out.gltf
	says "normal map is not turned: $type [NMAP_NOT_TURNED]"
done
head -c 300 down.png >short.png
changed quad.gltf short.gltf 'g["images"][0]["uri"] = "short.png"'
run --flip-green=on short.gltf out.gltf
exits 0
says "IMAGE_DAMAGED"
for most in 18431:7 18432:0; do # 96 x 96 are decoded and made
	run --max-pixels=${most%:*} --flip-green=on quad.gltf out.gltf
	exits ${most#*:}
done

scene "a height map in the place of a glTF's normal map is a finding, and made a normal map if asked for"
images write h.png 16 16 '16 * (x * y % 16)'
cp "$data/grey.jpg" .
images write near.png 16 16 '(lambda r: (r, r, r + (x + y) % 2))(10 * (x * y % 16))' # as scaling rounds it
for file in h.png grey.jpg near.png "-clamp on h.png"; do
	quad "norm $file"
	run quad.obj direct.glb
	images embedded direct.glb 0 normals.png
	run --bump=normal quad.obj quad.glb
	run --check --report=r.json quad.glb
	is "$file $(value r.json '[f["code"] for f in r["files"][0]["findings"] if f["code"] != "TAN_UNUSED"]')" "$file ['NMAP_HEIGHTS']"
	is "$(value r.json 'r["files"][0]["verdict"]')" "Convert with nmtan: normal map that is a height map: nmtan --bump=height quad.glb quad-repaired.glb"
	run --flip-green=on quad.glb still.glb
	run quad.glb plain.glb
	same still.glb plain.glb
	run --verify --bump=height quad.glb out.glb
	exits 0
	images embedded out.glb 0 made.png
	same made.png normals.png
	is "$(gltf out.glb 'g.images[0].mimeType')" image/png
	run --check out.glb
	grep -q NMAP_HEIGHTS "$WORK/out.txt" && wrong "it is none any more"
	run --bump=height out.glb again.glb
	same out.glb again.glb
done

scene "the normal map of a clearcoat is examined, too, and once where both are one"
hills n.png -1
hills up.png 1
quad 'norm up.png' 'map_Kd n.png'
run --buffers=embed quad.obj quad.gltf
coat='const of = (name) => g.textures.findIndex((t) => g.images[t.source].name === name);
	const clearcoatNormalTexture = {index: of(asked)};
	g.materials[0].extensions = {KHR_materials_clearcoat: {clearcoatFactor: 1, clearcoatNormalTexture}}'
for pair in n:1 up:0; do
	gltf quad.gltf coated "const asked = '${pair%:*}';" "$coat"
	run --check --report-format=json coated.gltf
	is "$(grep -c '"message.*down: clearcoatNormalTexture, correlation -' "$WORK/out.txt")" ${pair#*:}
done

scene "a normal map that --texture-path finds is examined"
mkdir elsewhere
hills elsewhere/n.png -1
quad 'norm n.png'
run --check --texture-path=elsewhere quad.obj
prints "NMAP_GREEN_DOWN"

scene "the image that a PLY names is found and converted as an OBJ's"
mkdir elsewhere
images write elsewhere/wood.tga 8 8 '(x * 9, y * 9, 3)'
{
	printf '%s\n' ply "format ascii 1.0" "comment TextureFile wood.tga" "element vertex 3" "property float x" "property float y" \
		"property float z" "property float s" "property float t" "element face 1" "property list uchar int vertex_indices" \
		end_header "0 0 0 0 0" "1 0 0 1 0" "0 1 0 0 1" "3 0 1 2"
} >t.ply
run t.ply t.glb
exits 0
says "IMAGE_MISSING"
run --texture-path=elsewhere t.ply t.glb
exits 0
says "wood.tga became wood.png (embedded)"
images write twin.png 8 8 '(x * 9, y * 9, 3)'
images embedded t.glb 0 made.png
is "$(images rows made.png)" "$(images rows twin.png)"
is "$(gltf t.glb '[g.images[0].mimeType, g.materials[0].pbrMetallicRoughness.baseColorTexture.index]')" '["image/png",0]'

scene "maps that are none, or of another kind"
sphere='(math.cos(x / 10) * math.sin(y / 20.5), math.sin(x / 10) * math.sin(y / 20.5), math.cos(y / 20.5))'
while IFS='|' read -r code width formula; do
	images write map.png $width $width "$formula"
	quad 'norm map.png'
	run --check quad.obj
	prints "$code"
	prints 'in material "m", line 2 of m.mtl'
done <<END
info      NMAP_CONSTANT|8|(131, 124, 255)
warning   NMAP_CONSTANT|8|(140, 128, 254)
warning   NMAP_CONSTANT|8|(128, 140, 254)
warning   NMAP_CONSTANT|8|(100, 128, 120)
NMAP_OBJECT_SPACE|64|tuple(int(127.5 + 127 * v) for v in $sphere)
NMAP_NOT_UNIT|64|(128 + x, 128 + y, 255)
END
printf '\253KTX 20\273\r\n\032\n and more' >k.ktx2
quad 'norm k.ktx2'
run --check quad.obj
prints "NMAP_NOT_EXAMINED"
images write h.png 8 8 'x'
quad 'norm h.png'
run --check quad.obj
! grep -q NMAP_ ../out.txt || wrong "a height map was examined"

scene "WebP is looked at, and stays as it is"
hills down.webp -1
hills up.webp 1
images write h.webp 16 16 '(16 * (x * y % 16),) * 3'
images write h.png 16 16 '16 * (x * y % 16)'
images write space.webp 64 64 "tuple(int(127.5 + 127 * v) for v in $sphere)"
hills lossy.webp 1
for kind in down:NMAP_GREEN_DOWN up: lossy:NMAP_JPEG space:NMAP_OBJECT_SPACE; do
	quad "norm ${kind%:*}.webp"
	run --check -q --report=r.json --fail-on=never quad.obj
	is "$kind $(value r.json '"".join(f["code"] for f in r["files"][0]["findings"] if f["code"].startswith("NMAP"))')" "$kind ${kind#*:}"
done
# no option makes another file of it
quad 'norm down.webp' 'map_Kd up.webp'
mkdir out
for options in --flip-green=on --flip-green=auto --textures=png --fix; do
	run $options quad.obj out/quad.gltf
	exits 0
	same down.webp out/down.webp
	same up.webp out/up.webp
	is "$options $(ls out | tr '\n' ' ')" "$options down.webp quad.bin quad.gltf up.webp "
done
# map_Bump is a normal map if it is not grey, and else heights, of which a normal map is made
quad 'map_Bump up.webp'
run --check -q --report=r.json --fail-on=never quad.obj
is "$(value r.json '[f["code"] for f in r["files"][0]["findings"] if "BUMP" in f["code"]]')" "['BUMP_AS_NORMAL']"
for type in png webp; do
	quad "map_Bump h.$type"
	run quad.obj $type.glb
	images embedded $type.glb 0 made-$type.png
done
same made-png.png made-webp.png
# one channel of it, packed
quad 'map_Pr h.webp'
run quad.obj out.glb
says_not MATERIAL_LOST
# a glTF's, and limits
quad 'norm down.webp'
run quad.obj quad.gltf
gltf quad.gltf wrong 'const n = g.meshes[0].primitives[0].attributes.TANGENT; for (let i = 0; i < 4; i++) bytes[0].writeFloatLE(-bytes[0].readFloatLE(at(n, i) + 12), at(n, i) + 12)'
run --check quad.gltf
prints "NMAP_GREEN_DOWN"
run --check wrong.gltf
prints "TAN_GREEN_PAIR"
run --check --max-pixels=1000 quad.gltf
exits 7
head -c 100 down.webp >short.webp
quad 'norm short.webp'
run --check quad.obj
prints "WebP: the file ends within the image"

done_testing
