# atrito 0.1.0: contact pair 1 along s
# In this folder: gnuplot contact-1.gp draws contact-1.png and contact-1.svg again.
# The next run removes this file: to keep changes, copy it under another name.
reset
set encoding utf8
# Columns of contact.tab: 2 pair, 4 s [L], 7 gap [L], 8 pressure [F/L^2], 9 weighted pressure [F/L^2],
# 10 shear [F/L^2], 11 slip [L], 12 status (0 open, 1 stick, 2 slip)
pair = 1
col(c) = column(2) == pair ? column(c)/unit : NaN
marked(c, status) = column(12) == status ? col(c) : NaN
table = "../contact.tab"
heading = 'two elements on a line'
pair_line = 'pair 1: UNDER on FLOOR;  ν = 0.5, ε = 0.001, ρ = 0.25'
panels = 4
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
nu = 0.5
eps = 0.001
do for [kind in "png svg"] {
if (kind eq "png") { set terminal pngcairo size 1000,height font "sans-serif,11" background "white" enhanced
} else { set terminal svg size 1000,height font "sans-serif,15" background "white" enhanced }
set output "contact-1.".kind
dot = kind eq "png" ? 1.0 : 0.6
set style line 1 lt 1 lw 2 lc rgb "#0072B2"
set style line 2 lw 2 dt (8,5) lc rgb "#E69F00"
set style line 3 lw 1.5 dt (7,5) lc rgb "#404040"
set style line 4 pt 6 lw 1.5 lc rgb "black" ps dot*1
set style line 5 pt 7 lw 1.5 lc rgb "black" ps dot*1
set style line 6 pt 9 lw 1.5 lc rgb "#D55E00" ps 1.2*dot*1
set multiplot title heading."\n".pair_line noenhanced
set rmargin at screen right; set tmargin at screen top(1); set bmargin at screen bottom(1)
set key noautotitle at screen right + 0.015, screen top(1) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "pressure [F/L^2]" at screen 0.03, screen middle(1) center rotate by 90
if (1 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [-0.18/unit:3.18/unit]
plot table using 4:(col(8)) with lines ls 1 title "pressure p", table using 4:(col(9)) with lines ls 2 title "weighted, S_{ρ}(p)", table using 4:(marked(8,0)) with points ls 4 title "open", table using 4:(marked(8,1)) with points ls 5 title "stick", table using 4:(marked(8,2)) with points ls 6 title "slip"
set rmargin at screen right; set tmargin at screen top(2); set bmargin at screen bottom(2)
set key noautotitle at screen right + 0.015, screen top(2) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "shear [F/L^2]" at screen 0.03, screen middle(2) center rotate by 90
if (2 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [-1.68/unit:1.68/unit]
plot table using 4:(col(10)) with lines ls 1 title "shear", table using 4:(nu*col(9)) with lines ls 3 title "± ν S_{ρ}(p)", table using 4:(-nu*col(9)) with lines ls 3, table using 4:(marked(10,0)) with points ls 4, table using 4:(marked(10,1)) with points ls 5, table using 4:(marked(10,2)) with points ls 6
set rmargin at screen right; set tmargin at screen top(3); set bmargin at screen bottom(3)
set key noautotitle at screen right + 0.015, screen top(3) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "slip [10^{-3} L]" at screen 0.03, screen middle(3) center rotate by 90
if (3 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e-3
set yrange [-0.01066/unit:0.00166/unit]
plot table using 4:(col(11)) with lines ls 1 title "slip u_T", eps/unit with lines ls 3 title "± ε", -eps/unit with lines ls 3, table using 4:(marked(11,0)) with points ls 4, table using 4:(marked(11,1)) with points ls 5, table using 4:(marked(11,2)) with points ls 6
set rmargin at screen right; set tmargin at screen top(4); set bmargin at screen bottom(4)
set key noautotitle at screen right + 0.015, screen top(4) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "gap [10^{-3} L]" at screen 0.03, screen middle(4) center rotate by 90
if (4 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e-3
set yrange [-6.0106e-4/unit:0.01060006/unit]
plot table using 4:(col(7)) with lines ls 1 title "gap", table using 4:(marked(7,0)) with points ls 4, table using 4:(marked(7,1)) with points ls 5, table using 4:(marked(7,2)) with points ls 6
unset multiplot
}
set output
