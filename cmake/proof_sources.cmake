# Writes FILE, which defines kProofSources: a hash of the files in the list SOURCES, and of all files that they include
# from the folders in the list ROOTS. So a change of the code makes all proofs of the user's cache anew, and nobody has
# to remember to raise a version. A change of a comment, of blank lines or of the indentation keeps the proofs.
cmake_minimum_required(VERSION 3.16)

# The text of a file without comments. A file in which these simple expressions cannot tell a comment from code keeps
# its comments. So two texts are equal only if the compiler sees the same code.
function(read_code file result)
  file(READ "${file}" text)
  set(code "\n${text}")
  # The beginning of a line up to a comment: signs, whole texts in quotation marks, and separators within numbers.
  set(code_of_line "(\n([^\n\"'/]|/[^\n\"'/*]|\"([^\n\"\\]|\\\\[^\n])*\"|[0-9]'[0-9])*)")
  string(REGEX REPLACE "${code_of_line}/[*][^\n\"'/*]*[*]/" "\\1 " code "${code}")
  string(REGEX REPLACE "${code_of_line}//[^\n]*" "\\1" code "${code}")
  string(REGEX REPLACE "[ \t]+\n" "\n" code "${code}")
  string(REGEX REPLACE "\n[ \t\n]+" "\n" code "${code}")
  # A comment over several lines, a raw string, or a line that continues the line before.
  if(code MATCHES "/[*]" OR text MATCHES "R\"" OR text MATCHES "\\\\\r?\n")
    set(code "${text}")
  endif()
  set(${result} "${code}" PARENT_SCOPE)
endfunction()

set(files "")
foreach(source IN LISTS SOURCES)
  get_filename_component(path "${source}" ABSOLUTE)
  list(APPEND files "${path}")
endforeach()
list(SORT files)
set(seen "")
set(hashes "")
while(files)
  list(GET files 0 source)
  list(REMOVE_AT files 0)
  list(APPEND seen "${source}")
  read_code("${source}" code)
  string(SHA256 hash "${code}")
  string(APPEND hashes "${hash}\n")
  string(REGEX MATCHALL "#[ \t]*include[ \t]*\"[^\"\n]+\"" includes "${code}")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE ".*\"(.*)\"" "\\1" include "${include}")
    set(found FALSE)
    foreach(root IN LISTS ROOTS)
      if(EXISTS "${root}/${include}")
        get_filename_component(path "${root}/${include}" ABSOLUTE)
        set(found TRUE)
        if(NOT path IN_LIST seen AND NOT path IN_LIST files)
          list(APPEND files "${path}")
        endif()
        break()
      endif()
    endforeach()
    if(NOT found)
      message(FATAL_ERROR "${source} includes \"${include}\", which is in none of the folders ${ROOTS}")
    endif()
  endforeach()
endwhile()
string(SHA256 hash "${hashes}")
file(WRITE "${FILE}" "#include \"collision/proofs/proof_sources.h\"

namespace gpu_planning_scene::core
{
const char* const kProofSources = \"${hash}\";
}  // namespace gpu_planning_scene::core
")
