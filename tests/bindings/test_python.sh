# SPDX-License-Identifier: MIT
# The wheel: what is in it, and its module under pytest, from the unpacked wheel.
. "$ROOT/tests/support/cli.sh"

python=
for candidate in python3 /usr/bin/python3; do
	if "$candidate" -c 'import numpy, pytest' 2>/dev/null; then python=$candidate && break; fi
done

scene "the wheel has the module, the library and the licence, and nothing else"
make -C "$ROOT" -s python >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
python3 -m zipfile -l "$ROOT/build/python/nmtan.whl" | awk 'NR > 1 { sub(/-[0-9.]+\.dist/, ".dist", $1); print $1 }' | sort >names.txt
printf '%s\n' nmtan.dist-info/{LICENSE,METADATA,RECORD,WHEEL} nmtan/{__init__.py,_convert.py,_library.py,libnmtan.so.0,py.typed} |
	sort | diff - names.txt >diff.txt || wrong "$(cat diff.txt)"

scene "two builds of the wheel have the same bytes"
cp -L "$ROOT/build/python/nmtan.whl" first.whl
rm -f "$ROOT/build/python/nmtan.whl"
make -C "$ROOT" -s python >make.txt 2>&1 || wrong "$(tail -5 make.txt)"
cmp -s first.whl "$ROOT/build/python/nmtan.whl" || wrong "they differ"

if [ -z "$python" ]; then
	scene "the module's tests"
	skip_case "no Python with numpy and pytest (python3-numpy, python3-pytest)"
	done_testing
	exit
fi
finish_case
python3 -m zipfile -e "$ROOT/build/python/nmtan.whl" "$WORK/wheel"
NMTAN_DATA=$data NMTAN_HEADER=$ROOT/include/nmtan.h PYTHONPATH=$WORK/wheel PYTHONDONTWRITEBYTECODE=1 \
	"$python" -m pytest -v -p no:cacheprovider "$ROOT/tests/bindings/test_nmtan.py" >"$WORK/pytest.txt" 2>&1
ended=$?
while IFS= read -r line; do
	case $line in
	*::*" PASSED"*) scene "module: $(sed -E 's/.*::(.*) PASSED.*/\1/' <<<"$line")" ;;
	*::*" FAILED"* | *::*" ERROR"*)
		scene "module: $(sed -E 's/.*::(.*) (FAILED|ERROR).*/\1/' <<<"$line")"
		wrong "see below"
		;;
	esac
done <"$WORK/pytest.txt"
scene "the program of README.md prints what it says"
PYTHONPATH=$WORK/wheel "$python" -m doctest -o ELLIPSIS "$ROOT/README.md" >doctest.txt 2>&1 || wrong "$(head -30 doctest.txt)"
grep -q ">>> import numpy" "$ROOT/README.md" || wrong "there is no program"
scene "module: pytest ends with 0"
[ $ended = 0 ] || wrong "$(tail -50 "$WORK/pytest.txt")"
done_testing
