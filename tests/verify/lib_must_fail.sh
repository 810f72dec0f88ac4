#!/bin/sh
# The assertions of lib.sh must fail on what is wrong: each of these has to leave failures above zero.
lib=$(dirname "$0")/lib.sh
set -- none none none
. "$lib"
bad=0
must_fail() {
   failures=0
   "$@" >/dev/null 2>&1
   [ "$failures" -gt 0 ] || { echo "passed, but must fail: $*"; bad=1; }
}
must_pass() {
   failures=0
   "$@" >/dev/null 2>&1
   [ "$failures" -eq 0 ] || { echo "failed, but must pass: $*"; bad=1; }
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
table() { printf '# columns: point p\n'; printf '%s\n' "$@"; }
table '1 1.0' '2 2.0' >"$work/a"
table '1 1.0' '2 2.1' >"$work/b"
table '1 1.0' >"$work/short"
table '1 1.0' '2 nan' >"$work/nan"
table '1 1.0' '3 2.0' >"$work/integer"
table '1 1e3' '2 2e3' >"$work/thousand"
printf '# columns: point p\n' >"$work/empty"
must_pass near x 1.0 1.05 0.1
must_fail near x 1.0 1.2 0.1
must_fail near x nan 1.0 0.1
must_fail near x '' 1.0 0.1
must_fail near x inf 1.0 0.1
must_fail near x 1.0 nan 0.1
must_pass same_tables x "$work/a" "$work/a" 1e-12
must_fail same_tables x "$work/a" "$work/b" 1e-3
must_fail same_tables x "$work/a" "$work/short" 1e-3
must_fail same_tables x "$work/a" "$work/nan" 1e-3
must_fail same_tables x "$work/nan" "$work/nan" 1e-3
must_fail same_tables x "$work/a" "$work/integer" 1e-3
must_fail same_tables x "$work/empty" "$work/empty" 1e-3
must_fail same_tables x "$work/a" "$work/none" 1e-3
must_pass same_tables x "$work/a" "$work/thousand" 1e-12 p=1000
must_fail same_tables x "$work/a" "$work/thousand" 1e-12
must_pass all_near x "$work/a" p 1.5 0.5
must_fail all_near x "$work/a" p 1.5 0.4
must_fail all_near x "$work/nan" p 1.5 10
must_fail all_near x "$work/empty" p 1.5 10
must_fail says x "$work/a" nothing
must_fail absent "$work/a"
exit $bad
