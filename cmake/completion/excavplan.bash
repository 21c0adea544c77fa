# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
#
# Completion of the excavplan tools in bash: their options, and the words that an option may have, as
# --help tells them; names of files else.

_excavplan() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words
  COMPREPLY=()
  if [[ $word == -* ]]; then
    words=$("$1" --help 2>/dev/null | sed -nE 's/^  (-h, )?(--[a-z0-9-]+).*/\2/p')
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    return
  fi
  [[ $before == --?* ]] || return 0
  # "loam|sand|FILE", "cycle|priced:WATT", "[before|after=]FILE.tif|ply": the words in small letters.
  words=$("$1" --help 2>/dev/null | sed -nE "s/^  $before ([^ ]+)( .*)?$/\1/p" |
    sed -E '/^\[/ { s/^\[([^]]*)=\].*/\1/; s/\||$/=&/g }; s/FILE\..*//' | tr '|' '\n' |
    sed -nE 's/^([a-z0-9-]+[=:]?)([A-Z]*)$/\1/p')
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  if [[ ${COMPREPLY[*]} == *[=:] ]]; then compopt -o nospace; fi
}

complete -o default -F _excavplan @tools@
