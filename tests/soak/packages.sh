#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/packages.sh BUILD: the packages of make deb, first of what is built already: lintian has nothing to say
# against them; a root directory with nothing in it but what they depend on takes, runs and gives them back. Then they are
# compiled twice, from two places of names of different lengths, by different numbers of jobs and an hour apart by the clock
# of the files: the same to the byte.
cd "$(dirname "$0")/../.." || exit 1
ROOT=$PWD BUILD=$PWD/$1 NMTAN=$PWD/$1/nmtan WORK=$(mktemp -d)
export ROOT BUILD NMTAN WORK
. "$ROOT/tests/support/cli.sh"
trap 'rm -rf "$WORK"' EXIT
version=$(sed -n 's/^#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' "$ROOT/include/nmtan.h")
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
deb=$WORK/deb

scene "Debian's tools make packages that lintian accepts"
tree=$deb/nmtan-$version
mkdir -p "$tree/build/release"
(cd "$ROOT" && cp -a Makefile README.md LICENSE src include man tests data "$tree" &&
	tar -cf - --format=posix --exclude=build/release/tests --exclude=build/release/installed build/release | tar -xf - -C "$tree")
mv "$tree/data/debian" "$tree/debian"
rm "$tree/debian/build.sh"
(cd "$tree" && MAKEFLAGS= dpkg-buildpackage --build=binary --unsigned-changes --no-pre-clean) >"$WORK/out.txt" 2>&1 ||
	wrong "$(tail -30 "$WORK/out.txt")"
grep -q '^[1-9][0-9]* passed, 0 failed' "$WORK/out.txt" || wrong "the build runs no test"
! grep -q ' -o [^ ]*/weld\.c\.o' "$WORK/out.txt" || wrong "what is built was built again"
lintian --fail-on error,warning "$deb"/*.changes >"$WORK/out.txt" 2>"$WORK/err.txt" || wrong "$(tail -30 "$WORK/out.txt")"
for package in nmtan libnmtan0 libnmtan-dev; do
	exists "$deb/${package}_${version}_$(dpkg --print-architecture).deb"
done
exists "$deb/nmtan-farm_${version}_all.deb"
# A file with all that the dynamic linker wants for it, at the same place below ./root.
with_libraries() {
	local file
	for file in $(ldd "$@" | awk '/=> \// { print $3 } $1 ~ /^\// && $1 !~ /:$/ { print $1 }' | sort -u); do
		case $file in "$PWD"*) continue ;; esac
		mkdir -p "root$(dirname "$file")"
		cp -L "$file" "root$file"
	done
}
in_root() {
	dpkg --root="$PWD/root" --force-not-root --force-script-chrootless --force-depends --log=/dev/null "$@" \
		>"$WORK/out.txt" 2>&1 || wrong "dpkg $*: $(tail -3 "$WORK/out.txt")"
}

scene "they are installed, run and removed in an empty root directory"
mkdir -p root/var/lib/dpkg/info root/var/lib/dpkg/updates root/tmp
touch root/var/lib/dpkg/status root/var/lib/dpkg/available
in_root -i "$deb"/nmtan_*.deb "$deb"/nmtan-farm_*.deb "$deb"/libnmtan0_*.deb "$deb"/libnmtan-dev_*.deb
exists root/usr/bin/nmtan root/usr/share/man/man1/nmtan.1.gz \
	root/usr/share/man/man7/nmtan-mtl.7.gz root/usr/share/doc/nmtan/copyright \
	root/usr/share/bash-completion/completions/nmtan root/usr/share/zsh/vendor-completions/_nmtan
# shellcheck disable=SC2046
with_libraries root/usr/bin/nmtan $(find root/usr/lib -name '*.so*' -type f)
cp "$data/head.obj" "$data"/plates.* "$data/bumps.png" root/tmp
enter="chroot root"
[ "$(id -u)" = 0 ] || enter="unshare --map-root-user --root=root"
for words in "/tmp/head.obj /tmp/head.glb" "--draco=edgebreaker --verify /tmp/plates.gltf /tmp/plates_packed.glb" \
	"--check /tmp/plates_packed.glb"; do
	# shellcheck disable=SC2086
	$enter /usr/bin/nmtan $words >"$WORK/out.txt" 2>"$WORK/err.txt" </dev/null
	status=$?
	exits 0
done
run "$data/head.obj" head.glb
cmp head.glb root/tmp/head.glb || wrong "the package's tool has other bytes"

export PKG_CONFIG_LIBDIR=$PWD/root/usr/lib/$triplet/pkgconfig PKG_CONFIG_SYSROOT_DIR=$PWD/root \
	PKG_CONFIG_SYSTEM_INCLUDE_PATH=/ PKG_CONFIG_SYSTEM_LIBRARY_PATH=/
(cd "$tree" && LD_LIBRARY_PATH=$OLDPWD/root/usr/lib/$triplet AUTOPKGTEST_TMP=$OLDPWD sh debian/tests/library) >"$WORK/out.txt" 2>&1 ||
	wrong "debian/tests/library: $(cat "$WORK/out.txt")"
mkdir bin && ln -s "$NMTAN" bin/nmtan
(cd "$tree" && PATH=$OLDPWD/bin:$PATH AUTOPKGTEST_TMP=$OLDPWD sh -eu debian/tests/convert) >"$WORK/out.txt" 2>&1 ||
	wrong "debian/tests/convert: $(cat "$WORK/out.txt")"

in_root --purge nmtan-farm nmtan libnmtan-dev libnmtan0
is "$(find root/usr \( -name '*nmtan*' -o -name '*.pc' \))" ""

scene "a changelog of another version is no package"
mkdir -p tree/data
cp -r "$ROOT/data/debian" tree/data
cp -r "$ROOT/include" tree
sed -i 's/^nmtan ([^)]*)/nmtan (99.0)/' tree/data/debian/changelog
sh tree/data/debian/build.sh elsewhere >"$WORK/out.txt" 2>"$WORK/err.txt"
status=$?
exits 1
says "data/debian/changelog ends with 99.0, include/nmtan.h says $version"

scene "two builds have the same bytes"
places=("$WORK/one" "$WORK/another place that is much longer")
for place in "${places[@]}"; do
	mkdir -p "$place"
	cp -R "$ROOT"/{Makefile,README.md,LICENSE,src,include,man,tests,data} "$place"
done
find "${places[1]}" -exec touch -h -d "1 hour ago" {} +
make -s -C "${places[0]}" MAKEFLAGS= deb >"$WORK/out.txt" 2>&1 || wrong "$(tail -20 "$WORK/out.txt")"
DEB_BUILD_OPTIONS=parallel=1 TZ=Asia/Tokyo LC_ALL=C make -s -C "${places[1]}" MAKEFLAGS= deb >"$WORK/out.txt" 2>&1 ||
	wrong "$(tail -20 "$WORK/out.txt")"
for package in "${places[0]}"/build/deb/*.deb; do
	same "$package" "${places[1]}/build/deb/${package##*/}"
done
is "$(ls "${places[0]}"/build/deb/*.deb | grep -vc -e -dbgsym_)" 4

done_testing
