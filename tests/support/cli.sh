# SPDX-License-Identifier: MIT
#
# What every tests/cli/test_*.sh sources: small words for running $NMTAN as its users do and saying in
# TAP what came of it. Each case works in a fresh folder, so that what lies there afterwards is its doing.
#
#   scene "a sentence"         begins a case
#   run ARGUMENTS...           runs nmtan; $status, out.txt and err.txt (in ..) hold what came back
#   exits N / says TEXT / silent / prints TEXT / exists FILE... / only FILE...
#   done_testing               at the end
set -u
data=$ROOT/data
calls=$BUILD/tests/preload/calls.so
cases=0 bad=0
case_name= case_ok=true

finish_case() {
	[ -n "$case_name" ] || return 0
	cases=$((cases + 1))
	if $case_ok; then
		echo "ok - $case_name$case_without"
	else
		bad=$((bad + 1))
		echo "not ok - $case_name"
	fi
	case_name=
}

scene() {
	finish_case
	case_name=$1 case_ok=true case_without= status=
	cd "$WORK" && { rm -rf here out.txt err.txt || { chmod -R u+rwX . && rm -rf here out.txt err.txt; }; } 2>/dev/null && mkdir here &&
		cd here || exit 1
}

# Ends the case at once as skipped, with the reason.
skip_case() {
	[ -n "$case_name" ] || return 0
	cases=$((cases + 1))
	echo "ok - $case_name # SKIP $1"
	case_name=
}

wrong() {
	case_ok=false
	echo "# $*"
	[ ! -s "$WORK/err.txt" ] || sed 's/^/#   stderr: /' "$WORK/err.txt" | head -20
	[ -z "${NT_STOP-}" ] || { echo "not ok - $case_name"; exit 1; }
}

run() {
	"$NMTAN" "$@" >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
	status=$?
}

# Runs the tool between the system and itself, with what tests/preload/calls.c takes in the environment.
run_under_calls() {
	LD_PRELOAD=$calls ASAN_OPTIONS=${ASAN_OPTIONS-}:verify_asan_link_order=0 run -j1 "$@"
}

exits() {
	[ "$status" = "$1" ] || wrong "exit code $status, expected $1"
}

# has FILE TEXT: the file has the text in a line; without grep, which takes longer to begin than all else here.
has() {
	local parts part
	mapfile -d '' parts <"$1"
	for part in "${parts[@]}"; do
		[[ $part != *"$2"* ]] || return 0
	done
	return 1
}

says() {
	has "$WORK/err.txt" "$1" || wrong "standard error does not say: $1"
}

says_not() {
	! has "$WORK/err.txt" "$1" || wrong "standard error says: $1"
}

prints() {
	has "$WORK/out.txt" "$1" || wrong "standard output does not say: $1"
}

silent() {
	[ ! -s "$WORK/err.txt" ] || wrong "standard error is not empty"
	[ ! -s "$WORK/out.txt" ] || wrong "standard output is not empty"
}

exists() {
	local file
	for file; do
		[ -s "$file" ] || wrong "$file is missing or empty"
	done
}

# The folder holds these names and nothing else.
only() {
	local expected found
	expected=$(printf '%s\n' "$@" | sort | tr '\n' ' ')
	found=$(ls -A | sort | tr '\n' ' ')
	[ "$#" != 0 ] || expected=
	[ "$expected" = "$found" ] || wrong "the folder holds: $found, expected: $expected"
}

same() {
	cmp -s "$1" "$2" || wrong "$1 and $2 differ"
}

is() {
	[ "$1" = "$2" ] || wrong "got '$1', expected '$2'"
}

