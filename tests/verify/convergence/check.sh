# check.sh ATRITO CASE_FOLDER INPUT_FOLDER ERROR_NORMS: prints the numbers of docs/verification/convergence.md, and asserts the orders.
. "$(dirname "$0")/../lib.sh"
errors=$4
mesh=$here/../mesh.awk
. "$here/rates.sh"
rm -f waves.txt ring.txt

# waves: the second half of the deck.
waves() {
   echo "*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=M
*PARAMETER
k = 2
a = 1
b = 0.5
g = 1000/2.6
c = 3 - 4*0.3
*STEP
*STATIC
*BOUNDARY, FUNCTION
ALL-OUTLINE, 1, 1, exp(k*x)*((c*a - b)*cos(k*y) - a*k*(x*cos(k*y) + y*sin(k*y)))/(2*g)
ALL-OUTLINE, 2, 2, exp(k*x)*((c*a + b)*sin(k*y) - a*k*(y*cos(k*y) - x*sin(k*y)))/(2*g)
*END STEP"
}

# Two by two general quadrilaterals, or as many pairs of triangles; nine nodes: straight sides.
skewed() {
   awk -v type="$1" 'BEGIN {
      nine = type ~ /[689]/; hollow = type ~ /[68]/; triangles = type ~ /[36]/
      split("0 0.45 1 0 0.6 1 0 0.35 1", x); split("0 0 0 0.6 0.42 0.5 1 1 1", y)
      split("1 2 4 5", first)
      print "*NODE"
      for (k = 1; k <= 9; k++) print k ", " x[k] ", " y[k]
      n = 9
      corners = 4 - triangles
      for (e = 1; e <= 4*(1 + triangles); e++) {
         a = first[triangles ? int((e + 1)/2) : e]; c[1] = a; c[2] = a + 1; c[3] = a + 4; c[4] = a + 3
         if (triangles && e % 2 == 0) { c[2] = a + 4; c[3] = a + 3 }
         list[e] = e ", " c[1] ", " c[2] ", " c[3] (triangles ? "" : ", " c[4])
         if (!nine) continue
         for (s = 1; s <= corners; s++) {
            p = c[s]; q = c[s % corners + 1]; key = (p < q) ? p " " q : q " " p
            if (!(key in middle)) { middle[key] = ++n; printf "%d, %.17g, %.17g\n", n, (x[p] + x[q])/2, (y[p] + y[q])/2 }
            list[e] = list[e] ", " middle[key]
         }
         if (hollow) continue
         n++
         printf "%d, %.17g, %.17g\n", n, (x[c[1]] + x[c[2]] + x[c[3]] + x[c[4]])/4, (y[c[1]] + y[c[2]] + y[c[3]] + y[c[4]])/4
         list[e] = list[e] ", " n
      }
      print "*ELEMENT, TYPE=" type ", ELSET=ALL"
      for (e = 1; e in list; e++) print list[e]
      print "*NSET, NSET=ALL-OUTLINE\n1, 2, 3, 4, 6, 7, 8, 9"
      if (nine) print middle["1 2"] ", " middle["2 3"] ", " middle["1 4"] ", " middle["4 7"] ", " middle["3 6"] ", " middle["6 9"] \
                      ", " middle["7 8"] ", " middle["8 9"]
   }' </dev/null
}

