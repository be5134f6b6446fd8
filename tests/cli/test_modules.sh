# SPDX-License-Identifier: MIT
# Modules: opened when an input needs them, from the tool's folder alone as long as it is not installed
# (tests/tree/test_install.sh has the installed one), and what is said where one is not there or not the right one.
. "$ROOT/tests/support/cli.sh"

"$NMTAN" -q --draco=edgebreaker "$data/plates.glb" "$WORK/draco.glb" || exit 1
"$NMTAN" -q --draco=sequential "$data/plates.glb" "$WORK/second.glb" || exit 1
built=$NMTAN

# The tool in a folder of its own, with the modules that are named.
lone_tool() {
	local name
	mkdir -p tool
	cp "$built" tool/nmtan
	for name; do cp "$BUILD/nmtan-$name.so" tool/; done
	NMTAN=$PWD/tool/nmtan
}

scene "the tool alone converts and checks what is not compressed"
lone_tool
for input in head.obj quad_wedge.ply plates.glb sparse.gltf; do
	run "$data/$input" "${input%.*}.glb"
	exits 0
	run --check --fail-on=never --report=r.html "$data/$input"
	exits 0
done
run "$data/quad_wedge.ply" out.ply
exits 0
run "$data/plates.glb" out.gltf
exits 0

scene "a module that is missing is named, with its folder and the input that needs it"
lone_tool
run --existing=replace "$WORK/draco.glb" out.glb
exits 5
says "$WORK/draco.glb: /bufferViews/3: mesh \"plates\", primitive 0, material \"bumpy\": Draco compression needs the module"
says "the module nmtan-draco.so, which is not in $PWD/tool"
run --draco=sequential "$data/plates.glb" out.glb
exits 5
says "nmtan-draco.so"
run --verify "$data/quad.obj" out.glb
exits 5
says "nmtan-tinygltf.so"
run -q --check-maps=on --check "$data/plates.glb"
exits 5
says "nmtan-png.so"
only tool

scene "a pipe or a folder with the name of a module is none"
lone_tool
mkfifo tool/nmtan-draco.so
mkdir tool/nmtan-tinygltf.so
NMTAN=timeout
run 60 tool/nmtan --existing=replace "$WORK/draco.glb" out.glb
exits 5
says "the module nmtan-draco.so, which is not in $PWD/tool"
run 60 tool/nmtan --verify "$data/quad.obj" out.glb
exits 5
says "the module nmtan-tinygltf.so, which is not in $PWD/tool"

scene "OpenMesh is needed where boundaries fork, not where they are plain"
lone_tool
printf '%s\n' "v 0 0 0" "v 1 0 0" "v 0 1 0" "v -1 0 0" "v 0 -1 0" "f 1 2 3" >plain.obj
{ cat plain.obj; echo "f 1 4 5"; } >fork.obj
run --check --fail-on=never plain.obj
exits 0
run --check fork.obj
exits 5
says "fork.obj: a report on seams or boundaries that fork needs the module nmtan-openmesh.so"
NMTAN=$built
run --check --fail-on=never fork.obj
exits 0

scene "with several inputs, those that need no module are converted"
lone_tool
run --existing=replace -d out "$data/quad.obj" "$WORK/draco.glb" "$data/plates.glb"
exits 5
says "draco.glb: /bufferViews/3"
exists out/quad.glb out/plates.glb

scene "a report says which maps were not examined for want of a module"
lone_tool
run --check --fail-on=never --report=r.json "$data/plates.glb"
exits 0
grep -q '"NMAP_NOT_EXAMINED"' r.json && grep -q 'nmtan-png.so' r.json || wrong "no finding"

scene "beside the tool, whatever name it is called by, modules are found"
lone_tool draco tinygltf
mkdir elsewhere
ln -s ../tool/nmtan elsewhere/called
(cd elsewhere && ./called -q --existing=replace --verify "$WORK/draco.glb" out.glb) || wrong "not found"
"$built" -q --existing=replace "$WORK/draco.glb" same.glb
same elsewhere/out.glb same.glb

