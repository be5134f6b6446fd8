# SPDX-License-Identifier: MIT
# Who shares accessors, views and bytes with whom, in each layout, with each kind of tangents: the table of
# support/gltf_table.py, which knows what the output has to be.
. "$ROOT/tests/support/cli.sh"
table=$ROOT/tests/support/gltf_table.py
# under a sanitizer some will do
case $BUILD in *release*) stride=1 ;; *) stride=3 ;; esac
mkdir "$WORK/table" && cd "$WORK/table" && python3 "$table" make || exit 1

while read -r name options; do
	scene "who shares what, $name: ${options:-no options}"
	cd "$WORK/table" || exit 1
	python3 "$table" run "$name" "$NMTAN" $stride >"$WORK/err.txt" 2>&1 || wrong "$name"
done < <(python3 "$table" sets)

[ $stride = 1 ] || { done_testing; exit; }
scene "the validator finds no error in them that the input did not have"
valid --pairs "$WORK/table/pairs"

done_testing
