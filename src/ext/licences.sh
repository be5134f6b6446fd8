#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Prints the licences of what is linked into the tool (linked.c) and its modules, as the packages have them that it was
# built with. Libraries that are shared come with their own.
for package in libdeflate-dev libfast-float-dev libjpeg62-turbo-dev libstb-dev libstdc++ libxxhash-dev nlohmann-json3-dev; do
	name=$package
	[ $package != libstdc++ ] || name=$(dpkg-query -W -f='${Package}\n' 'libstdc++-*-dev' 2>/dev/null | tail -n 1)
	text=/usr/share/doc/$name/copyright
	echo "==== $package ===="
	echo
	if [ -f "$text" ]; then cat "$text"; else echo "The licence is where the library came from."; fi
	echo
done
