#!/bin/sh
# The diffs of docs/developer/tour.md go onto this tree, each by itself. With a folder to build in, each is built there as well, and the
# tests run that it brings; that takes minutes, so it is for whoever changes the tour.
#    tour.sh SOURCE [BUILD]
. "$(dirname "$0")/../tools/lib.sh"
source=$(cd "$1" && pwd)
build=${2:-}
cd "$work" || exit 9
awk '/^```diff/ { n++; on = 1; next } /^```/ { on = 0 } on { print > (n ".diff") }' "$source/docs/developer/tour.md"
[ -f 3.diff ] || fail 'there are no three diffs in the tour'
mkdir tree
(cd "$source" && tar cf - --exclude=./build --exclude=./.git .) | (cd tree && tar xf -)
for change in *.diff; do
   (cd tree && GIT_CEILING_DIRECTORIES="$work" git apply --check -p1 "../$change") || fail "$change does not apply"
   [ -n "$build" ] || continue
   (cd tree && GIT_CEILING_DIRECTORIES="$work" git apply -p1 "../$change")
   cmake -S tree -B "$build" -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 && cmake --build "$build" -j2 >>"$work/log" 2>&1 &&
      ctest --test-dir "$build" -L 'unit|regression' -j2 >>"$work/log" 2>&1 || { fail "$change:"; tail -40 "$work/log"; }
   (cd tree && GIT_CEILING_DIRECTORIES="$work" git apply -R -p1 "../$change")
done
finish
