#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/huge.sh BUILD_DIR...: buffers of more than 4 GiB, with the first build: see huge.py. Needs 10 GB of
# room in the folder for temporary files.
set -u
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 tests/soak/huge.py "$PWD/$1/nmtan" "$work"
