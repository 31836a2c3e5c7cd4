# Writes FILE, which defines kProofSources: a hash of the files in the list SOURCES. So a change of the code makes all
# proofs of the user's cache anew, and nobody has to remember to raise a version.
list(SORT SOURCES)
set(hashes "")
foreach(source IN LISTS SOURCES)
  file(SHA256 "${source}" hash)
  string(APPEND hashes "${hash}\n")
endforeach()
string(SHA256 hash "${hashes}")
file(WRITE "${FILE}" "#include \"collision/filter/proofs/proof_sources.h\"

namespace gpu_planning_scene::core
{
const char* const kProofSources = \"${hash}\";
}  // namespace gpu_planning_scene::core
")
