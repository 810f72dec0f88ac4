# The model of docs/user/clusters.md: time and memory over ranks, few contact points, no two elements equal.
#    gnuplot tests/bench/rank-model.gp        draws docs/user/figures/rank-model.png and prints the table
set terminal pngcairo size 1000,420 font 'sans,11'
set output 'docs/user/figures/rank-model.png'
fair(p) = p > 1 ? ((1 + 0.2*(p - 2)/p)/p < 1.0/(p - 1) ? (1 + 0.2*(p - 2)/p)/p : 1.0/(p - 1)) : 1.0
own(p) = 1 - (p - 1)*fair(p)
sides(p) = p < 2 ? 0 : p < 4 ? 1 : p < 16 ? 2 : 4
root(n, p) = p < 2 ? 0 : 1.07*sqrt(n)
held(m) = m > 1 ? m*(160 + 59*log(m)/log(2)) : 0
left(m, p) = 12*(1.4*sides(p)*sqrt(m))**2
first(n, p) = (340*n + held(own(p)*n) + left(own(p)*n, p) + 8*root(n, p)**2)/1e9
other(n, p) = (held(fair(p)*n) + left(fair(p)*n, p) + (p > 2 ? 8*(1.5*root(n, p))**2 : 0))/1e9
serial(n) = 2.1e-6*n
part(n, p) = 6.1*(fair(p)*n/1.25e6)**1.4
top(n, p) = root(n, p)**3/3/2.5e10*(p > 2 ? 2 : 1)
whole(n, p) = serial(n) + part(n, p) + top(n, p)
do for [e = 7:9] {
   do for [k = 0:10:2] {
      p = 2.0**k
      n = 10.0**e
      print sprintf('| 1e%d | %.0f | %.3g | %.3g | %.3g | %.3g | %.3g | %.3g |', e, p, first(n, p), other(n, p), serial(n), part(n, p), top(n, p), whole(n, p))
   }
}
set multiplot layout 1,2
set logscale xy
set samples 11
set xrange [1:1024]
set xtics (1, 4, 16, 64, 256, 1024)
set xlabel 'ranks'
set grid
set key left bottom samplen 2
set title 'seconds: the whole, and what is shared out (dashed)'
plot for [e = 7:9] whole(10.0**e, x) with lines lw 2 lc e title sprintf('10^%d displacements', e), for [e = 7:9] part(10.0**e, x) with lines dt 2 lc e notitle
set key left bottom samplen 2
set title 'GB: the first rank, and another one (dashed)'
plot for [e = 7:9] first(10.0**e, x) with lines lw 2 lc e title sprintf('10^%d displacements', e), for [e = 7:9] other(10.0**e, x) with lines dt 2 lc e notitle
