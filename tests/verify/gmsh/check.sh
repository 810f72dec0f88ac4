. "$(dirname "$0")/../lib.sh"

# hertz FOLDER: p(0) over that of Hertz, less 1; half of the contact is modelled. R = 10, E = 210000, mu = 0.3, plane strain.
hertz() {
   awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      !/^#/ { x = $place["x"]; q += 2*$place["weight"]*$place["pressure"]; if (x*x < 1e-20) middle = $place["pressure"] }
      END { pi = atan2(0, -1); a = sqrt(4*q*10/(pi*210000/0.91/2)); printf "%.17g", middle/(2*q/(pi*a)) - 1 }' "$1/contact.tab"
}

# the worked example of docs/user/meshes.md
run 0 "$input/gmsh/disk-on-block.inp" disk --digits 17 --quiet
near "disk: p(0)/p0 - 1" "$(hertz disk)" 0 0.01
near "disk: the load" "$(summary disk normal_resultant)" 500 1e-6
run 0 "$input/gmsh/disk-on-block.inp" finer --refine 1 --digits 17 --quiet
near "disk, refined: p(0)/p0 - 1" "$(hertz finer)" 0 0.01

# the same mesh in the other forms that Gmsh writes
for form in 22 inp; do
   awk -v form=$form -v state=CPE -f "$here/convert.awk" "$input/gmsh/disk-on-block.msh" >mesh.$form
done
sed 's/disk-on-block\.msh/mesh.22/' "$input/gmsh/disk-on-block.inp" >old.inp
sed 's/disk-on-block\.msh.*/mesh.inp/' "$input/gmsh/disk-on-block.inp" >abaqus.inp
for form in old abaqus; do
   run 0 $form.inp $form --digits 17 --quiet
   "$atrito" compare $form disk >$form.same || { complain "$form: another solution"; cat $form.same; }
done

# a surface from a set of nodes is that of the curve
sed -e 's/^\*CONTACT PAIR/*SURFACE, NAME=slave, TYPE=NODE\ndisk-bottom\n&/' -e 's/^disk-bottom, /slave, /' \
   -e "s|disk-on-block.msh|$input/gmsh/&|" "$input/gmsh/disk-on-block.inp" >nodes.inp
grep -q '^slave, block-top' nodes.inp || complain "the deck is not changed"
run 0 nodes.inp nodes --digits 17 --quiet
"$atrito" compare nodes/contact.tab disk/contact.tab >nodes.same || { complain "nodes: another solution"; cat nodes.same; }

# a plate with a hole against a rigid line, triangles of six nodes
run 0 "$input/gmsh/plate-with-hole.inp" plate --digits 17 --quiet
run 0 "$input/gmsh/plate-with-hole.inp" plate-finer --refine 1 --digits 17 --quiet
base=$(awk '/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next } !/^#/ { r += $place["r2"] } END { printf "%.17g", r }' \
   plate/reactions.tab)
near "plate: base and platen" "$(value "$base/$(summary plate normal_resultant)")" 1 1e-9
near "plate: against a finer mesh" "$(value "$(summary plate normal_resultant)/$(summary plate-finer normal_resultant)")" 1 2e-3
finish
