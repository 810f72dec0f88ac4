# Tables of errors and their orders, as markdown. To be sourced after lib.sh, with
#    errors (the program error_norms), mesh (mesh.awk)

# row TABLE CASE LEVEL DECK FIELD...: solves, adds a row and the order since the row before it of the same case.
row() {
   table=$1
   case_name=$2
   level=$3
   deck=$4
   shift 4
   "$errors" "$deck" "$level" "$@" >norms.out 2>norms.err || complain "$deck, refined $level times: not solved"
   awk -v name="$case_name" -v level="$level" '
      { printf "%s %d %d %.17g %.17g %.3f\n", name, $1, $2, $3, $4, $5 }' norms.out >>"$table"
}

# markdown TABLE: rows of `case elements dofs L2 energy distortion`. Distortion: half the range of the Jacobian within an element
# over its mean; 0 for parallelograms.
markdown() {
   awk '
      function order(before, now) { return (before > 0) ? sprintf("%.2f", log(before/now)/log(2)) : "" }
      BEGIN { print "| mesh | elements | dofs | L2 error | order | energy error | order | distortion |\n|---|---|---|---|---|---|---|---|" }
      { if ($1 != name) { l2 = 0; energy = 0 }
        text = $1; gsub(/_/, " ", text)
        printf "| %s | %d | %d | %.3e | %s | %.3e | %s | %.3f |\n", text, $2, $3, $4, order(l2, $4), $5, order(energy, $5), $6
        name = $1; l2 = $4; energy = $5 }' "$1"
}

# orders TABLE CASE L2 ENERGY [WITHIN]: the orders between the last two rows of a case, within 0.1.
orders() {
   found=$(awk -v name="$2" '$1 == name { a = l2; b = energy; l2 = $4; energy = $5 }
      END { if (a > 0 && l2 > 0) printf "%.6f %.6f", log(a/l2)/log(2), log(b/energy)/log(2); else print "none none" }' "$1")
   near "$2: order of the L2 error" "${found% *}" "$3" "${5:-0.1}"
   near "$2: order of the energy error" "${found#* }" "$4" "${5:-0.1}"
}
