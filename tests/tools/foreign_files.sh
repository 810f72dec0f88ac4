#!/bin/sh
# No run replaces or removes a file that it has read, or one that atrito did not write: exit 5, told before anything is computed.
#    foreign_files.sh ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9

# deck NAME INCLUDE [CARD ...]: a square, its nodes in another file
deck() {
   name=$1
   include=$2
   shift 2
   printf '%s\n' '*HEADING' 'a square' "*INCLUDE, INPUT=$include" '*ELEMENT, TYPE=CPE4, ELSET=B' '1, 1, 2, 3, 4' '*MATERIAL, NAME=M' \
      '*ELASTIC' '1000, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' '1, 1, 2' '2, 2' '*PARAMETER' 'q = 1' "$@" '*STEP' \
      '*STATIC' '*CLOAD' '3, 2, <q>' '*NODE PRINT' 'U, RF' '*EL PRINT' 'S' '*END STEP' >"$name"
}
nodes() { # nodes FILE
   printf '*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n' >"$1"
}
# refused WHAT FILE COMMAND ...: exit 5, the file is named and as it was, and nothing was computed
refused() {
   what=$1
   file=$2
   shift 2
   cp -P "$file" as-it-was
   timeout 60 "$@" >said 2>&1
   code=$?
   [ $code -eq 5 ] || { fail "$what: exit $code, expected 5"; cat said; }
   grep -q 'E-FILE' said && grep -qF "${file##*/}" said || { fail "$what: not told"; cat said; }
   grep -q '^solve' said && fail "$what: told after the work"
   if [ -h as-it-was ]; then
      [ "$(readlink "$file")" = "$(readlink as-it-was)" ] || fail "$what: $file is another link"
   else
      cmp -s "$file" as-it-was || fail "$what: $file is not as it was"
   fi
   rm -f as-it-was
}

# --- files that the run reads, whatever they are called, and by whatever name --------------------------------------------------------
mkdir -p in/deeper
cd in || exit 9
for name in nodes.csv stress.tab joints.tab a.h5 a.xdmf a.lst a.run.inp a.run.msh report.html summary.tab.part nodes.tab.old.part; do
   nodes $name
   deck a.inp $name
   refused "an include $name" $name "$atrito" a.inp -o deeper/..
   rm $name
done
nodes n.inc
for name in stress.tab timing.csv iterations.tab; do
   deck $name n.inc
   refused "a deck $name" $name "$atrito" $name -o .
   rm $name
done
# hard links: another name of the same file, which even says that atrito wrote it
deck a.inp n.inc
"$atrito" a.inp -o out --quiet || fail "the deck itself fails: exit $?"
cp out/a.run.inp again.inp
ln again.inp out/again.run.inp
refused 'a deck that is a table of the run by another name' out/again.run.inp "$atrito" again.inp -o out
rm -rf out again.inp
cd ..

# --- files that atrito did not write --------------------------------------------------------------------------------------------------
nodes n.inc
deck a.inp n.inc
tables='contact summary extremes resultants history nodes reactions stress nodal_stress bodies rigid joints sections ties equations
        springs iterations timing'
form=csv
for name in $tables; do
   [ $form = csv ] && form=tab || form=csv
   rm -rf out
   mkdir out
   printf 'step,node,load\r\n1,2,3\r\n' >out/$name.$form
   refused "a $name.$form of the user" out/$name.$form "$atrito" a.inp -o out
   [ "$(ls -A out)" = $name.$form ] || fail "a $name.$form of the user: something was written beside it"
done
for name in a.lst a.h5 a.xdmf a.run.inp a.run.msh report.html stress.tab.part stress.tab.old.part; do
   rm -rf out
   mkdir out
   echo mine >out/$name
   refused "a $name of the user" out/$name "$atrito" a.inp -o out
done
for name in mesh.gp mesh.dat mesh.png contour-s11.bin motion.gif contact-1.png gnuplot.log; do
   rm -rf out
   mkdir -p out/plots
   echo mine >out/plots/$name
   refused "a plots/$name of the user" out/plots/$name "$atrito" a.inp -o out --plot
