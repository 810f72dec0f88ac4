#!/bin/sh
# The word of a message's severity has a colour on a terminal, and nowhere else: not with NO_COLOR, on a dumb one, in a pipe, as JSON.
#    colours.sh ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$1
escape=$(printf '\033')
printf '*NODES\n' >"$work/bad.inp"
unset NO_COLOR
TERM=xterm
export TERM

# at_terminal ARGUMENT...: what a run prints there into said; its carriage returns are dropped
at_terminal() {
   script -q -e -c "\"$atrito\" $*" /dev/null </dev/null 2>&1 | tr -d '\r' >"$work/said"
   grep -q 'E-KEYWORD' "$work/said" || fail "$*: no message"
}

has_colour() {
   grep -q "$escape\[" "$work/said"
}

at_terminal check "$work/bad.inp"
red="^$work/bad.inp:1:2: $escape\[1;31merror$escape\[0m \[E-KEYWORD\] "
grep -q "$red" "$work/said" || fail "no red error at a terminal: $(cat "$work/said")"
at_terminal check "$work/bad.inp" --messages json
has_colour && fail 'JSON has colours'
NO_COLOR=1
export NO_COLOR
at_terminal check "$work/bad.inp"
has_colour && fail 'colours in spite of NO_COLOR'
NO_COLOR=
at_terminal check "$work/bad.inp"
has_colour || fail 'no colours with an empty NO_COLOR'
unset NO_COLOR
TERM=dumb
at_terminal check "$work/bad.inp"
has_colour && fail 'colours on a dumb terminal'
unset TERM
at_terminal check "$work/bad.inp"
has_colour && fail 'colours without TERM'
TERM=xterm
export TERM
"$atrito" check "$work/bad.inp" 2>"$work/said"
has_colour && fail 'colours in a file'
"$atrito" check "$work/bad.inp" 2>&1 | cat >"$work/said"
has_colour && fail 'colours in a pipe'
finish
