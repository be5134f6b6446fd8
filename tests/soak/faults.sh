#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/faults.sh BUILD_DIR...: every allocation of the first build's tool fails, once and with all that come
# after it; every system call fails in four ways; at every system call an input becomes empty. Prints how many were tried and how many of them ended badly: see tests/faults/sweep.py.
set -u
cd "$(dirname "$0")/../.." || exit 1
ROOT=$PWD BUILD=$PWD/$1 NMTAN=$PWD/$1/nmtan WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
. tests/faults/cases.sh
make_inputs && sweep_all "memory" "memory onwards" EIO ENOMEM EINTR ENOSPC shorten -- 1
