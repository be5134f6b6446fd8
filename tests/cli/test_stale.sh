# SPDX-License-Identifier: MIT
# --update is never stale, and makes nothing that nobody changed: some random edits; a thousand are in tests/soak/stale.sh.
. "$ROOT/tests/support/cli.sh"

case $BUILD in *sanitize*) steps=8 ;; *) steps=40 ;; esac
for seed in 1 2; do
	scene "$steps random edits of a tree, compared with clean runs: seed $seed"
	PYTHONDONTWRITEBYTECODE=1 python3 "$ROOT/tests/support/stale.py" "$NMTAN" $steps $seed >said 2>&1 || wrong "$(cat said)"
done

done_testing
