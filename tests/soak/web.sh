#!/bin/bash
# SPDX-License-Identifier: MIT
# web.sh BUILD: the page of make web in Chromium, with files that are dropped: see web.mjs. NT_HELMET names a DamagedHelmet.glb,
# which is dropped as it is and as gltfpack makes it worse; without it both cases are left out.
nmtan=$PWD/$1/nmtan
t=$(mktemp -d)
trap 'rm -rf "$t"' EXIT
make -s web >"$t/make" 2>&1 || { tail -5 "$t/make"; echo "web.sh: make web fails"; exit 1; }
mkdir "$t/in" && cd "$t/in" || exit 1
data=$OLDPWD/data
cp "$data"/{head.obj,plates.glb,plates.gltf,plates.bin,bumps.png} .
"$nmtan" -q --draco=edgebreaker --only=all --existing=replace plates.glb draco.glb
head -c 900 draco.glb >damaged.glb
truncate -s 2200000000 large.glb
cp head.obj '<img src=x onerror=window.broken=1>.obj'
cp head.obj -- "-'\"\$(x).obj"
[ -z "${NT_HELMET-}" ] || cp "$NT_HELMET" Helmet.glb
[ -z "${NT_HELMET-}" ] || node "$OLDPWD/build/node/node_modules/gltfpack/cli.js" -noq -gt -i "$NT_HELMET" -o DamagedHelmet.glb >/dev/null
python3 "$OLDPWD/tests/support/images.py" write colour.tga 64 64 '(x * 4, y * 4, 128)'
{ echo "mtllib set.mtl"; cat head.obj; } | sed '0,/^f /s//usemtl skin\nf /' >set.obj
printf 'newmtl skin\nmap_Kd colour.tga\n' >set.mtl
python3 - <<'END'
import zipfile
def archive(name, *files, **other):
    with zipfile.ZipFile(name, "w", zipfile.ZIP_DEFLATED) as z:
        for file in files: z.write(file, "set/" + file)
        for path, text in other.items(): z.writestr(path.replace("_up_", "../"), text)
archive("set.zip", "set.obj", "set.mtl", "colour.tga")
archive("outside.zip", "set.obj", _up_evil="x")
with zipfile.ZipFile("bomb.zip", "w", zipfile.ZIP_DEFLATED) as z:
    for i in range(11):
        with z.open(f"{i}.obj", "w", force_zip64=False) as f:
            for _ in range(100): f.write(bytes(1000000))
n = 707
with open("million.obj", "w") as f:
    for j in range(n + 1):
        for i in range(n + 1): f.write(f"v {i} {j} {(i * j % 97) / 97:.3f}\nvt {i / n:.5f} {j / n:.5f}\n")
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            f.write(f"f {a}/{a} {a + 1}/{a + 1} {a + n + 2}/{a + n + 2} {a + n + 1}/{a + n + 1}\n")
END
rm colour.tga set.mtl
mkdir folder && cp plates.gltf plates.bin bumps.png folder && cp head.obj folder/another.obj
node "$OLDPWD/tests/soak/web.mjs" "$OLDPWD/build/node/node_modules" "$OLDPWD/build/web" "$nmtan" "$t/in"
