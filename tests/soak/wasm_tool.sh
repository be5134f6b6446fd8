#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/wasm_tool.sh BUILD: the tool of the npm package (src/bindings/tool) does what BUILD's does: files, messages,
# reports and exit codes are the same, for data, ../shared/models, goldens and NT_CORPUS (a folder, as an absolute path), and
# for commands that use more of the system than one file in and out; Windows is what tests/bindings/windows.mjs makes of it.
# A run over files in memory, as a page makes it, gives the same bytes. Builds the package, and installs emscripten for it.
set -u
cd "$(dirname "$0")/../.." || exit 1
native=$PWD/$1/nmtan package=$PWD/build/npm-tool
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
make -s wasm-tool >"$work/make.log" 2>&1 || { tail -n 20 "$work/make.log" | cut -c1-300; echo "wasm_tool.sh: cannot be built"; exit 1; }
checked=0 faults=0

# both NAME COMMAND: runs the command twice in folders of their own; nmtan is either tool there. Times are left out.
both() {
	local name=$1 tool
	for tool in native npm; do
		rm -rf "$work/$tool" && mkdir "$work/$tool"
		(
			cd "$work/$tool" || exit 1
			if [ $tool = native ]; then
				nmtan() { "$native" "$@"; }
			else
				nmtan() { node "$package/nmtan.js" "$@"; }
			fi
			eval "$2" >out 2>err
			echo $? >status
			sed -i -E 's/[0-9.]+ m?s$//; s/[0-9.]+ m?s(,|;)/\1/' err
			find . -name .nmtan-record -delete
			[ -z "$(find . -name '*.tmp')" ] || echo "temporary files are left" >>err
		)
	done
	checked=$((checked + 1))
	diff -r "$work/native" "$work/npm" >"$work/difference" || {
		faults=$((faults + 1))
		echo "wasm_tool.sh: $name:"
		head -n 5 "$work/difference" | cut -c1-200
	}
}

while IFS= read -r file; do
	both "$file" 'nmtan "$file" out.glb --report=report.json; nmtan --check "$file"'
done < <(find -L "$PWD/data" "$PWD/../shared/models" "$PWD/../shared/golden" ${NT_CORPUS-} -size -2M \
	\( -name '*.obj' -o -name '*.glb' -o -name '*.gltf' -o -name '*.ply' -o -name '*.drc' \) | sort)

cube=$PWD/data/mirrored_cube.obj
both "a pipe" "nmtan -q - - <'$cube' | cat >piped.glb"
both "standard input" "nmtan - out.glb <'$cube'"
both "standard output" "nmtan '$cube' -"
both "a set" "nmtan '$cube' out.gltf && nmtan out.gltf out.gltf --existing=replace"
both "PLY" "nmtan '$cube' out.ply && nmtan out.ply again.glb"
both "Draco, compared" "nmtan '$cube' a.glb; nmtan a.glb out.glb --draco=edgebreaker --existing=replace; nmtan --verify out.glb again.glb --existing=replace"
both "a folder" "cp '$PWD'/data/*.obj '$PWD'/data/*.mtl . && nmtan -d made -- *.obj"
both "brought up to date" "cp '$cube' a.obj; nmtan --update -d made a.obj; nmtan --update -d made a.obj; touch a.obj; nmtan --update -d made a.obj"
both "a difference" "nmtan '$cube' a.glb; nmtan '$cube' b.glb --method=area; nmtan --check --diff a.glb b.glb"
both "checked" "nmtan --check '$cube' && nmtan --check --fail-on=info '$cube'"
both "every report" "for kind in json sarif html csv markdown junit lines github text; do nmtan --check --report=report.\$kind --report-format=\$kind '$cube'; done"
both "no clobber" "echo mine >out.glb; nmtan --no-clobber '$cube' out.glb"
both "in place" "nmtan '$cube' a.glb && chmod 640 a.glb && nmtan a.glb a.glb --existing=replace && stat -c %a a.glb"
both "not there" "nmtan missing.obj out.glb"
both "a wrong option" "nmtan --wrong"
both "help" "nmtan --help"

cat >"$work/memory.cjs" <<'END'
const {readFileSync} = require('node:fs');
const create = require(process.argv[2] + '/nmtan-tool.js');
(async () => {
	const source = readFileSync(process.argv[2] + '/run.js');
	const {run} = await import('data:text/javascript;base64,' + source.toString('base64'));
	const module = new WebAssembly.Module(readFileSync(process.argv[2] + '/nmtan-tool.wasm'));
	const files = Object.fromEntries(['mirrored_cube.obj', 'mirrored_cube.mtl', 'bumps.png'].map((name) =>
		[name, readFileSync('data/' + name)]));
	const made = await run(create, module, {argv: ['mirrored_cube.obj', 'out.glb'], files});
	const refused = await run(create, module, {argv: ['missing.obj', 'out.glb'], files});
	if (Object.keys(made.files).join() !== 'out.glb' || made.status !== 0 || refused.status === 0 ||
		!refused.stderr.includes('missing.obj') || Object.keys(refused.files).length)
		throw new Error(JSON.stringify([made, refused]).slice(0, 300));
	process.stdout.write(made.files['out.glb']);
})();
END
"$native" -q "$cube" "$work/out.glb"
checked=$((checked + 1))
node "$work/memory.cjs" "$PWD/build/web-tool" >"$work/memory.glb" && cmp "$work/memory.glb" "$work/out.glb" ||
	{ faults=$((faults + 1)); echo "wasm_tool.sh: files in memory"; }

