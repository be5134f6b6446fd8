#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/cross.sh BUILD: the whole tool for arm64, with its modules, run by qemu: its files have the bytes of BUILD's,
# and its messages are the same. If Draco encodes uncompressed primitives, the messages alone are compared: Debian's
# library multiplies and adds in one step on arm64, and may quantize to another integer. The libraries (6 MB) are unpacked
# below build/aarch64/, installed is nothing. Needs gcc-aarch64-linux-gnu, g++-aarch64-linux-gnu, qemu-user, and a Debian
# that knows packages of arm64:
#
#   dpkg --add-architecture arm64 && apt-get update
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$1
cross=build/aarch64 root=$PWD/build/aarch64/root
libraries=$root/usr/lib/aarch64-linux-gnu
packages="libdraco-dev libdraco7 libmeshoptimizer-dev libmeshoptimizer2d libopenmesh-dev libopenmesh1 libtinygltf-dev
	libtinygltf2d libspng-dev libspng0 libtiff-dev libtiff6 libjpeg62-turbo-dev libjpeg62-turbo
	libdeflate-dev libdeflate0 zlib1g zlib1g-dev libwebp-dev libwebp7 libwebpmux3 libwebpdemux2 libzstd1 liblzma5 libjbig0 liblerc4 libstb-dev libstb0"
for program in aarch64-linux-gnu-g++ qemu-aarch64 apt-get dpkg-deb; do
	command -v $program >/dev/null || { echo "cross.sh: $program is not here, nothing to run"; exit 0; }
done
dpkg --print-foreign-architectures | grep -q '^arm64$' ||
	{ echo "cross.sh: this Debian does not know packages of arm64 (dpkg --add-architecture arm64), nothing to run"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ ! -e "$libraries/libtinygltf.so" ]; then
	mkdir -p "$work/packages" "$root"
	# shellcheck disable=SC2086
	(cd "$work/packages" && apt-get -q download nlohmann-json3-dev $(printf '%s:arm64 ' $packages)) >"$work/said" 2>&1 ||
		{ tail -3 "$work/said"; exit 1; }
	for package in "$work"/packages/*.deb; do
		dpkg-deb -x "$package" "$root" || exit 1
	done
fi
make -s -j"$(nproc)" B=$cross CC=aarch64-linux-gnu-gcc CXX=aarch64-linux-gnu-g++ \
	CPPFLAGS="-isystem $root/usr/include -isystem $root/usr/include/aarch64-linux-gnu" \
	LDFLAGS="-L$libraries -Wl,-rpath-link,$libraries" $cross/nmtan \
	$cross/nmtan-{draco,meshopt,openmesh,png,tiff,tinygltf}.so || exit 1

cat >"$work/arm" <<END
#!/bin/sh
exec qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH="$libraries:$root/lib/aarch64-linux-gnu" "$PWD/$cross/nmtan" "\$@"
END
chmod +x "$work/arm"
"$build/nmtan" -q --draco=edgebreaker data/plates.gltf "$work/draco.glb" || exit 1
inputs=("$work/draco.glb" data/*.gltf data/*.glb data/*.obj data/*.ply)
[ ! -d ../shared/models ] || mapfile -t -O ${#inputs[@]} inputs < <(find ../shared/models -type f -size -400k \
	\( -name '*.gltf' -o -name '*.glb' -o -name '*.obj' -o -name '*.ply' -o -name '*.drc' \) | LC_ALL=C sort)
tried=0 bad=0
# try COMPARED ARGUMENT...: what a run says, without its time, and, where "." is compared, its files.
try() {
	local who compared=$1
	shift
	tried=$((tried + 1))
	for who in "$build/nmtan" "$work/arm"; do
		rm -rf "$work/out" && mkdir "$work/out"
		"$who" "${@//OUT/$work/out}" >"$work/said" 2>&1
		echo "code $?" >>"$work/said"
		sed -E 's/[0-9.]+ m?s(;|$)/T s\1/' "$work/said" >"$work/out/said"
		rm -rf "$work/${who##*/}.is" && mv "$work/out" "$work/${who##*/}.is"
	done
	diff -r "$work/nmtan.is/$compared" "$work/arm.is/$compared" >"$work/differs" && return
	bad=$((bad + 1))
	echo "FAILED $*"
	head -5 "$work/differs"
}
for input in "${inputs[@]}"; do
	try . --only=all --existing=replace --verify "$input" OUT/a.glb
	try . --only=all --existing=replace --images=embed --method=robust "$input" OUT/a.gltf
	try . --check --fail-on=never --report=OUT/r.json "$input"
	try said --only=all --existing=replace --draco=edgebreaker "$input" OUT/a.gltf
done
echo "$tried runs on arm64: $bad differ"
[ $bad = 0 ] && [ $tried -gt 60 ]
