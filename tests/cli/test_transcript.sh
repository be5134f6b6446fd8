# SPDX-License-Identifier: MIT
# What the command says of small files is what tests/cli/transcript.txt says, by tests/report/transcript.py.
# Leaks count.
exec python3 -B "$ROOT/tests/report/transcript.py" "$NMTAN" "$ROOT/tests/cli/transcript.txt"
