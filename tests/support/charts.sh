#!/bin/sh
# SPDX-License-Identifier: MIT
#
# charts.sh FOLDER NAME: a PNG beside each chart of a folder, where rsvg-convert is installed; NAME says it if not.
if command -v rsvg-convert >/dev/null; then
	for chart in "$1"/*.svg; do
		rsvg-convert -o "${chart%.svg}.png" "$chart"
	done
else
	echo "$2: no rsvg-convert (librsvg2-bin), charts as SVG alone"
fi
