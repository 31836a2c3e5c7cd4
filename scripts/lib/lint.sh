# Sourced by scripts/test: clang-tidy on what changed.
# shellcheck shell=bash

# lint_base: the commit that changes are counted from: where this branch left the upstream one, or else the commit before.
# Fails without one (no git, a shallow clone, a first commit).
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

# Under sudo the repository belongs to someone else, which git refuses otherwise.
git_here()
{
  git -C "$repository" -c safe.directory='*' "$@" 2> /dev/null
}

# files_to_lint: the .cpp files that changed, committed or not, and for each changed header one file that includes it: the
# .cpp of the same name, or else the first. clang-tidy reports the findings of a header through any file that includes it.
# Prints all files where git cannot tell the changes.
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

# includer_of HEADER: a .cpp file that includes it.
includer_of()
{
  local name=${1##*/} includers
  includers="$(grep --recursive --files-with-matches --include='*.cpp' "#include \".*\b$name\"" src test bench | sort)"
  grep "/${name%.h}\.cpp$" <<< "$includers" | head -1 | grep . || head -1 <<< "$includers"
}

# lint: prints the findings of clang-tidy in the changed files; fails if there are any. clang-tidy needs the command that
# compiles each file alone, and a unity build has none: a build folder is configured for it, where only messages are made.
lint()
{
  local list="$temporary/lint" folder="$build/lint" target=gpu_planning_scene_generate_messages_cpp
  files_to_lint > "$list.changed"
  if [[ -s "$list.changed" ]]; then
    configure_and_build "$folder" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
    # The commands lack files that another build compiles, such as those of test/install.
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
