# Turns a pFUnit test file into Fortran: awk -v out=test_x.F90 -f pf2f90.awk test_x.pf
#
# The test module is copied, each assertion becomes a call that knows its file and line, and a module
# wraptest_x with a subroutine test_x_suite, which runs every test, is added at the end.
# What pFUnit 4.14 refuses is refused here, with FILE:LINE; all of it in one go. The output is written
# only if there was nothing to refuse, so that no build goes on with half a file.

BEGIN {
   BLANK = "[ \t]*"
   NAME = "[A-Za-z][A-Za-z0-9_]*"
   split("equal notequal true false lessthan lessthanorequal greaterthan greaterthanorequal " \
         "relativelyequal isnan isfinite fail", words, " ")
   for (i in words) known["assert" words[i]] = 1
}

FNR == 1 {
   file = FILENAME
   sub(/.*\//, "", file)
   suite = file
   sub(/\.[^.]*$/, "", suite)
   emit("#line 1 \"" FILENAME "\"")
}

{ sub(/\r$/, ""); stripped = $0; gsub(/^[ \t]+|[ \t]+$/, "", stripped) }

stripped ~ /^@/ && !quote { directive(stripped); next }

{ code = without_strings(stripped); check_code(tolower(code)); emit($0) }

END {
   if (module == "") refuse("no module " suite " in this file")
   else if (wanted != "") refuse("@" wanted " is not followed by a subroutine")
   else if (tests == 0) refuse("no test found: no @test in this file")
   if (refused) exit 1
   add_suite()
   for (i = 1; i <= lines; i++) print line[i] > out
}

function emit(text) { line[++lines] = text }

function refuse(message) {
   print FILENAME ":" FNR ": error: " message > "/dev/stderr"
   refused = 1
}

function directive(text,   name, rest) {
   match(text, /^@[A-Za-z0-9_]*/)
   name = tolower(substr(text, 2, RLENGTH - 1))
   rest = substr(text, RLENGTH + 1)
   sub("^" BLANK, "", rest)
   emit("!" text)
   if (name ~ /^assert/) assertion(name, text, rest)
   else if (name != "test" && name != "before" && name != "after") refuse("unknown directive @" name)
   else if (rest ~ /^\(/) refuse("options of @" name " are not supported")
   else if (rest != "") refuse("nothing may follow @" name " on its line, not even a comment")
   else if (wanted != "") refuse("@" wanted " is not followed by a subroutine")
   else wanted = name
}

# pFUnit writes `  call`, the text without its last parenthesis, `, &`: that line has to fit into 132.
function assertion(name, text, rest,   close_at, call) {
   if (!(name in known)) { refuse("unknown assertion @" name); return }
   if (rest ~ /&$/) { refuse("an assertion cannot be continued with &"); return }
   close_at = closing(rest)
   if (close_at == 0) { refuse("@" name ": its arguments are not within parentheses"); return }
   if (close_at < length(rest)) { refuse("nothing may follow an assertion on its line, not even a comment"); return }
   call = "  call " substr(text, 2, length(text) - 2) ", &"
   if (length(call) > 132) refuse("the assertion becomes a line of " length(call) " columns, 132 are allowed")
   lines-- # the call takes the place of the comment
   emit(call)
   emit("    location=SourceLocation('" file "', " FNR "))")
   emit("  if (anyExceptions()) return")
   emit("#line " (FNR + 1) " \"" FILENAME "\"")
}

# Place of the parenthesis that closes the one at the start of text; 0 if there is none.
function closing(text,   i, c, depth, inside) {
   if (text !~ /^\(/) return 0
   for (i = 1; i <= length(text); i++) {
      c = substr(text, i, 1)
      if (inside != "") { if (c == inside) inside = "" }
      else if (c == "'" || c == "\"") inside = c
      else if (c == "(") depth++
      else if (c == ")" && --depth == 0) return i
   }
   return 0
}

# The line without strings and comment; a string continued with & stays open into the next line.
function without_strings(text,   i, c, code) {
   for (i = 1; i <= length(text); i++) {
      c = substr(text, i, 1)
      if (quote != "") { if (c == quote) quote = "" }
      else if (c == "'" || c == "\"") quote = c
      else if (c == "!") break
      else code = code c
   }
   if (text !~ /&$/) quote = ""
   return code
}

function check_code(code) {
   sub(/[ \t]+$/, "", code)
   if (code ~ /@assert/) refuse("an assertion must stand alone on its line, not behind an if or a label")
   else if (code ~ /@/) refuse("a directive must stand alone on its line")
   if (code ~ "^module[ \t]+" NAME "$" && code !~ /^module[ \t]+procedure$/) module_statement(code)
   if (code ~ /^type[ \t,:]/ && code !~ /^type[ \t]*\(/) in_type = 1
   if (code ~ /^end[ \t]*type/) in_type = 0
   if (code == "contains" && !in_type) in_procedures = 1
   if (code == "private" && !in_type && !in_procedures) refuse("a test module must not be private")
   if (wanted != "" && code != "") procedure_of(wanted, code)
}

function module_statement(code) {
   if (module != "") refuse("a second module in one file")
   module = stripped
   sub(/^[A-Za-z]+[ \t]+/, "", module)
   if (module ~ /!/) refuse("nothing may follow the name of the module on its line, not even a comment")
   else if (module != suite) refuse("module " module " must have the name of its file, " suite)
}

# The subroutine line after @test, @before or @after.
function procedure_of(kind, code) {
   wanted = ""
   if (code !~ "^subroutine[ \t]+" NAME BLANK "(\\(" BLANK "\\))?$") {
      refuse("@" kind " must be followed by a plain `subroutine name()` without arguments")
      return
   }
   sub(/^subroutine[ \t]+/, "", code)
   match(code, NAME)
   code = substr(code, 1, RLENGTH)
   if (kind == "test") {
      if (RLENGTH >= 44) refuse("the name of a test must stay under 44 characters, this one has " RLENGTH)
      test[++tests] = code
   }
   else if (kind in fixture) refuse("a second @" kind)
   else fixture[kind] = code
}

# Like pFUnit's, the suite sees the whole test module and has local names `suite` and `t`: a test
# module with a public entity of one of these names compiles with neither.
function add_suite(   i, kind, arguments) {
   for (kind in fixture) arguments = arguments ", " kind "=" fixture[kind]
   emit("#line " (lines + 2) " \"" out "\"")
   emit("module wrap" suite)
   emit("   implicit none (type, external)")
   emit("   private")
   emit("   public :: " suite "_suite")
   emit("contains")
   emit("   subroutine " suite "_suite()")
   emit("      use funit")
   emit("      use " suite)
   emit("      character(len=*), parameter :: suite = '" suite "'")
   emit("      character(len=43) :: t")
   for (i = 1; i <= tests; i++) {
      emit("      t = '" test[i] "'")
      emit("      call run_test(suite, t, " test[i] arguments ")")
   }
   emit("   end subroutine " suite "_suite")
   emit("end module wrap" suite)
}
