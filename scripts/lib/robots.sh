# Sourced by the scripts: the robots of Debian's dart-doc.
# shellcheck shell=bash

# find_robots: sets robots to the folder with urdf/KR5, urdf/drchubo and urdf/wam. The package is not installed: it lies
# under /usr/share/doc, which slim images leave out, so it is unpacked into the build folder, once. Fails where it is
# neither there nor to be had.
find_robots()
{
  local installed=/usr/share/doc/dart/data
  robots="$installed"
  [[ ! -e "$installed/urdf/KR5" ]] || return 0
  robots="$build/robots"
  [[ ! -e "$robots/urdf/KR5" ]] || return 0

  local folder="$temporary/dart-doc"
  mkdir -p "$folder"
  # apt's lists may be missing or old even where no package had to be installed.
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
