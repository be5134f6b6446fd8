#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/stale.sh BUILD_DIR...: what --update leaves alone is what a clean run makes: 1000 random edits with the first build
# (tests/support/stale.py; STEPS=N SEED=N, another seed each time).
cd "$(dirname "$0")/../.." || exit 1
python3 tests/support/stale.py "$1/nmtan" "${STEPS:-1000}" ${SEED:-}
