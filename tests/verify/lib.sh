# What the checks of tests/verify share. POSIX sh and awk. To be sourced with: ATRITO CASE_FOLDER INPUT_FOLDER.
# The check runs in a fresh folder below the build folder; every assertion prints what it measured.
set -u
atrito=$1
here=$2
input=$3
failures=0
compared=$PWD/compared
comparisons=0
rm -f "$compared"

complain() {
   echo "FAILED: $*"
   failures=$((failures + 1))
}

# run CODE DECK FOLDER [options]: runs a deck and expects an exit code.
run() {
   wanted=$1
   deck=$2
   folder=$3
   shift 3
   [ ! -e "$folder" ] || rm -rf "$folder"
   "$atrito" "$deck" -o "$folder" "$@" >"$folder.out" 2>"$folder.err"
   found=$?
   [ "$found" -eq "$wanted" ] || { complain "$deck $*: exit $found, expected $wanted"; cat "$folder.err"; }
}

# stack NAME FORM [NAME=VALUE ...]: a deck of the stack.awk of the case, run.
stack() {
   folder=$1
   form=$2
   shift 2
   set -- "$@" end
   while [ "$1" != end ]; do set -- "$@" -v "$1"; shift; done
   shift
   awk "$@" -f "$here/stack.awk" </dev/null >"$folder.inp"
   run 0 "$folder.inp" "$folder" --digits 17 --contact "$form" --quiet
}

# summary FOLDER QUANTITY: a value of summary.tab.
summary() {
   awk -v q="$2" '!/^#/ && $3 == q { print $4 }' "$1/summary.tab"
}

# column FILE NAME: a column of a table.
column() {
   awk -v name="$2" '/^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) k = i - 2 } !/^#/ { print $k }' "$1"
}

# drop_columns FILE NAME...: a table without some of its columns.
drop_columns() {
   table=$1
   shift
   awk -v names="$*" 'BEGIN { n = split(names, list, " "); for (i = 1; i <= n; i++) drop[list[i]] = 1 }
      /^# columns:/ { for (i = 3; i <= NF; i++) gone[i - 2] = $i in drop }
      /^# (columns|dimensions):/ { line = $1 " " $2; for (i = 3; i <= NF; i++) if (!gone[i - 2]) line = line " " $i; print line; next }
      /^#/ { print; next }
      { line = ""; for (i = 1; i <= NF; i++) if (!gone[i]) line = line " " $i; print line }' "$table" >"$table.rest"
   mv "$table.rest" "$table"
}

# near WHAT VALUE EXPECTED TOLERANCE: |value - expected| <= tolerance. Nothing but a finite number passes. All of them are judged by
# one awk, when the check finishes: a thousand of its own each take longer than the runs.
near() {
   printf '%s\001%s\001%s\001%s\002' "$1" "$2" "$3" "$4" >>"$compared"
   comparisons=$((comparisons + 1))
}

# judge_numbers: the comparisons so far. (To mawk a NaN is equal to everything, so NaNs are found by how they are written.)
judge_numbers() {
   [ "$comparisons" -eq 0 ] || awk -v least="$comparisons" '
      BEGIN { RS = "\002"; FS = "\001"; number = "^[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$" }
      { good = NF == 4 && $2 ~ number && $3 ~ number && $4 ~ number
        d = $2 - $3; if (d < 0) d = -d
        good = good && sprintf("%g", d) ~ number && d <= $4 + 0
        printf "%s%s: %s, expected %s, off by %.2e of %s\n", good ? "" : "FAILED: ", $1, $2, $3, d, $4
        if (!good) bad = 1 }
      END { if (NR < least) { print "FAILED: comparisons are lost"; bad = 1 }
        exit bad }' "$compared" || failures=$((failures + 1))
   rm -f "$compared"
   comparisons=0
}

# below WHAT VALUE LIMIT: 0 <= value < limit.
below() {
   near "$1" "$2" 0 "$3"
}

