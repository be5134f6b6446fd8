#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/clang.sh: clang builds everything without a warning, and its sanitizers, which see more than gcc's
# (pointers that are made from NULL, numbers that do not fit an integer), find nothing in the tests.
set -u
cd "$(dirname "$0")/../.." || exit 1
command -v clang >/dev/null || { echo "clang.sh: clang is not here (clang, libclang-rt-14-dev), nothing to run"; exit 0; }
said=$(mktemp)
trap 'rm -f "$said"' EXIT
code=0
for config in clang clang-sanitize; do
	make -s -j"$(nproc)" config=$config all tests >"$said" 2>&1 || code=1
	! grep -q 'warning:' "$said" || code=1
	[ $code = 0 ] || { grep -E 'warning:|error:' "$said" | head -20; echo "FAILED config=$config"; exit 1; }
done
for part in tests/unit/ tests/api/ tests/cli/; do
	bash tests/run --only=$part build/clang-sanitize >"$said" 2>&1 || { code=1; sed -n '/^failed:/,$p' "$said"; }
	tail -1 "$said"
done
exit $code
