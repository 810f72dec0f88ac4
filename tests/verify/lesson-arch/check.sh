. "$(dirname "$0")/../lib.sh"
arch=$input/lessons/arch.inp

# joint FOLDER PAIR NAME: a value of joints.tab.
joint() {
   column "$1/joints.tab" "$3" | sed -n "$2p"
}

run 0 "$arch" arch --digits 17 --quiet
near 'half the weight' "$(joint arch 1 n)" "$(value '4.5*0.15*sin(atan2(0, -1)/9)')" 1e-12
near 'the other half' "$(joint arch 10 n)" "$(value '4.5*0.15*sin(atan2(0, -1)/9)')" 1e-12
thrust=$(joint arch 1 t)
near 'the thrust' "$thrust" 0.0908504513 1e-9
# the side of voussoir k towards the left springing lies on the ray 20 (k - 1) degrees above it, its outward normal leans that much
for k in 2 3 4 5 6 7 8 9; do
   angle=$(value "($k - 1)*atan2(0, -1)/9")
   near "thrust at joint $k" "$(value "$(joint arch $k n)*sin($angle) + $(joint arch $k t)*cos($angle)")" "$thrust" 1e-12
done
near 'm/n at the springing' "$(value "$(joint arch 1 m)/($(joint arch 1 n))")" -0.0484265 1e-6
[ "$(column arch/bodies.tab name | tail -1)" = V9 ] || complain 'the name of the last voussoir'

# thin: the line of thrust at the edges
run 0 "$arch" thin --set t=0.1016 --digits 17 --quiet
below 'outer edge at the springing' "$(value "1 + 0.0508 + $(joint thin 1 x)")" 3e-4
below 'inner edge at the haunch' "$(value "1e-8 + sqrt(($(joint thin 3 x))^2 + ($(joint thin 3 y))^2) - (1 - 0.0508)")" 3e-4
below 'outer edge at the crown' "$(value "1e-8 + 1 + 0.0508 - sqrt(($(joint thin 5 x))^2 + ($(joint thin 5 y))^2)")" 3e-4
run 0 "$arch" stands --set t=0.10153 --quiet
run 4 "$arch" falls --set t=0.10152 --quiet
run 4 "$arch" lesson --set t=0.1 --quiet
says 'thin' lesson.err 'are free to move under their loads'
says 'thin' lesson.err 'can rotate about (-1.05, 0)'

# slippery
run 0 "$arch" slippery --set t=0.2 --set nu=0.31 --digits 17 --quiet
near 'friction at the springing' "$(value "$(joint slippery 1 t)/($(joint slippery 1 n))")" 0.31 1e-9
near 'friction 60 degrees up' "$(value "-($(joint slippery 4 t))/($(joint slippery 4 n))")" 0.307 5e-4
run 0 "$arch" rough --set t=0.2 --set nu=0.30899 --quiet
run 4 "$arch" smooth --set t=0.2 --set nu=0.30898 --quiet
run 4 "$arch" lesson --set t=0.2 --set nu=0.3 --quiet
says 'slippery' lesson.err 'can move along x2'
says 'slippery' lesson.err 'friction takes 96.07 % of the work of the loads at most'
finish
