# SPDX-License-Identifier: MIT
# Depfiles: make and Ninja make again exactly what has to be.
# Leaks count.
. "$ROOT/tests/support/cli.sh"
unset MAKEFLAGS MFLAGS MAKELEVEL # of the make that runs the tests: it may be silent

take() {
	cp "$data"/mirrored_cube.* "$data/bumps.png" "$data"/plates.gltf "$data/plates.bin" .
}

scene "a depfile names what was read, from the current folder on where the output is named so"
take
run --depfile=d mirrored_cube.obj out.glb
exits 0
is "$(sed -n '1,/[^\\]$/p' d | tr -d '\\\n' | tr -s ' ')" "out.glb: mirrored_cube.obj mirrored_cube.mtl bumps.png"
is "$(tail -2 d | tr '\n' ' ')" "mirrored_cube.mtl: bumps.png: "
run --update -d out plates.gltf
run --update --depfile=again -d out plates.gltf
says "up to date"
is "$(sed -n '1,/[^\\]$/p' again | tr -d '\\\n' | tr -s ' ')" "out/plates.gltf: plates.gltf plates.bin bumps.png"
run --depfile=absolute "$PWD/mirrored_cube.obj" "$PWD/out.glb"
is "$(sed -n '1,/[^\\]$/p' absolute | tr -d '\\\n' | tr -s ' ')" \
	"$PWD/out.glb: $PWD/mirrored_cube.obj $PWD/mirrored_cube.mtl $PWD/bumps.png"

scene "a depfile names the folder in which a file may come to be, also if a folder in between is missing"
take
sed -i 's|^mtllib.*|mtllib sub/folder/cube.mtl|' mirrored_cube.obj
mkdir out
run --depfile=d mirrored_cube.obj out/o.glb
exits 0
is "$(sed -n '1,/[^\\]$/p' d | tr -d '\\\n' | tr -s ' ')" "out/o.glb: mirrored_cube.obj ."
mkdir sub
run --depfile=d mirrored_cube.obj out/o.glb
is "$(sed -n '1,/[^\\]$/p' d | tr -d '\\\n' | tr -s ' ')" "out/o.glb: mirrored_cube.obj sub"

scene "a depfile is refused where it would be wrong, and stays where nothing was made"
take
echo mine >d
run --depfile=d missing.obj o.glb
exits 2
is "$(cat d)" mine
run --depfile=mirrored_cube.obj mirrored_cube.obj o.glb
exits 2
says "the same file as the input"
same mirrored_cube.obj "$data/mirrored_cube.obj"
run --depfile=d mirrored_cube.obj -
exits 1
says "--depfile"
cp mirrored_cube.obj $'line\nfeed.obj'
run --depfile=d $'line\nfeed.obj' o.glb
exits 5
says "a name with a line feed cannot be in a depfile"

# Names that hurt: blanks, backslashes before them, "#", "$", ":". The depfiles alone tell of them.
hard=('two words.obj' 'back\slash.obj' 'back\ blank.obj' 'ha#sh.obj' 'dol$lar.obj' 'co:lon.obj' '100%.obj' 'br[1].obj')

take_hard() {
	local name
	take
	for name in "${hard[@]}"; do cp mirrored_cube.obj "$name"; done
}

all_hard() {
	local i
	for i in "${!hard[@]}"; do printf 'h%s.glb ' $i; done
}

# For each name: what a build makes after it was touched.
touch_hard() {
	local name
	for name in "${hard[@]}"; do
		later
		touch "$name"
		echo "$name: $("$@" | grep -o 'h[0-9]*\.glb$' | sort -u | tr '\n' ' ')"
	done
}

expected_hard() {
	local i
	for i in "${!hard[@]}"; do echo "${hard[i]}: h$i.glb "; done
}

scene "make makes again exactly what was made of a file that changed"
hard+=('back\#hash.obj') # which Ninja has no spelling for that make reads, too
take_hard
{
	echo "all: $(all_hard) plates.glb"
	for i in "${!hard[@]}"; do
		printf 'h%s.glb:\n\t@echo $@\n\t@"%s" -q --ignore=MTL_MISSING --depfile=$@.d '"'%s'"' $@\n' $i "$NMTAN" "${hard[i]//\$/\$\$}"
	done
	printf '%%.glb: %%.gltf\n\t@echo $@\n\t@"%s" -q --depfile=$@.d $< $@\n' "$NMTAN"
	echo '-include $(wildcard *.d)'
} >Makefile
make >made 2>&1 || wrong "$(cat made)"
is "$(make)" "make: Nothing to be done for 'all'."
touch_hard make >touched 2>&1
expected_hard >expected
diff expected touched >difference || wrong "$(cat difference)"
later
touch plates.bin
is "$(make)" plates.glb
later
touch mirrored_cube.mtl
is "$(make | tr '\n' ' ')" "$(all_hard)"
is "$(make)" "make: Nothing to be done for 'all'."
rm mirrored_cube.mtl
is "$(make 2>&1 | tr '\n' ' ')" "$(all_hard)"
is "$(make)" "make: Nothing to be done for 'all'."

scene "Ninja makes again exactly what was made of a file that changed, and nothing after what has not"
unset 'hard[-1]'
take_hard
{
	echo "rule nmtan"
	echo "  command = \"$NMTAN\" -q --write-if-changed --depfile=\$out.d \$input \$out"
	echo "  depfile = \$out.d"
	echo "  deps = gcc"
	echo "  restat = 1"
	echo "rule size"
	echo "  command = wc -c <\$in >\$out"
	for i in "${!hard[@]}"; do
		echo "build h$i.glb: nmtan"
		printf "  input = '%s'\n" "${hard[i]//\$/\$\$}"
		echo "build h$i.size: size h$i.glb"
	done
	printf "build plates.glb: nmtan\n  input = plates.gltf\n"
} >build.ninja
ninja >made 2>&1 || wrong "$(cat made)"
is "$(ninja)" "ninja: no work to do."
touch_hard ninja -v >touched 2>&1
expected_hard >expected
diff expected touched >difference || wrong "$(cat difference)"
# the library was touched, not changed, so what is made from the outputs is not made again
later
touch mirrored_cube.mtl
ninja -v >made
is "$(grep -o 'h[0-9]*\.glb$' made | sort -u | tr '\n' ' ')" "$(all_hard)"
! grep -q 'wc -c' made || wrong "restat has no effect: $(cat made)"
later
touch plates.bin
ninja -v >made
is "$(grep -o '[a-z0-9]*\.glb$' made | sort -u | tr '\n' ' ')" "plates.glb "
is "$(ninja)" "ninja: no work to do."

done_testing