for type in CPE4 CPE9 CPE8 CPE3 CPE6 CPE4R CPE8R; do
   l2=3; energy=2
   case $type in *[34] | *4R) l2=2; energy=1 ;; esac
   for map in square trapezoids arched; do
      for n in 4 8 16 32; do
         { printf '*HEADING\nWaves\n'; awk -v type=$type -v n=$n -v m=$n -v map=$map -f "$mesh"; waves; } >deck.inp
         row waves.txt ${type}_$map 0 deck.inp waves 2 1 0.5
      done
      case ${type}_$map in
      # eight nodes lose up to an order on meshes that stay distorted (D. N. Arnold, D. Boffi, R. S. Falk, Math. Comp. 71, 2002)
      CPE8*_trapezoids) orders waves.txt ${type}_trapezoids 2.5 1.5 0.5 ;;
      *) orders waves.txt ${type}_$map $l2 $energy ;;
      esac
   done
   { printf '*HEADING\nWaves\n'; skewed $type; waves; } >skewed.inp
   { printf '*HEADING\nWaves\n'; awk -v type=$type -v n=2 -v m=2 -v map=arched -f "$mesh"; waves; } >arched.inp
   for level in 1 2 3 4; do row waves.txt ${type}_skewed,_refined $level skewed.inp waves 2 1 0.5; done
   orders waves.txt ${type}_skewed,_refined $l2 $energy
   case $type in *[34] | *4R) continue ;; esac
   for level in 1 2 3 4; do row waves.txt ${type}_arched,_refined $level arched.inp waves 2 1 0.5; done
   orders waves.txt ${type}_arched,_refined $l2 $energy
done

# ring TYPE N: Lame's ring.
ring() {
   printf '*HEADING\nRing\n'
   awk -v type="$1" -v n="$2" -v m="$2" -v map=ring -v r1=1 -v r2=2 -v turn=90 -f "$mesh"
   echo "*MATERIAL, NAME=M
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=ALL, MATERIAL=M
*BOUNDARY
ALL-BOTTOM, 2
ALL-TOP, 1
*STEP
*STATIC
*DSLOAD
ALL-LEFT, P, 1
*NODE PRINT
U
*EL PRINT
S
*END STEP"
}
for type in CPE4 CPS4 CPE9 CPS9 CPE8 CPS8 CPE3 CPS3 CPE6 CPS6 CPE4R CPS4R CPE8R CPS8R; do
   case $type in *[34] | *4R) l2=2 energy=1 ;; *) l2=3 energy=2 ;; esac
   for n in 4 8 16 32; do
      ring $type $n >deck.inp
      row ring.txt ${type}_ring 0 deck.inp ring 1 2 1 0
   done
   # that of six nodes comes down to 3 from 3.5
   case $type in *6) within=0.2 ;; *) within=0.1 ;; esac
   orders ring.txt ${type}_ring $l2 $energy $within
done
for type in CPE4 CPE9; do
   ring $type 4 >deck.inp
   for level in 0 1 2 3; do row ring.txt ${type}_ring_of_4_x_4,_refined $level deck.inp ring 1 2 1 0; done
   # the shape of the coarse mesh stays: 1 - cos(pi/16) of the radius for four nodes, 1/100 of it for nine
   near "$type: refinement stops at the coarse shape" "$(awk -v name=${type}_ring_of_4_x_4,_refined '
      $1 == name { last = $4 } END { limit = (name ~ /4_ring/) ? 1e-2 : 1e-5; print (last > limit) + 0 }' ring.txt)" 1 0
done

# Stresses as they are printed, against sr = (1 - 4/r^2)/3, st = (1 + 4/r^2)/3; within h^2 = 1/256 of the pressure.
ring CPE9 16 >stress.inp
run 0 stress.inp stress --digits 17 --quiet
field_near 'CPE9 s11 at the Gauss points' stress/stress.tab s11 '1/3 - 4/3*(x*x - y*y)/(x*x + y*y)^2' 4e-3
field_near 'CPE9 s22 at the Gauss points' stress/stress.tab s22 '1/3 + 4/3*(x*x - y*y)/(x*x + y*y)^2' 4e-3
field_near 'CPE9 s12 at the Gauss points' stress/stress.tab s12 '-8/3*x*y/(x*x + y*y)^2' 4e-3
field_near 'CPE9 s33 at the Gauss points' stress/stress.tab s33 '0.2' 4e-3
echo
markdown waves.txt
echo
markdown ring.txt
finish