# As on Windows: C: and \\server\share are folders of $d. $w has the same for the native tool.
d=$work/drives w=$work/plain
mkdir -p "$w/tex" "$d/D"
sed 's/$/\r/' "$cube" >"$w/cube.obj"
printf 'newmtl bumps\r\nmap_Bump tex\\bumps.png\r\n' >"$w/mirrored_cube.mtl"
cp data/bumps.png "$w/tex"
for folder in C/a C/desk SERVER+SHARE; do
	mkdir -p "$d/$folder/Tex"
	cp "$w/tex/bumps.png" "$d/$folder/Tex/BUMPS.PNG"
	cp "$w/mirrored_cube.mtl" "$d/$folder"
	cp "$w/cube.obj" "$d/$folder/Cube.OBJ"
done
printf 'C:\\desk\\cube.obj\r\n' >"$d/C/list"

# windows NAME STATUS STDERR FILE WORDS...: the words make FILE, if it is named, as the native tool makes it of cube.obj.
windows() {
	local name=$1 status=$2 said=$3 file=$4
	shift 4
	checked=$((checked + 1))
	NT_DRIVES=$d node "$PWD/tests/bindings/windows.mjs" "$package/nmtan.js" "$@" >"$work/out" 2>"$work/err" </dev/null
	[ $? = "$status" ] && grep -qE "$said" "$work/err" &&
		{ [ -z "$file" ] || { (cd "$w" && "$native" -q cube.obj "${file##*/}") && cmp "$d/$file" "$w/${file##*/}"; }; } ||
		{ faults=$((faults + 1)); echo "wasm_tool.sh: Windows, $name:"; head -n 5 "$work/err"; }
}
windows "a drive" 0 '^nmtan: C:/a/cube.obj -> D:/x.glb: ' D/x.glb 'C:\a\cube.obj' 'D:\x.glb'
windows "another folder" 0 '^nmtan: ../a/cube.obj -> ../desk/x.glb: ' C/desk/x.glb '..\a\cube.obj' '..\desk\x.glb'
windows "a share" 0 '^nmtan: //server/share/cube.obj -> //server/share/x.gltf: ' SERVER+SHARE/x.gltf '\\server\share\cube.obj' '\\server\share\x.gltf'
windows "a list" 0 '^nmtan: C:/desk/cube.obj -> D:/made/cube.glb: ' D/made/cube.glb -d 'D:\made' --update '--files-from=C:\list'
windows "up to date" 0 'D:/made/cube.glb: up to date' D/made/cube.glb -d 'D:\made' --update -v 'C:\desk\cube.obj'
windows "a device" 2 'D:/aux.glb: cannot write: Invalid argument' '' 'C:\a\cube.obj' 'D:\aux.glb'
windows "not there" 2 '^nmtan: C:/a/missing.obj: no such file' '' 'C:\a\missing.obj' 'D:\y.glb'
windows "one output" 1 "would both be written to '.*D:/made/" '' -d 'D:\made' 'C:\a\CUBE.obj' 'C:\desk\cube.obj'
windows "a report" 0 '' '' --check '--report=C:\r.json' 'C:\a\cube.obj'
[ -s "$d/C/r.json" ] && cmp "$d/SERVER+SHARE/x.bin" "$w/x.bin" && [ -z "$(find "$d" -name '*.tmp')" ] ||
	{ faults=$((faults + 1)); echo "wasm_tool.sh: Windows: the files are $(find "$d" | xargs)"; }

# A start, the best of five, below 150 ms; the package at most 6 MB.
best=$(for _ in 1 2 3 4 5; do begin=$(date +%s%N); node "$package/nmtan.js" --version >/dev/null; echo $((($(date +%s%N) - begin) / 1000000)); done | sort -n | head -n 1)
size=$(tar -czf - -C "$package" . | wc -c)
[ "$best" -lt 150 ] && [ "$size" -lt 6000000 ] || { faults=$((faults + 1)); echo "wasm_tool.sh: a start takes $best ms, the package $size bytes"; }
echo "wasm_tool.sh: $checked runs compared, $faults differ; a start takes $best ms, the package $size bytes"
[ $faults = 0 ]
