# Sourced by the scripts, after processes.sh: installs Debian packages that only one script needs.
# shellcheck shell=bash

# install_packages PACKAGE...: installs those that are missing. Ends with an error if apt cannot install them.
install_packages()
{
  local as_root=() missing=() package log="${temporary:?}/apt.log"
  command -v apt-get > /dev/null || die "this is not Debian (no apt-get): install these by hand: $*"
  for package in "$@"; do
    [[ "$(dpkg-query --show --showformat '${db:Status-Status}' "$package" 2> /dev/null)" == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]} > 0)) || return 0
  [[ "$(id -u)" -eq 0 ]] || as_root=(sudo)
  say "installing ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet=2 -o DPkg::Lock::Timeout=300 \
    install --yes --no-install-recommends "${missing[@]}" > "$log" 2>&1 ||
    die "apt-get could not install ${missing[*]}: $(grep '^E:' "$log" | head -1 || true)"
}
