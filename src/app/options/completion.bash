# Completion for bash; printed by `atrito help bash`.
# shellcheck shell=bash

# Files whose names fit a pattern, and folders.
_atrito_files() {
   compopt -o filenames 2>/dev/null
   mapfile -t COMPREPLY < <({
      compgen -f -X "!$1" -- "$cur"
      compgen -d -- "$cur"
   } | sort -u)
}

# Those of some words that go on as it was begun.
_atrito_words() {
   mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# The next word of the keywords that go on as they were begun at word $1.
_atrito_keywords() {
   local typed='' keyword words='' i
   for ((i = $1; i < COMP_CWORD; i++)); do typed+="${COMP_WORDS[i]^^} "; done
   while read -r keyword; do
      if [[ $keyword == "$typed${cur^^}"* ]]; then
         keyword=${keyword#"$typed"}
         words+=" ${keyword%% *}"
      fi
   done <<'EOF'
@KEYWORDS@
EOF
   mapfile -t COMPREPLY < <(compgen -W "$words" | sort -u
      [ "$1" -lt "$COMP_CWORD" ] || compgen -W '@PAGES@' -- "$cur")
}

_atrito() {
   local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} task='' i
   COMPREPLY=()
   if [ "$cur" = = ]; then cur=''; fi
   if [ "$prev" = = ]; then prev=${COMP_WORDS[COMP_CWORD - 2]}; fi
   case $prev in
@OPTIONS WITH WORDS@
      @FOLDERS@) compopt -o filenames 2>/dev/null
         mapfile -t COMPREPLY < <(compgen -d -- "$cur"); return ;;
      @FILES@) _atrito_files '*'; return ;;
      @OWN@) return ;;
   esac
   for ((i = 1; i < COMP_CWORD && ${#task} == 0; i++)); do
      case ${COMP_WORDS[i]} in
         @VALUES@)
            if [ "${COMP_WORDS[i + 1]}" = = ]; then ((i++)); fi
            ((i++)) ;;
         -*) ;;
         @COMMANDS@) task=${COMP_WORDS[i]} ;;
         *) task=run ;;
      esac
   done
   case ${task:-run}:$cur in
@TASKS@
      help:*) _atrito_keywords "$i" ;;
      compare:*) _atrito_files '*' ;;
      *)
         _atrito_files '*.inp'
         [ -n "$task" ] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -W '@WORDS@' -- "$cur") ;;
   esac
}
complete -F _atrito atrito
