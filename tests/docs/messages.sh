#!/bin/sh
# Each message that the sources can print has a cause in docs/user/messages.md, errors and warnings a cure, and it has no other.
#    messages.sh SOURCE
. "$(dirname "$0")/../tools/lib.sh"
cd "$1" || exit 9
page=docs/user/messages.md

# documented PAGE: the names of its lists, `- **NAME** (code): cause. *cure*`, in which lines go on; entries without a cause or a cure are told
documented() {
   awk 'function judge() {
           if (entry ~ /^- \*\*[EWN]-[A-Z]/) {
              if (entry !~ /: [^*]/ || (entry !~ /^- \*\*N/ && entry !~ /\*$/)) print "no cause or no cure: " substr(entry, 5, 12) >"/dev/stderr"
              while (match(entry, /\*\*[EWN]-[A-Z-]+\*\*/)) { print substr(entry, RSTART + 2, RLENGTH - 4); entry = substr(entry, RSTART + RLENGTH) }
           }
           entry = "" }
        /^- / || /^$/ { judge() }
        { sub(/^ +/, " "); entry = entry $0 }
        END { judge() }' "$1" 2>"$work/bare" | sort -u
}

grep -rhowE '[EWN]-[A-Z]+(-[A-Z]+)*' --include='*.f90' --include='*.c' src | sort -u >"$work/printed"
documented $page | comm -3 - "$work/printed" >"$work/differ"
cat "$work/bare"
[ ! -s "$work/bare" ] || fail "$page"
while read -r name; do fail "printed or in $page, but not both: $name"; done <"$work/differ"

sed '/^- \*\*E-DATA\*\*/d; s/^\(- \*\*E-EMPTY\*\*: .*\) \*.*$/\1/; s/^- \*\*W-BLAS\*\*/- **W-BLASS**/' $page >"$work/faulty.md"
documented "$work/faulty.md" | comm -3 - "$work/printed" | tr -d '\t' | tr '\n' ' ' >"$work/differ"
[ "$(cat "$work/differ")$(cat "$work/bare")" = 'E-DATA W-BLAS W-BLASS no cause or no cure: E-EMPTY**: t' ] ||
   fail "faults are not noticed: $(cat "$work/differ" "$work/bare")"
finish
