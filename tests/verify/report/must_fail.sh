# check_page.py notices pages that are not sound. With: CHECK_PAGE.PY
set -u
judge=$1
failures=0
top='<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>t</title><style>p{margin:0}</style></head><body><main><h1>t</h1>'
end='</main></body></html>'
page() { # EXPECTED WHAT BODY [options]
   wanted=$1
   what=$2
   body=$3
   shift 3
   printf '%s\n%s\n%s\n' "$top" "$body" "$end" >page.html
   python3 "$judge" "$@" page.html >page.out 2>&1
   found=$?
   [ "$found" -eq "$wanted" ] || { echo "FAILED: $what: exit $found"; cat page.out; failures=$((failures + 1)); }
}
page 0 'sound' '<p id="a">x &lt; y</p><a href="#a">a</a><div class="whole"><h3>b</h3><div class="scroll"><table><tr><td>1</td></tr><tr><td>2</td></tr></table></div></div>' \
   --has 'x < y' --pictures 0
page 1 'not closed' '<p>x'
page 1 'crossed' '<p><em>x</p></em>'
page 1 'a script' '<script>1</script>'
page 1 'a script in an attribute' '<p onclick="x()">x</p>'
page 1 'a picture elsewhere' '<img alt="a" src="http://example.org/a.png">'
page 1 'a picture without words' '<img src="data:image/gif;base64,R0lGODsK">'
page 1 'a picture that is none' '<img alt="a" src="data:image/png;base64,R0lGODsK">'
page 0 'a picture' '<img alt="a" src="data:image/gif;base64,R0lGODsK">' --pictures 1
page 1 'too few pictures' '<img alt="a" src="data:image/gif;base64,R0lGODsK">' --pictures 2
page 1 'a file' '<a href="x.html">x</a>'
page 1 'a link to nowhere' '<a href="#b">x</a>'
page 1 'an id twice' '<p id="a">x</p><p id="a">x</p>'
page 1 'a bare &' '<p>x & y</p>'
page 1 'a style from elsewhere' '<style>@import "x.css"</style>'
page 1 'rows' '<div class="scroll"><table><tr><td>1</td></tr><tr><td>2</td><td>3</td></tr></table></div>'
page 1 'a table that does not scroll' '<table><tr><td>1</td></tr></table>'
page 1 'a heading alone' '<h3>b</h3><div class="whole"><p>x</p></div>'
page 1 'a text that is missing' '<p>x</p>' --has 'y'
page 1 'a control character' "<p>$(printf '\001')</p>"
page 1 'Latin-1' "<p>$(printf '\351')</p>"
exit $((failures > 0))
