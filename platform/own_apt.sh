# own_apt FOLDER RELEASE [ARCHITECTURE]: from here on apt-get reads and writes FOLDER/apt alone, and knows that release of Debian, with
# its sources: as if nothing were installed. Needs no root and changes nothing of the system. apt-get verifies what it fetches.
own_apt() {
  local apt=$1/apt release=$2 architecture=${3-} mirror=http://deb.debian.org/debian
  local options="${architecture:+arch=$architecture }signed-by=/usr/share/keyrings/debian-archive-keyring.gpg"
  mkdir -p "$apt"/{lists/partial,archives/partial}
  printf 'deb%s [%s] %s %s main\n' "" "$options" "$mirror" "$release" "-src" "$options" "$mirror" "$release" >"$apt/sources.list"
  : >"$apt/status"
  cat >"$apt/apt.conf" <<END
Dir::State "$apt";
Dir::State::status "$apt/status";
Dir::State::lists "$apt/lists";
Dir::Cache "$apt";
Dir::Etc::sourcelist "$apt/sources.list";
Dir::Etc::sourceparts "/dev/null";
Dir::Etc::main "/dev/null";
Dir::Etc::parts "/dev/null";
APT::Sandbox::User "root";
${architecture:+APT::Architecture \"$architecture\"; APT::Architectures { \"$architecture\"; \};}
END
  export APT_CONFIG=$apt/apt.conf
  apt-get -qq update
}
