#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run_pareto.sh PROGRAM NMTAN FOLDER SVG: run time against error. $MODELS and $PEERS: see models.sh and native.h.
set -u
program=$1 nmtan=$2 folder=$3 svg=$4
exchange=$folder/exchange
rm -rf "$exchange" && mkdir -p "$exchange" "${svg%/*}" || exit 2
# shellcheck disable=SC2046
set -- $(sh tests/bench/models.sh "$nmtan" "$folder/models")
"$program" export "$exchange" "$@" || exit 2
sh tests/bench/run_peers.sh "$exchange"
"$program" judge "$exchange" "$nmtan" "$@" && python3 tests/bench/chart.py "$svg" <"$exchange/marks.tsv" || exit 1
rm -rf "$exchange"
