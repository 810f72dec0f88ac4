# atrito 0.1.0: the deformed mesh over the undeformed one
# In this folder: gnuplot mesh.gp draws mesh.png and mesh.svg again.
# The next run removes this file: to keep changes, copy it under another name.
reset
set encoding utf8
# Columns of mesh.dat: 1 x [L], 2 y [L], 3 u1 [L], 4 u2 [L]; a block a body and kind of line
scale = 10   # of the displacements; change it here
heading = 'two elements on a line'
set xrange [-0.12:2.12]
set yrange [-0.066:1.166]
height = 633
do for [kind in "png svg"] {
if (kind eq "png") { set terminal pngcairo size 1000,height font "sans-serif,11" background "white" enhanced
} else { set terminal svg size 1000,height font "sans-serif,15" background "white" enhanced }
set output "mesh.".kind
dot = kind eq "png" ? 1.0 : 0.6
set size ratio -1
set clip two
set border lt 1 lw 1 lc rgb "#A0A0A0"
set tics nomirror out scale 0.6 textcolor rgb "black" format "%h"
set key noautotitle outside bottom center horizontal Left reverse samplen 2 height 0.7
set xlabel "x [L]"
set ylabel "y [L]"
set style line 8 lt 1 lw 1 lc rgb "#B0B0B0"
set style line 9 lt 1 lw 4 lc rgb "#404040"
set style line 1 lt 1 lc rgb "#0072B2"
set style line 2 lt 1 lc rgb "#D55E00"
set style line 3 lt 1 lc rgb "#009E73"
set style line 4 lt 1 lc rgb "#CC79A7"
set style line 5 lt 1 lc rgb "#56B4E9"
set style line 6 lt 1 lc rgb "#E69F00"
set style line 7 lt 1 lc rgb "#000000"
set tmargin 4
set label 1 heading.sprintf("\ndisplacements drawn %g ×, the largest is %g [L]", scale, 0.01) at screen 0.5, screen 1 - 22.0/height center noenhanced
plot for [i=0:1] "mesh.dat" index i using 1:2 with lines ls 8 title i == 0 ? "undeformed" : "", \
   "mesh.dat" index 0 using ($1 + scale*$3):($2 + scale*$4) with lines ls 1 lw 1, \
   "mesh.dat" index 1 using ($1 + scale*$3):($2 + scale*$4) with lines ls 1 lw 2.5 title 'O''NEIL_{x}' noenhanced, \
   "mesh.dat" index 2 using 1:2 with lines ls 9 title 'FLOOR (rigid)' noenhanced
}
set output
