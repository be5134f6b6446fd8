# SPDX-License-Identifier: MIT
# Output sets: nothing of anybody else's is touched, and whatever cuts a run short, the main file is whole.
. "$ROOT/tests/support/cli.sh"
sets=$ROOT/tests/support/sets.py
export PYTHONDONTWRITEBYTECODE=1

# Under a sanitizer a run takes many times as long; there some of the calls do.
case $BUILD in
*release*) stride=1 ;;
*) stride=5 ;;
esac

# sweep MODE BEFORE MAIN ARGUMENTS...: every state is good.
sweep() {
	local mode=$1
	shift
	python3 "$sets" $mode --stride=$stride ${also:+--also=$also} ${other:+--other=$other} "$NMTAN" "$calls" "$@" >"$WORK/sweep.txt" 2>&1 ||
		wrong "$mode: $(cat "$WORK/sweep.txt")"
	grep -q ' 0 bad$' "$WORK/sweep.txt" || wrong "$mode was not tried"
}

state() {
	python3 "$sets" state "$1"
}

as_nobody() {
	setpriv --reuid=65534 --regid=65534 --clear-groups "$@"
}

# run_keeping NAME[:NAME] ARGUMENTS...: files of these names, in this folder, cannot be replaced or removed. Only root can have
# that from a file system, and not from each; elsewhere the calls are refused.
run_keeping() {
	local names=$1
	shift
	if chattr +i ${names//:/ } 2>/dev/null; then
		run "$@"
		chattr -i ${names//:/ }
	else
		NT_CALLS_KEEP=$names run_under_calls "$@"
	fi
}

# Goes into a new folder, $place, that users without rights can reach, with a tool that they can run, and lets them read what
# is made; false where there is no other user.
outsider() {
	local folder
	for folder in "${TMPDIR:-/tmp}" /tmp /var/tmp; do
		place=$(mktemp -d -p "$folder") && chmod 755 "$place" && cp "$NMTAN" "$place/nmtan" && chmod 755 "$place/nmtan" &&
			cd "$place" || exit 1
		umask 022
		[ "$(id -u)" = 0 ] && command -v setpriv >/dev/null && as_nobody test -x "$place/nmtan" && return 0
		cd "$WORK/here" && rm -rf "$place"
	done
	return 1
}

# A document of three buffers, of which two change, and two images of one name.
many_files() {
	mkdir -p in/x in/y
	for image in x y; do printf '\x89PNG\r\n\x1a\n%s' $image >in/$image/n.png; done
	gltf "$data/plates.gltf" in/m 'g.images = [{uri: "x/n.png"}, {uri: "y/n.png"}];
		for (const i of [1, 2])
			bytes[g.buffers.push({}) - 1] = bytes[0];
		/* each primitive has four accessors, each accessor a view */
		g.bufferViews.forEach((view, v) => { view.buffer = v >> 2; })'
}

# An OBJ with a normal map of these bytes.
textured() {
	mkdir -p "$1"
	printf '\x89PNG\r\n\x1a\n%s' "$2" >"$1/n.png"
	printf 'newmtl m\nnorm n.png\n' >"$1/m.mtl"
	sed -e '/^mtllib/d' -e '/^usemtl/d' -e '1i mtllib m.mtl\nusemtl m' "$data/quad.obj" >"$1/$1.obj"
}

# The bytes of the normal map of a document.
map_of() {
	(cd "$(dirname "$1")" && tail -c +9 "$(gltf "$(basename "$1")" 'decodeURIComponent(g.images[0].uri)' | tr -d '"')")
}

scene "in place, a .bin that another document owns stays"
cp "$data/bumps.png" "$data/plates.bin" "$data/plates.gltf" .
cp plates.bin a.bin
mv plates.gltf other.gltf
sed 's/plates\.bin/a.bin/' other.gltf >plates.gltf
before=$(state other.gltf)
run --in-place plates.gltf
exits 0
same plates.bin "$data/plates.bin"
same a.bin "$data/plates.bin"
is "$(state other.gltf)" "$before"
says "plates.bin is another file, so ours is plates-"
is "$(ls | wc -l)" 6

scene "in place, a second run with the same result adds nothing and replaces nothing"
cp "$data/bumps.png" "$data/plates.bin" "$data/plates.gltf" .
run --existing=replace --in-place plates.gltf
exits 0
sum=$(cat * | cksum) list=$(ls) stamp=$(stat -c %i.%y plates.gltf)
run --existing=replace --in-place plates.gltf
exits 0
is "$(cat * | cksum)" "$sum"
is "$(ls)" "$list"
is "$(stat -c %i.%y plates.gltf)" "$stamp"
says "left as it is"
same plates.bin "$data/plates.bin"
# another document that shares the .bin keeps it, whatever is done to this one
cp plates.gltf second.gltf
before=$(state second.gltf)
run --existing=replace --bitangents --in-place plates.gltf
exits 0
is "$(state second.gltf)" "$before"

scene "a file that stands in the way stays, and repeated runs pile up nothing"
mkdir out
echo somebody >out/o.bin
run "$data/plates.gltf" out/o.gltf
exits 0
says "o.bin is another file, so ours is o-"
is "$(cat out/o.bin)" somebody
first=$(state out/o.gltf) list=$(ls out)
run "$data/plates.gltf" out/o.gltf
exits 0
is "$(ls out)" "$list"
is "$(state out/o.gltf)" "$first"
# with another result the file of the earlier one goes: this main file alone referred to it
run --bitangents "$data/plates.gltf" out/o.gltf
exits 0
is "$(ls out | wc -l)" 4
is "$(cat out/o.bin)" somebody
run "$data/plates.gltf" out/o.gltf
is "$(ls out)" "$list"
is "$(state out/o.gltf)" "$first"

scene "a .bin of ours is replaced under its own name, one that was changed since is not"
run --bitangents "$data/plates.gltf" o.gltf
run "$data/plates.gltf" o.gltf
exits 0
only o.gltf o.bin bumps.png
says_not "another file"
is "$(xxhsum -H2 o.bin 2>/dev/null | cut -c1-32)" "$(command -v xxhsum >/dev/null && gltf o.gltf 'g.buffers[0].extras["nmtan:xxh128"]' | tr -d '"')"
echo changed >>o.bin
cp o.bin before
run --bitangents "$data/plates.gltf" o.gltf
exits 0
same o.bin before
says "o.bin is another file"

scene "what is read back before the switch is what will be there"
run --bitangents "$data/plates.gltf" o.gltf
run --verify "$data/plates.gltf" o.gltf
exits 0
only o.gltf o.bin bumps.png
echo somebody >o.bin
run --verify --bitangents "$data/plates.gltf" o.gltf
exits 0
says "o.bin is another file"

scene "no-clobber keeps what has a sidecar's name"
echo somebody >o.bin
run -n "$data/plates.gltf" o.gltf
exits 0
is "$(cat o.bin)" somebody
before=$(state o.gltf)
run -n --bitangents "$data/plates.gltf" o.gltf
exits 2
is "$(state o.gltf)" "$before"

scene "a record is not carried to a document that did not make the file"
run "$data/plates.gltf" a.gltf
mkdir sub
run --buffers=link a.gltf sub/a.glb
run --buffers=link a.gltf sub/a.gltf
run --buffers=embed --existing=replace a.gltf b.gltf
for file in sub/a.glb sub/a.gltf b.gltf; do
	! grep -q nmtan:xxh128 $file || wrong "$file claims a.bin"
done
grep -q nmtan:xxh128 a.gltf || wrong "a.gltf has no record"

scene "a file that is used as it is does not become ours"
run "$data/plates.gltf" a.gltf
mv a.gltf kept.gltf && mv a.bin o.bin && sed -i 's/"a\.bin"/"o.bin"/' kept.gltf
before=$(state kept.gltf)
run "$data/plates.gltf" o.gltf
exits 0
only kept.gltf o.gltf o.bin bumps.png
run --bitangents "$data/plates.gltf" o.gltf
exits 0
is "$(state kept.gltf)" "$before"
says "o.bin is another file"

scene "a main file that cannot be replaced keeps its sidecar"
run --bitangents "$data/plates.gltf" o.gltf
before=$(state o.gltf)
list=$(ls)
run_keeping o.gltf "$data/plates.gltf" o.gltf
exits 2
says "o.gltf: cannot write"
is "$(state o.gltf)" "$before"
is "$(ls -A)" "$list"
# and a sidecar that cannot: the new set is whole under other names
run_keeping o.bin "$data/plates.gltf" o.gltf
exits 0
says "the data of o.bin stays in o.new-"
run "$data/plates.gltf" fresh.gltf
is "$(state o.gltf)" "$(state fresh.gltf)"
run "$data/plates.gltf" o.gltf
exits 0
only o.gltf o.bin fresh.gltf fresh.bin bumps.png

scene "a sticky folder of somebody else's"
outsider || place=
mkdir sticky
(cd sticky && "$NMTAN" -q --bitangents "$data/plates.gltf" o.gltf)
chmod 1777 sticky
before=$(state sticky/o.gltf)
cp "$data"/plates.* "$data/bumps.png" .
if [ -n "$place" ]; then
	as_nobody ./nmtan plates.gltf sticky/o.gltf 2>"$WORK/err.txt"
	status=$?
else
	NT_CALLS_KEEP=o.gltf:o.bin run_under_calls plates.gltf sticky/o.gltf
fi
exits 2
says "o.gltf: cannot write"
is "$(state sticky/o.gltf)" "$before"
is "$(ls -A sticky | tr '\n' ' ')" "bumps.png o.bin o.gltf "
cd "$WORK/here" && rm -rf "$place"

scene "a record that cannot be written is said before anything is made"
if outsider; then
	mkdir closed open && touch closed/old && chmod 777 open
	cp "$data/quad.obj" .
	for record in old new; do
		as_nobody ./nmtan --record=closed/$record quad.obj open/q.glb 2>"$WORK/err.txt"
		status=$?
		exits 2
		says "closed/$record: cannot write the record: Permission denied"
		is "$(ls -A open closed)" "$(printf 'closed:\nold\n\nopen:')"
	done
	cd "$WORK/here" && rm -rf "$place"
fi

scene "images of one name from several inputs are all kept"
textured s1 one
textured s2 two
textured s3 one
for threads in 1 4; do
	rm -rf out
	run -j$threads --output-format=gltf -d out --images=copy s1/s1.obj s2/s2.obj s3/s3.obj
	exits 0
	is "$(map_of out/s1.gltf)" one
	is "$(map_of out/s2.gltf)" two
	is "$(map_of out/s3.gltf)" one
	is "$(ls out/*.png | wc -l)" 2
	says "n.png is another file, so ours is n-"
	list=$(ls out)
	run -j$threads --output-format=gltf -d out --images=copy s1/s1.obj s2/s2.obj s3/s3.obj
	exits 0
	is "$(map_of out/s2.gltf)" two
	is "$(ls out)" "$list"
done

scene "the same in runs of their own, one after the other and at once"
inputs=
for i in 1 2 3 4 5 6; do
	textured s$i "map $i"
done
mkdir one after
for i in 1 2; do
	run --images=copy s$i/s$i.obj after/s$i.gltf
	exits 0
done
is "$(map_of after/s1.gltf)" "map 1"
is "$(map_of after/s2.gltf)" "map 2"
for round in 1 2 3; do
	rm -rf one && mkdir one
	for i in 1 2 3 4 5 6; do
		"$NMTAN" -q --images=copy s$i/s$i.obj one/s$i.gltf 2>>"$WORK/err.txt" &
	done
	wait
	for i in 1 2 3 4 5 6; do
		is "$(map_of one/s$i.gltf)" "map $i"
	done
	is "$(ls one/*.png | wc -l)" 6
done

scene "killed anywhere, the first of its name"
mkdir before && textured s1 one
sweep kill before o.gltf -q -j1 --images=copy "$PWD/s1/s1.obj" o.gltf
sweep fail before o.gltf -q -j1 --images=copy "$PWD/s1/s1.obj" o.gltf
sweep power before o.gltf -q -j1 --sync --images=copy "$PWD/s1/s1.obj" o.gltf
sweep kill before o.glb -q -j1 "$PWD/s1/s1.obj" o.glb
sweep power before o.glb -q -j1 --sync "$PWD/s1/s1.obj" o.glb

scene "killed anywhere, several files replaced and images copied"
many_files
mkdir before
(cd before && "$NMTAN" -q --bitangents --buffers=copy --images=copy ../in/m.gltf o.gltf)
is "$(ls before | wc -l)" 6
for mode in kill fail power; do
	sweep $mode before o.gltf -q -j1 --sync --buffers=copy --images=copy "$PWD/in/m.gltf" o.gltf
done
sweep kill before o.gltf -q -j1 --buffers=copy --images=copy "$PWD/in/m.gltf" o.gltf

scene "killed anywhere, and then other options"
many_files
mkdir before
(cd before && "$NMTAN" -q --bitangents --buffers=copy ../in/m.gltf o.gltf)
other=--bitangents sweep kill before o.gltf -q -j1 --buffers=copy "$PWD/in/m.gltf" o.gltf
# what another document needs, or is somebody's, stays
cp before/o.bin before/o.new-0123456789abcdef.bin
(cd before && NT_CALLS_FAIL=link:1 LD_PRELOAD=$calls ASAN_OPTIONS=${ASAN_OPTIONS-}:verify_asan_link_order=0 \
	"$NMTAN" -q --buffers=copy ../in/m.gltf o.gltf && mv o.gltf o.vrm && ls >../names && "$NMTAN" -q --method=area --buffers=copy ../in/m.gltf o.gltf)
for name in $(cat names); do exists before/$name; done
rm before/o.vrm
(cd before && "$NMTAN" -q --buffers=copy ../in/m.gltf o.gltf)
is "$(ls before | grep new)" o.new-0123456789abcdef.bin

scene "two that write one document at once leave one set, and no other file"
grid_obj 40 >g.obj
for ((i = 0; i < 12; i++)); do
	"$NMTAN" -q --verify --method=area g.obj o.gltf 2>one & "$NMTAN" -q --verify --bitangents g.obj o.gltf 2>two
	wait $! && [ ! -s one ] && [ ! -s two ] || wrong "round $i: $(cat one two)"
	is "round $i: $(echo o*.bin)" "round $i: $(gltf o.gltf 'g.buffers[0].uri')"
done

scene "killed anywhere, where files cannot be linked"
many_files
mkdir before
(cd before && "$NMTAN" -q --bitangents --buffers=copy ../in/m.gltf o.gltf)
for mode in kill fail power; do
	also=link:1 sweep $mode before o.gltf -q -j1 --sync --buffers=copy "$PWD/in/m.gltf" o.gltf
done
# nor named without replacing, as on FAT, where an empty file takes the name first: a kill would leave that
also=renameat2:22 sweep kill before o.gltf -q -j1 --buffers=copy "$PWD/in/m.gltf" o.gltf
also=renameat2:22,link:1 sweep fail before o.gltf -q -j1 --buffers=copy "$PWD/in/m.gltf" o.gltf
cd before
# also a main file without an ending, and one that is called as names for the time being are
for name in o:.gltf p: q.new-1:.gltf; do
	main=${name/:/}
	[ -e $main ] || "$NMTAN" -q --bitangents --buffers=copy --output-format=gltf ../in/m.gltf $main
	NT_CALLS_FAIL=link:1 run_under_calls --buffers=copy --output-format=gltf ../in/m.gltf $main
	exits 0
	says "the data of ${name%:*}.bin stays in ${name%:*}.new-"
	is "$main $(state $main)" "$main $(state o.gltf)"
done
run --buffers=copy ../in/m.gltf p.gltf # wants the same names
is "$(state p)" "$(state o.gltf)"

scene "killed anywhere, beside somebody else's file"
mkdir before && echo somebody >before/o.bin
sweep kill before o.gltf -q -j1 "$data/plates.gltf" o.gltf
sweep power before o.gltf -q -j1 --sync "$data/plates.gltf" o.gltf
# and with another result before
(cd before && "$NMTAN" -q --bitangents "$data/plates.gltf" o.gltf)
for mode in kill fail power; do
	sweep $mode before o.gltf -q -j1 --sync "$data/plates.gltf" o.gltf
done

scene "killed anywhere, in place"
mkdir before && cp "$data/plates.gltf" "$data/plates.bin" "$data/bumps.png" before
for mode in kill fail power; do
	sweep $mode before plates.gltf -q -j1 --sync --in-place plates.gltf
done

scene "killed anywhere, a .glb with files"
many_files
mkdir before
(cd before && "$NMTAN" -q --bitangents --buffers=copy ../in/m.gltf o.glb)
sweep kill before o.glb -q -j1 --buffers=copy "$PWD/in/m.gltf" o.glb
sweep power before o.glb -q -j1 --sync --buffers=copy "$PWD/in/m.gltf" o.glb

# A temporary file as a killed run leaves it.
stale() {
	NT_CALLS_KILL=2 LD_PRELOAD=$calls ASAN_OPTIONS=${ASAN_OPTIONS-}:verify_asan_link_order=0 \
		"$NMTAN" -q "$data/quad.obj" out.glb 2>/dev/null
	ls -A | grep '^\.nmtan-' | head -1
}

scene "what a dead run left goes with the next run in that folder"
name=$(stale)
[ -n "$name" ] || wrong "nothing was left behind"
run "$data/quad.obj" out.glb
exits 0
only out.glb

scene "what others may still be writing stays"
name=$(stale)
rm -f "$name"
# .nmtan-BOOT-PID-NUMBER.tmp
boot=${name#.nmtan-} rest=${name#.nmtan-*-}
boot=${boot%%-*}
stay=".nmtan-$boot-1-$rest .nmtan-$$-0-0.tmp .nmtan-x"
go=".nmtan-$boot-2-$rest .nmtan-$boot-3-$rest"
touch $stay $go
exec 9<".nmtan-$boot-1-$rest"
flock -n 9 || wrong "no lock"
run "$data/quad.obj" out.glb
exits 0
only $stay out.glb
exec 9<&-
rm $stay
# another boot of this machine: certain only where no other machine can write
other=.nmtan-$(echo $boot | tr 0-9a-f 1-9a-f0)-2-$rest
touch "$other"
run "$data/quad.obj" out.glb
case $(stat -f -c %T .) in
ext2/ext3 | xfs | btrfs | tmpfs) only out.glb ;;
*) only out.glb "$other" ;;
esac

scene "in place keeps mode, owner, attributes and access list, and takes lent rights"
cp "$data/plates.glb" a.glb
chmod 600 a.glb
run --in-place a.glb
exits 0
is "$(stat -c %a a.glb)" 600
cp "$data/plates.glb" b.glb
[ "$(id -u)" != 0 ] || chown 12345:23456 b.glb
chmod 6751 b.glb
owner=$(stat -c %u:%g b.glb)
python3 - b.glb <<'END' || wrong "exit code $?"
import errno, os, struct, sys
try:
    os.setxattr(sys.argv[1], 'user.note', b'mine')
    os.setxattr(sys.argv[1], 'user.empty', b'')
except OSError as fault:  # a file system without
    sys.exit(fault.errno != errno.ENOTSUP)
# version 2: user rw-, user 4242 r--, group ---, mask r--, others ---
entries = [(1, 6, 0xffffffff), (2, 4, 4242), (4, 0, 0xffffffff), (16, 4, 0xffffffff), (32, 0, 0xffffffff)]
acl = struct.pack('<I', 2) + b''.join(struct.pack('<HHI', *e) for e in entries)
os.setxattr(sys.argv[1], 'system.posix_acl_access', acl)
if os.geteuid() == 0:  # of the old content
    os.setxattr(sys.argv[1], 'security.capability', struct.pack('<5I', 0x02000001, 1 << 10, 0, 0, 0))
END
chmod u+s b.glb
attributes='import os, sys; print([(n, os.getxattr(sys.argv[1], n)) for n in sorted(os.listxattr(sys.argv[1])) if n != sys.argv[2]])'
kept=$(python3 -c "$attributes" b.glb security.capability)
run --in-place b.glb
exits 0
is "$(stat -c %u:%g b.glb)" "$owner"
is "$(stat -c %a b.glb)" 640
is "$(python3 -c "$attributes" b.glb none)" "$kept"
case $kept in *user.note*posix_acl* | *posix_acl*user.note* | "[]") ;; *) wrong "nothing was there to be kept: $kept" ;; esac

