#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/conformance.sh BUILD_DIR...: the answers of the conformance kit against mikktspace.c as published, which
# lies in the folder that $MIKKTSPACE names, and the card in three.js, right and with each mistake.
set -u
cd "$(dirname "$0")/../.." || exit 1
status=0
if [ -f "${MIKKTSPACE:-.}/mikktspace.c" ]; then
	python3 -B tests/conformance/reference.py "$MIKKTSPACE" || status=1
else
	echo "conformance.sh: \$MIKKTSPACE names no folder that has mikktspace.c, nothing was compared"
fi
make -s conformance build/clients/node_modules/three/package.json build/node/node_modules/gltf-validator/package.json
node tests/conformance/card.mjs build/conformance/card.glb build build/conformance.png || status=1
exit $status
