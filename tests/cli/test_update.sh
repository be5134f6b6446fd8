# SPDX-License-Identifier: MIT
# Doing only what is needed: what is there stays, what is up to date is not read, and nothing is lost when a batch ends early.
. "$ROOT/tests/support/cli.sh"

# Inode and time of change.
identity() {
	stat -c '%i %y' "$@"
}

# q.obj, whose normal map n.png is not there.
quad_with_map() {
	{ echo "mtllib q.mtl" && echo "usemtl q" && grep -v '^#\|^usemtl\|^mtllib' "$data/quad.obj"; } >q.obj
	printf '%s\n' "newmtl q" "norm n.png" >q.mtl
}

scene "an output that has its bytes already keeps its inode and time with --write-if-changed, and not without"
run "$data/quad.obj" o.glb
before=$(identity o.glb)
run --write-if-changed "$data/quad.obj" o.glb
exits 0
says "left as it is"
is "$(identity o.glb)" "$before"
run --write-if-changed --bitangents "$data/quad.obj" o.glb
exits 0
says_not "left as it is"
run "$data/quad.obj" o.glb
[ "$(identity o.glb)" != "$before" ] || wrong "the output was not replaced"
only o.glb

scene "--write-if-changed keeps the files beside the output, too"
run "$data/quad.obj" o.gltf
before=$(identity o.gltf o.bin)
run --write-if-changed "$data/quad.obj" o.gltf
exits 0
is "$(identity o.gltf o.bin)" "$before"
only o.gltf o.bin

scene "--no-clobber decides before anything is read"
echo "no mesh at all" >bad.obj
echo "mine" >o.glb
run -n bad.obj o.glb
exits 2
says "o.glb: refusing to write: the file exists already"
run -n bad.obj other.glb
exits 3
is "$(cat o.glb)" mine
run -n "$data/quad.obj" new.glb
exits 0
exists new.glb
mkfifo nobody_writes
timeout 60 "$NMTAN" -n nobody_writes o.glb 2>"$WORK/err.txt"
is $? 2

# Outputs that the run made again: the names of inputs.
made() {
	sed -n 's/^nmtan: \([^>]*\) -> .*, [0-9.e-]* m*s\(;.*\)*$/\1/p' "$WORK/err.txt" | tr '\n' ' '
}

take() {
	cp "$data"/mirrored_cube.* "$data/bumps.png" "$data"/plates.gltf "$data/plates.bin" "$data/quad.obj" .
	later
}
inputs="mirrored_cube.obj plates.gltf quad.obj"

