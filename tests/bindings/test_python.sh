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
# not in build/, from which other tests read
(cd "$ROOT" && python3 -B src/bindings/python/wheel.py build/python/libnmtan.so.0 "$OLDPWD") >second.txt || wrong "$(cat second.txt)"
cmp -s "$(tail -1 second.txt)" "$ROOT/build/python/nmtan.whl" || wrong "they differ"

scene "the wheel's tag names the newest glibc that its library asks for"
newest=$(objdump -T "$ROOT/build/python/libnmtan.so.0" | grep -o 'GLIBC_2\.[0-9]*' | sort -uV | tail -1 | tr . _)
is "$(basename "$(readlink -f "$ROOT/build/python/nmtan.whl")")" \
	"nmtan-$(sed -n 's/.*VERSION_STRING "\(.*\)"/\1/p' "$ROOT/include/nmtan.h")-py3-none-manylinux_${newest#GLIBC_}_$(uname -m).whl"

scene "mypy --strict passes for the module and for who uses it"
if command -v mypy >/dev/null && [ -n "$python" ]; then
	cat >user.py <<'END'
import numpy as np
import nmtan

rows = np.zeros((3, 3), np.float32)
result: nmtan.VertexTangents = nmtan.vertex_tangents(rows, rows, rows[:, :2], [[0, 1, 2]], v_down=True)
mirrored: int = nmtan.corner_tangents(rows, rows, rows[:, :2], face_sizes=[3]).counts.mirrored
print(result.apply(rows).shape, result.tangents.dtype, mirrored, nmtan.version())
print(nmtan.convert("a.obj", "a.glb", verify=True).outputs)
END
	MYPYPATH=$ROOT/src/bindings/python mypy --strict --python-executable "$python" --cache-dir "$WORK/mypy" user.py \
		"$ROOT/src/bindings/python/nmtan" >mypy.txt 2>&1 || wrong "$(cat mypy.txt)"
	sed -i 's/v_down=True/convention="gltf"/' user.py
	! MYPYPATH=$ROOT/src/bindings/python mypy --strict --python-executable "$python" --cache-dir "$WORK/mypy" user.py >mypy.txt 2>&1 ||
		wrong "the old word is taken"
else
	skip_case "no mypy, or no numpy"
fi

scene "the source distribution builds the wheel, whose module has the same tangents"
python3 -B -c 'import sys, tarfile; tarfile.open(sys.argv[1]).extractall("sdist")' "$ROOT/build/python/nmtan.tar.gz" || wrong "no archive"
cd sdist/nmtan-* || wrong "$(ls sdist)"
CC="cc -DNMTAN_ONE_SET" python3 -B -c 'import wheel; print(wheel.build_wheel(".")); print(wheel.build_sdist("."))' >out.txt 2>&1 || wrong "$(cat out.txt)"
cmp -s nmtan-*.tar.gz "$ROOT/build/python/nmtan.tar.gz" || wrong "it is not the same from itself"
python3 -m zipfile -e nmtan-*.whl "$WORK/own"
cd "$WORK" || exit 1
[ -z "$python" ] || PYTHONPATH=$WORK/own "$python" -B -c 'import numpy, nmtan
assert nmtan.__file__.startswith("'"$WORK"'")
print(nmtan.tangents([[0,0,0],[1,0,0],[0,1,0]], [[0,0,1]]*3, [[0,0],[1,0],[0,1]]).tolist()[0])' >out.txt 2>&1 || wrong "$(cat out.txt)"
[ -z "$python" ] || is "$(cat out.txt)" "[1.0, 0.0, 0.0, 1.0]"

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
