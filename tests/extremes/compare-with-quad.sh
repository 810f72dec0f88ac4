#!/bin/sh
# Solves the scenes of a list with atrito and in quadruple precision:
#    compare-with-quad.sh ATRITO SCENE_DECK QUAD_REFERENCE LIST [PATTERN]
#
# Prints a row a case: what was expected, what came, digits kept in p and t (of the largest), outer iterations and solves, exit code,
# verdict. Digits are those of the largest error, at most 16. Where atrito's solution is another one than the reference
# found, the exact solution next to it counts; the row says `other`. Works in ./compare. PATTERN: only these cases.
set -u
atrito=$1
scene_deck=$2
quad=$3
list=$4
pattern=${5:-.}
failures=0
mkdir -p compare
: >compare/counts

# digits A B: digits that the columns pressure and shear of two tables share, relative to the largest of B.
digits() {
   awk '
      function abs(x) { return x < 0 ? -x : x }
      function kept(worst, top) {
         if (worst == 0) return 16
         if (top == 0) return 0
         worst = int(-log(worst/top)/log(10)*10)/10
         return worst > 16 ? 16 : worst }
      FNR == 1 { file++ }
      /^# columns:/ { for (i = 3; i <= NF; i++) place[file, $i] = i - 2 }
      /^#/ { next }
      { p = $place[file, "pressure"]; t = $place[file, "shear"]
        if (p !~ /^[-+0-9.eE]+$/ || t !~ /^[-+0-9.eE]+$/) bad = 1 }
      file == 1 { n++; pa[n] = p + 0; ta[n] = t + 0 }
      file == 2 { m++; pb[m] = p + 0; tb[m] = t + 0; if (abs(p) > mp) mp = abs(p); if (abs(t) > mt) mt = abs(t) }
      END {
        # what is below 1e-14 of the largest pressure is written as 0
        for (i = 1; i <= m; i++) {
           if (abs(pb[i] - pa[i]) > ep) ep = abs(pb[i] - pa[i])
           if (abs(tb[i] - ta[i]) > et && (ta[i] != 0 || abs(tb[i]) > 1e-14*mp)) et = abs(tb[i] - ta[i])
        }
        if (bad || n != m || n == 0) print "- -"; else printf "%.1f %.1f\n", kept(ep, mp), kept(et, mt) }' "$1" "$2"
}

# most FILE: the largest pressure or shear.
most() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 } /^#/ { next }
      { for (k = 1; k <= 2; k++) { v = $place[k == 1 ? "pressure" : "shear"] + 0; if (v < 0) v = -v; if (v > top) top = v }; n++ }
      END { printf "%.3g\n", n ? top : 1e300 }' "$1"
}

at_least() { # at_least DIGITS P T
   awk -v d="$1" -v p="$2" -v t="$3" 'BEGIN { exit !(p != "-" && t != "-" && p >= d && t >= d) }' </dev/null
}

below() { # below A B
   awk -v a="$1" -v b="$2" 'BEGIN { exit !(a + 0 <= b + 0) }' </dev/null
}

printf '%-34s %-10s %5s %6s %6s %6s %7s  %s\n' '# case' expected exit p t outer solves verdict
grep '^case ' "$list" | grep -e "$pattern" >compare/chosen
while read -r _ name scene expected values; do
   grep "^scene $scene " "$list" | cut -d' ' -f3- | tr ' ' '\n' >compare/scene
   for value in $values; do echo "$value" >>compare/scene; done
   rm -rf compare/out compare/quad compare/next
   "$scene_deck" <compare/scene >compare/deck.inp || { echo "$name: no deck"; failures=$((failures + 1)); continue; }
   "$atrito" compare/deck.inp -o compare/out --digits 17 --quiet >compare/said 2>&1
   code=$?
   outer=-
   solves=-
   kept='- -'
   note=
   if [ -s compare/out/summary.tab ]; then
      outer=$(awk '$3 == "picard_iterations" { print $4 }' compare/out/summary.tab)
      solves=$(awk '$3 == "linear_solves" { print $4 }' compare/out/summary.tab)
   fi
   verdict=bad
   case $expected in
   exit*)
      [ "$code" -eq "${expected#exit}" ] && verdict=ok
      ;;
   open | none:*)
      limit=0
      [ "$expected" != open ] && limit=${expected#none:}
      if [ "$code" -eq 0 ]; then
         note=$(most compare/out/contact.tab)
         below "$note" "$limit" && verdict=ok
         note="largest $note"
      fi
      ;;
   *)
      wanted=$expected
      case $expected in law) wanted=10 ;; like:*) wanted=8 ;; told:*) wanted=${expected#told:} ;; esac
      if [ "$code" -eq 0 ]; then
         "$quad" compare/deck.inp >compare/quad 2>&1 && kept=$(digits compare/out/contact.tab compare/quad)
         # shellcheck disable=SC2086 # two words
         if ! at_least 2 $kept; then
            "$quad" compare/deck.inp compare/out/contact.tab >compare/next 2>&1 && kept=$(digits compare/out/contact.tab compare/next) &&
               note=other
         fi
         # shellcheck disable=SC2086
         if at_least "$wanted" $kept; then
            [ -z "$note" ] || [ "$expected" = law ] && verdict=ok
         fi
         case $expected in like:*)
            grep -q "^${expected#like:} $outer $solves$" compare/counts || { verdict=bad; note='other iteration counts'; } ;;
         told:*)
            grep -q 'W-DIGITS' compare/said || { verdict=bad; note='no warning'; } ;;
         esac
      elif [ "$code" -eq 3 ] && [ "$expected" = law ]; then
         verdict=ok
      fi
      ;;
   esac
   echo "$name $outer $solves" >>compare/counts
   [ "$verdict" = ok ] || failures=$((failures + 1))
   [ "$verdict" = ok ] || [ "$code" -eq 0 ] || note="$note $(grep -m 1 -e 'error' compare/said | cut -c 1-150)"
   # shellcheck disable=SC2086
   printf '%-34s %-10s %5s %6s %6s %6s %7s  %s\n' "$name" "$expected" "$code" $kept "$outer" "$solves" "$verdict $note"
done <compare/chosen
echo "# $(wc -l <compare/chosen) cases, $failures bad"
[ "$failures" -eq 0 ]
