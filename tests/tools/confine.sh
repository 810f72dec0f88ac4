#!/bin/sh
# Decks that are not trusted: what is no plain file is not read, and with --confine nothing outside of a folder.
#    confine.sh ATRITO
. "$(dirname "$0")/lib.sh"
atrito=$1
cd "$work" || exit 9

mkdir -p hand/sub others
printf '*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n' >hand/sub/nodes.inc
printf '*NODE\n** SECRET\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\nSECRET\n' >others/secret.inc
deck() { # deck INCLUDE
   printf '%s\n' '*HEADING' 'a square' "*INCLUDE, INPUT=$1" '*ELEMENT, TYPE=CPE4, ELSET=B' '1, 1, 2, 3, 4' '*MATERIAL, NAME=M' \
      '*ELASTIC' '1000, 0.3' '*SOLID SECTION, ELSET=B, MATERIAL=M' '*BOUNDARY' '1, 1, 2' '2, 2' '*STEP' '*STATIC' '*CLOAD' \
      '3, 2, 1' '*NODE PRINT' 'U, RF' '*END STEP' >hand/a.inp
}
# expect CODE WHAT [ARGUMENT ...]
expect() {
   wanted=$1
   what=$2
   shift 2
   (ulimit -v 2000000 && timeout 20 "$atrito" "$@" --quiet) >said 2>&1 </dev/null
   code=$?
   row "$what" "exit $wanted" "exit $code"
   [ $code -eq "$wanted" ] || { fail "$what: exit $code, expected $wanted"; cat said; }
   grep -q SECRET said && fail "$what: it is shown"
}

# --- no plain files, as decks and as includes; none hangs -------------------------------------------------------------------------
mkfifo pipe 2>/dev/null
ln -s /dev/stdin stdin
ln -s stdin stdin-2
ln -s /proc/self proc
for file in /dev/stdin /dev/null /dev/zero /dev/random /dev/tty /dev/fd/0 /proc/self/environ /proc/cpuinfo /proc/self/fd/0 /sys/kernel/notes \
            stdin stdin-2 proc/environ pipe; do
   if [ $file = pipe ] || [ $file = /dev/tty ] || [ -e $file ]; then
      expect 5 "deck $file" $file -o out
      case $file in /*) deck $file ;; *) deck ../$file ;; esac
      expect 5 "include of $file" hand/a.inp -o out
      grep -q 'hand/a.inp, line 3' said || fail "include of $file: its place is not told"
      expect 5 "check of an include of $file" check hand/a.inp
   fi
done
[ ! -e out ] || fail 'a folder was made'
deck sub/nodes.inc
timeout 20 "$atrito" /dev/stdin -o out --quiet <hand/a.inp >said 2>&1
[ $? -eq 5 ] || fail '/dev/stdin from a file: not exit 5'

# --- inside ---------------------------------------------------------------------------------------------------------------------------
expect 0 'a deck within its folder' hand/a.inp --confine hand -o out
expect 0 'a deck within its folder, output where it is by itself' hand/a.inp --confine ./hand/
expect 0 'a folder above' hand/a.inp --confine . -o out
expect 0 'check' check hand/a.inp --confine hand
ln -s sub/nodes.inc hand/inside.inc
for name in inside.inc sub/../sub/nodes.inc "$work/hand/sub/nodes.inc"; do
   deck "$name"
   expect 0 "include of $name" hand/a.inp --confine hand -o out
done
deck sub/none.inc
expect 2 'a file that is not there' hand/a.inp --confine hand -o out
grep -q 'no such file' said || fail 'a file that is not there: not told'

# --- outside, by name, by links, and whether or not there is such a file: all are told alike ---------------------------------------------
ln -s ../others/secret.inc hand/link.inc
ln -s link.inc hand/link-2.inc
ln -s ../others/none.inc hand/dangling.inc
ln -s ../others hand/folder
ln -s / hand/root
for name in ../others/secret.inc ../others/none.inc ../none/none.inc /etc/passwd /etc/none link.inc link-2.inc dangling.inc folder/secret.inc \
            folder/none.inc root/etc/passwd root/none sub/../../others/secret.inc "$work/others/secret.inc" ../hand-2; do
   deck "$name"
   expect 5 "include of $name" hand/a.inp --confine hand -o out
   grep -q 'is outside of the folder of --confine$' said || { fail "include of $name: not told so"; cat said; }
   expect 5 "check of an include of $name" check hand/a.inp --confine hand
   expect 5 "a sweep of an include of $name" sweep hand/a.inp --vary q=1 --confine hand -o sweep
   printf '%s\n' "*INCLUDE, INPUT=$name, TYPE=GMSH" >hand/a.inp
   expect 5 "a mesh $name" hand/a.inp --confine hand -o out
done
deck sub/nodes.inc
cp hand/a.inp deck.inp
expect 5 'a deck outside' deck.inp --confine hand -o out
expect 5 'a folder that is not there' hand/a.inp --confine none -o out
expect 5 'a restart file outside' hand/a.inp --confine hand -o out --restart others/secret.inc

# --- nothing is written outside of the output --------------------------------------------------------------------------------------
rm -rf output out
mkdir target
ln -s "$work/target" output
expect 5 'a link in the place of output' hand/a.inp --confine hand
grep -q 'factor' said && fail 'a link in the place of output: told after the work'
mkdir out
ln -s ../target out/plots
"$atrito" hand/a.inp --confine hand -o out --plot >said 2>&1
[ -z "$(ls -A target)" ] || { fail 'files outside of the output'; ls -A target; }

finish
