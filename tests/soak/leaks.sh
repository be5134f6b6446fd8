# SPDX-License-Identifier: MIT
#
# tests/soak/leaks.sh BUILD_DIR...: no process that tests/cli starts leaks. In make check the scripts look that have
# "# Leaks count" at their top: looking takes 10 to 17 ms of each process, which is half of its time. The last build has
# the address sanitizer.
set -u
cd "$(dirname "$0")/../.." || exit 1
said=$(mktemp)
trap 'rm -f "$said"' EXIT
NMTAN_LEAKS=1 bash tests/run --only=tests/cli/ "${!#}" >"$said" 2>&1
status=$?
grep -A60 '^FAILED' "$said"
tail -1 "$said"
exit $status
