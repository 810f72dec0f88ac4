. "$(dirname "$0")/../lib.sh"
row() { # row DECK nu area uniform triangular cm
   run 0 "$input/$1.inp" "$1-$2" --set nu="$2" --quiet
   near "$1 nu=$2 area" "$(summary "$1-$2" effective_area_percent)" "$3" 0.5
   near "$1 nu=$2 uniform" "$(summary "$1-$2" max_pressure_over_uniform)" "$4" 0.06
   near "$1 nu=$2 triangular" "$(summary "$1-$2" max_pressure_over_triangular)" "$5" 0.06
   near "$1 nu=$2 cm" "$(awk -v d="$(summary "$1-$2" resultant_from_end)" 'BEGIN { print 100*d }')" "$6" 0.06
   for q in 1 1000; do run 0 "$input/$1.inp" "$1-$2-q$q" --set nu="$2" --set q=$q --digits 17 --quiet; done
   for ratio in effective_area_percent max_pressure_over_uniform max_pressure_over_triangular resultant_from_end; do
      a=$(summary "$1-$2-q1" $ratio)
      near "$1 nu=$2 q=1000 $ratio" "$(summary "$1-$2-q1000" $ratio)" "$a" "$(awk -v a="$a" 'BEGIN { print 1e-10*a }')"
   done
}
row ex1-plate-on-rigid-support 0 25 9.1 4.6 2.4
row ex1-plate-on-support 0 58 4.5 2.3 9.3
row ex1-plate-on-rigid-support 0.3 58 7.1 3.5 6.2
row ex1-plate-on-support 0.3 75 4.7 2.3 10.4
finish
