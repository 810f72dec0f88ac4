. "$(dirname "$0")/../lib.sh"
dataset=$4

# deck_with NAME LINES: example 1, 3 or what NAME begins with, with requests; '|' separates lines.
deck_with() {
   case $1 in
   ex3*) deck=$input/ex3-pillar-in-ground.inp ;;
   *) deck=$input/ex1-plate-on-support.inp ;;
   esac
   { sed '/^\*END STEP/d' "$deck"; printf '%s\n' "$2" | tr '|' '\n'; echo '*END STEP'; } >"$1.inp"
}

# rows FOLDER PATH: a dataset without its attributes.
rows() {
   "$dataset" "$1/$1.h5" "$2" | grep -v '^#'
}

# attribute FOLDER PATH NAME: its value.
attribute() {
   "$dataset" "$1/$1.h5" "$2" | sed -n "s/^# $3: //p"
}

# Tables have 15 digits here, and write what is below 1e-14 of its field's scale as 0.
tolerance=1e-13

# same_field FOLDER PATH COMPONENT TABLE COLUMN DIMENSION [AWK CONDITION on the table's row, with place["column"]]
same_field() {
   rows "$1" "$2" | awk -v k="$3" '{ print $k }' >found.txt
   awk -v name="$5" '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 } !/^#/ { print $place[name] }' "$1/$4.tab" >wanted.txt
   [ "$(attribute "$1" "$2" dimension)" = "$6" ] || complain "$1 $2: dimension $(attribute "$1" "$2" dimension)"
   [ -n "$(attribute "$1" "$2" name)" ] || complain "$1 $2: no name"
   table_dimension=$(awk -v name="$5" '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) k = i } /^# dimensions:/ { print $k }' "$1/$4.tab")
   [ "$table_dimension" = "$6" ] || complain "$1 $2: $4.tab has the dimension $table_dimension"
   paste found.txt wanted.txt | awk -v tol="$tolerance" -v what="$1 $2" '
      NF != 2 || $1 !~ /^[-+0-9.E]+$/ { bad = 1 }
      { d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d; z = $2 < 0 ? -$2 : $2; if (z > scale) scale = z }
      END { printf "%s: %d rows, worst difference %.2e of %.2e\n", what, NR, worst, scale
            exit bad || NR == 0 || !(worst <= tol*scale) }' || complain "$1 $2 differs from $4.tab"
}

all='*NODE FILE|U, RF|*EL FILE|S|*CONTACT FILE'
for name in ex1 ex3; do
   deck_with $name "$all"
   run 0 $name.inp $name --digits 15
   same_field $name /mesh/coordinates 1 nodes x L
   same_field $name /mesh/coordinates 2 nodes y L
   same_field $name /mesh/node 1 nodes node -
   same_field $name /step_1/nodes/U 1 nodes u1 L
   same_field $name /step_1/nodes/U 2 nodes u2 L
   for column in element point; do same_field $name /step_1/stress_points/$column 1 stress $column -; done
   for column in s11 s22 s12 mises; do same_field $name /step_1/stress_points/$column 1 stress $column F/L^2; done
   same_field $name /step_1/stress_points/coordinates 1 stress x L
   same_field $name /step_1/stress_points/coordinates 2 stress y L
   for column in s gap slip; do same_field $name /step_1/pair_1/$column 1 contact $column L; done
   for column in pressure weighted_pressure shear; do same_field $name /step_1/pair_1/$column 1 contact $column F/L^2; done
   same_field $name /step_1/pair_1/status 1 contact status -
   same_field $name /step_1/pair_1/weight 1 contact weight L^2
   same_field $name /step_1/pair_1/coordinates 1 contact x L
   # an upper body as slave: n = (0, -1), so the traction is (shear, p)
   same_field $name /step_1/pair_1/traction 1 contact shear F/L^2
   same_field $name /step_1/pair_1/traction 2 contact pressure F/L^2
   # what the slave's points move is what the node at the same place moves
   { rows $name /mesh/coordinates >x.txt; rows $name /step_1/nodes/U | paste x.txt - | sed 's/^/n /'
     rows $name /step_1/pair_1/coordinates >x.txt; rows $name /step_1/pair_1/U | paste x.txt - | sed 's/^/p /'; } | awk '
      $1 == "n" { at[$2 " " $3] = at[$2 " " $3] " " $4 "/" $5 " " }
      $1 == "p" { points++; if (index(at[$2 " " $3], " " $4 "/" $5 " ") == 0) bad = 1 }
      END { exit bad || points != 7 }' || complain "$name: U of the pair"
   # reactions of all nodes, 0 where nothing is prescribed, against the sum of reactions.tab
   near "$name reactions" "$(rows $name /step_1/nodes/RF | awk '{ a += $2 } END { printf "%.17g", a }')" \
      "$(column $name/reactions.tab r2 | awk '{ a += $1 } END { printf "%.17g", a }')" "$(value "1e-9*$(summary $name normal_resultant)")"
   [ "$(attribute $name / converged)" = 1 ] || complain "$name: not converged"
   [ "$(attribute $name / deck)" = $name.inp ] || complain "$name: deck"
   attribute $name / program | grep -q '^atrito ' || complain "$name: program"
   [ "$(attribute $name / heading)" = "$(sed -n 's/^# heading: //p' $name/nodes.tab)" ] || complain "$name: heading"
   says "$name xdmf" $name/$name.xdmf "$name.h5:/step_1/pair_1/traction<"
   says "$name screen" $name.out "$name/$name.xdmf, with .h5"
   says "$name listing" $name/$name.lst "$name.xdmf, with .h5: U RF S contact"
   # every dataset that the .xdmf names is there, and beside those the list of increments
   sed -n 's/.*\.h5:\([^<]*\)<.*/\1/p' $name/$name.xdmf | sort -u >named.txt
   "$dataset" $name/$name.h5 | sort | grep -v '^/increments/' >there.txt
   near "$name time" "$(rows $name /increments/time | awk '{ print $NF }')" 1 0
   cmp named.txt there.txt || complain "$name: the .xdmf does not name what the .h5 holds"
