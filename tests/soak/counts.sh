#!/bin/bash
# SPDX-License-Identifier: MIT
#
# counts.sh RELEASE ...: what is counted in inputs, from 1 000 to 100 000 of it, takes n log n time: see counts.py.
set -u
cd "$(dirname "$0")/../.." || exit 1
exec python3 -B tests/soak/counts.py "$1/nmtan"
