#!/bin/sh
# The assertions of lib.sh must fail on what is wrong: each of these has to leave failures above zero.
lib=$(dirname "$0")/lib.sh
set -- none none none
. "$lib"
bad=0
must_fail() {
   failures=0
   { "$@"; judge_numbers; } >/dev/null 2>&1
   [ "$failures" -gt 0 ] || { echo "passed, but must fail: $*"; bad=1; }
}
must_pass() {
   failures=0
   { "$@"; judge_numbers; } >/dev/null 2>&1
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
table '1 1e400' '2 1e400' >"$work/huge"
printf '# columns: point p\n' >"$work/empty"
printf '# columns: point q\n1 1.0\n2 2.0\n' >"$work/other"
printf '# columns: point p q\n1 1.0 1.0\n2 2.0 2.0\n' >"$work/wide"
printf '# columns: step node x y u\n1 1 0 1 3.0\n1 2 1 1 5.0\n' >"$work/field"
printf '# columns: step node x y u\n1 1 0 1 3.0\n1 2 1 1 nan\n' >"$work/field-nan"
printf '# columns: step pair quantity value\n1 1 a 2.0\n' >"$work/summary.tab"
must_pass near x 1.0 1.05 0.1
must_fail near x 1.0 1.2 0.1
must_fail near x nan 1.0 0.1
must_fail near x '' 1.0 0.1
must_fail near x inf 1.0 0.1
must_fail near x 1.0 nan 0.1
must_fail near x 1e400 1e400 0.1
must_fail near x 1.0 1.0 nan
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
must_fail same_tables x "$work/a" "$work/thousand" 1e-12 p=nan
must_fail same_tables x "$work/huge" "$work/huge" 1e-12
must_fail all_near x "$work/huge" p 1e400 10
must_fail same_tables x "$work/a" "$work/thousand" 1e-12 p=
must_fail same_tables x "$work/a" "$work/other" 1e-3
must_fail same_tables x "$work/wide" "$work/a" 1e-3
must_pass all_near x "$work/a" p 1.5 0.5
must_fail all_near x "$work/a" p 1.5 0.4
must_fail all_near x "$work/nan" p 1.5 10
must_fail all_near x "$work/empty" p 1.5 10
must_pass field_near x "$work/field" u '2*x + 3*y' 1e-12
must_fail field_near x "$work/field" u '2.1*x + 3*y' 1e-3
must_fail field_near x "$work/field" v '2*x + 3*y' 10
must_fail field_near x "$work/field" u 'log(-1)' 10
must_fail field_near x "$work/field-nan" u '2*x + 3*y' 10
must_fail field_near x "$work/empty" p 1 10
must_pass near x "$(summary "$work" a)" 2 0
must_fail near x "$(summary "$work" missing)" 0 10
must_pass near x "$(value '1/4 - 1')" -0.75 0
must_fail near x "$(value '1/' 2>"$work/err")" 0 1
must_pass below x 0.5 1
must_fail below x nan 1
must_fail below x 2 1
must_fail says x "$work/a" nothing
must_fail eval 'near x 1 1 0; rm "$compared"'
must_fail eval 'near x 1 1 0; near x 1 2 0; near x 1 1 0'
must_fail absent "$work/a"
exit $bad