done
# pictures are an extra: a warning where the run does not know beforehand that it would draw them
rm -rf out
mkdir -p out/plots
echo mine | tee out/plots/scene.png >out/plots/sets.dat
"$atrito" check a.inp --plot -o out >said 2>&1 || fail "check --plot: exit $?"
grep -q 'W-PLOT.*was not written by atrito' said || { fail 'check --plot: not told'; cat said; }
[ "$(cat out/plots/scene.png out/plots/sets.dat)" = 'mine
mine' ] || fail 'check --plot: pictures of the user are gone'
rm -rf out
mkdir out
echo mine >out/.atrito.lock
"$atrito" a.inp -o out --quiet || fail "a file of the user in the place of the lock: exit $?"
[ "$(cat out/.atrito.lock)" = mine ] || fail 'a file of the user in the place of the lock is gone'
for target in elsewhere nowhere; do
   rm -rf out
   mkdir out
   echo mine >elsewhere
   ln -s ../$target out/nodes.tab
   refused "a link to $target" out/nodes.tab "$atrito" a.inp -o out
   rm out/nodes.tab
   ln -s ../$target out/nodes.tab.part
   refused "a link to $target, with a temporary name" out/nodes.tab.part "$atrito" a.inp -o out
   [ "$(cat elsewhere)" = mine ] && [ ! -e nowhere ] || fail "a link to $target: it was followed"
done
for name in sweep.tab runs.csv sweep.journal report.html; do
   rm -rf out
   mkdir out
   echo mine >out/$name
   refused "a $name of the user, --resume" out/$name "$atrito" sweep a.inp --vary q=1,2 -o out --resume
done
rm -rf out
mkdir out
ln -s ../elsewhere out/sweep.journal
refused 'a journal that is a link' out/sweep.journal "$atrito" sweep a.inp --vary q=1,2 -o out --resume
for name in study.tab study.csv; do
   rm -rf out
   mkdir out
   echo mine >out/$name
   refused "a $name of the user" out/$name "$atrito" study a.inp --levels 2 -o out
done

# --- what atrito wrote is replaced and removed, in all forms and between them -----------------------------------------------------
rm -rf out
echo mine >user.txt
for run in '--format csv' '--report' ''; do
   for i in 1 2; do
      "$atrito" a.inp -o out $run >said 2>&1 || { fail "again with '$run': exit $?"; cat said; }
      cp user.txt out/mine.tab.user
      echo mine >out/video.part                         # no table's
   done
done
[ -e out/nodes.csv ] || [ -e out/report.html ] || [ -e out/plots ] && fail 'files of earlier runs are left'
[ "$(cat out/video.part out/mine.tab.user)" = 'mine
mine' ] || fail 'files of the user are gone'
"$atrito" out/a.run.inp -o out --quiet && "$atrito" out/a.run.inp -o out --quiet || fail "the deck as it was run: exit $?"
[ "$(grep -c '^\*\* atrito ' out/a.run.run.inp)" -eq 1 ] || fail 'the mark of the deck as it was run is not there once'
# names that the system does not take, told before the work
for n in 243 251; do
   name=$(printf "%0${n}d" 0)
   cp a.inp $name.inp 2>/dev/null || continue
   rm -rf out
   "$atrito" $name.inp -o out >said 2>&1
   code=$?
   [ $code -eq 5 ] && grep -q 'E-FILE.*the name is too long' said || { fail "a deck with a name of $n letters: exit $code"; cat said; }
   grep -q '^solve' said && fail "a deck with a name of $n letters: told after the work"
   [ ! -e out ] || fail "a deck with a name of $n letters: a folder is left"
   rm $name.inp
done
# a deck as run without a mark, of an older atrito, is known by its digest in the listing; one line more, and it is somebody else's
rm -rf out
"$atrito" a.inp -o out --quiet || fail "a deck: exit $?"
sed -i 1d out/a.run.inp
"$atrito" a.inp -o out --quiet >said 2>&1 || { fail "over a deck as run without a mark: exit $?"; cat said; }
sed -i 1d out/a.run.inp
echo '** mine' >>out/a.run.inp
refused 'a deck as run without a mark that was changed' out/a.run.inp "$atrito" a.inp -o out
sed -i '$d' out/a.run.inp
rm out/a.lst
refused 'a deck as run without a mark and without a listing' out/a.run.inp "$atrito" a.inp -o out
for run in 'sweep a.inp --vary q=1,2' 'study a.inp --levels 2' 'sweep a.inp --vary q=1,2 --resume'; do
   for form in tab csv tab; do
      "$atrito" $run -o "out-${run%% *}" --format $form --plot --quiet >said 2>&1 || { fail "again: $run, $form: exit $?"; cat said; }
   done
done

finish
