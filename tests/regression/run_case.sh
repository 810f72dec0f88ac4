#!/bin/sh
# Runs a deck and compares its tables with the reference tables.
#    run_case.sh ATRITO DECK REFERENCE OUTPUT [options of the run]
set -u
atrito=$1
deck=$2
reference=$3
output=$4
shift 4
rm -rf "$output"
"$atrito" "$deck" -o "$output" --quiet "$@" || exit 1
"$atrito" compare "$reference" "$output" --rtol 1e-8
