. "$(dirname "$0")/../lib.sh"
decks=$here/../../peers/decks

# runs NAME [DECK]: no error; no kind of note is told twice.
runs() {
   run 0 "${2:-$decks/$1.inp}" "$1" --digits 12
   ! grep -q 'error \[' "$1.err" || complain "$1: an error"
   grep -q 'note \[N-IGNORED\]' "$1.err" || complain "$1: no note"
   twice=$(sed -n 's/^.*note \[//p' "$1.err" | sed 's/ (and [0-9]* more lines*)//' | sort | uniq -d)
   [ -z "$twice" ] || complain "$1: told twice: $twice"
}
# lacks WHAT FILE PATTERN: no line of a file has it.
lacks() {
   ! grep -qE "$3" "$2" || complain "$1"
}
# of NAME STEP QUANTITY: a value of summary.tab.
of() {
   awk -v s="$2" -v q="$3" '!/^#/ && $1 == s && $3 == q { print $4 }' "$1/summary.tab"
}

runs prepomax-punch
near 'punch: pressed' "$(of prepomax-punch 1 normal_resultant)" 100 1e-8
near 'punch: still pressed' "$(of prepomax-punch 2 normal_resultant)" 100 1e-8
near 'punch: pushed' "$(of prepomax-punch 2 shear_resultant)" -20 1e-8
says 'punch: NLGEOM' prepomax-punch.err 'warning [W-NLGEOM]'
says 'punch: it does not matter' prepomax-punch.err 'note [N-SMALL]'
says 'punch: the second step, too' prepomax-punch.err 'atrito takes it from --solver (and 1 more line)'
lacks 'punch: not large' prepomax-punch.err '\[W-LARGE\]'

sed 's/^210000, 0.28/100, 0.28/' "$decks/prepomax-punch.inp" >soft.inp
runs soft soft.inp
says 'soft: it matters' soft.err 'warning [W-LARGE]'
lacks 'soft: not small' soft.err '\[N-SMALL\]'
sed 's/, Nlgeom//' "$decks/prepomax-punch.inp" >linear.inp
runs linear linear.inp
lacks 'linear: nobody asked' linear.err '\[(N-SMALL|W-NLGEOM)\]'
same_tables 'linear: the same solution' linear/contact.tab prepomax-punch/contact.tab 0

runs prepomax-shrink-fit
p=$(value '59.0625/(1 + 59.0625e-9/2.4e-3)')
area=$(value '8*atan2(1, 1)*2*0.5')
near 'fit: mean pressure' "$(value "$(of prepomax-shrink-fit 1 normal_resultant)/$area")" "$p" 0.002

runs mecway-bar
all_near 'bar: uniform' mecway-bar/contact.tab pressure 5 1e-9
all_near 'bar: no shear' mecway-bar/contact.tab shear 0 1e-9
[ ! -e mecway-bar/nodes.tab ] || complain 'bar: FREQUENCY=0 prints nothing'

runs prepomax-style
near 'style: pressed' "$(of prepomax-style 1 normal_resultant)" 10 1e-8

# components of what is written, and of what is not
awk '/^\*NODE PRINT|^\*EL PRINT/ { exit } { print }' "$decks/mecway-bar.inp" >components.inp
cp components.inp whole.inp
printf '*NODE PRINT\nU1, RF2, U3, COOR1\n*EL PRINT, POSITION=CENTROIDAL\nS11, E11, S23\n*END STEP\n' >>components.inp
sed -i -e 's/^\*STEP/&, INCF=9, THERMAL NETWORK/' -e 's/^\*SURFACE,/& TRIM=YES,/' -e 's/^\*SOLID SECTION,/& REF NODE=1,/' \
   -e 's/^\*[CD]LOAD/&, SECTOR=2/' components.inp
printf '*NODE PRINT\nU, RF\n*EL PRINT\nS\n*END STEP\n' >>whole.inp
runs components components.inp
run 0 whole.inp whole --digits 12
for table in nodes reactions stress; do
   same_tables "components: $table" components/$table.tab whole/$table.tab 0
done
says 'components: told' components.err 'variable U1 of *NODE PRINT is written with all components of U'
says 'components: not in the plane' components.err 'variable U3 of *NODE PRINT is not written'
says 'components: where' components.err 'POSITION=CENTROIDAL of *EL PRINT has no effect: stress.tab has the integration points'
for option in INCF THERMAL\ NETWORK TRIM REF\ NODE SECTOR; do
   says "components: $option" components.err "option $option of "
done
finish
