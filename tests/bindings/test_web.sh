# SPDX-License-Identifier: MIT
# What of the page and of the tool for Node needs no WebAssembly: the page's text and archives, and Windows' paths. The page
# in a browser: tests/soak/web.sh. The tool: tests/soak/wasm_tool.sh.
. "$ROOT/tests/support/cli.sh"

scene "the report of the page is made of markup and of scripts alone"
mkdir -p src/bindings src/report/render
cp -r "$ROOT/src/bindings/web" src/bindings
cp -r "$ROOT"/src/report/render/{page,page_assets.c} src/report/render
echo 'include src/bindings/web/web.mk' >Makefile
env -u MAKEFLAGS make -s build/web/report.html build/web/report.js 2>make.txt || wrong "$(cat make.txt)"
is "$(cat build/web/report.html)" "$(cat src/bindings/web/report.html src/report/render/page/page.html && printf '</body>\n</html>\n')"
is "$(sed '1,2d; $d' build/web/report.js)" "$(cd src/report/render/page && cat $(grep -o '[a-z]*\.js' ../page_assets.c))"

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
# old versions of node do not see by themselves that scripts are modules
cp -r "$ROOT/src/bindings/web" "$ROOT/src/bindings/tool" "$WORK"
echo '{"type": "module"}' >"$WORK/package.json"
cases_of zip "$ROOT/tests/bindings/zip.mjs" "$WORK/web" "$WORK/python.zip" "$WORK/ours.zip"

mkdir "$WORK/drives"
cases_of windows "$ROOT/tests/bindings/windows.mjs" "$WORK/tool" "$WORK/drives"

scene "Python reads the archive that the page wrote"
is "$(python3 -c 'import sys, zipfile
z = zipfile.ZipFile(sys.argv[1]); print(z.testzip(), [(i.filename, i.file_size) for i in z.infolist()])' "$WORK/ours.zip")" \
	"None [('a/größe.bin', 70000), ('b.gltf', 0)]"
finish_case
done_testing
