#!/bin/sh
# Runs with more threads than there are idle cores begin anew, once, with threads that sleep soon when they wait; the command line
# stays as it was, and what the environment says of it goes first. Seen by a stand-in for gnuplot, which gets the program's
# environment.
#    waiting.sh ATRITO DECK
. "$(dirname "$0")/lib.sh"
atrito=$1
deck=$2
unset OMP_WAIT_POLICY GOMP_SPINCOUNT
many=$(($(getconf _NPROCESSORS_ONLN) + 1))

mkdir "$work/bin" "$work/a folder"
cp "$deck" "$work/a folder/one deck.inp"
cat >"$work/bin/gnuplot" <<'END'
#!/bin/sh
echo "policy ${OMP_WAIT_POLICY-none} count ${GOMP_SPINCOUNT-none}" >>"$SEEN"
END
chmod +x "$work/bin/gnuplot"
SEEN=$work/seen
export SEEN

# seen EXPECTED ARGUMENT...: what gnuplot saw in a run with these arguments
seen() {
   expected=$1
   shift
   rm -rf "$SEEN" "$work/an output "
   PATH=$work/bin:$PATH "$atrito" "$work/a folder/one deck.inp" -o "$work/an output " --set 'nu = 0.2' --plot --quiet "$@" >"$work/said" 2>&1
   code=$?
   [ -s "$work/an output /nodes.tab" ] || { fail "$*: no tables, exit $code"; cat "$work/said"; }
   head -n 1 "$SEEN" | grep -qx "$expected" || fail "$*: expected '$expected', gnuplot saw '$(head -n 1 "$SEEN")'"
}

seen 'policy none count none' --threads 1
seen 'policy none count 2000' --threads "$many"
OMP_WAIT_POLICY=active
export OMP_WAIT_POLICY
seen 'policy active count none' --threads "$many"
unset OMP_WAIT_POLICY
GOMP_SPINCOUNT=7
export GOMP_SPINCOUNT
seen 'policy none count 7' --threads "$many"

finish
