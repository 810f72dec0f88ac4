. "$(dirname "$0")/../lib.sh"
# mesh NX NY: writes the deck. Forces on a face of the ends by two Gauss points, exact for a parabola times a shape function.
mesh() {
   awk -v nx="$1" -v ny="$2" '
      function shear(y) { return 0.75*(1 - y*y) }
      function add(i, j, fx, fy) { f[i, j, 1] += fx; f[i, j, 2] += fy }
      BEGIN {
         print "*HEADING\nTimoshenko cantilever\n*BLOCK, TYPE=CPS4, ELSET=BEAM, NX=" nx ", NY=" ny "\n0, -1\n8, -1\n8, 1\n0, 1"
         print "*MATERIAL, NAME=M\n*ELASTIC\n1000, 0.3\n*SOLID SECTION, ELSET=BEAM, MATERIAL=M"
         row = nx + 1
         print "*NSET, NSET=END\n" row*(ny/2) + row
         print "*BOUNDARY\n" row*(ny/2) + 1 ", 1, 2\n" row*ny + 1 ", 1"
         print "*STEP\n*STATIC\n*CLOAD"
         h = 2/ny
         for (j = 0; j < ny; j++) for (g = -1; g <= 1; g += 2) {
            t = 0.5*(1 + g/sqrt(3)); y = -1 + (j + t)*h
            for (k = 0; k <= 1; k++) {
               w = 0.5*h*(k ? t : 1 - t)
               add(nx, j + k, 0, w*shear(y))
               add(0, j + k, w*12*y, -w*shear(y))
            }
         }
         for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i += nx) for (d = 1; d <= 2; d++)
            if (f[i, j, d] != 0) printf "%d, %d, %.17g\n", j*row + i + 1, d, f[i, j, d]
         print "*NODE PRINT, NSET=END\nU\n*NODE PRINT\nRF\n*END STEP"
      }' </dev/null >"$1.inp"
   run 0 "$1.inp" "mesh$1" --digits 17 --quiet
   below "$1 equilibrium" "$(summary "mesh$1" equilibrium_residual)" 1e-10
   near "$1 work of the forces over twice the energy" "$(value "$(summary "mesh$1" external_work)/2/$(summary "mesh$1" strain_energy)")" \
      1 1e-11
   all_near "$1 reactions along 1" "mesh$1/reactions.tab" r1 0 1e-10
   all_near "$1 reactions along 2" "mesh$1/reactions.tab" r2 0 1e-10
}
# order WHAT COARSE FINE: rate of two errors.
order() {
   near "order of $1" "$(value "log($2/$3)/log(2)")" 2 0.1
}
mesh 16 4
mesh 32 8
mesh 64 16
for n in 16 32 64; do
   energy=$(value "0.13424 - $(summary mesh$n strain_energy)")
   near "$n energy below the exact one" "$(value "$energy > 0")" 1 0
   deflection=$(column mesh$n/nodes.tab u2 | awk '{ u = $1 } END { if (NR == 1) print u }')
   near "$n deflection of the end" "$deflection" 0.267 "$(value "0.267*4/$n/$n*4")"
   if [ $n -gt 16 ]; then
      order "energy, $((n / 2)) to $n" "$energy_before" "$energy"
   fi
   energy_before=$energy
done
finish
