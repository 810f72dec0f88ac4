#!/bin/sh
# Files get their names by plain renaming, whatever the file system: all of a run, or none. Every single renaming is made to fail, and
# the program is killed at every one (by strace, where it is there and may).
#    renaming.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2
cd "$work" || exit 9

# no hard links, which some file systems have not
if command -v nm >/dev/null; then
   nm -D "$atrito" | grep -Eqw 'rename' || fail 'nm does not show what the program calls'
   nm -D "$atrito" | grep -Ew 'link|linkat' && fail 'the program makes hard links'
fi

"$atrito" "$deck" --quiet --set nu=0.1 -o old || fail "the deck itself fails"
rm old/timing.tab                                   # times may be the same by chance
cp -r old out
"$atrito" "$deck" --quiet --set nu=0.4 -o out || fail "the second run fails: exit $?"
for file in old/*; do
   cmp -s "$file" "out/${file##*/}" && fail "${file##*/} is the same in both runs"
done
find out -name '*.part' | grep . && fail 'a temporary file is left'
echo mine >old/stress.tab.old                       # of the user
cp old/summary.tab old/bodies.tab                    # a table that the second run does not write

calls=rename,renameat,renameat2
traced() { # traced WHAT: the second run with something done to one renaming
   rm -rf out
   cp -r old out
   strace -f -o calls -e trace=$calls -e "inject=$calls:$1" "$atrito" "$deck" --quiet --set nu=0.4 -o out >said 2>&1
   code=$?
}
if ! { command -v strace && strace -f -o calls -e "inject=$calls:error=EIO:when=1" true; } >/dev/null 2>&1; then
   echo 'not tested: renamings that fail, and a process killed among them (no strace)'
   finish
fi

is_new() { # is_new: all tables of the second run are there, and no others
   for file in old/*; do
      case $file in
         old/bodies.tab) [ ! -e out/bodies.tab ] || return 1 ;;
         old/stress.tab.old) ;;
         *) [ -f "out/${file##*/}" ] && ! cmp -s "$file" "out/${file##*/}" || return 1 ;;
      esac
   done
}

no_mixture() { # no_mixture: no new file beside a former one
   formers=0
   news=0
   for file in old/*.lst old/*.tab; do
      there=out/${file##*/}
      [ -e "$there" ] || continue
      if cmp -s "$file" "$there"; then formers=$((formers + 1)); else news=$((news + 1)); fi
   done
   [ $formers -eq 0 ] || [ $news -eq 0 ]
}

comes_back() { # comes_back: a run of another deck has cleared up what a killed one left, and holds nothing of it but its listing
   "$atrito" other.inp --quiet -o out || return 1
   for file in out/*; do
      case $file in
         out/plots | out/stress.tab.old) ;;
         out/other.*) ;;
         *.lst | *.run.inp) ;;                          # of the former run, or of the new one: they have names of their own
         *) grep -q '^# deck: other.inp' "$file" || return 1 ;;
      esac
   done
   for file in old/*.lst old/*.run.inp; do
      [ -f "out/${file##*/}" ] || return 1
   done
}

all_formers() { # all_formers: each former file is whole, under its name or its second one
   for file in old/*; do
      there=out/${file##*/}
      cmp -s "$file" "$there" || cmp -s "$file" "$there.old.part" || return 1
   done
}

cp "$deck" other.inp
traced error=EIO:when=60000
[ $code -eq 0 ] && is_new || fail "undisturbed: exit $code"
n=$(grep -c 'rename' calls)
[ "$n" -ge 12 ] || fail "only $n renamings were seen"
i=0
failed=0
while [ $i -lt "$n" ]; do
   i=$((i + 1))
   traced "error=EIO:when=$i"
   if [ $code -eq 5 ]; then
      failed=$((failed + 1))
      diff -r old out || fail "renaming $i fails: the older results were changed"
      grep -q E-FILE said || fail "renaming $i fails: not told"
   else # there was no former file
      [ $code -eq 0 ] && is_new || fail "renaming $i fails: exit $code, and not all tables are new"
   fi
   traced "signal=KILL:when=$i"
   [ $code -eq 137 ] || fail "killed at renaming $i: exit $code"
   no_mixture || fail "killed at renaming $i: a mixture of old and new tables"
   all_formers || fail "killed at renaming $i: a former file is lost"
   cp -r out killed
   "$atrito" "$deck" --quiet --set nu=0.4 -o out && is_new || fail "killed at renaming $i: the next run fails"
   find out -name '*.part' | grep . && fail "killed at renaming $i: the next run leaves temporary files"
   rm -rf out
   mv killed out
   comes_back || { fail "killed at renaming $i: not cleared up by another deck"; ls out; }
   find out -name '*.part' | grep . && fail "killed at renaming $i: another deck leaves temporary files"
done
[ $failed -ge 10 ] || fail "only $failed of $n renamings mattered"
row "one of $n renamings fails, or the process is killed there" 'all files or none' "$([ "$failures" -eq 0 ] && echo 'all files or none' || echo failed)"
finish
