# A plate with a crack whose faces share the nodes of its tips: a deck on standard output.
#
#    awk -v type=CPS4 -v up=12 -v low=12 -v beside=9 -v rows=8 -v angle=0 -v kink=0 -v tips=2 -v shear=0 -v roles="UP, LOW" \
#        -v quadrature=MORTAR -v friction=0.3 -f crack.awk
#
# The plate is 2 by 2 round the origin, the crack of half length 0.4 along x; up, low: elements along its upper and its lower face,
# beside: from each tip to the outline. kink: both faces rise by this slope from the middle. tips=1: the crack begins at the left
# outline. Loads: pressure 1 all round, shear along the crack besides. The scene is turned by `angle` degrees.
function place(x, y) {
   y += kink*(x < 0 ? -x : x)*(1 - (y < 0 ? -y : y))
   return sprintf("%.17g, %.17g", c*x - s*y, s*x + c*y)
}
# node(x, y, side): its number; on the crack each side has its own.
function node(x, y, side,   key) {
   key = sprintf("%.9f %.9f", x, y)
   if (y*y < 1e-18 && x < 0.4 - 1e-9 && x > (tips == 1 ? -9 : -0.4 + 1e-9)) key = key " " side
   if (!(key in number)) { number[key] = ++n_nodes; nodes = nodes n_nodes ", " place(x, y) "\n" }
   return number[key]
}
function add(lists, key, text) { lists[key] = lists[key] text "\n" }
# half(side, n, y1, y2): elements of one half, columns at x[0..m].
function half(side, n, y1, y2,   i, j, k, m, x, y, p, q, xm, ym, e, first, last) {
   m = 0; x[0] = -1
   if (tips != 1) for (i = 1; i <= beside; i++) x[++m] = -1 + 0.6*i/beside
   first = m
   for (i = 1; i <= n; i++) x[++m] = x[first] + (0.4 - x[first])*i/n
   last = m
   for (i = 1; i <= beside; i++) x[++m] = 0.4 + 0.6*i/beside
   for (j = 1; j <= rows; j++) for (i = 1; i <= m; i++) {
      p = x[i - 1]; q = x[i]; xm = (p + q)/2
      y = y1 + (y2 - y1)*(j - 1)/rows; k = y1 + (y2 - y1)*j/rows; ym = (y + k)/2
      corner[1] = node(p, y, side); corner[2] = node(q, y, side); corner[3] = node(q, k, side); corner[4] = node(p, k, side)
      if (degree == 2) {
         mid[1] = node(xm, y, side); mid[2] = node(q, ym, side); mid[3] = node(xm, k, side); mid[4] = node(p, ym, side)
         if (type ~ /[69]/) mid[5] = node(xm, ym, side)
      }
      face["bottom"] = "S1"; face["right"] = "S2"; face["top"] = "S3"; face["left"] = "S4"
      for (k = 1; k <= 4; k++) of[k] = n_elements + 1
      if (type ~ /[36]$/) {
         e = ++n_elements
         add(elements, 1, e ", " corner[1] ", " corner[2] ", " corner[3] (degree == 2 ? ", " mid[1] ", " mid[2] ", " mid[5] : ""))
         add(elements, 1, (e + 1) ", " corner[1] ", " corner[3] ", " corner[4] (degree == 2 ? ", " mid[5] ", " mid[3] ", " mid[4] : ""))
         n_elements = e + 1
         of[3] = of[4] = e + 1
         face["top"] = "S2"; face["left"] = "S3"
      } else {
         e = ++n_elements
         k = corner[1] ", " corner[2] ", " corner[3] ", " corner[4]
         if (degree == 2) k = k ", " mid[1] ", " mid[2] ", " mid[3] ", " mid[4] (type ~ /9/ ? ", " mid[5] : "")
         add(elements, 1, e ", " k)
      }
      if (i == 1) add(surface, "LEFT-" side, of[4] ", " face["left"])
      if (i == m) add(surface, "RIGHT-" side, of[2] ", " face["right"])
      if (side == "UP" && j == rows) add(surface, "TOP", of[3] ", " face["top"])
      if (side == "LOW" && j == 1) add(surface, "BOTTOM", of[1] ", " face["bottom"])
      if (side == "UP" && j == 1 && i > first && i <= last) add(surface, "UP", of[1] ", " face["bottom"])
      if (side == "LOW" && j == rows && i > first && i <= last) add(surface, "LOW", of[3] ", " face["top"])
   }
}
BEGIN {
   if (type == "") type = "CPS4"
   if (up == "") up = 12
   if (low == "") low = up
   if (beside == "") beside = 9
   if (rows == "") rows = 8
   if (friction == "") friction = 0.3
   if (roles == "") roles = "UP, LOW"
   degree = (type ~ /[34]R?$/) ? 1 : 2
   c = cos(angle*atan2(0, -1)/180); s = sin(angle*atan2(0, -1)/180)
   half("LOW", low, -1, 0); half("UP", up, 0, 1)
   print "*HEADING\na crack with shared tips\n*NODE\n" nodes "*ELEMENT, TYPE=" type ", ELSET=ALL\n" elements[1]
   for (name in surface) print "*SURFACE, NAME=" name "\n" surface[name]
   print "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*SURFACE INTERACTION, NAME=I\n*FRICTION\n" friction
   print "*CONTACT PAIR, INTERACTION=I" (quadrature != "" ? ", QUADRATURE=" quadrature : "") "\n" roles
   print "*BOUNDARY\n" node(-1, -1, "LOW") ", 1, 2\n" node(1, -1, "LOW") ", " (s*s > 0.5 ? 1 : 2) "\n*STEP\n*STATIC\n*DSLOAD"
   k = split("TOP BOTTOM LEFT-UP LEFT-LOW RIGHT-UP RIGHT-LOW", outer, " ")
   for (i = 1; i <= k; i++) print outer[i] ", P, 1."
   if (shear) {
      way["TOP"] = c ", " s ", 0."; way["BOTTOM"] = -c ", " (-s) ", 0."
      way["RIGHT-UP"] = way["RIGHT-LOW"] = -s ", " c ", 0."; way["LEFT-UP"] = way["LEFT-LOW"] = s ", " (-c) ", 0."
      for (i = 1; i <= k; i++) print outer[i] ", TRVEC, " shear ", " way[outer[i]]
   }
   print "*CONTACT PRINT\n*NODE PRINT\nU, RF\n*END STEP"
}
