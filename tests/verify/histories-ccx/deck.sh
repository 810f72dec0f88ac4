# deck.sh NAME: the deck of a scene on standard output; the first line of its steps has the arguments of scene.awk.
here=$(dirname "$0")
set -- "$1" $(sed -n '1s/^\*\* //p' "$here/$1.steps")
name=$1
shift
for word in "$@"; do
   set -- "$@" -v "$word"
   shift
done
awk "$@" -f "$here/scene.awk" <"$here/$name.steps"
