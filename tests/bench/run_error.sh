#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_error.sh PROGRAM FOLDER: run time against error. Peers that the machine has join.
set -u
program=$1 folder=$2
exchange=$folder/exchange
rm -rf "$exchange" && mkdir -p "$exchange" || exit 2
"$program" export "$exchange" || exit 2

sh tests/bench/run_peers.sh "$exchange"
"$program" judge "$exchange" "$folder" || exit 1
sh tests/support/charts.sh "$folder" bench
cat "$folder/error.md"
