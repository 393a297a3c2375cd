#!/usr/bin/env bash
# Builds and tests the project in a clean Debian, as a newcomer would: a root folder with nothing but the release's own
# minimum and git, a clone of HEAD, and the two commands of the README. Prints how long each took, and what ctest says.
#
#   tests/platforms/debian.sh bookworm|trixie [FOLDER]
#
# FOLDER (default: one below TMPDIR that is removed at the end) keeps the root for a look or for a second run, which
# then begins with the build that is there. Needs root, mmdebstrap (Debian package) and a network; MIRROR names another
# mirror than Debian's own. CCACHE names a folder of compiler results that the root shares, with ccache installed there:
# the minutes printed are then not those of a newcomer. GNOMON_STRICT=1: warnings are errors, as in .ci/run.
set -euo pipefail

die() { printf 'debian.sh: %s\n' "$*" >&2; exit 2; }

source=$(git -C "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")" rev-parse --show-toplevel)
suite=${1-}
[[ $suite == bookworm || $suite == trixie ]] || die "which release? bookworm (12) or trixie (13)"
((EUID == 0)) || die "must be root: it makes a root folder and changes into it"
command -v mmdebstrap >/dev/null || die "mmdebstrap is not there (apt-get install mmdebstrap)"

kept=${2-}
root=${kept:-$(mktemp -d "${TMPDIR:-/tmp}/gnomon-$suite.XXXXXX")}

leave() {
  local folder
  # What is still busy goes from sight at once: nothing that is mounted may be there when the root is removed.
  for folder in ccache dev proc sys; do
    if mountpoint -q "$root/$folder"; then umount -R "$root/$folder" 2>/dev/null || umount -R -l "$root/$folder"; fi
  done
  if [[ -z $kept ]]; then rm -rf --one-file-system -- "$root"; fi
}
trap leave EXIT

# Names, proxies and trusted certificates are those of the machine.
make_root() {
  local options
  options=$(apt-config dump | grep -E '^Acquire::https?::' || true)
  mmdebstrap --variant=minbase --include=ca-certificates,git${CCACHE:+,ccache} ${options:+--aptopt="$options"} "$suite" "$root" ${MIRROR:+"$MIRROR"}
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
}

mount_kernel() {
  mount -t proc proc "$root/proc"
  mount --rbind --make-rslave /sys "$root/sys" 2>/dev/null || mount -t tmpfs tmpfs "$root/sys"
  mount -t tmpfs -o mode=755 tmpfs "$root/dev"
  local device
  for device in null zero full random urandom tty; do
    touch "$root/dev/$device"
    mount --bind "/dev/$device" "$root/dev/$device"
  done
  ln -s /proc/self/fd "$root/dev/fd"
  mkdir -p "$root/dev/shm"
  mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
  if [[ -n ${CCACHE-} ]]; then
    mkdir -p "$root/ccache"
    mount --bind "$CCACHE" "$root/ccache"
  fi
}

inside() {
  chroot "$root" /usr/bin/env -C /gnomon -u LC_ALL HOME=/root LANG=C.UTF-8 ${CCACHE:+CCACHE_DIR=/ccache} "$@"
}

# timed NAME COMMAND...: its time in minutes, on stdout; its output into FOLDER/NAME.log.
timed() {
  local name=$1 start=$SECONDS status=0
  shift
  inside "$@" >"$root/$name.log" 2>&1 </dev/null || status=$?
  printf '%-8s %-9s %3d min %02d s, exit code %d (%s)\n' "$suite" "$name" $(((SECONDS - start) / 60)) \
    $(((SECONDS - start) % 60)) "$status" "$*"
  if ((status != 0)); then tail -n 40 "$root/$name.log" >&2; fi
  return "$status"
}

[[ -e $root/etc/debian_version ]] || make_root
mount_kernel
rm -rf "$root/gnomon.new"
git clone --quiet --no-hardlinks "$source" "$root/gnomon.new"
if [[ -d $root/gnomon/build ]]; then mv "$root/gnomon/build" "$root/gnomon.new/build"; fi
rm -rf "$root/gnomon"
mv "$root/gnomon.new" "$root/gnomon"

printf '%-8s Debian %s, %s\n' "$suite" "$(<"$root/etc/debian_version")" "$(git -C "$source" describe --always --dirty)"
timed compare ./gnomon compare fence -o out/fence
timed test ./gnomon test
sed -n 's/^\([0-9]* *%* *tests passed.*\)/\1/p' "$root/test.log"
# What was skipped, and why.
inside tests/skipped_tests.sh build/release || true
grep -h -A1 ': Skipped$' "$root/gnomon/build/release/Testing/Temporary/LastTest.log" | grep -v -e ': Skipped$' -e '^--$' | sort | uniq -c || true
