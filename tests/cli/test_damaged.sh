# SPDX-License-Identifier: MIT
# Every damaged file of data/damaged is refused with the exit code, the place and the reason that stand
# in damaged.tsv: file, exit code, how the message begins, words of the reason. Exit code 0: what is
# wrong is left out, with a finding.
. "$ROOT/tests/support/cli.sh"

while IFS=$'\t' read -r file code place reason; do
	case $file in "" | "#"*) continue ;; esac
	if [ "$code" = 0 ]; then
		scene "$file is converted with a finding at $place"
	else
		scene "$file is refused at $place"
	fi
	cp -r "$data/damaged/." in
	rm -rf in/make.py in/__pycache__
	(cd in && exec "$NMTAN" -v --only=all "$file" ../out.glb) >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
	status=$?
	exits "$code"
	says "nmtan: $place"
	says "$reason"
	if [ "$code" = 0 ]; then only in out.glb; else only in; fi
done <"$ROOT/tests/cli/damaged.tsv"

scene "every damaged file is in the table"
for file in "$data"/damaged/*.obj "$data"/damaged/*.ply "$data"/damaged/*.glb "$data"/damaged/*.gltf; do
	grep -q "^${file##*/}	" "$ROOT/tests/cli/damaged.tsv" || wrong "${file##*/} is not in damaged.tsv"
done

done_testing
