# SPDX-License-Identifier: MIT
# Materials of an OBJ: what the statements of an MTL become in glTF. Expected numbers are those of the formulas in the man
# page, worked out here.
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

# A member of the material, as JSON.
material() { gltf quad.glb "g.materials[0]$1"; }

# The samples of image NUMBER of quad.glb, in rows.json.
made() {
	images embedded quad.glb "$1" made.png
	images rows made.png >rows.json
}

# What Python makes of "rows", the samples.
samples() { python3 -c "import json, math; rows = json.load(open('rows.json')); print($1)"; }

scene "numbers of a material"
convert "Kd 0.5 0.25 1" "Pr 0.25" "Pm 0.75" "d 0.5"
is "$(material .pbrMetallicRoughness)" \
	'{"baseColorFactor":[0.5,0.25,1,0.5],"metallicFactor":0.75,"roughnessFactor":0.25}'
is "$(material .alphaMode)" BLEND
convert "Ke 4 2 0"
is "$(material .emissiveFactor)" '[1,0.5,0]'
is "$(material .extensions)" '{"KHR_materials_emissive_strength":{"emissiveStrength":4}}'
# (2 / (30 + 2))^(1/4)
convert "Ns 30" "Ks 0.5 0.5 0.5" "illum 2"
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0,"roughnessFactor":0.5}'
convert "Ns 30" "Ks 0 0 0"
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0}'
convert "Tr 0.75"
is "$(material .pbrMetallicRoughness.baseColorFactor)" '[1,1,1,0.25]'

scene "layers are extensions, which are listed as used"
convert "Pc 0.5" "Pcr 0.25" "Ps 0.75" "aniso 0.5" "anisor 0.5" "Ni 1.25"
is "$(gltf quad.glb 'g.extensionsUsed')" \
	'["KHR_materials_anisotropy","KHR_materials_clearcoat","KHR_materials_ior","KHR_materials_sheen"]'
is "$(gltf quad.glb 'g.extensionsRequired')" undefined
is "$(material .extensions.KHR_materials_clearcoat)" '{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.25}'
is "$(material .extensions.KHR_materials_sheen)" '{"sheenColorFactor":[0.75,0.75,0.75],"sheenRoughnessFactor":0.5}'
is "$(material .extensions.KHR_materials_ior)" '{"ior":1.25}'
is "$(material .extensions.KHR_materials_anisotropy.anisotropyStrength)" 0.5
is "$(gltf quad.glb 'Math.abs(g.materials[0].extensions.KHR_materials_anisotropy.anisotropyRotation - Math.PI) < 1e-6')" true

scene "anisotropy asks for tangents, in the OBJ and in what is made of it"
quad "aniso 0.5"
run --check --report-format=json --report=r.json quad.obj
is "$(python3 -c 'import json; print(json.load(open("r.json"))["files"][0]["meshes"][0]["slots"])')" "['anisotropy']"
run quad.obj quad.glb
is "$(gltf quad.glb 'g.meshes[0].primitives[0].attributes.TANGENT !== undefined')" true
run --check --fail-on=warning quad.glb
exits 0
sed '/^vt/d; s|^f .*|f 1 2 3 4|' quad.obj >bare.obj
run bare.obj bare.glb
says "TAN_NO_UV"
is "$(gltf bare.glb 'g.materials[0].extensions')" undefined

scene "roughness, metallic and occlusion are packed into one image"
images write r.png 4 4 '10 * x + y'
images write m.tga 4 4 '(5 * y, 5 * y, 5 * y)'
images write o.png 4 4 '(99, 20 * x, 0)'
convert "Pr 0.5" "map_Pr r.png" "map_Pm m.tga" "map_ao -imfchan g o.png"
says "o.png and r.png and m.tga became o-orm.png (embedded)"
is "$(gltf quad.glb 'g.images.length')" 1
is "$(material .pbrMetallicRoughness)" '{"metallicRoughnessTexture":{"index":0},"roughnessFactor":0.5}'
is "$(material .occlusionTexture)" '{"index":0}'
made 0
is "$(samples 'rows == [[[20 * x, 10 * x + y, 5 * y] for x in range(4)] for y in range(4)]')" True

