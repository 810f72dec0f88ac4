#!/bin/sh
# What names and texts of a user cannot do: speak to the terminal, become a formula, be written into through a link, open another file.
#    injection.sh ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9

nodes='*NODE
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1'
deck() { # deck FILE HEADING SET
   printf '%s\n' '*HEADING' "$2" "$nodes" '*ELEMENT, TYPE=CPE4, ELSET=B' '1, 1, 2, 3, 4' "*NSET, NSET=\"$3\"" '3, 4' '*MATERIAL, NAME=M' \
      '*ELASTIC' '1000, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' '1, 1, 2' '2, 2' '*PARAMETER' 'q = 1' '*STEP' '*STATIC' \
      '*CLOAD' "\"$3\", 2, <q>" '*NODE PRINT' 'U, RF' '*END STEP' >"$1"
}
# quiet_text WHAT FILE: no control character, of one byte or two, and no mark that turns the direction
quiet_text() {
   LC_ALL=C tr -d '\n' <"$2" | LC_ALL=C grep -q "[$(printf '\001')-$(printf '\037')$(printf '\177')]" && fail "$1: a control character"
   LC_ALL=C grep -q "$(printf '\302')[$(printf '\200')-$(printf '\237')]" "$2" && fail "$1: a control character of two bytes"
   LC_ALL=C grep -q "$(printf '\342\200\256')" "$2" && fail "$1: a mark of direction"
   LC_ALL=C grep -q "X$(printf '\233')" "$2" && fail "$1: a control character of eight bits"
}
escape=$(printf '\033]0;title\007')
code_1=$(printf '\302\2332J')
bare=$(printf 'X\2332J')
turned=$(printf '\342\200\256')

