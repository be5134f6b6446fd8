#!/bin/sh
# SPDX-License-Identifier: MIT
#
# build.sh FOLDER: make deb. Leaves nmtan, nmtan-farm, libnmtan0 and libnmtan-dev in FOLDER, built from a copy of the tree, and
# lets lintian look at them. DEB_BUILD_OPTIONS as in Debian's policy.
set -eu
cd "$(dirname "$0")/../.."
folder=$1
for pair in dpkg-buildpackage:dpkg-dev dh:debhelper lintian:lintian; do
	command -v "${pair%%:*}" >/dev/null || {
		echo "make deb needs ${pair%%:*}: apt-get install dpkg-dev debhelper lintian" >&2
		exit 1
	}
done
version=$(sed -n 's/^#define NMTAN_VERSION_STRING "\(.*\)"/\1/p' include/nmtan.h)
said=$(dpkg-parsechangelog -l data/debian/changelog -S Version)
[ "$said" = "$version" ] || {
	echo "data/debian/changelog ends with $said, include/nmtan.h says $version" >&2
	exit 1
}
rm -rf "$folder"
tree=$folder/nmtan-$version
mkdir -p "$tree"
cp -R Makefile README.md LICENSE src include man tests data "$tree"
mv "$tree/data/debian" "$tree/debian"
rm "$tree/debian/build.sh"
(cd "$tree" && DEB_BUILD_OPTIONS="parallel=$(nproc) ${DEB_BUILD_OPTIONS:-}" \
	dpkg-buildpackage --build=binary --unsigned-changes --no-pre-clean >../build.log 2>&1) || {
	tail -40 "$folder/build.log" >&2
	exit 1
}
lintian --fail-on error,warning "$folder"/*.changes
ls -l "$folder"/*.deb
