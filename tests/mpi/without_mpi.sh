#!/bin/sh
# -DATRITO_MPI=ON where there is no MPI: CMake stops and names the packages.
#    without_mpi.sh CMAKE SOURCES
. "$(dirname "$0")/../tools/lib.sh"
"$1" -S "$2" -B "$work/build" -DATRITO_MPI=ON -DBUILD_TESTING=OFF -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON >"$work/said" 2>&1 &&
   fail 'it is configured without MPI'
tr -s ' \n' ' ' <"$work/said" | grep -q 'is missing: install libopenmpi-dev' || { fail 'the package is not named'; cat "$work/said"; }
finish