done
[ "$(attribute ex1 /step_1/pair_1 slave)" = OVER-BOTTOM ] || complain 'slave'
[ "$(attribute ex1 /step_1/pair_1 master)" = SUPPORT-TOP ] || complain 'master'

# areas by the corners; mid-sides and centres are means
area() {
   { rows "$1" /mesh/coordinates | sed 's/^/x /'; rows "$1" "/mesh/$2/nodes" | sed 's/^/e /'; } | awk '
      $1 == "x" { x[n + 0] = $2; y[n + 0] = $3; n++ }
      $1 == "e" { c = (NF == 4 || NF == 7) ? 3 : 4; for (k = 0; k < c; k++) { a = $(2 + k) + 0; b = $(2 + (k + 1)%c) + 0; area += (x[a]*y[b] - x[b]*y[a])/2
                     if (NF > 5) { m = $(2 + c + k) + 0; off(x[m] - (x[a] + x[b])/2); off(y[m] - (y[a] + y[b])/2) } }
                  if (NF > 9) { a = $2 + 0; b = $4 + 0; m = $10 + 0; off(x[m] - (x[a] + x[b])/2); off(y[m] - (y[a] + y[b])/2) } }
      function off(d) { if (d < 0) d = -d; if (!(d <= 1e-13)) bad = 1 }
      END { if (bad) print "none"; else printf "%.17g", area }'
}
near 'area of example 1' "$(area ex1 Q1)" 1.11 1e-13
near 'area of example 3' "$(area ex3 Q2)" 88 1e-12
sed 's/CPE4/CPE8/' ex1.inp >eight.inp
run 0 eight.inp eight --quiet
near 'area of example 1 of eight nodes' "$(area eight S2)" 1.11 1e-13
says 'XDMF of eight nodes' eight/eight.xdmf 'TopologyType="Quadrilateral_8"'
for nodes in 3 6; do
   sed "s/CPE4/CPE$nodes/" ex1.inp >triangles.inp
   run 0 triangles.inp triangles --quiet
   near "area of example 1 of $nodes nodes" "$(area triangles T$((nodes/3)))" 1.11 1e-13
done
says 'XDMF of six nodes' triangles/triangles.xdmf 'TopologyType="Triangle_6"'

# equal runs, equal files
run 0 ex1.inp again --quiet
cmp ex1/ex1.h5 again/ex1.h5 || complain 'two runs differ'

# parts: the nodes of a set, the elements of a set; nothing else
deck_with parts '*NODE FILE, NSET=OVER-TOP|U|*EL FILE, ELSET=SUPPORT|S'
run 0 parts.inp parts --quiet
near 'nodes of OVER-TOP' "$(rows parts /step_1/nodes/U | grep -vc -i nan)" 7 0
near 'the others' "$(rows parts /step_1/nodes/U | grep -c -i 'nan.*nan.*nan')" 138 0
near 'points of SUPPORT' "$(rows parts /step_1/stress_points/s11 | grep -c .)" 144 0
near 'stress.tab has all' "$(grep -vc '^#' parts/stress.tab)" 444 0
if "$dataset" parts/parts.h5 | grep -q 'pair_1\|RF'; then complain 'parts: contact or RF was not asked for'; fi

# only where a deck asks for it; an old one goes
deck_with none ''
cp none.inp parts.inp
run 0 parts.inp parts --quiet
absent parts/parts.h5
absent parts/parts.xdmf
[ -f parts/parts.lst ] || complain 'the run itself wrote nothing'

# a run that does not converge is marked
sed '/^\*STATIC/a *CONTROLS, MAXIT=1, METHOD=PICARD' ex1.inp >failed.inp
run 3 failed.inp failed --quiet
near 'converged' "$(attribute failed / converged)" 0 0
[ -n "$(attribute failed / 'NOT CONVERGED')" ] || complain 'the .h5 of a failed run is not marked'
says 'the .xdmf of a failed run' failed/failed.xdmf 'Information Name="NOT CONVERGED"'

# what cannot be written: exit 5, named, and all is as it was
rm -rf before
cp -r ex1 before
sed '/^\*EL PRINT/,/^S$/d; /^\*NODE PRINT/,/^U, RF$/d' ex1.inp >full.inp
mv full.inp ex1.inp
(ulimit -f 100; "$atrito" ex1.inp --quiet -o ex1 2>full.err)
[ $? -eq 5 ] || complain 'a full disk: not exit 5'
says 'a full disk' full.err 'ex1/ex1.h5: cannot be written completely'
[ "$(wc -l <full.err)" -eq 1 ] || complain 'HDF5 speaks too'
rm before/ex1.xdmf ex1/ex1.h5
mkdir ex1/ex1.h5
"$atrito" ex1.inp --quiet -o ex1 2>folder.err
[ $? -eq 5 ] || complain 'a folder in its place: not exit 5'
says 'a folder in its place' folder.err 'ex1/ex1.h5: cannot be written'
for file in before/*.tab before/*.lst; do
   cmp "$file" "ex1/${file##*/}" || complain "${file##*/} was replaced"
done
if ls -A ex1 | grep '\.part$'; then complain 'a temporary file is left'; fi
finish
