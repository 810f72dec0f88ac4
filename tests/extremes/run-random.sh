#!/bin/sh
# Runs random decks and checks what atrito answers: run-random.sh ATRITO RANDOM_DECKS FIRST LAST SEED MOST_FAILURES [options of atrito]
#
# Right is exit 0 with a contact law that holds (check-law.awk). Exit 3 is allowed MOST_FAILURES times, anything else never.
# Prints the decks that are not solved and the sums. Works in ./random.
set -u
atrito=$1
generator=$2
first=$3
last=$4
seed=$5
most=$6
shift 6
here=$(CDPATH="" cd -- "$(dirname -- "$0")" && pwd)
mkdir -p random
solved=0
given_up=0
wrong=0
k=$first
: >random/failures
: >random/iterations
while [ "$k" -le "$last" ]; do
   rm -rf random/out
   "$generator" "$k" "$seed" >random/deck.inp || exit 2
   "$atrito" random/deck.inp -o random/out --digits 17 --quiet "$@" >random/said 2>&1
   code=$?
   case $code in
   0)
      if said=$(awk -f "$here/check-law.awk" random/deck.inp random/out/contact.tab random/out/nodes.tab); then
         solved=$((solved + 1))
      else
         wrong=$((wrong + 1))
         echo "deck $k: exit 0, $said"
         echo "$k" >>random/failures
      fi
      awk -v k="$k" '$3 == "picard_iterations" { o = $4 } $3 == "linear_solves" { print k, o, $4 }' random/out/summary.tab >>random/iterations
      ;;
   3)
      given_up=$((given_up + 1))
      echo "deck $k: exit 3: $(grep -i -m 1 -e 'converge' -e 'law' -e settle -e cycle -e equilib random/said)"
      echo "$k" >>random/failures
      ;;
   *)
      wrong=$((wrong + 1))
      echo "deck $k: exit $code: $(tail -n 2 random/said)"
      echo "$k" >>random/failures
      ;;
   esac
   k=$((k + 1))
done
awk -v s="$solved" -v g="$given_up" -v w="$wrong" -v most="$most" '
   { outer += $2; solves += $3; n++; if ($2 > mo) mo = $2; if ($3 > ms) ms = $3 }
   END { printf "%d solved, %d not converged (exit 3; %d allowed), %d wrong; outer iterations mean %.2f max %d, solves mean %.2f max %d\n", \
      s, g, most, w, n ? outer/n : 0, mo, n ? solves/n : 0, ms }' random/iterations
[ "$wrong" -eq 0 ] && [ "$given_up" -le "$most" ]
