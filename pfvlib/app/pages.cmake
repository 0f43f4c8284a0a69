# SPDX-License-Identifier: GPL-3.0-or-later
# The manual page and the completion of the shell, both out of what COMMAND itself says of its words: cmake -DCOMMAND=...
# -DVERSION=... -DFOLDER=... -P pages.cmake writes FOLDER/pfv.1 and FOLDER/pfv.bash.
function(help_of result)
  execute_process(COMMAND ${COMMAND} ${ARGN} --help OUTPUT_VARIABLE text RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${COMMAND} ${ARGN} --help")
  endif()
  string(STRIP "${text}" text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# The words of a help text that begin with two hyphens, in order.
function(options_of result text)
  string(REGEX MATCHALL "--[a-z][a-z-]*[a-z]" words "${text}")
  list(REMOVE_DUPLICATES words)
  list(SORT words)
  string(REPLACE ";" " " words "${words}")
  set(${result} "${words}" PARENT_SCOPE)
endfunction()

# A text as it stands, for troff: backslashes, hyphens that can be copied, no line taken for a request.
function(troff result text)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

help_of(top)
string(REGEX REPLACE "^.*\nSubcommands:\n" "" list "${top}")
string(REGEX MATCHALL "(^|\n)  [a-z][a-z-]*" names "${list}")
string(REGEX REPLACE "[\n ]" "" names "${names}")
if(NOT names)
  message(FATAL_ERROR "the help of ${COMMAND} lists no subcommand")
endif()

troff(text "${top}")
set(page ".TH PFV 1 \"\" \"pfv ${VERSION}\"\n.SH NAME\npfv \\- pore\\-scale finite volume flow through sphere packings\n")
string(APPEND page ".SH SYNOPSIS\n.B pfv\nSUBCOMMAND [OPTIONS]\n.SH DESCRIPTION\n.nf\n${text}\n.fi\n")
options_of(words "${top}")
set(cases "")
foreach(name IN LISTS names)
  help_of(help ${name})
  options_of(own "${help}")
  string(APPEND cases "    ${name}) words='${own}' ;;\n")
  string(TOUPPER "pfv ${name}" title)
  troff(text "${help}")
  string(APPEND page ".SH ${title}\n.nf\n${text}\n.fi\n")
endforeach()
file(WRITE ${FOLDER}/pfv.1 "${page}")

string(REPLACE ";" " " names "${names}")
file(WRITE ${FOLDER}/pfv.bash "# completion of pfv ${VERSION} for bash, made of its --help
_pfv() {
  local words
  case \${COMP_WORDS[1]} in
${cases}    *) words='${names} ${words}' ;;
  esac
  [ \"$COMP_CWORD\" -gt 1 ] || words='${names} ${words}'
  COMPREPLY=()
  case $2 in
    -* | '') mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$2\") ;;
    *) [ \"$COMP_CWORD\" -gt 1 ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$2\") ;;
  esac
}
complete -o default -F _pfv pfv
")
