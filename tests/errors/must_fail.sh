#!/bin/sh
# The runner notices every kind of wrong case, and says which.
#    must_fail.sh ATRITO WORK_FOLDER
set -u
here=$(dirname "$0")
bad=0
while IFS='|' read -r name complaint; do
   if said=$(sh "$here/run_case.sh" "$1" "$here/must-fail/wrong.txt" "$name" "$2/$name" 2>&1 </dev/null); then
      echo "$name: nothing was wrong"
      bad=1
   elif ! printf '%s\n' "$said" | grep -qF -- "$complaint"; then
      echo "$name: not said: $complaint"
      printf '%s\n' "$said"
      bad=1
   fi
done <<'END'
wrong-exit|exit 2, expected 5
wrong-count|not 2 errors
wrong-place|no error at 35:5
wrong-text|not said: [E-DOF] dof 8
unknown-word|unknown line content
asks-nothing|asks for nothing
no-such-line|the scene has no line 44
no-such-scene|no scene ../seen.inp
no-such-case|0 times in the catalogue
sound-deck|a table was written
sound-deck|an output folder was made
END
exit $bad
