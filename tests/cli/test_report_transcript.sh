# SPDX-License-Identifier: MIT
# Reports of small files in every format are what tests/report/transcript.txt says.
# Leaks count.
exec python3 -B "$ROOT/tests/report/transcript.py" "$NMTAN" "$ROOT/tests/report/transcript.txt"