scene "neither the working folder nor the environment is looked in"
lone_tool
cp "$BUILD"/nmtan-*.so .
LD_LIBRARY_PATH=$PWD PATH=$PWD:$PATH run --existing=replace "$WORK/draco.glb" out.glb
exits 5
says "nmtan-draco.so, which is not in $PWD/tool"

scene "modules of another version, or none at all, are refused"
version=$("$built" --version | cut -d' ' -f2)
lone_tool
LC_ALL=C sed "s/${version//./\\.}\x00/$(tr '[0-9]' 9 <<<"$version")\x00/g" "$BUILD/nmtan-draco.so" >tool/nmtan-draco.so
run --existing=replace "$WORK/draco.glb" out.glb
exits 5
says "tool/nmtan-draco.so is a module of nmtan $(tr '[0-9]' 9 <<<"$version"), expected one of nmtan $version"
cp "$BUILD/nmtan-png.so" tool/nmtan-draco.so
run --existing=replace "$WORK/draco.glb" out.glb
exits 5
says "tool/nmtan-draco.so is no module of nmtan"
for content in "" text; do
	printf %s "$content" >tool/nmtan-draco.so
	run --existing=replace "$WORK/draco.glb" out.glb
	exits 5
	says "tool/nmtan-draco.so cannot be opened"
done
only tool

scene "several jobs that need one at the same time have the same results"
for i in 1 2 3 4 5 6 7 8; do cp "$WORK/draco.glb" $i.glb && cp "$WORK/second.glb" s$i.glb; done
NMTAN=$built
run -q --existing=replace --threads=8 -d out ?.glb s?.glb
exits 0
for i in 2 3 4 5 6 7 8; do same out/1.glb out/$i.glb && same out/s1.glb out/s$i.glb; done

scene "--version -v tells what is there"
lone_tool png
run --version -v
exits 0
prints "png: libspng "
prints "draco: Draco compression needs the module nmtan-draco.so"
run --version
is "$(wc -l <"$WORK/out.txt")" 1

scene "--version -v names every foreign library and its licence"
NMTAN=$built
run --version -v
exits 0
for library in $(sed -n 's/^TOOL_LIBS := -Wl,-Bstatic \(.*\) -Wl,-Bdynamic.*/\1/p' "$ROOT/Makefile"); do
	grep -q "^linked: lib${library#-l}.*, [A-Za-z]" "$WORK/out.txt" || wrong "$library is not named"
done
for module in "$BUILD"/nmtan-*.so; do
	for library in $(readelf -d "$module" | sed -n 's/.*NEEDED.*\[lib\([A-Za-z]*\).*/\1/p'); do
		case $library in
		c | m | gcc | stdc | asan | ubsan) ;;
		OpenMeshCore) prints "OpenMesh " ;;
		*) grep -qi "$library.*, [A-Za-z]" "$WORK/out.txt" || wrong "$library of $module is not named" ;;
		esac
	done
done

# Sanitizers bring libraries of their own, and take more address space than there may be here.
case $BUILD in
*release) ;;
*)
	done_testing
	exit
	;;
esac

scene "the tool itself needs no library but the system's"
is "$(readelf -d "$built" | grep NEEDED | grep -vE '\[(libm|libc|ld-linux[^]]*)\.so' | wc -l)" 0

scene "where memory ends while a module is opened, the run says so"
for ((kilobytes = 60000; kilobytes < 400000; kilobytes += 1250)); do
	(
		ulimit -v $kilobytes
		exec "$built" -q --threads=1 --existing=replace --verify "$WORK/draco.glb" out.glb
	) 2>"$WORK/err.txt"
	status=$?
	case $status in
	0) break ;;
	4 | 5) [ -s "$WORK/err.txt" ] || wrong "nothing is said with $kilobytes kB" ;;
	*) wrong "exit code $status with $kilobytes kB" ;;
	esac
	rm -f out.glb
done
is "$status" 0

done_testing
