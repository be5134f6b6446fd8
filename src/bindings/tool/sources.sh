#!/bin/sh
# SPDX-License-Identifier: MIT
#
# sources.sh FOLDER: the sources of the foreign libraries into FOLDER/NAME, from Debian's source packages, in the versions
# that the native tool is linked with. The mirror is the one that the system's own list names, the list of
# sources one beside the sources: nothing of the system is changed, nothing is installed.
set -eu
mkdir -p "$1" && cd "$1"
top=$(pwd)

packages="libdraco-dev libmeshoptimizer-dev libopenmesh-dev libtinygltf-dev libspng-dev libdeflate-dev
	libjpeg62-turbo-dev libtiff-dev libwebp-dev zlib1g-dev libzstd-dev"

apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
	awk '!seen[$0]++' >sources.list
mkdir -p lists/partial
apt() {
	apt-get -qq -o Dir::Etc::sourcelist="$top/sources.list" -o Dir::Etc::sourceparts=/dev/null \
		-o Dir::State::lists="$top/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
		-o APT::Sandbox::User= -o Acquire::Languages=none "$@"
}
apt update

for package in $packages; do
	source=$(dpkg-query -W -f='${source:Package}' "$package")
	[ -e "$source/.complete" ] && continue
	rm -rf "$source" && mkdir "$source"
	(
		cd "$source" &&
			apt source --only-source "$source=$(dpkg-query -W -f='${source:Version}' "$package")" &&
			mv "$(find . -mindepth 1 -maxdepth 1 -type d)" unpacked
	) >"$source.log" 2>&1 || { cat "$source.log" >&2; exit 1; }
	rm "$source.log" "$source"/*.tar.* "$source"/*.dsc
	touch "$source/.complete"
done
