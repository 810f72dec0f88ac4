# Compares the components of types with those that procedures name, by rules: exchanged.sh. First the rules, then all sources.
FNR == NR {
   n++
   type[n] = $1; file[n] = $2; procedures[n] = "," $3 ","; variable[n] = $4; left_out[n] = "," $5 ","
   has_procedures[$2] = 1
   has_rule[$2 ~ /^fields/ ? $1 : ""] = 1
   next
}

FNR == 1 { in_type = ""; procedure = "" }

{
   line = tolower($0)
   sub(/!.*/, "", line)
}

in_type == "" && line ~ /^ *type(, *(abstract|public|private|extends\([a-z0-9_]+\)))* *:: *[a-z0-9_]+ *$/ {
   in_type = line
   sub(/.*:: */, "", in_type)
   sub(/ *$/, "", in_type)
   is_type[in_type] = 1
   if (match(line, /extends\([a-z0-9_]+\)/)) note(in_type, substr(line, RSTART + 8, RLENGTH - 9), "")
   next
}

in_type != "" && line ~ /^ *(end type|contains)/ { in_type = ""; next }

in_type != "" && line ~ /::/ {
   kind = ""
   if (match(line, /^ *(type|class)\([a-z0-9_]+\)/)) {
      kind = substr(line, RSTART, RLENGTH)
      sub(/.*\(/, "", kind)
      sub(/\)/, "", kind)
   }
   while (gsub(/\([^()]*\)|\[[^\[\]]*\]/, "", line)) { }
   sub(/^[^:]*:: */, "", line)
   gsub(/=[^,]*/, "", line)
   gsub(/ /, "", line)
   m = split(line, names, ",")
   for (i = 1; i <= m; i++) if (names[i] != "") note(in_type, names[i], kind)
   next
}

!(FILENAME in has_procedures) { next }

line ~ /^ *(pure |elemental |recursive |impure |module )*(logical |integer\([a-z]+\) |real\([a-z]+\) |type\([a-z0-9_]+\) )*(subroutine|function) / {
   procedure = line
   sub(/.*(subroutine|function) +/, "", procedure)
   sub(/[^a-z0-9_].*/, "", procedure)
}

line ~ /%/ {
   # variable(index)%component
   while (gsub(/\([^()%]*\)%/, "%", line)) { }
   while (match(line, /[a-z0-9_]+%[a-z0-9_]+/)) {
      named[FILENAME, procedure, substr(line, RSTART, RLENGTH)] = 1
      rest = substr(line, RSTART, RLENGTH)
      sub(/%.*/, "", rest)
      line = substr(line, RSTART + length(rest) + 1)
   }
}

function note(of, component, kind) {
   if ((of, component) in kind_of) return
   components[of] = components[of] " " component
   kind_of[of, component] = kind
}

function is_named(r, component,   key, part) {
   for (key in named) {
      split(key, part, SUBSEP)
      if (part[1] != file[r] || part[3] != variable[r] "%" component) continue
      if (procedures[r] == ",*," || index(procedures[r], "," part[2] ",")) return 1
   }
   return 0
}

END {
   for (r = 1; r <= n; r++) {
      if (!(type[r] in is_type)) print "there is no type " type[r]
      m = split(components[type[r]], names, " ")
      for (i = 1; i <= m; i++) {
         known[type[r], names[i]] = 1
         kind = kind_of[type[r], names[i]]
         if (index(left_out[r], "," names[i] ",")) continue
         if (!is_named(r, names[i])) print file[r] ": " procedures[r] " forgets a component of " type[r] ": " names[i]
         if (file[r] ~ /^fields/ && kind != "" && !(kind in has_rule)) print kind " has no rule"
      }
      m = split(left_out[r], names, ",")
      for (i = 1; i <= m; i++) {
         if (names[i] != "" && !((type[r], names[i]) in known)) print type[r] " has no component " names[i] ", which is left out"
      }
   }
}
