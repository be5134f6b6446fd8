#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Installs what is missing, and only that: "need.sh build" for make demo, "need.sh tests" for what tests are compiled
# with as well, "need.sh check" for all that they run, "need.sh wasm" for make wasm, whose packages the tests want too where clang is at hand. Touches
# nothing, and needs no network, when everything is there. Debian packages by apt, with sudo when not root; on other
# systems it names what to install by hand.
set -eu

build="pkg-config libopenmesh-dev libtinygltf-dev nlohmann-json3-dev libdraco-dev
	libmeshoptimizer-dev libfast-float-dev libxxhash-dev libspng-dev libjpeg62-turbo-dev
	libtiff-dev libwebp-dev libdeflate-dev libstb-dev"
check="libcmocka-dev chromium abigail-tools python3-numpy python3-pytest ninja-build parallel musl-tools mypy"
wasm="lld wasi-libc libclang-rt-dev-wasm32 binaryen"

# Programs are looked for by name, since they often come from elsewhere than Debian.
missing=
for pair in gcc:build-essential g++:build-essential make:make; do
	command -v "${pair%%:*}" >/dev/null 2>&1 || missing="$missing ${pair#*:}"
done
case ${1:-build} in
tests) build="$build libcmocka-dev" ;;
check)
	build="$build $check"
	! command -v clang >/dev/null 2>&1 || build="$build $wasm"
	for pair in node:nodejs npm:npm python3:python3 cmake:cmake; do
		command -v "${pair%%:*}" >/dev/null 2>&1 || missing="$missing ${pair#*:}"
	done
	;;
esac

if [ "${1:-build}" = wasm ]; then
	build=$wasm
	command -v clang >/dev/null 2>&1 || missing="$missing clang"
fi

# A package above 100 MB is no part of the check: make wasm-tool asks for it.
if [ "${1:-build}" = emscripten ]; then
	build="$build emscripten dpkg-dev nodejs"
	missing=
fi

if ! command -v dpkg-query >/dev/null 2>&1; then
	echo "need.sh: this is not Debian; please install by hand:" $build $missing
	exit 0
fi
for package in $build; do
	case $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true) in
	"install ok installed") ;;
	*) missing="$missing $package" ;;
	esac
done
[ -n "$missing" ] || exit 0

missing=$(printf '%s\n' $missing | sort -u | tr '\n' ' ')
sudo=
if [ "$(id -u)" != 0 ]; then
	command -v sudo >/dev/null 2>&1 || {
		echo "need.sh: not root and no sudo; please install: $missing" >&2
		exit 1
	}
	sudo=sudo
fi
echo "Installing from Debian: $missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# A list of packages that is new enough is not fetched again.
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing \
	>"$log" 2>&1 || {
	echo "Fetching the list of packages first"
	$sudo apt-get update >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
	$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing \
		>"$log" 2>&1 || { cat "$log" >&2; exit 1; }
}