# --- file names: of decks, includes, folders -----------------------------------------------------------------------------------------
for sign in "$escape" "$code_1" "$bare" "$turned" "$(printf 'a\rb')" "$(printf 'a\nb')"; do
   name="d${sign}.inp"
   deck "$name" 'a square' TOP
   "$atrito" "$name" -o out >said 2>&1 || { fail "a name with a sign: exit $?"; cat -v said; }
   quiet_text 'the screen' said
   quiet_text 'a table' out/nodes.tab
   cat out/*.lst >listing
   quiet_text 'the listing' listing
   grep -qv '^#\|^ \|^[0-9]' out/nodes.tab && fail 'a table: the name makes a line of its own'
   rm -rf out
   "$atrito" check "$name" >said 2>&1
   quiet_text 'check' said
   "$atrito" "none$name" >said 2>&1
   quiet_text 'a file that is not there' said
   printf '*INCLUDE, INPUT="none%s"\n' "$(printf %s "$code_1$turned")" >i.inp
   "$atrito" i.inp >said 2>&1
   quiet_text 'an include' said
   "$atrito" "$name" -o "o$sign" >said 2>&1
   quiet_text 'a folder' said
   "$atrito" "$name" -o "o$sign" --nonsense"$sign" >said 2>&1
   quiet_text 'an option' said
   "$atrito" help "$sign" >said 2>&1
   quiet_text 'a keyword' said
   "$atrito" compare "$name" "o$sign" >said 2>&1
   quiet_text 'compare' said
   "$atrito" "none$name" --messages json >said 2>&1
   quiet_text 'JSON' said
   rm -rf "$name" "o$sign"
done
deck a.inp "he$code_1$bare$turned" "T$code_1"
"$atrito" a.inp -o out >said 2>&1 || { fail "signs in heading and names: exit $?"; cat -v said; }
cat said out/*.tab out/*.lst >all
quiet_text 'signs in heading and names' all
# letters stay
deck a.inp 'Träger, Fuß' TOP
"$atrito" a.inp -o out --quiet
grep -q '^# heading: Träger, Fuß' out/nodes.tab || fail 'letters of two bytes are changed'

# --- formulas in comma-separated values ---------------------------------------------------------------------------------------------
for name in '=1+1' '+CMD' '-A' '@SUM(A1)' '=A,B' '＝1+1'; do
   deck a.inp 'a square' "$name"
   "$atrito" a.inp -o out --format csv --quiet >said 2>&1 || { fail "a set $name: exit $?"; cat said; continue; }
   LC_ALL=C grep -E '(^|,)"?([=@]|＝|[+-][A-Za-z(])' out/*.csv && fail "a set $name: a formula"
   grep -qF "'$name" out/resultants.csv || { fail "a set $name: it is not there"; cat out/resultants.csv; }
   "$atrito" a.inp -o tab --quiet
   "$atrito" compare tab out >said || { fail "a set $name: the two forms differ"; cat said; }
done
grep -q "'-[0-9]" out/*.csv && fail 'a number has an apostrophe'
"$atrito" a.inp -o out --format csv --quiet --observe '=x=u2(3)' >said 2>&1

# --- links in the place of what is written ------------------------------------------------------------------------------------------
deck a.inp 'a square' TOP
echo mine >victim
for name in nodes.tab.part a.lst.part timing.tab.part a.run.inp.part .atrito.lock; do
   rm -rf out
   mkdir out
   ln -s ../victim out/$name
   "$atrito" a.inp -o out --quiet >said 2>&1
   [ "$(cat victim)" = mine ] || fail "a link $name: it was followed"
done
"$atrito" sweep a.inp --vary q=1,2 -o sweep --quiet || fail "a sweep: exit $?"
ln -sf ../victim sweep/sweep.journal
"$atrito" sweep a.inp --vary q=1,2,3 -o sweep --quiet --resume >said 2>&1
[ "$(cat victim)" = mine ] || fail 'a journal that is a link: it was followed'
if command -v gnuplot >/dev/null; then
   for name in mesh.png gnuplot.log mesh.gp; do
      rm -rf out
      mkdir -p out/plots
      ln -s ../../victim out/plots/$name
      "$atrito" a.inp -o out --plot --quiet >said 2>&1
      "$atrito" check a.inp -o out --plot --quiet >said 2>&1
      [ "$(cat victim)" = mine ] || fail "a link plots/$name: it was followed"
   done
fi

# --- names with blanks at the end -----------------------------------------------------------------------------------------------------
deck 'b.inp ' 'with a blank' TOP
deck 'b.inp' 'without a blank' TOP
"$atrito" 'b.inp ' -o out2 --quiet || fail "a deck with a blank: exit $?"
grep -q 'heading: with a blank' out2/nodes.tab || fail 'a deck with a blank: another file was read'
rm 'b.inp '
"$atrito" 'b.inp ' -o out3 --quiet >said 2>&1
[ $? -eq 5 ] || fail 'a deck with a blank that is not there: another file was read'
deck c.inp 'a square' TOP
sed -i.bak 's/^\*NODE$/*INCLUDE, INPUT="n.inc "/; /^[1-4], [01], [01]$/d' c.inp
echo "$nodes" >n.inc
"$atrito" c.inp -o out3 --quiet >said 2>&1
[ $? -eq 2 ] || { fail 'an include with a blank in quotes: another file was read'; cat said; }
mv n.inc 'n.inc '
"$atrito" c.inp -o out3 --quiet || fail "an include with a blank in quotes: exit $?"
"$atrito" b.inp -o 'out4 ' --quiet && [ -f 'out4 /nodes.tab' ] && [ ! -e out4 ] || fail 'a folder with a blank'
"$atrito" compare 'out4 ' 'out4 ' >said || fail 'compare: a folder with a blank'
"$atrito" compare 'out4' 'out4' >said 2>&1 && fail 'compare: a folder without its blank'
if "$atrito" --version | grep -q 'HDF5: [^n]'; then
   sed 's/^\*STATIC/*STATIC/; s/^\*NODE PRINT/*RESTART, WRITE\n&/' b.inp >r.inp
   "$atrito" r.inp -o r --quiet && cp r/r.restart.h5 'x.h5'
   "$atrito" r.inp -o r2 --quiet --restart 'x.h5 ' >said 2>&1
   [ $? -eq 5 ] || { fail 'a restart file with a blank: another file was read'; cat said; }
fi

finish