scene "one map alone leaves the other number as it is"
images write r.tga 4 4 '(x, x, x)'
convert "Pm 0.75" "map_Pr r.tga"
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0.75,"metallicRoughnessTexture":{"index":0}}'
made 0
is "$(samples 'rows[0][3]')" "[255, 3, 255]"
convert "Ns 30" "map_Pm r.tga"
is "$(material .pbrMetallicRoughness)" '{"metallicRoughnessTexture":{"index":0},"roughnessFactor":0.5}'
made 0
is "$(samples 'rows[0][3][1:]')" "[255, 3]"

scene "a map that is right already is copied byte for byte"
images write orm.png 8 8 '(9 * x, 9 * y, x * y)'
convert "map_ORM orm.png"
images embedded quad.glb 0 made.png
same orm.png made.png
is "$(material .pbrMetallicRoughness)" '{"metallicRoughnessTexture":{"index":0}}'
is "$(material .occlusionTexture)" '{"index":0}'
# grey: green is roughness, and blue counts for nothing
images write r.png 8 8 '9 * x'
convert "map_Pr r.png"
images embedded quad.glb 0 made.png
same r.png made.png
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0,"metallicRoughnessTexture":{"index":0}}'
cp "$data/grey.jpg" o.jpg
convert "map_ao o.jpg"
images embedded quad.glb 0 made.jpg
same o.jpg made.jpg

scene "map_RMA has another order"
images write rma.png 8 8 '(9 * x, 9 * y, x * y)'
convert "map_RMA rma.png"
made 0
is "$(samples 'rows == [[[x * y, 9 * x, 9 * y] for x in range(8)] for y in range(8)]')" True

scene "what has another size is resampled to the largest"
images write r.png 2 2 '(200 if x else 100)'
images write m.png 4 1 '40 * x'
convert "map_Pr r.png" "map_Pm m.png"
made 0
is "$(samples '[len(rows), len(rows[0])]')" "[2, 4]"
# pixel centres 0.25, 0.75 ... of the small one lie at -0.25, 0.25, 0.75, 1.25 between its centres; borders repeat
is "$(samples '[p[1] for p in rows[0]]')" "[125, 125, 175, 175]"
is "$(samples '[p[2] for p in rows[1]]')" "[0, 40, 80, 120]"

scene "materials that share maps share the image"
images write r.tga 4 4 '(x, x, x)'
images write m.tga 4 4 '(y, y, y)'
quad "map_Pr r.tga" "map_Pm m.tga" "newmtl second" "map_Pm ./m.tga" "map_Pr ./r.tga" "Pr 0.5"
{ cat quad.obj; echo "usemtl second"; grep '^f' quad.obj; } >both.obj
run both.obj both.glb
exits 0
is "$(gltf both.glb '[g.images.length, g.materials.length]')" "[1,2]"

scene "sixteen bits stay sixteen"
images write r.png 4 4 '("16", 1000 * x)'
images write m.png 4 4 '10 * x'
convert "map_Pr r.png" "map_Pm m.png"
made 0
is "$(samples 'rows[0][3][1:]')" "[3000, $((30 * 257))]"

scene "-imfchan and -mm"
images write x.png 4 4 '(10 * x, 20 * y, 100)'
convert "map_Pr -imfchan r -mm 0.2 0.5 x.png" "map_Pm -imfchan g x.png"
made 0
is "$(samples 'rows[1][2][1:]')" "[$((51 + 10)), 20]"
# 0.2126 10 + 0.7152 20 + 0.0722 100
convert "map_Pr x.png"
made 0
is "$(samples 'rows[1][1]')" "[24]"
convert "map_Kd -mm 0 0.5 x.png"
made 0
is "$(samples 'rows[2][2]')" "[10, 20, 50]"
convert "map_Kd -mm 0 0 x.png"
made 0
is "$(samples 'rows[2][2]')" "[0, 0, 0]"
convert "map_Pr -mm 0 0 x.png"
made 0
is "$(samples 'rows[2][2]')" "[0]"
images write h.png 8 8 '(0, abs(4 - x) * 16, 0)'
convert "bump -imfchan g h.png"
made 0
images write g.png 8 8 'abs(4 - x) * 16'
cp rows.json first.json
convert "bump g.png"
made 0
same first.json rows.json

