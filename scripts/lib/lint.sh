# Sourced by scripts/test: runs clang-tidy on changed files.
# shellcheck shell=bash

# lint_base: prints the commit with which the files are compared. This is the commit where the branch left its upstream
# branch, or otherwise the previous commit. Fails without such a commit (no git, a shallow clone, a first commit).
lint_base()
{
  local upstream base head
  head="$(git_here rev-parse HEAD)" || return 1
  for upstream in '@{upstream}' origin/HEAD origin/main; do
    base="$(git_here merge-base HEAD "$upstream")" || continue
    if [[ "$base" != "$head" ]]; then
      echo "$base"
      return 0
    fi
  done
  git_here rev-parse --verify --quiet HEAD~1
}

# safe.directory: under sudo the repository belongs to another user, and git would refuse it.
git_here()
{
  git -C "$repository" -c safe.directory='*' "$@" 2> /dev/null
}

# files_to_lint: prints the changed .cpp files, committed or not, and one .cpp file per changed header: the file of the
# same name, or else the first file that includes the header. clang-tidy reports the findings of a header through any
# file that includes it. If git does not know the changes, prints all .cpp files.
files_to_lint()
{
  local base changed header
  cd "$repository" || return 1
  if ! base="$(lint_base)"; then
    find src test bench -name '*.cpp' | sort
    return 0
  fi
  changed="$(git_here diff --name-only --diff-filter=d "$base" -- src include test bench shaders
    git_here ls-files --others --exclude-standard -- src include test bench)"
  {
    grep '\.cpp$' <<< "$changed" || true
    grep '\.h$' <<< "$changed" | while read -r header; do
      includer_of "$header"
    done
  } | sort --unique
}

# includer_of HEADER: prints a .cpp file that includes the header.
includer_of()
{
  local name=${1##*/} includers
  includers="$(grep --recursive --files-with-matches --include='*.cpp' "#include \".*\b$name\"" src test bench |
    grep --invert-match '^test/install/' | sort)"
  grep "/${name%.h}\.cpp$" <<< "$includers" | head -1 | grep . || head -1 <<< "$includers"
}

# lint: prints the findings of clang-tidy in the changed files; fails if there are any. clang-tidy needs a compile
# command for each file, which a unity build does not have. So lint configures a second build folder, and builds only
# the messages there.
lint()
{
  if [[ "$(clang-tidy --version)" != *"version 14."* ]]; then
    say "clang-tidy is left out: the code is held to version 14, and other versions have other findings"
    return
  fi
  local list="$temporary/lint" folder="$build/lint"
  files_to_lint > "$list.changed"
  if [[ -s "$list.changed" ]]; then
    configure_and_build "$folder" --target gpu_planning_scene_generate_messages_cpp -DCMAKE_BUILD_TYPE=Debug \
      -DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
    # The compile commands do not include files of other builds, such as test/install.
    sed "s|^|$repository/|" "$list.changed" |
      while read -r file; do
        ! grep --quiet --fixed-strings "\"$file\"" "$folder/compile_commands.json" || echo "$file"
      done > "$list"
  else
    : > "$list"
  fi
  say "clang-tidy on $(wc -l < "$list") changed files"
  [[ ! -s "$list" ]] ||
    run xargs --arg-file="$list" --delimiter='\n' --max-args=1 --max-procs="$(nproc)" \
      clang-tidy -p "$folder" --quiet 2> "$temporary/clang-tidy.log"
}
