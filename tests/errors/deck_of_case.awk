# Makes the deck of a case of a catalogue, and prints what is expected of it (the format stands in README.md).
#    awk -v wanted=CASE -v folder=FOLDER_OF_CATALOGUE -v deck=DECK_TO_WRITE -f deck_of_case.awk CATALOGUE
function complain(text) {
   print FILENAME ": " text >"/dev/stderr"
   failed = 1
   exit 9
}
# What stands behind the bar; a backslash and three octal digits are a byte.
function text_of(line,   head, tail, code) {
   sub(/^[^|]*\| ?/, "", line)
   head = ""
   while (match(line, /\\[0-7][0-7][0-7]/)) {
      code = 64*substr(line, RSTART + 1, 1) + 8*substr(line, RSTART + 2, 1) + substr(line, RSTART + 3, 1)
      head = head substr(line, 1, RSTART - 1) sprintf("%c", code)
      line = substr(line, RSTART + 4)
   }
   return head line
}
function line_number(text) {
   if (text !~ /^[0-9]+$/) complain("no number of a line: " text)
   return text + 0
}
# Writes the scene with its changes.
function write_scene(   line, i, n) {
   while ((getline line <(folder "/" scene)) > 0) {
      n++
      if (n == cut) {
         printf "%s", cut_text >deck
         return
      }
      if (!(n in dropped)) print (n in changed) ? changed[n] : line >deck
      for (i = 1; i <= added[n]; i++) print addition[n, i] >deck
   }
   if (n == 0) complain("no scene " scene)
   for (i in changed) if (i + 0 > n) complain("the scene has no line " i)
   for (i in added) if (i + 0 > n) complain("the scene has no line " i)
   for (i in dropped) if (i + 0 > n) complain("the scene has no line " i)
}
BEGIN { scene = "scene.inp" }
{ sub(/\r$/, "") }
$1 == "case" {
   active = $2 == wanted
   found += active
   next
}
!active || /^[ \t]*$/ || /^#/ { next }
/^\|/ { own[++n_own] = text_of($0); next }
$1 == "line" { changed[line_number($2)] = text_of($0); next }
$1 == "after" { k = line_number($2); addition[k, ++added[k]] = text_of($0); next }
$1 == "cut" { cut = line_number($2); cut_text = text_of($0); next }
$1 == "scene" { scene = $2; next }
$1 == "file" { file = $2; next }
$1 == "empty" { empty = 1; next }
$1 == "without" {
   n = split($2, ends, "-")
   for (k = line_number(ends[1]); k <= line_number(ends[n]); k++) dropped[k] = 1
   next
}
{ print }                                         # an expectation
END {
   if (failed) exit 9
   if (found != 1) {
      print "case " wanted ": " found + 0 " times in the catalogue" >"/dev/stderr"
      exit 9
   }
   printf "" >deck
   if (file != "") system("cat '" folder "/" file "' >'" deck "'")
   else if (n_own > 0) for (k = 1; k <= n_own; k++) print own[k] >deck
   else if (!empty) write_scene()
}
