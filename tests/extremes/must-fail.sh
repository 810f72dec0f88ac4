#!/bin/sh
# compare-with-quad.sh must notice what is wrong: must-fail.sh ATRITO SCENE_DECK QUAD_REFERENCE
set -u
here=$(CDPATH="" cd -- "$(dirname -- "$0")" && pwd)
mkdir -p must-fail && cd must-fail || exit 2
cat >list <<'END'
scene block lower_nx=6 lower_width=1.5 lower_x=-0.25 top_x=1 top_y=1 top_u1=5e-4 top_u2=-1e-3 eps=1e-5 rho=0.3
case right block 8
case more-digits-than-a-double block 17
case solved-but-not-to-be block exit4
case pressed-but-open block open
case pressed-but-none block none:1e-9
case no-such-case-to-be-like block like:nothing
case with-other-iterations block like:right lower_e=1e3
END
# a program that solves a scene with a little more friction
cat >liar <<'END'
#!/bin/sh
deck=$1
shift
sed 's/^3[.]E-001, /3.0000001E-001, /' "$deck" >lie.inp
exec "$ATRITO" lie.inp "$@"
END
chmod +x liar
ATRITO=$1
export ATRITO
sh "$here/compare-with-quad.sh" "$@" list >said
cat said
bad=$(grep -v '^#' said | grep -c ' bad')
good=$(grep -c ' ok' said)
[ "$good" -eq 1 ] && [ "$bad" -eq 6 ] || { echo "one right and six wrong cases expected"; exit 1; }
shift
sh "$here/compare-with-quad.sh" ./liar "$@" list 'case right' >said && { cat said; echo 'a wrong coefficient was not noticed'; exit 1; }
cat said
