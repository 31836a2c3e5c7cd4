# Sourced by the scripts: finds the robots of Debian's package dart-doc.
# shellcheck shell=bash

# find_robots: sets `robots` to the folder with urdf/KR5, urdf/drchubo and urdf/wam. If the package is not installed,
# this function downloads it once and unpacks it into the build folder. (An installation would not help on slim images,
# which leave out /usr/share/doc.) Fails if the package is not there and cannot be downloaded.
find_robots()
{
  local installed=/usr/share/doc/dart/data
  robots="$installed"
  [[ ! -e "$installed/urdf/KR5" ]] || return 0
  robots="$build/robots"
  [[ ! -e "$robots/urdf/KR5" ]] || return 0

  local folder="$temporary/dart-doc"
  mkdir -p "$folder"
  # The lists of apt may be missing or old, even if no package had to be installed.
  if ! download_robots "$folder"; then
    update_package_lists && download_robots "$folder" || return 1
  fi
  dpkg-deb --fsys-tarfile "$folder"/dart-doc_*.deb | tar -x -C "$folder" ./usr/share/doc/dart/data
  mkdir -p "$build"
  mv "$folder/usr/share/doc/dart/data" "$robots"
}

download_robots()
{
  (cd "$1" && apt-get --quiet=2 download dart-doc > /dev/null 2>&1)
}

update_package_lists()
{
  local as_root=()
  [[ "$(id -u)" -eq 0 ]] || as_root=(sudo)
  "${as_root[@]}" apt-get --quiet=2 update > /dev/null 2>&1
}
