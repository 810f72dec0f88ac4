# A mesh of Gmsh, format 4.1, in another form: -v form=22 for format 2.2, -v form=inp for an Abaqus file as Gmsh writes it, with
# -v state=CPE for the elements. Triangles of six nodes and lines of three.
function name(dim, tag) { return dim SUBSEP tag }
/^\$/ { section = $1; n = 0; left = 0; next }
section == "$PhysicalNames" && NF == 3 { gsub(/"/, "", $3); named[name($1, $2)] = $3 }
section == "$Entities" {
   if (n++ == 0) { points = $1; curves = $2; next }
   dim = n - 1 <= points ? 0 : n - 1 <= points + curves ? 1 : 2
   k = dim == 0 ? 5 : 8
   if ($k > 0) group[name(dim, $1)] = $(k + 1)
}
section == "$Nodes" {
   if (n++ == 0) { next }
   if (left == 0) { left = 2*$4; half = $4; next }
   if (left > half) id[half - left + half] = $1
   else { node[++nodes] = id[half - left]; place[nodes] = $1 " " $2 " " $3 }
   left--
}
section == "$Elements" {
   if (n++ == 0) { next }
   if (left == 0) { dim = $1; tag = $2; kind = $3; left = $4; next }
   number[++elements] = $1
   of[elements] = name(dim, tag)
   dims[elements] = dim
   tags[elements] = tag
   kinds[elements] = kind
   $1 = ""
   list[elements] = $0
   left--
}
END {
   if (form == "22") {
      print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames"
      for (g in named) count++
      print count
      for (g in named) { split(g, key, SUBSEP); printf "%d %d \"%s\"\n", key[1], key[2], named[g] }
      print "$EndPhysicalNames\n$Nodes\n" nodes
      for (i = 1; i <= nodes; i++) print node[i], place[i]
      print "$EndNodes\n$Elements\n" elements
      for (e = 1; e <= elements; e++) print number[e], kinds[e], 2, group[of[e]] + 0, tags[e] list[e]
      print "$EndElements"
      exit
   }
   print "*Heading\n mesh.inp\n*NODE"
   for (i = 1; i <= nodes; i++) { gsub(/ /, ", ", place[i]); print node[i] ", " place[i] }
   print "******* E L E M E N T S *************"
   for (e = 1; e <= elements; e++) {
      split(list[e], at, " ")
      if (of[e] != before) printf "*ELEMENT, type=%s, ELSET=%s%d\n", dims[e] == 1 ? "T3D3" : state "6", dims[e] == 1 ? "Line" : "Surface", tags[e]
      before = of[e]
      if (dims[e] == 1) printf "%d, %d, %d, %d\n", number[e], at[1], at[3], at[2]
      else printf "%d, %d, %d, %d, %d, %d, %d\n", number[e], at[1], at[2], at[3], at[4], at[5], at[6]
      sets[dims[e] SUBSEP group[of[e]]] = sets[dims[e] SUBSEP group[of[e]]] number[e] ",\n"
   }
   for (g in named) { print "*ELSET,ELSET=" named[g]; printf "%s", sets[g] }
}
