# SPDX-License-Identifier: MIT
# What make install puts where, that a C program finds it there, and that uninstall takes it away.
. "$ROOT/tests/support/cli.sh"

version=$(sed -n 's/^#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' "$ROOT/include/nmtan.h")
install_here() {
	make -s -C "$ROOT" MAKEFLAGS= "$@" config=release DESTDIR="$PWD/root" PREFIX=/opt/nmtan \
		>"$WORK/out.txt" 2>"$WORK/err.txt" || wrong "make $1 failed"
}

scene "install puts every file in its place"
install_here install
p=root/opt/nmtan
exists $p/bin/nmtan $p/lib/libnmtan.a "$p/lib/libnmtan.so.$version" $p/include/nmtan.h \
	$p/lib/pkgconfig/nmtan.pc $p/lib/cmake/nmtan/nmtan-config.cmake $p/share/man/man1/nmtan.1 \
	$p/share/bash-completion/completions/nmtan $p/share/zsh/site-functions/_nmtan $p/share/man/man7/nmtan-farm.7 \
	$p/share/man/man7/nmtan-mtl.7 $p/share/man/man3/nmtan.3 $p/share/man/man3/nmtan_vertex_tangents.3
is "$(cd $p/share/nmtan && find . -type f -printf '%m %P\n' | sort -k 2)" "$(cd "$data" && {
	ls farm/* | sed -e '/nmtan-farm$\|\.sh$/!s/^/644 /' -e '/^farm/s/^/755 /' && ls ./*.schema.json | sed 's|^\./|644 |'
} | sort -k 2)"
printf 'a.obj\0' | $p/bin/nmtan-farm prepare work 1 -d out || wrong "the installed nmtan-farm does not run"
! command -v parallel >/dev/null || NMTAN=$PWD/$p/bin/nmtan $p/bin/nmtan-farm parallel work >"$WORK/out.txt" 2>&1
grep -q '"status":"failed"' work/manifest.jsonl || ! command -v parallel >/dev/null || wrong "nmtan-farm finds no parallel.sh"
is "$(readlink $p/lib/libnmtan.so)" libnmtan.so.0
is "$(readlink $p/lib/libnmtan.so.0)" "libnmtan.so.$version"
grep -q "^prefix=/opt/nmtan$" $p/lib/pkgconfig/nmtan.pc || wrong "nmtan.pc has another prefix"
grep -q "^Version: $version$" $p/lib/pkgconfig/nmtan.pc || wrong "nmtan.pc has another version"
exists $p/lib/nmtan/nmtan-{draco,meshopt,openmesh,png,tiff,tinygltf}.so
[ -z "$(find root -type f -perm /022)" ] || wrong "files that others may write"
"$p/bin/nmtan" --version -v >"$WORK/out.txt"
for name in $(sed -n 's/^linked: \([A-Za-z_]*\).*/\1/p' "$WORK/out.txt"); do
	case $name in libjpeg) name=jpeg62 ;; stb_image) name=stb ;; xxHash) name=xxhash ;; fast_float) name=fast-float ;; esac
	grep -q "^==== .*$name" $p/share/doc/nmtan/licences.txt || wrong "the licence of $name is not installed"
done
"$p/bin/nmtan" --version | grep -q "$version" || wrong "the installed tool does not run"
# make deb fails where a package has none of them: tests/soak/packages.sh
cat "$data"/debian/*.install "$data/debian/not-installed" | sed 's/ .*//; /^#/d' >packaged
(cd $p && find . ! -type d) | sed 's|^\./lib/|usr/lib/any/|; s|^\./|usr/|' >installed
while read -r pattern; do
	grep -qxE "${pattern//\*/.*}(/.*)?" installed || wrong "$pattern is packaged and not installed"
	grep -vxE "${pattern//\*/.*}(/.*)?" installed >rest
	mv rest installed
done <packaged
is "$(cat installed)" ""

scene "the installed tool finds its modules where they were installed, by its own folder first"
make -s -C "$ROOT" MAKEFLAGS= install config=release PREFIX="$PWD/root" LIBDIR="$PWD/root/lib/x" >"$WORK/out.txt" 2>&1 ||
	wrong "make install failed"
