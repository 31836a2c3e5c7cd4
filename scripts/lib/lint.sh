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

# files_to_lint: prints the changed .cpp files, committed or not, and the .cpp files that include a changed header. If
# the changes are unknown, prints all .cpp files.
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
      grep --recursive --files-with-matches --include='*.cpp' "#include \".*${header##*/}\"" src test bench || true
    done
  } | sort --unique
}

# lint BUILD_FOLDER: prints the findings of clang-tidy; fails if there are any.
lint()
{
  local list="$temporary/lint" file
  files_to_lint | while read -r file; do
    # Leaves out files that this build does not compile, such as the package of test/install.
    if grep --quiet --fixed-strings "\"$repository/$file\"" "$1/compile_commands.json"; then
      echo "$repository/$file"
    fi
  done > "$list"
  say "clang-tidy on $(wc -l < "$list") changed files"
  [[ ! -s "$list" ]] ||
    run xargs --arg-file="$list" --delimiter='\n' --max-args=1 --max-procs="$(nproc)" \
      clang-tidy -p "$1" --quiet 2> "$temporary/clang-tidy.log"
}
