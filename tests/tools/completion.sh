#!/bin/bash
# Completion yields the words of the tables in bash, and in zsh and fish where they are installed.
#    completion.sh ATRITO
# shellcheck disable=SC2016
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9
mkdir decks
: >plate.inp
: >plate.txt
: >decks/arch.inp
for shell in bash zsh fish; do
   "$atrito" help $shell >"atrito.$shell" || fail "help $shell: exit $?"
done
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
yields '--set --share --solver' plate.inp --s
yields '--quiet' check --q
yields '--quiet' compare --q
yields '--plot --plot-box' check --plot
yields '' check --dig
yields '--version' -V --ver
yields 'auto banded mumps skyline sparse' --solver ''
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
   for shell in bash zsh fish; do
      case $shell in
         fish) grep -q -- " -[ls] ${name##*-}\( \|$\)" atrito.fish || grep -q -- " -l ${name#--}\( \|$\)" atrito.fish ;;
         *) grep -q -- "$name\b" "atrito.$shell" ;;
      esac || fail "$shell: no $name"
   done
done

if command -v zsh >/dev/null 2>&1; then
   zsh -n atrito.zsh || fail 'zsh cannot read it'
fi
if command -v fish >/dev/null 2>&1; then
   # fish_yields WORDS LINE
   fish_yields() {
      came=$(fish --no-config -c "source atrito.fish; complete -C '$2'" | sed 's/\t.*//' | sort | tr '\n' ' ')
      came=${came% }
      [ "$came" = "$1" ] || fail "fish, $2: '$came' in place of '$1'"
   }
   fish_yields 'check' 'atrito ch'
   fish_yields '--set --solver' 'atrito check --s'
   fish_yields 'skyline sparse' 'atrito plate.inp --solver s'
   fish_yields 'CONTACT PAIR' 'atrito help "CONTACT PA'
   fish_yields 'decks/ plate.inp' 'atrito check '
fi
finish
