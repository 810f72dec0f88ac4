#!/bin/sh
# docs/user/screens.md is what the program shows.
#    screens.sh SOURCE ATRITO
. "$(dirname "$0")/../tools/lib.sh"
sh "$1/docs/make-screens" "$2" "$work/page"
code=$?
[ $code -eq 77 ] && exit 77
[ $code -eq 0 ] || fail "docs/make-screens: exit $code"
diff "$1/docs/user/screens.md" "$work/page" || fail 'docs/user/screens.md: record it by docs/make-screens'
finish
