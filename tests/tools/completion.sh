#!/bin/bash
# Completion yields the words of the tables in bash.
#    completion.sh ATRITO
# shellcheck disable=SC2016
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9
mkdir decks
: >plate.inp
: >plate.txt
: >decks/arch.inp
"$atrito" help bash >atrito.bash || fail "help bash: exit $?"
# shellcheck source=/dev/null
. ./atrito.bash

# yields WORDS LINE...: the words that stand for the last one of a line
yields() {
   expected=$1
   shift
   COMP_WORDS=(atrito "$@")
   COMP_CWORD=$#
   _atrito
   came=$(printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' ')
   came=${came% }
   [ "$came" = "$expected" ] || fail "atrito $*: '$came' in place of '$expected'"
}

yields 'check' ch
yields 'check compare decks help limit plate.inp study sweep' ''
yields 'decks plate.inp' check ''
yields 'decks/arch.inp' sweep decks/
yields '--set --share --show --solver' plate.inp --s
yields '--quiet' check --q
yields '--quiet' compare --q
yields '--plot --plot-box --plot-labels' check --plot
yields '' check --dig
yields '--version' -V --ver
yields 'auto banded skyline sparse' --solver ''
yields 'skyline sparse' plate.inp --solver = s
yields 'json text' check plate.inp --messages = =
yields 'decks' plate.inp -o ''
yields '' plate.inp --threads ''
yields 'decks plate.inp' -o check check ''
yields 'PAIR PRINT PROPERTY' help contact p
yields 'BLOCK BODY BOUNDARY bash' help b
yields 'plate.inp plate.txt' compare plate
[ "$(complete -p atrito)" = 'complete -F _atrito atrito' ] || fail 'bash does not know whom to ask'

# Every option of --help can be completed, of some command.
for name in $("$atrito" --help | sed -n 's/^  \(-[a-zA-Z], \)\{0,1\}\(--*[a-z-]*\) .*/\2/p'); do
   grep -q -- "$name\b" atrito.bash || fail "bash: no $name"
done
finish