# ask FILE WORDS...: what one process says that answers all questions of this script, since Python and Node take long to begin.
# Two at the same time are two processes.
ask() {
	local folder=$WORK/.ask/$1 program=(node "$ROOT/tests/support/$1") command status parts
	command=("${program[@]}")
	[[ $1 != *.py ]] || { program[0]=python3 command=(python3); }
	if [ ! -d "$folder" ]; then
		mkdir -p "$folder" && mkfifo "$folder/ask" "$folder/said" || return 1
		(cd / && setsid --fork "${program[@]}" --serve "$folder" </dev/null >/dev/null 2>"$folder/fault")
	fi
	set -C
	{ : >"$folder/busy"; } 2>/dev/null
	status=$?
	set +C
	[ $status = 0 ] || { command "${command[@]}" "${@:2}"; return; }
	printf '%s\0' "$BASHPID" "$PWD" "${@:2}" >"$folder/ask"
	read -r status <"$folder/said"
	mapfile -d '' parts <"$folder/out"
	[ ${#parts[@]} = 0 ] || { printf '%s' "${parts[0]}" && [ ${#parts[@]} = 1 ] || printf '\0%s' "${parts[@]:1}"; }
	[ ! -s "$folder/err" ] || cat "$folder/err" >&2
	rm "$folder/busy"
	return "$status"
}
trap 'for pid in "$WORK"/.ask/*/pid; do kill "$(<"$pid")"; done 2>/dev/null' EXIT
python3() {
	case $1 in
	- | -c | *.py) ask answer.py "$@" ;;
	*) command python3 "$@" ;;
	esac
}

# The value of a JavaScript expression over a glTF file: see gltf.mjs.
gltf() { ask answer.mjs gltf "$@"; }

# The value of a Python expression over r, which is what a JSON file holds, or a page of a report.
value() {
	python3 -c 'import json, re, sys
text = open(sys.argv[1], encoding="utf-8").read()
page = re.search(r"id=\"data\">(.*?)</script>", text, re.S)
r = json.loads(page.group(1) if page else text)
print(eval(sys.argv[2]))' "$@"
}

# validates KIND FILE...: each is as the schema of data/ says; with --lines before KIND, each line.
validates() {
	local lines=
	[ "$1" != --lines ] || { lines=$1; shift; }
	python3 "$ROOT/tests/report/schema.py" $lines "$data/nmtan-$1.schema.json" "${@:2}" >"$WORK/faults.txt" ||
		wrong "$(head -3 "$WORK/faults.txt")"
}

# The output has no error in the Khronos validator that its input (if any) did not have.
valid() {
	if [ -f "$ROOT/build/node/node_modules/gltf-validator/package.json" ]; then
		ask answer.mjs validate "$@" || wrong "$1 is not valid"
	else
		case_without=" # SKIP gltf-validator is not installed (no network?)" # all else of the case is asked
	fi
}

# Until a command succeeds, one minute at most.
await() {
	local try
	for ((try = 0; try < 6000; try++)); do
		"$@" && return
		sleep 0.01
	done
	return 1
}

# Until a file that is touched now has a later time than all that were before, whatever the grain of the file system's clock;
# and longer than that of --update (src/batch/record.c).
later() {
	touch "$WORK/before"
	sleep 0.03
	await eval 'touch "$WORK/after" && [ "$WORK/after" -nt "$WORK/before" ]'
}

# An OBJ grid of N by N quads with texture coordinates: big enough to last a while.
grid_obj() {
	awk -v n="$1" 'BEGIN {
		for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
			printf "v %g %g %g\n", i / n, j / n, 0.05 * sin(i * 0.3) * cos(j * 0.2)
			printf "vt %g %g\n", i / n, j / n
		}
		for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
			a = j * (n + 1) + i + 1; b = a + 1; c = b + n + 1; d = c - 1
			printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, d, d
		}
	}'
}

# cases_of PREFIX PROGRAM ARGUMENTS...: what node says in TAP, each case under a prefix.
cases_of() {
	local prefix=$1 line
	shift
	node "$@" >"$WORK/tap.txt" 2>&1
	local ended=$?
	while IFS= read -r line; do
		case $line in
		"ok - "*) scene "$prefix: ${line#ok - }" ;;
		"not ok - "*)
			scene "$prefix: ${line#not ok - }"
			wrong "$(grep "^#" "$WORK/tap.txt" | head -30)"
			;;
		esac
	done <"$WORK/tap.txt"
	scene "$prefix: ends with 0"
	[ $ended = 0 ] && grep -q '^1\.\.' "$WORK/tap.txt" || wrong "$(tail -20 "$WORK/tap.txt" | sed "s,^,# ,")"
	finish_case
}

done_testing() {
	finish_case
	echo "1..$cases"
	[ $bad = 0 ]
}
