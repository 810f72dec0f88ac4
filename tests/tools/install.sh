#!/bin/sh
# What `cmake --install` leaves in a folder: the program runs the decks beside it, the pages' links hold, the manual page is sound.
#    install.sh BUILD
. "$(dirname "$0")/lib.sh"
DESTDIR=$work/root cmake --install "$1" --prefix /usr >"$work/said" 2>&1 || fail "cmake --install: $(tail -n 3 "$work/said")"
usr=$work/root/usr
for file in bin/atrito share/atrito/input/lessons/arch.inp share/man/man1/atrito.1 share/bash-completion/completions/atrito \
   share/doc/atrito/LICENSE share/doc/atrito/CHANGELOG.md share/doc/atrito/docs/user/keywords.md bin/atrito-lab share/atrito/lab/atrito_lab/cli.py; do
   [ -s "$usr/$file" ] || fail "there is no $file"
done
strange=$(find "$work/root" -type f ! -path '*/bin/atrito' ! -path '*/bin/atrito-mpi' ! -path '*/bin/atrito-lab' ! -path '*/share/*')
[ -z "$strange" ] || fail "what is $strange"
"$usr/bin/atrito" "$usr/share/atrito/input/ex1-plate-on-support.inp" -o "$work/out" --quiet || fail 'the program does not run'
! command -v python3 >/dev/null 2>&1 || "$usr/bin/atrito-lab" check 03-hertz >"$work/said" 2>&1 || fail "atrito-lab: $(cat "$work/said")"

# Links between the installed pages; those into the sources of the program lead nowhere here.
for page in $(find "$usr/share/doc/atrito" -name '*.md'); do
   for link in $(grep -o '](\([^)#: ]*\)' "$page" | sed 's/](//' | grep '\.\(md\|png\|json\)$' | grep -v '/\(tests\|output\|src\|tools\|input\)/'); do
      [ -e "${page%/*}/$link" ] || fail "${page#"$usr"/}: there is no $link"
   done
done

page=$usr/share/man/man1/atrito.1
for word in '\-\-solver NAME' '\-V, \-\-version' '\*FRICTION' 'EXIT STATUS' NO_COLOR; do
   grep -q -F -- "$(printf '%s' "$word" | sed 's/\\\*/*/')" "$page" || fail "the manual page has no $word"
done
if command -v man >/dev/null 2>&1; then
   LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 "$page" >/dev/null 2>"$work/said" || fail 'man cannot read the page'
   [ ! -s "$work/said" ] || fail "man: $(cat "$work/said")"
fi
if command -v mandoc >/dev/null 2>&1; then
   mandoc -T lint -W warning "$page" | grep -v 'missing date' >"$work/said"
   [ ! -s "$work/said" ] || fail "mandoc: $(cat "$work/said")"
fi
finish