scene "highlights become roughness where nothing else says it"
images write n.png 4 4 '51 * x'
convert "Ns 1000" "map_Ns n.png"
made 0
# ((2 / (1000 v + 2))^(1/4)
is "$(samples 'rows[0] == [[math.floor(255 * (2 / (1000 * x / 5 + 2)) ** 0.25 + 0.5)] for x in range(4)]')" True
convert "Ns 30" "Ks 1 1 1" "map_Ks n.png"
made 0
# 1 - (1 - 0.5) v
is "$(samples 'rows[0] == [[math.floor(255 - 51 * x / 2 + 0.5)] for x in range(4)]')" True

scene "libraries of Blender have its own formula, and its maps"
images write n.png 4 4 '51 * x'
quad "Ns 250" "Pm 0" "map_refl n.png"
sed -i '1i # Blender 3.6.5 MTL File: "x.blend"' m.mtl
run quad.obj quad.glb
exits 0
is "$(material .pbrMetallicRoughness)" '{"metallicRoughnessTexture":{"index":0},"roughnessFactor":0.5}'

scene "alpha is merged into the base colour, with the mode that its values ask for"
images write c.png 4 4 '(10 * x, 20 * y, 30)'
images write d.tga 4 4 '(60 * x, 60 * x, 60 * x)'
convert "map_Kd c.png" "map_d d.tga"
is "$(material .alphaMode)" BLEND
made 0
is "$(samples 'rows[1][3]')" "[30, 20, 30, 180]"
images write d.png 4 4 '255 * (x % 2)'
convert "map_Kd c.png" "map_d d.png"
is "$(material .alphaMode)" MASK
convert "map_Kd c.png" "map_d d.png" "d 0.5"
is "$(material '.alphaMode + g.materials[0].pbrMetallicRoughness.baseColorFactor[3]')" BLEND0.5
images write d.png 4 4 255
convert "map_Kd c.png" "map_d d.png"
is "$(material .alphaMode)" undefined
images embedded quad.glb 0 made.png
same c.png made.png
convert "Kd 1 0.5 0.25" "map_d d.tga"
made 0
is "$(samples 'rows[1][3]')" "[255, 180]"
is "$(material .pbrMetallicRoughness.baseColorFactor)" "[1,0.5,0.25,1]"
convert "map_Tr d.tga"
made 0
is "$(samples 'rows[1][3]')" "[255, 75]"

