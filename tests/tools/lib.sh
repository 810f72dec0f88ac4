# Shared by the scripts of this folder, which source it: a folder to work in, failures that are counted, and the last word.
set -u
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
   echo "$1"
   failures=$((failures + 1))
}

pause() {
   sleep 0.02 2>/dev/null || sleep 1
}

# row WHAT EXPECTED CAME: a line for tests/extremes/print-stability.sh, which names the file in FAULT_ROWS
row() {
   [ -z "${FAULT_ROWS:-}" ] || echo "| $1 | $2 | $3 |" >>"$FAULT_ROWS"
}

# the end of a script
finish() {
   [ "$failures" -eq 0 ] || exit 1
   echo 'all as expected'
   exit 0
}
