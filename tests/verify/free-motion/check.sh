. "$(dirname "$0")/../lib.sh"
expect_motion() { # NAME TEXT options
   name=$1
   text=$2
   shift 2
   run 4 "$here/block.inp" "$name" "$@"
   says "$name" "$name.err" 'body CRATE'
   says "$name" "$name.err" "$text"
   absent "$name"
}
run 0 "$here/block.inp" pressed --quiet
near 'pressed' "$(summary pressed normal_resultant)" 1 1e-12
expect_motion pulled 'free to move along x2' --set top=-1
expect_motion pushed 'free to move along x1' --set side=0.1
sed 's/^\*CONTACT PAIR/*FRICTION\n5.\n*CONTACT PAIR/' "$here/block.inp" >tip.inp
run 4 tip.inp tipped --set right=0.6
says tipped tipped.err 'free to rotate about'
absent tipped
run 0 tip.inp stands --set right=0.4 --quiet
sed -e '/^\*SURFACE, NAME=FLOOR/,/^CRATE-BOTTOM/d' "$here/block.inp" >alone.inp
run 4 alone.inp alone
says alone alone.err 'no support and no contact pair holds it'
absent alone
finish
