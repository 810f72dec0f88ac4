#!/bin/sh
# The diffs of docs/developer/tour.md go onto this tree, each by itself. With "build" a tree with all of them is built, too, and runs the
# decks of input/. That takes a minute.
#    tour.sh SOURCE [build]
. "$(dirname "$0")/../tools/lib.sh"
source=$(cd "$1" && pwd)
build=${2:-}
jobs=$(nproc 2>/dev/null || echo 2)
cd "$work" || exit 9
awk '/^```diff/ { n++; on = 1; next } /^```/ { on = 0 } on { print > (n ".diff") }' "$source/docs/developer/tour.md"
[ -f 3.diff ] || fail 'there are no three diffs in the tour'
mkdir tree
(cd "$source" && tar cf - --exclude=./build --exclude=./.git .) | (cd tree && tar xf -)
for change in *.diff; do
   (cd tree && GIT_CEILING_DIRECTORIES="$work" git apply --check -p1 "../$change") || fail "$change does not apply"
done
if [ -n "$build" ]; then
   for change in *.diff; do
      (cd tree && GIT_CEILING_DIRECTORIES="$work" git apply -p1 "../$change") || fail "$change does not apply behind the others"
   done
   if cmake -S tree -B built -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=None -DCMAKE_Fortran_FLAGS=-O0 >log 2>&1 && cmake --build built -j "$jobs" >>log 2>&1; then
      for deck in tree/input/*.inp; do
         name=$(basename "$deck" .inp)
         built/bin/atrito "$deck" --quiet -o "out/$name" >log 2>&1 || fail "$name does not run"
      done
   else
      fail 'the diffs are not built'
      tail -40 log
   fi
fi
finish
