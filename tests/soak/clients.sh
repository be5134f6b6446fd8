#!/bin/bash
# SPDX-License-Identifier: MIT
# clients.sh BUILD: three.js, Babylon.js, PlayCanvas, assimp and the Khronos validator read what comes of every mesh below
# the folders of NT_CORPUS (data, ../shared/models and ../shared/corpus unless it says others), by seven sets of options:
# see clients.mjs. With NT_PROGRESS=1 it says how far it is.
modules=build/soak-clients
[ -d $modules/node_modules/assimpjs ] || npm install --prefix $modules --no-save --ignore-scripts --no-audit --no-fund \
	--loglevel=error three@0.187.0 babylonjs@9.35.0 babylonjs-loaders@9.28.0 playcanvas@2.23.3 assimpjs@0.0.10 \
	meshoptimizer@1.3.0 >/dev/null || { echo "1 passed, 0 failed, 1 skipped (npm has no packages)"; exit 0; }
make -s build/node/node_modules/gltf-validator/package.json
# shellcheck disable=SC2086
node tests/soak/clients.mjs $modules/node_modules "$1" ${NT_CORPUS:-data ../shared/models ../shared/corpus}
