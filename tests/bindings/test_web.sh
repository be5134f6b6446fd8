# SPDX-License-Identifier: MIT
# What of the page needs no WebAssembly: its archives, and that the files that make it are there. The page in a browser:
# tests/soak/web.sh.
. "$ROOT/tests/support/cli.sh"

if ! command -v node >/dev/null 2>&1; then
	scene "the page"
	skip_case "no node"
	done_testing
	exit
fi

python3 -c 'import sys, zipfile
with zipfile.ZipFile(sys.argv[1], "w") as z:
    z.comment = b"PK\5\6 is how the last record begins"
    z.writestr("a/", "")
    z.writestr("a/stored.txt", "stored")
    z.writestr("a/letter.txt", "abcdefghij" * 10000, zipfile.ZIP_DEFLATED)
    z.writestr("a/f\u00fcnf.obj", "v\n")' "$WORK/python.zip"
cases_of zip "$ROOT/tests/bindings/zip.mjs" "$ROOT/src/bindings/web" "$WORK/python.zip" "$WORK/ours.zip"

scene "Python reads the archive that the page wrote"
is "$(python3 -c 'import sys, zipfile
z = zipfile.ZipFile(sys.argv[1]); print(z.testzip(), [(i.filename, i.file_size) for i in z.infolist()])' "$WORK/ours.zip")" \
	"None [('a/größe.bin', 70000), ('b.gltf', 0)]"
finish_case
done_testing
