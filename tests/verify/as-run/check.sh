#!/bin/sh
# The deck as run gives the tables of the deck, and needs no other file.
. "$(dirname "$0")/../lib.sh"
# digest FOLDER: of the deck, in the head of a table
digest() {
   sed -n 's/^# digest: //p' "$1/summary.tab"
}
# again DECK FOLDER [options]: runs a deck, then what the run has written of it, alone in a folder.
again() {
   deck=$1
   folder=$2
   shift 2
   rm -rf alone second
   run 0 "$deck" "$folder" --quiet "$@"
   mkdir alone
   cp "$folder"/*.run* alone
   name=$(basename "$deck" .inp)
   (cd alone && "$atrito" "$name.run.inp" -o ../second --quiet 2>../second.err) || { complain "$deck: its deck as run fails"; cat second.err; }
   "$atrito" compare "$folder" second --rtol 0 >compare.out 2>&1 || { complain "$deck $*: other tables"; cat compare.out; }
   [ -n "$(digest "$folder")" ] && [ "$(digest "$folder")" = "$(digest second)" ] || complain "$deck $*: another digest"
   # but for the name of a mesh
   sed 's/\.run\.run\.msh/.run.msh/' "second/$name.run.run.inp" >second.inp
   cmp "alone/$name.run.inp" second.inp || complain "$deck $*: the deck as run of the deck as run is another one"
}

# parameters, with and without --set
again "$input/ex1-plate-on-support.inp" plain
grep -v '^\*\*' plain/ex1-plate-on-support.run.inp | grep -q '[<>]\|PARAMETER' && complain 'plain: parameters are left'
says 'values in comments' plain/ex1-plate-on-support.run.inp '** eps = 4e-4'
head -n 1 plain/ex1-plate-on-support.run.inp | grep -q '^\*\* atrito .* ran this$' || complain 'plain: no word of who wrote it'
[ "$(wc -l <plain/ex1-plate-on-support.run.inp)" -eq $(($(wc -l <"$input/ex1-plate-on-support.inp") + 1)) ] || complain 'plain: other lines'
again "$input/ex1-plate-on-support.inp" set --set q=2 --set nu=0.1*3
says 'a value that was set' set/ex1-plate-on-support.run.inp '0.30000000000000004, 8e-4, 0.1'
says 'the head' set/contact.tab '# parameters: q = 2 (--set), nu = 0.30000000000000004 (--set), eps = 8e-4, rho = 0.1, delta = 1e-6'
[ "$(digest plain)" != "$(digest set)" ] || complain 'a value does not change the digest'
run 0 "$input/ex1-plate-on-support.inp" refined --quiet --refine 1 --digits 17
[ "$(digest plain)" = "$(digest refined)" ] || complain 'an option changes the digest'
says 'options' refined/contact.tab '# options: --refine 1 --digits 17'
says 'options in the listing' refined/ex1-plate-on-support.lst 'options  --refine 1 --digits 17'
says 'the name in the listing' plain/ex1-plate-on-support.lst "as run  ex1-plate-on-support.run.inp, digest $(digest plain)"

# includes: in the midst of data, of other folders, CR LF, a byte order mark, no end of the last line, one file twice
mkdir -p parts/deep
printf '\357\273\277*INCLUDE, INPUT=parts/values.inp\n*NODE, NSET=ALL\n1, 0., 0.\n*INCLUDE,\n INPUT="parts/two nodes.inp"\n4, 0., <h>\n' >inc.inp
cat >>inc.inp <<'END'
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*INCLUDE, INPUT=./parts/material.inp
*SOLID SECTION, ELSET=E, MATERIAL=M
** <nothing> is replaced in a comment
*STEP
*BOUNDARY
1, 1, 2
2, 2
*BOUNDARY, FUNCTION
3, 2, <n1 - 1>, -(a1*y**a2) + min(1e1, x)*0*e1 + deg
*CLOAD
4, 2, -<q>
<n1 - 1>, 1, <q>
*NODE PRINT
U, RF
*INCLUDE, INPUT=parts/print.inp
*INCLUDE, INPUT=parts/print.inp
*END STEP
END
printf '*PARAMETER\r\nq = 10\r\nh = 1/3\r\na1 = 0.01\r\n** in between\r\na2 = -2\r\ne1 = 3\r\nn1 = 0.1*3*10' >parts/values.inp
printf '2, 1., 0.\n*INCLUDE, INPUT=deep/node.inp\n' >'parts/two nodes.inp'
printf '3, 1., <h>' >parts/deep/node.inp
printf '*MATERIAL, NAME=M\n*ELASTIC\n1000., <0.3>\n' >parts/material.inp
printf '*EL PRINT, FREQUENCY=<n1>\nS\n' >parts/print.inp
again inc.inp includes
grep -q '^\*INCLUDE' includes/inc.run.inp && complain 'includes: one is left'
says 'a name of a negative value' includes/inc.run.inp '-(0.01*y**(-2)) + min(1e1, x)*0*3 + deg'
says 'a whole number' includes/inc.run.inp 'FREQUENCY=3'
says 'a comment' includes/inc.run.inp '** <nothing> is replaced in a comment'

# parts: one that has no instance keeps what it has
again "$here/../../peers/decks/cae-two-instances.inp" instances
cat >unused.inp <<'END'
*PARAMETER
w = 2
*PART, NAME=square
*NODE
1, 0., 0.
2, <w>, 0.
3, <w>, <w>
4, 0., <w>
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
*END PART
*PART, NAME=spare
*NODE
1, <w>, <2*w>
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=left, PART=square
*END INSTANCE
*INSTANCE, NAME=right, PART=square
<3*w>, 0.
*END INSTANCE
*END ASSEMBLY
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*EQUATION
2
left.2, 1, <1/w>, right.2, 1, -<1/w>
*STEP
*BOUNDARY
left.1, 1, 2
left.2, 2
right.1, 1, 2
right.2, 2
*CLOAD
left.3, 2, <w>
right.3, 1, 1.
*NODE PRINT
U
*END STEP
END
again unused.inp unused --set w=3
grep -v '^\*\*' unused/unused.run.inp | grep -q '<' && complain 'unused: parameters are left'

# meshes of Gmsh are copied: the deck as run needs nothing else, and the digest knows them
mkdir -p mesh
cp "$input/gmsh/disk-on-block.msh" mesh
sed 's,INPUT=disk-on-block.msh,INPUT="mesh/disk-on-block.msh",' "$input/gmsh/disk-on-block.inp" >'a disk.inp'
again 'a disk.inp' disk
head -c "$(wc -c <mesh/disk-on-block.msh)" disk/a_disk.run.msh | cmp - mesh/disk-on-block.msh || complain 'the copy of a mesh is another one'
before=$(digest disk)
printf '$Comments\nanother mesh\n$EndComments\n' >>mesh/disk-on-block.msh
again 'a disk.inp' disk
[ "$(digest disk)" != "$before" ] || complain 'a mesh does not change the digest'
cp disk/a_disk.run.msh disk/a_disk.run-2.msh
cp disk/a_disk.run.msh disk/mine.run.msh
sed '/^\*INCLUDE/d' "$here/../../peers/decks/cae-two-instances.inp" >'a disk.inp'
"$atrito" 'a disk.inp' -o disk --quiet 2>/dev/null || complain 'a deck without meshes fails'
[ ! -e disk/a_disk.run.msh ] && [ ! -e disk/a_disk.run-2.msh ] || complain 'meshes of an earlier run are left'
[ -e disk/mine.run.msh ] || complain 'a file of the user is gone'

# a file of the deck is never replaced
mkdir -p own
cp inc.inp own/own.inp
cp -r parts own
sed -i 's,parts/material.inp,own.run.inp,' own/own.inp
cp parts/material.inp own/own.run.inp
"$atrito" own/own.inp -o own --quiet 2>own.err
[ $? -eq 5 ] || complain 'own: exit code'
says 'own' own.err 'own/own.run.inp: this run reads it'
cmp parts/material.inp own/own.run.inp || complain 'own: an included file was replaced'

# a sweep: each run has its own deck, the tables of the sweep the digest of the deck with its own values
"$atrito" sweep "$input/ex1-plate-on-support.inp" --vary q=1,2 --set nu=0.2 -o swept --quiet || complain 'the sweep fails'
run 0 "$input/ex1-plate-on-support.inp" single --quiet --set nu=0.2 --set q=2
cmp single/ex1-plate-on-support.run.inp swept/q_2/ex1-plate-on-support.run.inp || complain 'sweep: another deck as run'
says 'sweep' swept/sweep.tab '# parameters: q varies, nu = 0.2 (--set), eps varies, rho = 0.1, delta = 1e-6'
says 'sweep' swept/runs.tab '# options: --vary q=1,2'
[ "$(sed -n 's/^# digest: //p' swept/sweep.tab)" = "$(digest swept/q_1)" ] || complain 'sweep: another digest'

# nothing is written of a run that fails
"$atrito" inc.inp -o failed --quiet --set h=0 2>/dev/null && complain 'a flat element is solved'
absent failed
finish
