#!/bin/sh
# A library of MUMPS of another version than the header that the program was built with is not used: exit 9, and both versions are told.
#    other_mumps.sh ATRITO-MPI DECK, whose top goes to MUMPS, with such a library where it is loaded from
. "$(dirname "$0")/lib.sh"

by_ranks 4 "$2" --share all --contact sparse --quiet -o out-of-it
expect_code 9 'another version of MUMPS'
grep -q 'is version 4\.10\.0 of MUMPS, and this program was built for [0-9.]*: build it anew' err || { fail 'the versions are not told'; cat err; }
[ ! -e out-of-it ] || fail 'something was written'
finish