NMTAN=$PWD/root/bin/nmtan
run -q --verify "$data/quad.obj" out.glb
exits 0
rm root/lib/x/nmtan/nmtan-tinygltf.so
run -q --verify "$data/quad.obj" none.glb
exits 5
says "the module nmtan-tinygltf.so, which is not in $PWD/root/bin or $PWD/root/lib/x/nmtan"
[ ! -e none.glb ] || wrong "an output without verification"
printf x >root/bin/nmtan-tinygltf.so
run -q --verify "$data/quad.obj" none.glb
exits 5
says "$PWD/root/bin/nmtan-tinygltf.so cannot be opened"

scene "a C program finds header and library through pkg-config, shared and static, without C++"
install_here install
cat >program.c <<'C'
#include <nmtan.h>
#include <stdio.h>
int main(void)
{
	puts(nmtan_version());
	return 0;
}
C
export PKG_CONFIG_PATH=$PWD/root/opt/nmtan/lib/pkgconfig
where="--define-variable=prefix=$PWD/root/opt/nmtan"
# as nmtan-engines(7) has it, but for the prefix
line=$(sed -n 's/\\-/-/g; s/^\.BR "\(cc program.c .*\)" \.$/\1/p' "$ROOT/man/nmtan-engines.7")
pkg-config() { command pkg-config "$where" "$@"; }
[ -n "$line" ] && eval "$line" || wrong "does not link shared: $line"
mv a.out shared
unset -f pkg-config
is "$(LD_LIBRARY_PATH=root/opt/nmtan/lib ./shared)" "$version"
# shellcheck disable=SC2046
cc -o static program.c $(pkg-config "$where" --cflags nmtan) root/opt/nmtan/lib/libnmtan.a \
	-pthread -lm || wrong "does not link static"
is "$(./static)" "$version"
! ldd shared static | grep -q 'libstdc++' || wrong "C++ came along"

triplet=$(cc -dumpmachine)
scene "so does a CMake project, wherever the whole was moved to, and other versions are refused"
install_here install LIBDIR=/opt/nmtan/lib/$triplet
mv root/opt/nmtan moved
mkdir project
printf '%s\n' '#include <nmtan.h>' '#include <stdio.h>' \
	'int main(void) { puts(nmtan_version()); return 0; }' >project/program.c
cat >project/CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.16)
project(asks C)
find_package(nmtan ${WANTED} CONFIG REQUIRED)
add_executable(shared program.c)
target_link_libraries(shared nmtan::nmtan)
add_executable(static program.c)
target_link_libraries(static nmtan::static)
CMAKE
cp project/CMakeLists.txt "$WORK"
configure() {
	cmake -S project -B "$1" -DCMAKE_PREFIX_PATH="$PWD/moved" -DWANTED="$2" >"$WORK/out.txt" 2>"$WORK/err.txt"
}
if configure built "${version%.*}" && cmake --build built >"$WORK/out.txt" 2>&1; then
	is "$(built/shared)" "$version"
	is "$(built/static)" "$version"
	readelf -d built/static | grep -q libnmtan && wrong "the static program wants the shared library"
	readelf -d built/shared | grep -q 'NEEDED.*libnmtan.so.0' || wrong "the shared program does not want libnmtan.so.0"
else
	wrong "cmake finds or builds nothing: $(tail -3 "$WORK/out.txt")"
fi
configure later 99.0 && wrong "version 99.0 is found"
says 'version: '"$version"
rm moved/lib/$triplet/libnmtan.so.*
configure gone "$version" && wrong "a library that is gone is found"
says 'nmtan_FOUND to FALSE'

