#!/usr/bin/env bash
# Clones HEAD and runs a command in the clone, in a minimal chroot of a Debian release, as on a new computer:
#   scripts/chroot_test.sh bookworm|trixie [COMMAND ...]     default: bash scripts/test.sh --quick
# Packages that scripts/package.sh has built are copied to build/ of the clone, for tests/library/installed_examples.sh.
# build/chroot keeps the bare chroot, the downloaded packages and the folder of the last run (RELEASE.root). apt uses the
# package archive of this computer. Needs root. When the script ends, its mounts and processes end, too.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
release=${1:-}
case $release in
  bookworm | trixie) shift ;;
  *) sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
[ $# -gt 0 ] || set -- bash scripts/test.sh --quick
[ "$(id -u)" -eq 0 ] || { echo "chroot_test.sh: run as root" >&2; exit 1; }

if [ -z "${SOFTGRIP_IN_NAMESPACE:-}" ]; then
  bash scripts/packages.sh chroot
  SOFTGRIP_IN_NAMESPACE=1 exec unshare --mount --pid --fork --kill-child bash "$0" "$release" "$@"
fi

store=$PWD/build/chroot
root=$store/$release.root
mkdir -p "$store/$release.packages"

if [ ! -s "$store/$release.tar" ]; then
  echo "chroot: $release"
  archive=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' 'Component: main' |
    grep -v security | head -n 1)
  [ -n "$archive" ] || { echo "chroot_test.sh: apt lists no archive of Debian" >&2; exit 1; }
  options=()
  while IFS= read -r line; do options+=(--aptopt="$line"); done < <(apt-config dump Acquire::http::Proxy Acquire::https::Proxy)
  mmdebstrap --quiet --format=tar --variant=minbase --include=ca-certificates,git "${options[@]}" \
    "$release" "$store/$release.part" "$archive" 2>"$store/mmdebstrap.log" ||
    { tail -n 20 "$store/mmdebstrap.log" >&2; exit 1; }
  mv "$store/$release.part" "$store/$release.tar"
fi

rm -rf "$root" && mkdir "$root"
tar -xf "$store/$release.tar" -C "$root" --exclude='./dev/*'
git clone -q --no-hardlinks . "$root/softgrip"
git -C "$root/softgrip" remote remove origin
mkdir -p "$root/softgrip/build"
find build -maxdepth 1 -name '*.deb' -exec cp -p {} "$root/softgrip/build" \;
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
# Keeps the downloaded packages of apt for the next run.
echo 'Binary::apt::APT::Keep-Downloaded-Packages "true"; APT::Keep-Downloaded-Packages "true";' \
  >"$root/etc/apt/apt.conf.d/98softgrip"
# dpkg may omit its safe writes (fsync), because each run creates the folder from scratch.
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/softgrip"
mount --bind "$store/$release.packages" "$root/var/cache/apt/archives"
mount -t proc proc "$root/proc"
mount --rbind /sys "$root/sys"
mount -t tmpfs -o mode=755 tmpfs "$root/dev"
mkdir "$root/dev/pts" "$root/dev/shm"
for node in null zero full random urandom tty; do
  touch "$root/dev/$node" && mount --bind "/dev/$node" "$root/dev/$node"
done
ln -s /proc/self/fd "$root/dev/fd"
ln -s fd/0 "$root/dev/stdin" && ln -s fd/1 "$root/dev/stdout" && ln -s fd/2 "$root/dev/stderr"
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts "$root/dev/pts"
ln -s pts/ptmx "$root/dev/ptmx"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM="${TERM:-dumb}" LC_ALL=C.UTF-8 \
  chroot "$root" bash -c 'cd /softgrip && exec "$@"' chroot "$@"
