#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/packages.sh: make deb twice, from two places of names of different lengths, by different numbers of jobs
# and an hour apart by the clock of the files: the packages are the same to the byte.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
places=("$work/one" "$work/another place that is much longer")
for place in "${places[@]}"; do
	mkdir -p "$place"
	cp -R "$root"/{Makefile,README.md,LICENSE,src,include,man,tests,data} "$place"
done
find "${places[1]}" -exec touch -h -d "1 hour ago" {} +
make -s -C "${places[0]}" MAKEFLAGS= deb >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
DEB_BUILD_OPTIONS=parallel=1 TZ=Asia/Tokyo LC_ALL=C make -s -C "${places[1]}" MAKEFLAGS= deb >"$work/log" 2>&1 ||
	{ tail -20 "$work/log"; exit 1; }
bad=0 count=0
for package in "${places[0]}"/build/deb/*.deb; do
	count=$((count + 1))
	cmp "$package" "${places[1]}/build/deb/${package##*/}" || bad=1
done
echo "$count packages, built twice: $([ $bad = 0 ] && echo the same bytes || echo DIFFERENT)"
[ $bad = 0 ] && [ $count -ge 3 ]