scene "an image that has its alpha is copied byte for byte"
python3 - <<'END'
import struct, zlib
def chunk(k, d): return struct.pack(">I", len(d)) + k + d + struct.pack(">I", zlib.crc32(k + d))
rows = b"".join(b"\0" + b"".join(bytes((9, 8, 7, 255 * (x > y))) for x in range(8)) for y in range(8))
open("leaf.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 6, 0, 0, 0)) +
	chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
END
convert "map_Kd leaf.png" "map_d leaf.png" "map_Ke leaf.png"
images embedded quad.glb 0 made.png
same leaf.png made.png
is "$(gltf quad.glb 'g.images.length')" 1
is "$(material .alphaMode)" MASK

scene "what is contradictory or meaningless is said"
convert "d 0.5" "Tr 0.25"
says "d 0.5 and Tr 0.25 are different: d counts [MATERIAL_DOUBTFUL]"
says "m.mtl:2"
convert "d 0"
says "d 0 makes it invisible"
is "$(material .alphaMode)" undefined
images write c.png 4 4 '(1, 2, 3)'
convert "Kd 0 0 0" "map_Kd c.png"
says "MATERIAL_DOUBTFUL"
is "$(material .pbrMetallicRoughness.baseColorFactor)" undefined
convert "Ke 0 0 0" "map_Ke c.png"
says_not "MATERIAL_"
is "$(material .emissiveFactor)" '[1,1,1]'

scene "what is lost is named, with its material and line"
quad "Kd 1 1 1" "disp h.png" "map_aniso a.png"
run quad.obj quad.glb
exits 0
says "m.mtl:3"
says 'material "m"'
says "MTL: disp"
says "MTL: map_aniso"

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

scene "a map that is not there leaves the number"
images write m.png 4 4 '10 * x'
convert "Pr 0.25" "map_Pr gone.png" "map_Pm m.png"
says "IMAGE_MISSING"
says "m.mtl:3"
is "$(material .pbrMetallicRoughness)" '{"metallicRoughnessTexture":{"index":0},"roughnessFactor":0.25}'
head -c 30 m.png >short.png
convert "map_Pr m.png" "Pm 0.5" "map_Pm short.png"
says "IMAGE_DAMAGED"
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0.5,"metallicRoughnessTexture":{"index":0}}'
convert "Pr 0.25" "map_Pr gone.png"
is "$(material .pbrMetallicRoughness)" '{"metallicFactor":0,"roughnessFactor":0.25}'

scene "maps that lie elsewhere are in no image together"
images write r.png 4 4 '10 * x'
images write m.png 4 4 '10 * y'
convert "map_Pr -s 2 2 1 r.png" "map_Pm m.png" "map_ao m.png"
says 'material "m"'
says "m.png lies elsewhere"
is "$(gltf quad.glb 'g.images.length')" 2
is "$(material .pbrMetallicRoughness.metallicFactor)" 0
convert "map_Pr -s 2 2 1 r.png" "map_Pm -s 2 2 1 m.png"
is "$(gltf quad.glb 'g.images.length')" 1
is "$(material .pbrMetallicRoughness.metallicRoughnessTexture.extensions.KHR_texture_transform.scale)" "[2,2]"

scene "layers have maps"
images write c.png 4 4 '10 * x'
images write d.png 4 4 '10 * y'
convert "map_Pc c.png" "Pcr 0.5" "map_Pcr d.png"
made 0
is "$(samples 'rows[1][2][:2]')" "[20, 10]"
is "$(material .extensions.KHR_materials_clearcoat)" \
	'{"clearcoatFactor":1,"clearcoatRoughnessFactor":0.5,"clearcoatRoughnessTexture":{"index":0},"clearcoatTexture":{"index":0}}'
images write s.png 4 4 '51 * x'
convert "map_Ps s.png"
made 0
# sRGB of 0.2 is 1.055 * 0.2^(1 / 2.4) - 0.055
is "$(samples 'rows[0][1] == [math.floor(255 * (1.055 * 0.2 ** (1 / 2.4) - 0.055) + 0.5)]')" True
is "$(material .extensions.KHR_materials_sheen.sheenColorTexture)" '{"index":0}'

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
run --flip-green=auto quad.obj quad.glb
exits 0
is "$(gltf quad.glb 'g.images.length')" 1

scene "maps that would be too large together are told, and their numbers count"
images write wide.png 20000 1 '(9, 9, 9)'
images write tall.png 1 20000 '(9, 9, 9)'
quad "Pr 0.25" "map_Pr wide.png" "map_Pm tall.png"
run -v quad.obj quad.glb
exits 0
says "IMAGE_DAMAGED"
is "$(material .pbrMetallicRoughness.roughnessFactor)" 0.25

scene "the same bytes for every number of threads"
for i in 1 2 3 4; do images write "$i.tga" 64 $((i * 16)) '(x + y, x, y)'; done
quad "map_Kd 1.tga" "map_d 2.tga" "map_Pr 3.tga" "map_Pm 4.tga" "map_Ke 2.tga"
run -j1 quad.obj one.glb
exits 0
run -j8 quad.obj eight.glb
same one.glb eight.glb

done_testing
