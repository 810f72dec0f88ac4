#!/bin/sh
# That tests/tools/mutate tells a fault whose text is not there, or stands twice, and counts as it says. Nothing is built.
#    mutate_list.sh PYTHON FOLDER_OF_THE_SOURCES
set -u
python=$1
top=$2
mutate=$top/tests/tools/mutate
work=$(mktemp -d) || exit 9
trap 'rm -rf "$work"' EXIT
failures=0

complain() {
   echo "FAILED: $*"
   failures=$((failures + 1))
}

# lists CODE TEXT: `mutate --list` of the faults in $work/faults ends with this code and says this.
lists() {
   "$python" "$mutate" --faults "$work/faults" --list >"$work/out" 2>&1
   found=$?
   [ $found -eq "$1" ] || { complain "exit $found, expected $1"; cat "$work/out"; }
   grep -qF -- "$2" "$work/out" || { complain "not said: $2"; cat "$work/out"; }
}

cat >"$work/faults" <<'END'
# a line and two lines
@ base/kinds.f90: the module has another name
- module atrito_kinds
+ module other_kinds

@ base/kinds.f90: two lines
- implicit none (type, external)
- private
+ implicit none
END
lists 0 '2 faults, 0 not found'
sed 's/^- module atrito_kinds/- module atrito_kind/' "$work/faults" >"$work/other" && mv "$work/other" "$work/faults"
lists 1 'the module has another name: text not found'
sed -i.old 's/^- module atrito_kind$/- /' "$work/faults"
lists 1 'times'
printf 'words without a mark\n' >>"$work/faults"
lists 1 'neither of'

# the score: what is known to change nothing does not count, what does not build neither, and the last result of a fault counts
cat >"$work/faults" <<'END'
@ base/a.f90: one
- x

@ base/a.f90: two
- x

@ base/a.f90: three
- x
same nothing asks for it

@ stepping/b.f90: four
- x
END
printf 'base/a.f90: one\tsurvived\nbase/a.f90: one\tcaught by unit_base\nbase/a.f90: two\tsurvived\nbase/a.f90: three\tsurvived\n' >"$work/results"
printf 'stepping/b.f90: four\tdoes not build\n' >>"$work/results"
"$python" "$mutate" --faults "$work/faults" --score "$work/results" >"$work/out" || complain "score: exit $?"
grep -q '^all  *1  *2  *1  *50.0 %' "$work/out" || { complain 'the score'; cat "$work/out"; }
grep -qx 'survived: base/a.f90: two' "$work/out" || complain 'the survivor is not named'
[ "$failures" -eq 0 ] && echo 'all hold'
exit $((failures > 0))