# all_near WHAT FILE COLUMN EXPECTED TOLERANCE: every row of a column, and at least one.
all_near() {
   worst=$(awk -v name="$3" -v b="$4" '
      /^# columns:/ { for (i = 3; i <= NF; i++) if ($i == name) k = i - 2 }
      /^#/ { next }
      { rows++; if ($k !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/) bad = 1
        d = $k - b; if (d < 0) d = -d; if (d > worst) worst = d; if (sprintf("%g", d) ~ /n/) bad = 1 }
      END { if (bad || rows == 0) print "none"; else printf "%.17g", worst }' "$2")
   near "$1: worst difference from $4" "$worst" 0 "$5"
}

# same_tables WHAT A B TOLERANCE [NAME=FACTOR ...]: A times the factors equals B, column by column, relative to the largest value
# of the column; columns without a factor that hold integers must be equal.
same_tables() {
   what=$1
   a=$2
   b=$3
   tol=$4
   shift 4
   [ -s "$a" ] && [ -s "$b" ] || { complain "$what: a table is missing"; return; }
   if ! awk -v tol="$tol" -v factors="$*" -v what="$what" '
      BEGIN { n = split(factors, list, " "); for (i = 1; i <= n; i++) { split(list[i], f, "="); factor[f[1]] = f[2]
            if (f[2] !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/) { bad = 1; print what ": factor " list[i] } } }
      FNR == 1 { file++ }
      /^# columns:/ { for (i = 3; i <= NF; i++) name[i - 2] = $i; columns = NF - 2
         header = ""; for (i = 3; i <= NF; i++) header = header " " $i
         if (file == 1) heading = header; else if (header != heading) { bad = 1; print what ": other columns" } }
      /^#/ { next }
      file == 1 { na++; for (i = 1; i <= NF; i++) first[na, i] = $i; next }
      { nb++
        for (i = 1; i <= NF; i++) {
           x = first[nb, i]; y = $i
           if (!(name[i] in factor) && x ~ /^-?[0-9]+$/ && y ~ /^-?[0-9]+$/) { if (x != y) { bad = 1; print what ": row " nb " " name[i] ": " x " and " y } continue }
           if (x !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/ || y !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/) { if (x != y || x ~ /[nN]a[nN]/) { bad = 1; print what ": " x " and " y } continue }
           s = (name[i] in factor) ? factor[name[i]] : 1
           d = x*s - y; if (d < 0) d = -d
           if (d > worst[i]) worst[i] = d
           if (sprintf("%g", d) ~ /n/) { bad = 1; print what ": " x " and " y }
           z = (y < 0) ? -y : y; if (z > largest[i]) largest[i] = z } }
      END {
        if (na != nb || nb == 0) { print what ": " na + 0 " and " nb + 0 " rows"; exit 1 }
        for (i = 1; i <= columns; i++) if (worst[i] > 0) {
           r = (largest[i] > 0) ? worst[i]/largest[i] : 1e300
           if (r > most) most = r
           if (!(r <= tol + 0)) { bad = 1; print what ": " name[i] " differs by " r } }
        printf "%s: worst difference %.2e of %s\n", what, most, tol
        exit bad }' "$a" "$b"; then
      complain "$what"
   fi
}

# says WHAT FILE TEXT: a file holds a text.
says() {
   grep -qF -- "$3" "$2" || complain "$1: not found: $3"
}

# absent FOLDER: nothing was written.
absent() {
   [ ! -e "$1" ] || complain "$1 was written"
}

# field_near WHAT FILE COLUMN EXPRESSION TOLERANCE: every row of a column is an awk expression in node (the column behind step), x, y.
field_near() {
   worst=$(awk -v wanted="$3" '
      /^# columns:/ { for (i = 3; i <= NF; i++) place[$i] = i - 2; next }
      /^#/ { next }
      { rows++
        x = $place["x"]; y = $place["y"]; node = $2; found = $place[wanted]
        expected = ('"$4"')
        if (found !~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/ || sprintf("%g", expected) ~ /n/) bad = 1
        d = found - expected; if (d < 0) d = -d; if (d > most) most = d; if (sprintf("%g", d) ~ /n/) bad = 1 }
      END { if (bad || rows == 0 || !(wanted in place)) print "none"; else printf "%.17g", most }' "$2")
   near "$1: worst difference from $4" "$worst" 0 "$5"
}

# value EXPRESSION: its value by awk, all digits.
value() {
   awk "BEGIN { printf \"%.17g\", ($1) }" </dev/null
}

# quick_pictures: from here on contours are drawn coarsely, which takes a tenth of the time.
# have_gnuplot: whether there are pictures at all.
quick_pictures() {
   have_gnuplot=no
   REAL_GNUPLOT=$(command -v gnuplot) || return 0
   have_gnuplot=yes
   mkdir -p quick
   cp "$here/../quick_gnuplot" quick/gnuplot
   PATH=$PWD/quick:$PATH
   export PATH REAL_GNUPLOT
}

# fine PATTERN COMMAND...: pictures whose scripts are of the pattern are drawn as they are.
fine() {
   FINE=$1
   export FINE
   shift
   "$@"
   FINE=none
}

finish() {
   judge_numbers
   [ "$failures" -eq 0 ] && echo "all hold"
   exit $((failures > 0))
}
