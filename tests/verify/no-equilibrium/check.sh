#!/bin/sh
# Scenes without equilibrium: solved at 0.99 of what statics gives as the limit, and at 1.01 proved to have none, in words and numbers.
. "$(dirname "$0")/../lib.sh"

# limit NAME DECK PARAMETER LIMIT [options]: leaves the message in NAME.err
limit() {
   name=$1
   deck=$2
   [ -e "$deck" ] || deck=$here/$2
   parameter=$3
   critical=$4
   shift 4
   run 0 "$deck" "$name-stands" --quiet --set "$parameter=$(value "0.99*($critical)")" "$@"
   run 4 "$deck" "$name" --quiet --set "$parameter=$(value "1.01*($critical)")" "$@"
   absent "$name"
}

# told NAME BEFORE EXPECTED: the number that stands behind a text of NAME.err
told() {
   near "$1: $2" "$(sed -n "s/.*$2\\([-0-9.eE+]*\\) .*/\\1/p" "$1.err")" "$(value "$3")" "$(value "1e-4*($3)")"
}

# G2 = 1.25 g2, G3 = 2 height g3; the push acts on a height of 1/2
limit upper stack.inp push3 '0.6*3/0.5'
says upper upper.err 'body B3 (node 91 and all others) is free to move along x1'
says upper upper.err 'it slides (B3-BOTTOM on B2-TOP), the load drives it with H ='
told upper 'with H = ' '1.01*1.8'
told upper 'nu times N = ' '1.8'
told upper '(N = ' '3'
told upper 'at most (N = 3 \[F\]), ' '0.018'

limit both stack.inp push3 '0.1*11.75/0.5' --set nu12=0.1 --set nu23=1.8
says both both.err 'bodies B2 and B3 are free to move along x1 together'
says both both.err 'they slide (B2-BOTTOM on B1-TOP), the loads drive them'
told both 'with H = ' '1.01*1.175'
told both 'nu times N = ' '1.175'
told both '(N = ' '11.75'

# a guide keeps the upper one where it is
sed 's/^B1-BOTTOM, 1, 2$/&\nB3-RIGHT, 1/' "$here/stack.inp" >guided.inp
limit middle guided.inp push2 '(0.2*11.75 + 0.05*3)/0.5' --set nu12=0.2 --set nu23=0.05
says middle middle.err 'body B2 (node 51 and all others) is free to move along x1'
says middle middle.err 'it slides (B2-BOTTOM on B1-TOP and B3-BOTTOM on B2-TOP)'
told middle 'with H = ' '1.01*2.5'
told middle 'friction holds ' '2.5'

# the weights differ by nine orders of magnitude: each body by its own forces
run 4 "$here/stack.inp" light --quiet --set g3=3e-9 --set push3=3.636e-9
says light light.err 'body B3 (node 91 and all others) is free to move along x1'
told light 'nu times N = ' '1.8e-9'
limit lighter stack.inp push2 '0.35*(8.75e-9 + 3)/0.5' --set g2=7e-9
says lighter lighter.err 'bodies B2 and B3 are free to move along x1 together'
told lighter 'nu times N = ' '0.35*3'

limit tips stack.inp push3 '12/4/2' --set height=4 --set g3=1.5 --set nu12=0.9 --set nu23=0.9
says tips tips.err 'body B3 (node 91 and all others) is free to rotate about (2.5, 1), which is node 81 of the contact,'
says tips tips.err 'no pressure there holds it (opening: B3-BOTTOM on B2-TOP)'
told tips 'turns it with ' '0.12'

limit tower stack.inp push3 '(6 + 0.0125)*1.25' --set height=1 --set g2=0.01 --set nu12=2 --set nu23=2
says tower tower.err 'are free to rotate about (2.75, 0.5), which is node 50 of the contact, together'
told tower 'turn them with ' '0.01*(6 + 0.0125)*1.25'

limit towers towers.inp push '(10*0.5 + 12*0.6)/3.125'
says towers towers.err 'bodies RIGHT and LEFT are free to move under their loads: RIGHT can rotate about (2.2, 0), LEFT can rotate about (1, 0)'
says towers towers.err 'no pressure takes up the work of the loads (sliding: LEFT-RIGHT on RIGHT-LEFT; opening: LEFT-BOTTOM on FLOOR and RIGHT-BOTTOM on FLOOR)'

# G = 6, along the slope 6/sqrt(17) + push down, 0.3 of 24/sqrt(17) up
limit slope slope.inp push '(0.3*24 - 6)/sqrt(17)'
says slope slope.err 'free to move along (-0.970143, -0.242536)'
told slope 'with H = ' '6/sqrt(17) + 1.01*1.2/sqrt(17)'
told slope 'nu times N = ' '7.2/sqrt(17)'
told slope '(N = ' '24/sqrt(17)'
finish
