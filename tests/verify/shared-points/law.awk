# The contact law with exact stick and hard contact, from contact.tab: awk -v nu=NU [-v tol=TOL] -f law.awk contact.tab
# Prints the worst error of friction, relative to the largest bound of its pair, or `violated`.
function abs(x) { return x < 0 ? -x : x }
/^# columns:/ { for (i = 3; i <= NF; i++) at[$i] = i - 2 }
/^#/ { next }
{
   n++
   pair[n] = $at["pair"]; p[n] = $at["pressure"]; t[n] = $at["shear"]; slip[n] = $at["slip"]; gap[n] = $at["gap"]
   bound[n] = nu*$at["weighted_pressure"]
   if (bound[n] > largest[pair[n]]) largest[pair[n]] = bound[n]
   if (abs(gap[n]) > place) place = abs(gap[n])
   if (abs(slip[n]) > place) place = abs(slip[n])
}
END {
   for (i = 1; i <= n; i++) {
      if (p[i] < 0 || gap[i] < -1e-9*place || (p[i] > 0 && abs(gap[i]) > 1e-9*place)) { print "violated"; exit }
      error = 0
      if (abs(t[i]) > bound[i]) error = abs(t[i]) - bound[i]
      # the shear on the slave acts against its slip
      if (abs(slip[i]) > 1e-9*place) { d = abs(t[i] + (slip[i] > 0 ? bound[i] : -bound[i])); if (d > error) error = d }
      if (largest[pair[i]] > 0) error /= largest[pair[i]]
      if (error > worst) worst = error
   }
   if (n == 0) print "violated"; else printf "%.3e\n", worst
}
