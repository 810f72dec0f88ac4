# Checks equation (8) at the points of a scene, from what a run printed and nothing else: awk -f check-law.awk DECK contact.tab nodes.tab
# The deck must have been written by scene_deck or random_decks, the tables with 17 digits. Prints `holds` with the worst errors,
# or `violated` and where; exit code 1 then.
#
# Errors are relative: of pressures and stresses to the largest friction bound, of places to the largest displacement, gap
# or distance. What a run may have: 1e-7 of the stress (the outer loop stops at 1e-8 of the bound), 1e-9 of the place in
# the law of the pressure, 1e-7 of the place between the table of the points and that of the nodes.
function abs(x) { return x < 0 ? -x : x }
function max(a, b) { return a > b ? a : b }
function value(name, other) { return name in scene ? scene[name] : other }
function fail(what, at) { if (!bad) printf "violated at point %d: %s\n", at, what; bad = 1 }
function is_number(x) { return x ~ /^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$/ }
# exp(rho^2/(r^2 - rho^2))
function kernel(q) { return q < 1 ? exp(1/((q - 1)*(q + 1))) : 0 }

FNR == 1 { file++ }
file == 1 && /^[*][*] scene: / { scene[$3] = $5; next }
file == 1 { next }
/^# NOT CONVERGED/ { fail("marked NOT CONVERGED", 0) }
/^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2 }
/^#/ { next }
file == 2 {
   n++
   for (i = 1; i <= NF; i++) if (!is_number($i)) fail("not a number: " $i, n)
   x[n] = $place["x"] + 0; y[n] = $place["y"] + 0; gap[n] = $place["gap"] + 0; p[n] = $place["pressure"] + 0
   shear[n] = $place["shear"] + 0; slip[n] = $place["slip"] + 0; weight[n] = $place["weight"] + 0
   printed[n] = $place["weighted_pressure"] + 0
   next
}
file == 3 {
   m++
   for (i = 1; i <= NF; i++) if (!is_number($i)) fail("not a number in nodes.tab: " $i, m)
   xn[m] = $place["x"] + 0; yn[m] = $place["y"] + 0; u1[m] = $place["u1"] + 0; u2[m] = $place["u2"] + 0
   size = max(size, max(abs(u1[m]), abs(u2[m])))
   coordinate = max(coordinate, max(abs(xn[m]), abs(yn[m])))
}

# The displacement of the lower body's top at x: interpolation of its order between the nodes of the element there.
function lower_at(at, field,    i, o, first, t, a, b, c) {
   o = value("lower_order", 1)
   first = lower_top
   while (first + o < lower_last && xn[first + o] < at) first += o
   t = (at - xn[first])/(xn[first + o] - xn[first])
   # a point that hangs over the end, by 1e-6 of an element at most, moves with the end
   if (t < 0) t = 0
   if (t > 1) t = 1
   a = field == 1 ? u1[first] : u2[first]
   b = field == 1 ? u1[first + o] : u2[first + o]
   if (o == 1) return (1 - t)*a + t*b
   c = field == 1 ? u1[first + 1] : u2[first + 1]
   return (1 - t)*(1 - 2*t)*a + 4*t*(1 - t)*c + t*(2*t - 1)*b
}

END {
   if (file < 3 || n == 0 || m == 0) { print "violated: a table is missing"; exit 1 }
   nu = value("nu", 0.3); eps = value("eps", 0); rho = value("rho", 0); delta = value("delta", 0)
   # the average, on the printed points
   least = 1e300
   for (j = 2; j <= n; j++) { d = sqrt((x[j] - x[j - 1])^2 + (y[j] - y[j - 1])^2); if (d < least) least = d }
   for (j = 1; j <= n; j++) {
      sum = 0; all = 0
      for (k = 1; k <= n; k++) {
         d = sqrt((x[j] - x[k])^2 + (y[j] - y[k])^2)
         w = rho <= least ? (j == k) : kernel(d/rho)*weight[k]
         sum += w; all += w*p[k]
      }
      tau[j] = nu*all/sum
      top = max(top, tau[j]); pmax = max(pmax, p[j])
      size = max(size, max(abs(gap[j]), abs(slip[j])))
   }
   # the nodes: the lower body's top row is its last, the upper one's bottom row its first
   o = value("lower_order", 1)
   lower_last = (value("lower_nx", 4)*o + 1)*(value("lower_ny", 3)*o + 1)
   lower_top = lower_last - value("lower_nx", 4)*o
   dy = (value("gap_right", 0) - value("gap_left", 0))/value("upper_width", 1)
   length_ = sqrt(1 + dy^2)
   o = value("upper_order", 1)
   skip = 0
   while (abs(xn[lower_last + 1 + skip] - x[1]) > 1e-9*abs(least) && skip < value("upper_nx", 4)*o) skip++
   for (j = 1; j <= n; j++) {
      if (p[j] < 0) fail("tension " p[j], j)
      if (p[j] > 0) law = max(law, abs(gap[j] + delta*p[j])/max(size, delta*pmax))
      if (p[j] == 0) law = max(law, -gap[j]/(size > 0 ? size : 1))
      if (law > 1e-9) fail("pressure " p[j] " at gap " gap[j], j)
      t = -shear[j]
      if (abs(t) > tau[j]) excess = max(excess, (abs(t) - tau[j])/(top > 0 ? top : 1e-300))
      if (excess > 1e-7) fail("shear " t " beyond the bound " tau[j], j)
      if (abs(slip[j]) > eps + 1e-9*size) {
         direction = max(direction, abs(t - (slip[j] > 0 ? tau[j] : -tau[j]))/(top > 0 ? top : 1e-300))
         if (direction > 1e-7) fail("shear " t " with bound " tau[j] " at slip " slip[j], j)
      } else if (eps > 1e-9*size) {
         part = slip[j]/eps; if (part > 1) part = 1; if (part < -1) part = -1
         stick = max(stick, abs(t - tau[j]*part)/(top > 0 ? top : 1e-300) - 1e-9*size/eps)
         if (stick > 1e-7) fail("shear " t " at slip " slip[j] " below eps, bound " tau[j], j)
      }
      if (abs(printed[j] - tau[j]/(nu > 0 ? nu : 1)) > 1e-12*pmax && nu > 0) fail("weighted pressure " printed[j], j)
      # gap and slip of the nodes
      i = lower_last + skip + j
      distance = (y[j] - yn[lower_top])*length_
      at = x[j] + dy*(y[j] - yn[lower_top])
      rel1 = u1[i] - lower_at(at, 1); rel2 = u2[i] - lower_at(at, 2)
      from_nodes = distance - (rel1*dy - rel2)/length_
      # a distance that is round-off of the coordinates is none
      off = max(off, max(abs(from_nodes - gap[j]) - 2e-15*coordinate, 0)/(size > 0 ? size : 1))
      off = max(off, abs((rel1 + rel2*dy)/length_ - slip[j])/(size > 0 ? size : 1))
      if (off > 1e-7) fail("gap or slip is not that of the nodes: " gap[j] " " from_nodes " " slip[j] " " (rel1 + rel2*dy)/length_, j)
   }
   if (bad) exit 1
   printf "holds %.1e %.1e %.1e %.1e %.1e\n", law, excess, direction, stick, off
}