scene "install-lib needs a C compiler and the headers of C alone; pkg-config, CMake and musl find what it installs"
dpkg -L libc6-dev linux-libc-dev | grep '^/usr/include/.*\.h$' | xargs cp --parents -t . && mv usr/include headers
mkdir tree && cp -r "$ROOT/Makefile" "$ROOT/src" "$ROOT/include" "$ROOT/man" "$ROOT/tests" tree
alone="cc -nostdinc -isystem $(cc -print-file-name=include) -isystem $PWD/headers -isystem $PWD/headers/$triplet"
echo '#include <draco/core/draco_types.h>' | $alone -E - >"$WORK/out.txt" 2>&1 && wrong "Draco's headers are found"
# without optimizations, which take 15 seconds and are in every other build
make -s -C tree MAKEFLAGS= CC="$alone" CXX=false CFLAGS=-O0 lanes= install-lib DESTDIR="$PWD" PREFIX=/moved LIBDIR=/moved/lib/$triplet \
	>"$WORK/out.txt" 2>"$WORK/err.txt" || wrong "make install-lib failed"
is "$(cd tree/build/release && find . -name '*.o' | cut -d/ -f2 | sort -u | tr '\n' ' ')" "api base tangent topology "
# shellcheck disable=SC2046
cc -o shared "$ROOT/tests/api/digest.c" $(PKG_CONFIG_PATH=moved/lib/$triplet/pkgconfig pkg-config \
	"--define-variable=prefix=$PWD/moved" --cflags --libs nmtan) -lm || wrong "pkg-config finds nothing"
expected=$(LD_LIBRARY_PATH=moved/lib/$triplet ./shared "$data"/golden/*.nmtg)
is "${expected#* }" "self-test 1"
mkdir project && cp "$WORK/CMakeLists.txt" project && cp "$ROOT/tests/api/digest.c" project/program.c
configure built "${version%.*}" && cmake --build built >"$WORK/out.txt" 2>&1 || wrong "$(tail -3 "$WORK/out.txt")"
is "$(built/static "$data"/golden/*.nmtg)" "$expected"
musl-gcc -static -o musl -Imoved/include project/program.c moved/lib/$triplet/libnmtan.a || wrong "does not link with musl"
is "$(./musl "$data"/golden/*.nmtg)" "$expected"
exists moved/share/man/man7/nmtan-engines.7
make -s -C tree MAKEFLAGS= uninstall-lib DESTDIR="$PWD" PREFIX=/moved LIBDIR=/moved/lib/$triplet
is "$(find moved -type f -o -type l)" ""

scene "pkg-config names the library's folder, inside of the prefix or elsewhere"
install_here install LIBDIR=/opt/nmtan/lib/$triplet
pc=root/opt/nmtan/lib/$triplet/pkgconfig/nmtan.pc
is "$(pkg-config --variable=libdir $pc)" /opt/nmtan/lib/$triplet
is "$(pkg-config --define-variable=prefix=/x --variable=libdir $pc)" /x/lib/$triplet
install_here install LIBDIR=/elsewhere
is "$(pkg-config --define-variable=prefix=/x --variable=libdir root/elsewhere/pkgconfig/nmtan.pc)" /elsewhere

scene "uninstall leaves nothing"
install_here install
install_here uninstall
install_here install LIBDIR=/elsewhere
install_here uninstall LIBDIR=/elsewhere
is "$(find root \( -type f -o -type l \))" ""
[ ! -e root/opt/nmtan/share/nmtan ] || wrong "its folder is left"

scene "where the tree lies makes no difference to what is built"
# tests/soak/packages.sh builds everything twice
mkdir -p "a place with a long name/tree"
cp -r "$ROOT/Makefile" "$ROOT/src" "$ROOT/include" "$ROOT/tests" "a place with a long name/tree"
objects="base/pool.c.o topology/weld.c.o obj/mtl.c.o ext/linked.c.o"
for object in $objects; do [ -f "$ROOT/build/release/$object" ] || wrong "$object is not there"; done
make -s -C "a place with a long name/tree" MAKEFLAGS= config=release $(printf 'build/release/%s ' $objects) \
	>"$WORK/out.txt" 2>"$WORK/err.txt" || wrong "make failed"
for object in $objects; do
	cmp "a place with a long name/tree/build/release/$object" "$ROOT/build/release/$object" || wrong "$object differs"
done

done_testing