scene "what is up to date is not made again, and whatever it was made from counts"
take
run --update -d out $inputs
exits 0
is "$(made)" "$inputs "
before=$(identity out/*)
run --update -d out $inputs
exits 0
says "3 of 3 done, 3 of them up to date"
is "$(made)" ""
is "$(identity out/*)" "$before"
for change in mirrored_cube.obj:mirrored_cube.obj mirrored_cube.mtl:mirrored_cube.obj "bumps.png:mirrored_cube.obj plates.gltf" \
	plates.bin:plates.gltf plates.gltf:plates.gltf; do
	later
	touch "${change%:*}"
	run --update -d out $inputs
	exits 0
	is "${change%:*} makes $(made)" "${change%:*} makes ${change#*:} "
	run --update -d out $inputs
	is "${change%:*} makes $(made)" "${change%:*} makes "
done

scene "an output that is gone, or was changed, is made again"
take
run --update -d out $inputs
cp -r out expected
rm out/plates.bin
run --update -d out $inputs
is "$(made)" "plates.gltf "
for image in out/*.png; do
	rm $image
	run --update -d out --manifest=m.jsonl $inputs
	says_not "left as"
	says "1 got tangents"
	is "$(grep -c '"status":"done"' m.jsonl)" 1
done
echo >>out/quad.glb
run --update -d out $inputs
is "$(made)" "quad.obj "
for file in quad.glb plates.gltf plates.bin mirrored_cube.glb; do same out/$file expected/$file; done

scene "other options and another version make everything again, the same in other words does not"
take
run --update -d out $inputs
run --update --method=mikktspace --uv auto --sync -j1 -d out $inputs
is "$(made)" ""
run --update --method=area -d out $inputs
is "$(made)" "$inputs "
run --update -d out --only=all --method=area quad.obj
is "$(made)" "quad.obj "
run --update -d out --method=area --only=all quad.obj
is "$(made)" ""
for degrees in 30:quad.obj\  40:quad.obj\  40: 30:quad.obj\ ; do
	run --update -d out --normals=angle:${degrees%%:*} quad.obj
	is "$degrees $(made)" "$degrees ${degrees#*:}"
done
sed -i 's/"nmtan":"/&0/' out/.nmtan-record
run --update -d out --normals=angle:30 quad.obj
is "$(made)" "quad.obj "

scene "a sidecar that was missing, and comes, makes its input again"
take
rm mirrored_cube.mtl
run --update -d out $inputs
run --update -d out $inputs
is "$(made)" ""
cp "$data/mirrored_cube.mtl" .
run --update -d out $inputs
is "$(made)" "mirrored_cube.obj "
mv bumps.png away.png
run --update -d out $inputs
is "$(made)" "mirrored_cube.obj plates.gltf "
mv away.png bumps.png
run --update -d out $inputs
is "$(made)" "mirrored_cube.obj plates.gltf "
run --update -d out $inputs
is "$(made)" ""

scene "without a record everything is made, and an unchanged output is touched"
take
run -d out --method=area $inputs
touch -d "1 hour" out/*
run --update -d out $inputs
is "$(made | wc -w)" "$(echo $inputs | wc -w)"
run --update -d out $inputs
is "$(made)" ""
rm out/.nmtan-record
later
touch quad.obj
inode=$(stat -c %i out/quad.glb)
run --update -d out $inputs
exits 0
is "$(made | wc -w)" "$(echo $inputs | wc -w)"
says "left as it is"
is "$(stat -c %i out/quad.glb)" "$inode"
# within one tick of the clock both have the same time
! [ quad.obj -nt out/quad.glb ] || wrong "it was not touched"
before=$(identity out/quad.glb)
later
touch quad.obj
run --update -d out $inputs
is "$(made)" "quad.obj "
is "$(identity out/quad.glb)" "$before"

scene "a change within one tick of the clock is seen"
# a machine with much to do may need some tries to read it so soon, or cannot: then it changed an hour from now
for try in $(seq 50); do
	rm -rf out
	cp "$data/quad.obj" now.obj
	[ $try -le 25 ] || touch -d "1 hour" now.obj
	run --update -d out now.obj
	! grep -q xxh128 out/.nmtan-record || break
done
stamp=$(stat -c %y now.obj)
sed -i 's/^v 1/v 2/' now.obj
touch -d "$stamp" now.obj
grep -q xxh128 out/.nmtan-record || wrong "the record has no digest of a file that has just changed"
run --update -d out now.obj
is "$(made)" "now.obj "

scene "by content, a file that was touched is the same, and one of the same time is not"
take
run --update=content -d out $inputs
exits 0
later
touch $inputs bumps.png out/*
chmod 600 quad.obj
cp -p plates.gltf t && mv t plates.gltf
run --update=content -d out $inputs
is "$(made)" ""
stamp=$(stat -c %y quad.obj)
sed -i 's/^v 1/v 3/' quad.obj
touch -d "$stamp" quad.obj
run --update=content -d out $inputs
is "$(made)" "quad.obj "
# by time, a line with digests alone holds as long as they do, and the next one has times alone; by content, the other way round
later
for by in time content; do
	run --update=$by -d out quad.obj
	is "$(made)" ""
	is "$by $(tail -n1 out/.nmtan-record | grep -o 'xxh128\|modified' | sort -u)" "$by $([ $by = time ] && echo modified || echo xxh128)"
done
run --update -d out $inputs
is "$(made)" ""
run --update=bytes -d out quad.obj
exits 1
says "--update: 'bytes' is none of: time content"

scene "a record can be elsewhere, and be written by a run that makes everything"
take
mkdir records
run --record=records/r -d out $inputs
exits 0
run --record=records/r -d out $inputs
is "$(made)" "$inputs "
run --update --record=records/r -d out $inputs
is "$(made)" ""
only $inputs mirrored_cube.mtl bumps.png plates.bin out records
is "$(ls -A out | grep -c record)" 0
# the root of a tree, which is above the record, moves with it
run --update -r --exclude=out -d tree .
exits 0
later
cd ..
mv "$OLDPWD" moved
cd moved
run --update --record=records/r -d out $inputs
is "$(made)" ""
run --update -r --exclude=out -d tree .
exits 0
is "$(made)" ""
says "3 of 3 done, 3 of them up to date"
run --update --record=nowhere/r -d never $inputs
exits 2
says "nowhere"
is "$(ls never)" "" # nothing ran

scene "a record's lines are as the schema says"
take
cp quad.obj $'\xff "%.obj'
mkdir v1
mv bumps.png v1/N.PNG
ln -s v1 t,x
sed -i 's|bumps.png|t,x/n.png|' mirrored_cube.mtl
run --update=content -d out $inputs $'\xff "%.obj'
exits 0
run --update -d out --method=area quad.obj
is "$(wc -l <out/.nmtan-record)" 5
validates --lines record out/.nmtan-record
grep -q '{"searched":"../t%2Cx/n.png","found":"N.PNG"}' out/.nmtan-record || wrong "$(cat out/.nmtan-record)"

scene "findings that fail a run fail it again, until they do not"
quad_with_map
cp "$data/quad.obj" fine.obj
later
# WORDS|EXIT CODE|MADE AGAIN: each after the one before.
while IFS='|' read -r words code expected; do
	# shellcheck disable=SC2086
	run --update -d out $words q.obj fine.obj
	[ "$status $(made)" = "$code $expected${expected:+ }" ] || wrong "$words: exit code $status, made: $(made)"
	[ $code = 0 ] || says "IMAGE_MISSING"
	[ -e before ] || identity out/*.glb >before
done <<-'EOF'
	--fail-on=warning|6|q.obj fine.obj
	--fail-on=warning|6|q.obj
	--fail-on=warning -q|6|
	--fail-on=error|0|
	|0|
	--fail-on=warning --ignore=IMAGE_MISSING|0|q.obj fine.obj
	--fail-on=warning --ignore=IMAGE_MISSING|0|
	--fail-on=warning|6|q.obj fine.obj
	--fail-on=warning --ignore=TAN_UNUSED --severity=IMAGE_MISSING=info|0|q.obj fine.obj
	--fail-on=info --ignore=TAN_UNUSED --severity=IMAGE_MISSING=info|6|q.obj
EOF
identity out/*.glb >after
same before after
validates --lines record out/.nmtan-record
run -q --check --report=known.json q.obj
run --update -d out --fail-on=warning --baseline=known.json q.obj fine.obj
is "$status $(made)" "0 q.obj fine.obj "
run --update -d out --fail-on=warning --baseline=known.json q.obj fine.obj
is "$status $(made)" "0 "
run -q --check --report=none.json fine.obj
mv none.json known.json
run --update -d out --fail-on=warning --baseline=known.json q.obj fine.obj
is "$status $(made)" "6 q.obj fine.obj "
cp "$data/bumps.png" n.png
run --update -d out --fail-on=warning q.obj fine.obj
is "$status $(made)" "0 q.obj fine.obj "

scene "an output that was made again and has its bytes counts as left, not as one that got tangents"
take
run -q --update -d out mirrored_cube.obj quad.obj
touch bumps.png
later
run --update -d out mirrored_cube.obj quad.obj
says "mirrored_cube.obj -> out/mirrored_cube.glb: left as it is"
says "nmtan: 2 of 2 done, 1 of them up to date; 1 left as it was"

scene "in place, a file is up to date as the last run left it"
take
mkdir sub
cp plates.* bumps.png sub/
run --in-place --update plates.gltf sub/plates.gltf
exits 0
is "$(made)" "plates.gltf sub/plates.gltf "
exists .nmtan-record sub/.nmtan-record
run --in-place --update plates.gltf sub/plates.gltf
is "$(made)" ""
later
touch sub/plates.gltf
before=$(identity sub/plates.gltf)
run --in-place --update plates.gltf sub/plates.gltf
is "$(made)" "sub/plates.gltf "
is "$(identity sub/plates.gltf)" "$before"
run --in-place --update plates.gltf sub/plates.gltf
is "$(made)" ""

scene "several processes append to one record, and half a line does no harm"
take
for i in $(seq 40); do cp quad.obj q$i.obj; done
later
mkdir out
printf '{"output":"q1.glb","nmtan' >out/.nmtan-record
"$NMTAN" -q --update -d out q?.obj & "$NMTAN" -q --update -d out q1?.obj q2?.obj & "$NMTAN" -q --update -d out q3?.obj q40.obj &
wait
is "$(grep -o '^{"output":"q[0-9]*.glb","nmtan":.*}$' out/.nmtan-record | cut -d'"' -f4 | sort | uniq -c | grep -c '^ *1 ')" 40
run --update -d out q*.obj
is "$(made)" "quad.obj "

scene "a record does not grow without end"
take
run --update -d out $inputs
for i in $(seq 1100); do grep '"quad.glb"' out/.nmtan-record; done >many
cat many >>out/.nmtan-record
run --update -d out $inputs
is "$(made)" ""
is "$(wc -l <out/.nmtan-record)" 3
run --update -d out $inputs
is "$(made)" ""

scene "names of any bytes are in the record"
name=$'od"d\\\n \xff%20.obj'
cp "$data/quad.obj" "$name"
later
run --update -d out "$name"
exits 0
run --update -d out "$name"
says "up to date"

scene "a dry run and streams leave no record"
take
run --update --dry-run -d out $inputs
exits 0
only $inputs mirrored_cube.mtl bumps.png plates.bin
"$NMTAN" -q --update --record=r - - <quad.obj >piped.glb || wrong "exit code $?"
run quad.obj o.glb
same piped.glb o.glb
[ ! -s r ] || wrong "a record of a pipe"
mkfifo pipe.obj
cat quad.obj >pipe.obj &
run -q --update --record=r pipe.obj piped.glb
exits 0
run -q --update --record=r --output-format=glb quad.obj /dev/null
exits 0
[ ! -s r ] || wrong "a record of a pipe or a device"

# a sanitizer makes each of them ten times as slow
case $BUILD in *sanitize*) many=250 ;; *) many=1000 ;; esac
scene "what was killed is gone on with, nothing is lost and nothing made twice"
for ((i = 0; i < many; i++)); do cp "$data/quad.obj" in_$i.obj; done
ls *.obj >list
later
"$NMTAN" -q -d clean --files-from=list || wrong "exit code $?"
# the lines of the record, without another process: the run is as fast as this has to be
made_so_far() { mapfile -t records 2>/dev/null <out/.nmtan-record || records=(); }
# runs that are done before they are looked at are not killed: if there are many such, all is begun anew
for ((try = 0, kills = 0; try < 20 && kills <= 5; try++)); do
	rm -rf out
	kills=0
	for ((i = 0; i < 50; i++)); do
		made_so_far
		[ ${#records[@]} -lt $many ] || break
		goal=$((${#records[@]} + RANDOM % 50))
		"$NMTAN" -q -j2 --update -d out --files-from=list 2>/dev/null & pid=$!
		while [ ${#records[@]} -lt $goal ] && kill -0 $pid 2>/dev/null; do made_so_far; done
		kill -9 $pid 2>/dev/null
		wait $pid 2>/dev/null
		[ $? != 137 ] || kills=$((kills + 1))
	done
done
[ $kills -gt 5 ] || wrong "only $kills runs were killed"
run --update -d out --files-from=list
exits 0
is "$(ls -A out | grep -v '^in_[0-9]*\.glb$')" .nmtan-record
diff -r clean out --exclude=.nmtan-record >difference || wrong "$(head -3 difference)"
# each run that was killed may have been at one file for each of its two threads; a line that was renewed has the output's time
lines=$(sed 's/.*"output":"\([^"]*\)".*"written":"[^}]*"modified":\([0-9]*\).*/\1 \2/' out/.nmtan-record | sort -u | wc -l)
[ "$lines" -ge $many ] && [ "$lines" -le $((many + kills * 2)) ] || wrong "$lines files were made in $kills runs"

scene "a record, a manifest, a depfile and a report replace nothing that a run has read or written"
cp "$data/mirrored_cube.obj" "$data/mirrored_cube.mtl" "$data/bumps.png" .
sum() { cat mirrored_cube.obj mirrored_cube.mtl bumps.png | cksum; }
before=$(sum)
for taken in mirrored_cube.obj mirrored_cube.mtl bumps.png; do
	for option in record manifest depfile report; do
		kind=
		[ $option != report ] || kind=--report-format=json
		run "--$option=$taken" $kind mirrored_cube.obj o.glb
		exits 2
		says "refusing to write"
		is "$(sum)" "$before"
	done
done
for option in --depfile --report-format=json\ --report; do
	run $option=o.bin mirrored_cube.obj o.gltf
	exits 2
	says "o.bin: refusing to write: it is the same file as the output o.bin"
done
run --manifest=- --output-format=glb mirrored_cube.obj -
exits 1

scene "folders of images are among the options that a record compares"
quad_with_map
mkdir A B
cp "$data/bumps.png" A/n.png
{ cat "$data/bumps.png" && echo more; } >B/n.png
run --update --texture-path=A q.obj q.glb
exits 0
run --update --texture-path=A q.obj q.glb
says "up to date"
run --update --texture-path=B q.obj q.glb
says_not "up to date"

scene "a link by which the run looks for images, and one that is the input, are followed each time"
quad_with_map
mkdir A B x
cp "$data/bumps.png" A/n.png
{ cat "$data/bumps.png" && echo more; } >B/n.png
ln -s A L
later
for target in A B A; do
	ln -sfn $target L
	run --update --texture-path=L q.obj q.glb
	[ $target = A ] && [ ! -e before ] || is "$target $(made)" "$target q.obj "
	"$NMTAN" -q --texture-path=$target q.obj clean.glb
	same q.glb clean.glb
	touch before
	run --update --texture-path=L q.obj q.glb
	says "up to date"
done
# another library beside it
ln -s ../q.obj x/q.obj
echo "newmtl q" >x/q.mtl
run --update --texture-path=L x/q.obj q.glb
says_not "up to date"
is "$(gltf q.glb 'g.images?.length')" undefined

scene "an image that appears under a name in another case is seen"
quad_with_map
run --update q.obj q.glb
exits 0
cp "$data/bumps.png" N.PNG
run --update q.obj q.glb
says_not "up to date"
is "$(gltf q.glb 'g.images.length')" 1

scene "whatever decides on what is read is seen, and what is as it was makes nothing"
quad_with_map
sed -i 's|n.png|tex/n.png|' q.mtl
mkdir v1 v2 two other
cp "$data/bumps.png" v1/n.png
cp "$data/bumps.png" v2/n.png
printf '\xff' | dd of=v2/n.png bs=1 seek=60 conv=notrunc 2>/dev/null
cp v1/n.png two/a.png
cp v2/n.png two/b.png
touch -d "1 hour ago" v?/n.png two/*
ln -s v1 tex
swap() { mv two/a.png two/c && mv two/b.png two/a.png && mv two/c two/b.png; }
later
run --update q.obj q.glb
while IFS='|' read -r change expected; do
	eval "$change" 2>/dev/null
	run --update q.obj q.glb
	exits 0
	is "$change: $(made)" "$change: ${expected:+q.obj }"
	"$NMTAN" -q q.obj clean.glb
	same q.glb clean.glb
	run --update q.obj q.glb
	is "$change, and again: $(made)" "$change, and again: "
done <<'END'
ln -sfn v2 tex|made
rm tex; mkdir tex; ln -s ../two/a.png tex/n.png|made
swap|made
rm tex/n.png; mv two tex/; ln -s two/a.png tex/n.png|
(cd tex; swap)|made
ln -sf two/b.png tex/n.png|made
rm tex/n.png; cp -p tex/two/a.png tex/n.png|made
cp -p tex/two/b.png tex/n.png|made
touch -r tex/n.png stamp; cp tex/n.png t; cat t >tex/n.png; touch -r stamp tex/n.png|made
cp -p q.mtl t; mv t q.mtl|made
chmod 600 q.obj|made
rm tex/n.png|made
touch tex/other.png|
mkdir tex/n.png|made
rmdir tex/n.png; mkfifo tex/n.png|
rm tex/n.png; ln -s ../../outside.png tex/n.png|
touch q.mtl|made
ln -sfn "$PWD/../elsewhere" tex/x; ln -sf x/n.png tex/n.png|
ln -sf two/a.png tex/n.png|made
mv tex/n.png tex/N.PNG|made
touch tex/x|
cp -p tex/two/b.png tex/N.png|
mv tex/N.png tex/n.png|made
cp -p q.glb t; mv t q.glb|made
cp -p q.glb t; dd if=q.obj of=t bs=1 count=9 seek=40 conv=notrunc; touch -r q.glb t; mv t q.glb|made
mkdir ../beside; cp -p v1/n.png ../beside/; rm -r tex; ln -s ../beside tex|made
rm .nmtan-record|made
END
rm -r q.glb tex .nmtan-record

scene "one image that is missing makes nothing again, and the record does not grow"
quad_with_map
for i in $(seq 40); do cp q.obj q$i.obj; done
later
run --update -d . q*.obj
later
run --update -d . q*.obj
is "$(made)" ""
size=$(stat -c %s .nmtan-record)
for i in 1 2 3; do
	run --update -d . q*.obj
	is "$(made)" ""
	is "$(stat -c %s .nmtan-record)" "$size"
done
for i in $(seq 8); do
	later
	touch other
	run --update -d . q*.obj
	is "$(made)" ""
done
[ "$(wc -l <.nmtan-record)" -le 200 ] || wrong "$(wc -l <.nmtan-record) lines"

case $BUILD in *sanitize*) folders=5 ;; *) folders=100 ;; esac
scene "${folders}00 files that are up to date take less than half a second of the processors, or a third of making them"
for ((i = 0; i < 100; i++)); do cp "$data/quad.obj" in_$i.obj; done
for ((i = 1; i < folders; i++)); do mkdir $i; cp in_*.obj $i/; done
mkdir 0 && mv in_*.obj 0/
find . -name '*.obj' | sort >list
later
# took WORDS...: milliseconds of the processors.
took() {
	local TIMEFORMAT='%U %S'
	{ time "$NMTAN" -q --keep-tree=. --files-from=list "$@"; } 2>&1 | awk 'END { printf "%d", 1000 * ($1 + $2) }'
}
took --update -d out >/dev/null
run --update -d out --keep-tree=. --files-from=list
exits 0
says "${folders}00 of ${folders}00 done, ${folders}00 of them up to date"
# Slower machines, and those with other work, take longer; but so does making them at that time, which is six times as much.
is_soon() {
	now=$(took --update -d out)
	[ "$now" -lt 500 ] || { made=$(took -d again$try) && [ $((3 * now)) -lt "$made" ]; }
}
case $BUILD in
*sanitize*) ;;
*)
	for try in 1 2 3 4 5; do ! is_soon || break; done
	[ "$now" -lt 500 ] || [ $((3 * now)) -lt "$made" ] || wrong "$now ms; making them took $made"
	;;
esac

scene "a folder of images is what it is, wherever nmtan runs"
mkdir a b a/tex b/tex
{
	echo "mtllib m.mtl"
	grep -v '^#' "$data/quad.obj" | sed '/^f /i usemtl m'
} >quad.obj
printf 'newmtl m\nmap_Kd n.png\n' >m.mtl
printf '\211PNG\r\n\032\n a' >a/tex/n.png
printf '\211PNG\r\n\032\n b' >b/tex/n.png
for folder in a b; do
	(cd $folder && "$NMTAN" -q --update --texture-path=tex ../quad.obj ../o.glb) || wrong "exit code $?"
	python3 "$ROOT/tests/support/images.py" embedded o.glb 0 made.png
	same made.png $folder/tex/n.png
done
(cd b && "$NMTAN" --update --texture-path=./tex ../quad.obj ../o.glb) 2>&1 | grep -q "up to date" || wrong "it was made again"
# and moves with the record
mkdir moved && cp -a b moved/ && cp -p quad.obj m.mtl o.glb .nmtan-record moved/
(cd moved/b && "$NMTAN" -q --update=content --texture-path=tex ../quad.obj ../o.glb) || wrong "exit code $?"
later
mv moved elsewhere
(cd elsewhere/b && "$NMTAN" --update=content --texture-path=tex ../quad.obj ../o.glb) 2>&1 | grep -q "up to date" || wrong "it was made again"
rm -r elsewhere
for folder in a b; do
	(cd $folder && "$NMTAN" -q --update --base-color=tex/n.png "$data/quad.obj" ../given.glb) || wrong "exit code $?"
	python3 "$ROOT/tests/support/images.py" embedded given.glb 0 made.png
	same made.png $folder/tex/n.png
done
(cd b && "$NMTAN" --update --base-color=tex/n.png "$data/quad.obj" ../given.glb) 2>&1 | grep -q "up to date" || wrong "it was made again"

scene "a dry run leaves records as they are"
cp "$data/quad.obj" .
run --update quad.obj o.glb
exits 0
line=$(cat .nmtan-record)
for i in $(seq 1100); do echo "$line"; done >.nmtan-record
cp .nmtan-record before
run --dry-run --update quad.obj o.glb
exits 0
same before .nmtan-record
run --update quad.obj o.glb
exits 0
[ "$(wc -l <.nmtan-record)" -le 2 ] || wrong "$(wc -l <.nmtan-record) lines"

scene "outputs whose input is gone are told of a folder, and stay"
mkdir in
for name in a b c; do cp "$data/quad.obj" in/$name.obj; done
run --update -d out in/c.obj # the first line of the record
run --update -r in -d out
says_not "gone"
rm in/b.obj
for number in 1 2; do # all others are up to date
	run --update -r in -d out
	exits 0
	says "nmtan: 1 output is left whose input is gone: out/b.glb"
done
run -q --update -r in -d out
silent
rm in/c.obj
run --update --record=out/r -r in -d out # which knows of none
says_not "gone"
run --update -r in -d out
says "nmtan: 2 outputs are left whose input is gone: out/b.glb and 1 more"
run --update -d out in/a.obj
says_not "gone"
rm out/[bc].glb
run --update -r in -d out
says_not "gone"

scene "outputs are told of as left when the last input is gone, too"
mkdir in
for name in a b; do cp "$data/quad.obj" in/$name.obj; done
run --update -r in -d out
rm in/*.obj
for quiet in "" -q; do
	run $quiet --update -r in -d out
	exits 2
	says "in: no mesh is in it"
	[ -n "$quiet" ] || says "nmtan: 2 outputs are left whose input is gone: out/a.glb and 1 more"
done
says_not "left"
run --update -r in -d never
exits 2
says_not "left"
only in out

scene "a file that is no record is refused, with what to do"
mkdir out
echo garbage >out/.nmtan-record
run --update -d out "$data/quad.obj"
exits 2
says "out/.nmtan-record: refusing to write: it is no record; delete it, or name another by --record=FILE"
run -q --update --record=r -d out "$data/quad.obj"
exits 0
rm out/.nmtan-record
run -q --update -d out "$data/quad.obj"
exits 0

scene "a record for which there is no room fails the run, and the output is made again"
cp "$data/quad.obj" .
run -q --record=full quad.obj q.glb
# room for a part of the line
printf "%$((8180 - $(stat -c %s full)))s\n" >>full
rm q.glb
before=$(cksum <full)
trap '' XFSZ
limit=$(ulimit -f)
ulimit -Sf 8
run --update --record=full quad.obj q.glb
ulimit -Sf "$limit"
trap - XFSZ
exits 2
says "full: cannot write the record: No space left on device; the output stands, --update makes it again"
is "$(cksum <full)" "$before"
run -q quad.obj clean.glb
same q.glb clean.glb
run --update --record=full quad.obj q.glb
exits 0
is "$(made)" "quad.obj "

scene "--no-clobber replaces no depfile and no manifest either"
cp "$data/quad.obj" .
run --depfile=d --manifest=m quad.obj first.glb
exits 0
cp d d.before
cp m m.before
for option in --depfile=d --manifest=m; do
	run -n $option quad.obj o.glb
	exits 2
	says "the file exists already"
	only quad.obj first.glb d m d.before m.before
done
same d d.before
same m m.before
run -n --depfile=other --manifest=- quad.obj o.glb
exits 0

done_testing