scene "in place, a group that cannot be kept gives its rights to no other"
outsider || place=
cp "$data/plates.glb" a.glb
chmod 660 a.glb
if [ -n "$place" ]; then
	chmod 777 .
	chown 65534:23456 a.glb
	as_nobody ./nmtan --in-place a.glb 2>"$WORK/err.txt"
	status=$?
	is "$(stat -c %u:%g a.glb)" 65534:65534
else
	NT_CALLS_FAIL=fchown:1 run_under_calls --in-place a.glb
fi
exits 0
is "$(stat -c %a a.glb)" 600
cd "$WORK/here" && rm -rf "$place"

scene "in place, attributes that cannot be listed are refused, but for a file system without any"
for row in 95:0 38:0 5:2; do # ENOTSUP, ENOSYS, EIO
	cp "$data/plates.glb" a.glb
	NT_CALLS_FAIL=listxattr:${row%:*} run_under_calls --in-place a.glb
	exits ${row#*:}
done
says "a.glb: cannot keep the file's attributes: Input/output error; name another output"
same a.glb "$data/plates.glb"

scene "in place, what is read-only or has further names is refused with the way out"
cp "$data/plates.glb" a.glb
chmod 444 a.glb
run --in-place a.glb
exits 2
says "a.glb: refusing to write in place: the file is read-only; chmod u+w"
same a.glb "$data/plates.glb"
chmod 644 a.glb
ln a.glb b.glb
run --in-place a.glb
exits 2
says "a.glb: refusing to write in place: the file has further names (hard links)"
says "name another output"
same b.glb "$data/plates.glb"
only a.glb b.glb

scene "in place, the refusal comes before anything is decoded, and what needs nothing is left alone"
begin=$((28 + $(od -An -t u4 -j 12 -N 4 "$data/plates.glb")))
head -c "$begin" "$data/plates.glb" >a.glb
head -c $(($(stat -c %s "$data/plates.glb") - begin)) /dev/zero | tr '\0' '\377' >>a.glb
run --in-place a.glb
exits 3
chmod 444 a.glb
run --in-place a.glb
exits 2
says "the file is read-only"
run -q "$data/plates.glb" b.glb
exits 0
chmod 444 b.glb
run --in-place b.glb
exits 0

scene "symbolic links that lead nowhere or round in a circle are refused"
ln -s nowhere.glb dangling.glb
ln -s loop.glb loop.glb
for name in dangling loop; do
	run "$data/quad.obj" $name.glb
	exits 2
	says "$name.glb: refusing to write: it is a symbolic link that leads"
	[ -L $name.glb ] || wrong "$name.glb is no link any more"
done
only dangling.glb loop.glb
# in place through a link, the file that it leads to is replaced
cp "$data/plates.glb" a.glb && ln -s a.glb link.glb
run --in-place link.glb
exits 0
[ -L link.glb ] || wrong "the link is gone"
! cmp -s a.glb "$data/plates.glb" || wrong "nothing was written"

scene "in place, a document that needs nothing is not replaced"
run "$data/plates.glb" a.glb
run "$data/plates.gltf" b.gltf
run "$data/quad_le.ply" c.ply
touch -d 2001-01-01 a.glb b.gltf b.bin c.ply
before=$(stat -c '%n %i %y' *)
run --in-place a.glb b.gltf c.ply
exits 0
is "$(stat -c '%n %i %y' *)" "$before"
says "left as it is"

scene "blocks that the file system shares are not written, and what follows comes behind them"
run -q "$data/quad.obj" quad.gltf
gltf quad.gltf in 'delete g.meshes[0].primitives[0].attributes.TANGENT'
run -q --only=all in.gltf out.gltf
NT_CALLS_CLONE=1 NT_CALLS_COUNT=made run_under_calls -q --only=all in.gltf shared.gltf
exits 0
is "$(grep -c ioctl made)" 1
same shared.bin out.bin
is "$(gltf shared.gltf 'g.buffers[0].extras')" "$(gltf out.gltf 'g.buffers[0].extras')"

scene "a set may have more files than a process may have open, and appears whole or not at all"
cp "$data/quad.obj" .
python3 "$ROOT/tests/support/inputs.py" mtl_tga_images 120 many.obj
mkdir nothing
for words in "many.obj many.gltf" "--images=copy many.gltf copies/many.gltf" "--images=copy --existing=replace many.gltf copies/many.gltf"; do
	mkdir -p copies
	# shellcheck disable=SC2086
	(ulimit -n 64 && "$NMTAN" -q $words) || wrong "$words: exit code $?"
	[ "$(ls -A ${words##* } "$(dirname "${words##* }")" | grep -c 'many\.[0-9]*\.png$')" -ge 120 ] || wrong "$words: $(ls -A copies | wc -l) files"
done
(ulimit -n 64 && for i in $(seq 120); do ln quad.obj $i.obj; done && "$NMTAN" -q --check --report=pages/ [0-9]*.obj) || wrong "exit code $?"
is "$(find pages -name '*.obj.html' | wc -l)" 120
python3 "$ROOT/tests/support/inputs.py" mtl_tga_images 40 "$PWD/forty.obj"
other= stride=$((7 * stride)) sweep kill nothing o.gltf -q -j1 "$PWD/forty.obj" o.gltf
other= stride=$((7 * stride)) sweep fail nothing o.gltf -q -j1 "$PWD/forty.obj" o.gltf

scene "buffers of one file become one, but for one with extras of its own, or if an extension may refer to them"
cp "$data"/plates.{gltf,bin} "$data/bumps.png" .
for row in VENDOR_x:2 EXT_x:1 KHR_x:1; do
	python3 - "${row%:*}" <<'END'
import json, sys
g = json.load(open('plates.gltf'))
g['buffers'] *= 2
g['bufferViews'][-1]['buffer'] = 1
g['extensionsUsed'] = [sys.argv[1]]
g['materials'][0]['extensions'] = {sys.argv[1]: {'source': 1}}
json.dump(g, open('two.gltf', 'w'))
END
	run -q --only=all two.gltf out.gltf
	exits 0
	is "$row: $(python3 -c 'import json; print(len(json.load(open("out.gltf"))["buffers"]))')" "$row: ${row#*:}"
done
for extras in '{}' '{"extras": {"keep": 1}}'; do
	python3 - "$extras" <<'END'
import json, sys
g = json.load(open('plates.gltf'))
g['buffers'].append({**g['buffers'][0], **json.loads(sys.argv[1])})
g['bufferViews'][-1]['buffer'] = 1
json.dump(g, open('two.gltf', 'w'))
END
	run -q --only=all two.gltf "out${#extras}.gltf"
	exits 0
	is "$extras: $(grep -o '"keep"' "out${#extras}.gltf") $(python3 -c 'import json, sys; print(len(json.load(open(sys.argv[1]))["buffers"]))' "out${#extras}.gltf")" \
		"$extras: $([ "$extras" = '{}' ] && echo ' 1' || echo '"keep" 2')"
done

done_testing
