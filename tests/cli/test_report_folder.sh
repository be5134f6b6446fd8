# SPDX-License-Identifier: MIT
# A report as a folder: a page of each input and an index.
. "$ROOT/tests/support/cli.sh"
script='"><script>.obj'

# The index's rows, in the order of the inputs: a Python expression over the row f.
rows() {
	value "$1" '"\n".join(str(('"$2"')) for f in r["files"])'
}

# Inputs of several scenes: names that are equal, equal but for case, hostile, hidden; an input that cannot be read.
inputs() {
	mkdir a b
	cp "$data/mirrored_cube.obj" a/m.obj
	cp "$data/quad.obj" b/m.obj
	cp "$data/quad.obj" a/M.obj
	cp "$data/quad.obj" a/index
	cp "$data/quad.obj" "a/$script"
	cp "$data/quad.obj" a/..obj
	cp "$data/quad.obj" "a/$(printf 'n\nu\377 %%2e.obj')"
	echo 'f 1 2 3' >b/bad.obj
}

scene "a page of each input and an index; names are safe, and none is taken twice"
inputs
run --check --report=r/ a/* a/..obj b/*
exits 3
exists r/M.obj.html r/bad.obj.html r/_.obj.html r/___script_.obj.html
is "$(ls r | grep -c '\.html$') $(ls r | grep -c '^nmtan-[0-9a-f]*\.\(js\|css\)$') $(ls -A r | wc -l)" "9 2 11"
is "$(ls r | grep -ci '^m\.obj')" 3
is "$(ls r | tr A-Z a-z | sort -u | wc -l)" 11
rows r/index.html 'f["page"]' >pages
is "$(grep -c '^[A-Za-z0-9._%-]*$' pages)" 8
python3 -c 'import os, urllib.parse
for line in open("pages"): assert os.path.isfile(b"r/" + urllib.parse.unquote_to_bytes(line.strip())), line' || wrong "a link leads nowhere"
grep -aq '<script>\.obj' r/*.html && wrong "a name is markup"

scene "the index has counts, layouts, and what could not be judged"
inputs
run --check --report=r a/m.obj b/bad.obj
exits 1
mkdir r
run --check --report=r --fail-on=never a/m.obj b/bad.obj
run --check --report=r.html --fail-on=never a/m.obj b/bad.obj
is "$(rows r/index.html 'f["name"], f["counts"], f["failure"]')" "$(rows r.html 'f["name"], f["counts"], f["failure"]')"
is "$(rows r/index.html 'f["triangles"], f["islands"], f["seams"]')" \
	"$(rows r.html 'tuple(sum(x) for x in ([m["triangles"] for m in f["meshes"]], [m["islands"] for m in f["meshes"]], [sum(len(s) == 6 for s in m["seams"]) for m in f["meshes"]]))')"
is "$(rows r/index.html 'sorted({x["code"] for x in f["findings"]})')" "$(rows r.html 'sorted({x["code"] for x in f["findings"]})')"
# a cube of side 2 shows three faces; of 112 x 80 pixels its height, 2 (0.955 + 0.167 + 0.244), takes 72, and 4 (0.788 + 0.296 + 0.539) is its area
cat >model.py <<'END'
import base64, zlib
def shades(f, kind="model"): return [] if not f[kind] else list(zlib.decompress(base64.b64decode(f[kind]), -15))
END
PYTHONPATH=. rows r/index.html '(lambda s: (len(s), len(set(s)), abs(sum(x > 0 for x in s) - 6.493 * (72 / 2.732) ** 2) < 120))(__import__("model").shades(f))' >models
is "$(head -1 models)" "(8960, 4, True)"
is "$(rows r/index.html 'f["model"] + f["layout"]' | tail -1)" ""
# its mirrored triangles cover the square of the texture, which takes 72 x 72
PYTHONPATH=. rows r/index.html '(lambda s: (len(s), s.count(1), s.count(2)))(__import__("model").shades(f, "layout"))' >layouts
is "$(head -1 layouts)" "(8960, 0, 5184)"
# a place far from any texture takes none from the others
{ cat a/m.obj; printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1e9 0\nvt 0 1e9\nf -3/-3 -2/-2 -1/-1\n'; } >far.obj
run --check --report=far/ --fail-on=never far.obj
is "$(PYTHONPATH=. rows far/index.html '(lambda s: (len(s), s.count(1), s.count(2)))(__import__("model").shades(f, "layout"))')" "(8960, 0, 5184)"
is "$(rows r/m.obj.html 'f["name"], f["counts"]')" "$(rows r/index.html 'f["name"], f["counts"]' | head -1)"

scene "any number of jobs and threads, and another run, write the same bytes"
inputs
run --check --report=one/ --jobs=1 --threads=1 a/* b/*
run --check --report=four/ --jobs=4 --threads=4 a/* b/*
diff -r one four >/dev/null || wrong "they differ"
run --check --report=four/ a/* b/*
diff -r one four >/dev/null || wrong "another run differs"

scene "pages that nmtan made are replaced or stay, all else is refused before anything is done"
inputs
run --check --report=r/ --fail-on=never a/m.obj b/bad.obj
exits 3
run --check --report=r/ --fail-on=never a/m.obj
exits 0
exists r/bad.obj.html
is "$(rows r/index.html 'f["page"]')" m.obj.html
for name in m.obj.html index.html; do
	mv r/$name kept
	echo mine >r/$name
	run --report=r/ -d out a/m.obj
	exits 2
	says "r/$name: refusing to write: it is no page of a report that nmtan made"
	is "$(cat r/$name)" mine
	[ ! -e out/m.glb ] || wrong "it ran"
	mv kept r/$name
done
run --report=r/ --no-clobber a/m.obj new.glb
exits 2
[ ! -e new.glb ] || wrong "it ran, with --no-clobber"
# an input is not replaced, whatever it says of itself
cp "$data/quad.obj" m.obj
{ printf '# <meta name="generator" content="nmtan">\n'; cat "$data/quad.obj"; } >m.obj.html
cp m.obj.html before
run --check --report=./ m.obj m.obj.html
exits 2
same m.obj.html before

scene "a folder is HTML, and of a conversion too"
cp "$data/mirrored_cube.obj" m.obj
run --check --report=r/ --report-format=json m.obj
exits 1
says "a report in a folder is HTML"
run --check --diff --report=r/ m.obj m.obj
exits 1
run --check --report=no/r/ m.obj
exits 2
[ ! -e r ] || wrong "a folder for nothing"
run --report=r/ --report-format=html m.obj m.glb
exits 0
only m.obj m.glb r
is "$(ls r | sed 's/-[0-9a-f]*\./-N./' | sort | tr '\n' ' ')" "index.html m.obj.html nmtan-N.css nmtan-N.js "

scene "pages share one script and one style, which are there first and never replace anything"
cp "$data/quad.obj" m.obj
run --check --report=r/ m.obj
run --check --report=m.html m.obj
script=$(echo r/nmtan-*.js) style=$(echo r/nmtan-*.css)
for page in r/index.html r/m.obj.html; do
	grep -q "<script src=\"${script#r/}\">" $page || wrong "$page does not have the script"
	grep -q "href=\"${style#r/}\">" $page || wrong "$page does not have the style"
	[ "$(wc -c <$page)" -lt 20000 ] || wrong "$page is large"
done
[ "$(wc -c <m.html)" -gt "$(cat "$script" "$style" | wc -c)" ] || wrong "a single page has not all in it"
! grep -q '<script src\|<link rel="stylesheet' m.html || wrong "a single page is not all"
# older pages keep theirs
cp "$script" r/nmtan-0123456789abcdef.js
ln "$script" kept
run --check --report=r/ m.obj
exits 0
exists r/nmtan-0123456789abcdef.js
[ "$script" -ef kept ] || wrong "it was written again"
for part in "$script" "$style"; do
	cp "$part" before
	echo mine >"$part"
	rm r/index.html
	run --report=r/ m.obj m.glb
	exits 2
	says "$part: refusing to write: it is no part of a report that nmtan made"
	is "$(cat "$part")" mine
	[ ! -e m.glb ] && [ ! -e r/index.html ] || wrong "it ran"
	cp before "$part"
done
rm "$script"
mkdir "$script"
run --check --report=r/ m.obj
exits 2

done_testing
