# atrito 0.1.0: quantities of several runs against the parameter that varies
# In this folder: gnuplot overlay-summary.gp draws overlay-summary.png and overlay-summary.svg again.
# The next run removes this file: to keep changes, copy it under another name.
reset
set encoding utf8
# Columns of overlay-summary.dat: 1 parameter, 2 normal resultant [F], 3 effective area [%],
# 4 largest pressure [F/L^2], 5 largest shear [F/L^2], 6 is 1 if not converged; a block a pair
pairs = 1
heading = 'two elements on a line'
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
set xrange [0.85303942:234.45575]
axis_label = 'q'
x_format = "%h"
set logscale x; x_format = "10^{%T}"
do for [kind in "png svg"] {
if (kind eq "png") { set terminal pngcairo size 1000,height font "sans-serif,11" background "white" enhanced
} else { set terminal svg size 1000,height font "sans-serif,15" background "white" enhanced }
set output "overlay-summary.".kind
dot = kind eq "png" ? 1.0 : 0.6
set multiplot title heading noenhanced
set style line 1 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#0072B2"
set style line 2 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#D55E00"
set style line 3 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#009E73"
set style line 4 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#CC79A7"
set style line 5 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#56B4E9"
set style line 6 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#E69F00"
set style line 7 lt 1 lw 1.8 pt 7 ps 0.9*dot lc rgb "#000000"
set rmargin at screen right; set tmargin at screen top(1); set bmargin at screen bottom(1)
set key noautotitle at screen right + 0.015, screen top(1) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "normal resultant [F]" at screen 0.03, screen middle(1) center rotate by 90
if (1 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [1.4/unit:12.6/unit]
plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($2/unit) with linespoints ls (i-1)%7+1, "overlay-summary.dat" using 1:($6 > 0 ? $2/unit : NaN) with points pt 6 lw 1.5 ps 2*dot lc rgb "black" title "not converged"
set rmargin at screen right; set tmargin at screen top(2); set bmargin at screen bottom(2)
set key noautotitle at screen right + 0.015, screen top(2) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "effective area [%]" at screen 0.03, screen middle(2) center rotate by 90
if (2 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [73.32/unit:76.68/unit]
plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($3/unit) with linespoints ls (i-1)%7+1, "overlay-summary.dat" using 1:($6 > 0 ? $3/unit : NaN) with points pt 6 lw 1.5 ps 2*dot lc rgb "black"
set rmargin at screen right; set tmargin at screen top(3); set bmargin at screen bottom(3)
set key noautotitle at screen right + 0.015, screen top(3) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "max. pressure [F/L^2]" at screen 0.03, screen middle(3) center rotate by 90
if (3 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [2.1/unit:18.9/unit]
plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($4/unit) with linespoints ls (i-1)%7+1, "overlay-summary.dat" using 1:($6 > 0 ? $4/unit : NaN) with points pt 6 lw 1.5 ps 2*dot lc rgb "black"
set rmargin at screen right; set tmargin at screen top(4); set bmargin at screen bottom(4)
set key noautotitle at screen right + 0.015, screen top(4) left top Left reverse samplen 2.5 spacing 1.15
set label 1 "max. |shear| [F/L^2]" at screen 0.03, screen middle(4) center rotate by 90
if (4 == panels) { set format x x_format; set xlabel axis_label noenhanced } else { set format x ""; unset xlabel }
unit = 1e0
set yrange [0.7332/unit:0.7668/unit]
plot for [i=1:pairs] "overlay-summary.dat" index i-1 using 1:($5/unit) with linespoints ls (i-1)%7+1, "overlay-summary.dat" using 1:($6 > 0 ? $5/unit : NaN) with points pt 6 lw 1.5 ps 2*dot lc rgb "black"
unset multiplot
}
set output
