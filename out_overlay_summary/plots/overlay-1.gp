# atrito 0.1.0: contact pair 1 of several runs along s
# In this folder: gnuplot overlay-1.gp draws overlay-1.png and overlay-1.svg again.
# The next run removes this file: to keep changes, copy it under another name.
reset
set encoding utf8
# Columns of contact.tab: 2 pair, 4 s [L], 7 gap [L], 8 pressure [F/L^2], 9 weighted pressure [F/L^2],
# 10 shear [F/L^2], 11 slip [L]
pair = 1
col(c) = column(2) == pair ? column(c)/unit : NaN
runs = 3
array folder[runs]; array label[runs]; array value_of[runs]
folder[1] = '../q=1'; label[1] = 'q=1'; value_of[1] = 1.00000000000e+00
folder[2] = '../q=2'; label[2] = 'q=2'; value_of[2] = 3.00000000000e+00
folder[3] = '../q=3'; label[3] = 'q=3'; value_of[3] = 2.00000000000e+02
table(i) = folder[i]."/contact.tab"
heading = 'two elements on a line'
pair_line = 'pair 1;  NOT CONVERGED: q=2'
panels = 5
height = 120 + 230*panels
top(i) = 1 - (60.0 + (i - 1)*230)/height
bottom(i) = top(i) - 205.0/height
middle(i) = 0.5*top(i) + 0.5*bottom(i)
set border 3 lt 1 lw 1 lc rgb "#404040"
set tics nomirror out scale 0.6 textcolor rgb "black"
set grid lt 1 lw 1 lc rgb "#E0E0E0"
set xzeroaxis lt 1 lw 1 lc rgb "#808080"
set format y "%h"
set lmargin at screen 0.13
right = 0.78
set xrange [0:2]
axis_label = "s [L]"
x_format = "%h"
right = 0.78   # leaves room for the names
do for [kind in "png svg"] {
if (kind eq "png") { set terminal pngcairo size 1000,height font "sans-serif,11" background "white" enhanced
} else { set terminal svg size 1000,height font "sans-serif,15" background "white" enhanced }
set output "overlay-1.".kind
dot = kind eq "png" ? 1.0 : 0.6
set multiplot title heading."\n".pair_line noenhanced
set style line 1 lw 1.8 lc rgb "#0072B2" dt 1      pt 7 ps 0.8*dot
set style line 2 lw 1.8 lc rgb "#D55E00" dt 1      pt 5 ps 0.8*dot
set style line 3 lw 1.8 lc rgb "#009E73" dt 1      pt 9 ps 0.8*dot
set rmargin at screen right; set tmargin at screen top(1); set bmargin at screen bottom(1)
set key noautotitle at screen right + 0.015, screen top(1) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "pressure [F/L^2]" at screen 0.03, screen middle(1) center rotate by 90
if (1 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [-1.08/unit:19.08/unit]
plot for [i=1:runs] table(i) using 4:(col(8)) with linespoints ls i title label[i] noenhanced
set rmargin at screen right; set tmargin at screen top(2); set bmargin at screen bottom(2)
set key noautotitle at screen right + 0.015, screen top(2) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "weighted pressure [F/L^2]" at screen 0.03, screen middle(2) center rotate by 90
if (2 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [-0.18/unit:3.18/unit]
plot for [i=1:runs] table(i) using 4:(col(9)) with linespoints ls i
set rmargin at screen right; set tmargin at screen top(3); set bmargin at screen bottom(3)
set key noautotitle at screen right + 0.015, screen top(3) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "shear [F/L^2]" at screen 0.03, screen middle(3) center rotate by 90
if (3 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [-0.8025/unit:0.1775/unit]
plot for [i=1:runs] table(i) using 4:(col(10)) with linespoints ls i
set rmargin at screen right; set tmargin at screen top(4); set bmargin at screen bottom(4)
set key noautotitle at screen right + 0.015, screen top(4) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "slip [10^{-3} L]" at screen 0.03, screen middle(4) center rotate by 90
if (4 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e-3
set yrange [-0.01066/unit:0.00166/unit]
plot for [i=1:runs] table(i) using 4:(col(11)) with linespoints ls i
set rmargin at screen right; set tmargin at screen top(5); set bmargin at screen bottom(5)
set key noautotitle at screen right + 0.015, screen top(5) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "gap [10^{-3} L]" at screen 0.03, screen middle(5) center rotate by 90
if (5 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e-3
set yrange [-6.0106e-4/unit:0.01060006/unit]
plot for [i=1:runs] table(i) using 4:(col(7)) with linespoints ls i
unset multiplot
}
set output
