# SPDX-License-Identifier: MIT
# Small OBJ and PLY files, which texts.tsv has as text: what is made of them, and what is said.
# Leaks count.
cd "$WORK" && exec python3 -B "$ROOT/tests/support/texts.py" "$NMTAN" "$ROOT/tests/cli/texts.tsv"
