#!/usr/bin/env bash
# Prepares the guest system of the system test. The guest has Debian 12 with the PREEMPT_RT kernel, systemd
# and simulated GPIO lines.
#   prepare.sh WORK PACKAGE.deb
# After that, WORK contains release, kernel/, gpio/, root.tar, disk.ext4 and initrd.gz. Existing files are
# kept. Only the root file system is replaced if the dependencies of the package have changed. Needs root and
# access to the Debian archive.
set -euo pipefail
work=$(realpath -m "$1")
package=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
mkdir -p "$work"
say() { printf '   guest: %s\n' "$*"; }

# Sets `kernel` to the release of the PREEMPT_RT kernel in the archive. The release is determined once and stored in
# WORK.
find_kernel() {
  if [ ! -s "$work/release" ]; then
    apt-cache depends linux-image-rt-amd64 |
      sed -n 's/.*Depends: linux-image-\([0-9].*-rt-amd64\)$/\1/p' | head -1 >"$work/release"
  fi
  kernel=$(cat "$work/release")
  [ -n "$kernel" ] || { echo "prepare.sh: the archive has no linux-image-rt-amd64" >&2; exit 1; }
}

# fetch PACKAGE FOLDER  downloads a package from the archive and unpacks it into FOLDER without installing it
fetch() {
  local folder=$2.part
  rm -rf "$folder" && mkdir -p "$folder/download"
  (cd "$folder/download" && apt-get -q download "$1" >/dev/null)
  dpkg-deb -x "$folder"/download/*.deb "$folder"
  rm -r "$folder/download"
  mv "$folder" "$2"
}

# Debian kernels contain neither gpio-sim nor the simulated interrupts that gpio-sim needs. Both are built as one module
# from the kernel source of Debian, with the kernel headers of Debian.
build_gpio() {
  local build=$work/gpio.part source
  rm -rf "$build" "$work/source" && mkdir -p "$build"
  fetch "linux-source-${kernel%%.*}.$(cut -d. -f2 <<<"$kernel")" "$work/source"
  source=$(find "$work/source" -name 'linux-source-*.tar.xz')
  tar -xJf "$source" -C "$work/source" --strip-components=1 --wildcards '*/drivers/gpio/gpio-sim.c' \
    '*/drivers/gpio/gpiolib.h' '*/kernel/irq/irq_sim.c'
  cp "$work/source/drivers/gpio/gpiolib.h" "$build/"
  cp "$work/source/drivers/gpio/gpio-sim.c" "$build/lines.c"
  # The kernel does not export irq_to_desc() to modules. The exported function generic_handle_irq() also handles the
  # interrupt.
  sed 's/handle_simple_irq(irq_to_desc(\(.*\)));/generic_handle_irq(\1);/' "$work/source/kernel/irq/irq_sim.c" \
    >"$build/interrupts.c"
  printf 'obj-m := gpio-sim.o\ngpio-sim-objs := lines.o interrupts.o\n' >"$build/Kbuild"
  make -s -C "/usr/src/linux-headers-$kernel" M="$build" modules >"$work/gpio.log" 2>&1 ||
    { tail -n 20 "$work/gpio.log" >&2; exit 1; }
  rm -rf "$work/source"
  mv "$build" "$work/gpio"
}

# Writes the root file system as a tar file. It contains the packages that the computer of a technician has. It also
# contains the dependencies of the softgrip package, because the guest has no network.
build_root() {
  local needs wanted
  needs=$(dpkg-deb -f "$package" Depends | tr ',' '\n' | sed 's/[|(].*//; s/ //g' | grep -v '^$' | sort -u | paste -sd,)
  wanted="systemd,systemd-sysv,udev,dbus,kmod,procps,util-linux,libpam-systemd,python3,rt-tests,gpiod,$needs"
  if [ -f "$work/root.tar" ] && [ "$wanted" = "$(cat "$work/root.packages" 2>/dev/null)" ]; then return; fi
  say "root file system"
  rm -f "$work/root.tar"
  mmdebstrap --quiet --variant=minbase --include="$wanted" --dpkgopt='path-exclude=/usr/share/locale/*' \
    bookworm "$work/root.tar" 2>"$work/mmdebstrap.log" || { tail -n 20 "$work/mmdebstrap.log" >&2; exit 1; }
  echo "$wanted" >"$work/root.packages"
}

# modules NAME ...: prints the files of these modules and of the modules that they depend on, in the order of
# loading
modules() {
  local name
  for name in "$@"; do
    modprobe -d "$work/kernel" -S "$kernel" --show-depends "$name" 2>/dev/null | sed -n 's/^insmod \([^ ]*\).*/\1/p'
  done | awk '!seen[$0]++'
}

build_disk() {
  local root=$work/root file
  say "disk"
  rm -rf "$root" && mkdir "$root"
  tar -xf "$work/root.tar" -C "$root"
  while read -r file; do
    install -D -m 644 "$file" "$root/lib/modules/$kernel/${file##*/lib/modules/"$kernel"/}"
  done < <(modules virtio_pci virtio_blk virtio_rng ext4 configfs autofs4)
  install -D -m 644 "$work/gpio/gpio-sim.ko" "$root/lib/modules/$kernel/extra/gpio-sim.ko"
  cp "$work/kernel/lib/modules/$kernel"/modules.{builtin,builtin.modinfo,order} "$root/lib/modules/$kernel/"
  depmod -b "$root" "$kernel"
  cp -r "$here/root/." "$root/"
  : >"$root/etc/machine-id"
  ln -s /etc/systemd/system/system-test.service "$root/etc/systemd/system/multi-user.target.wants/system-test.service"
  local unit
  for unit in apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer fstrim.timer \
    systemd-firstboot.service getty.target; do
    ln -sf /dev/null "$root/etc/systemd/system/$unit"
  done
  rm -f "$work/disk.ext4"
  mke2fs -q -t ext4 -O ^has_journal -d "$root" "$work/disk.ext4" 1400M
  rm -rf "$root"
}

# The initial file system has one task: to find the disk. It contains busybox, the modules in their order, and a script.
build_initrd() {
  local folder=$work/initrd file
  rm -rf "$folder" && mkdir -p "$folder"/{bin,modules,proc,sys,dev,root}
  cp /bin/busybox "$folder/bin/"
  cp "$here/init" "$folder/init" && chmod 755 "$folder/init"
  while read -r file; do
    cp "$file" "$folder/modules/"
    basename "$file" >>"$folder/modules/order"
  done < <(modules virtio_pci virtio_blk ext4)
  (cd "$folder" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd.gz"
  rm -rf "$folder"
}

apt-get -q update >/dev/null
find_kernel
dpkg-query -W "linux-headers-$kernel" >/dev/null 2>&1 ||
  DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=400 install -y --no-install-recommends \
    "linux-headers-$kernel" >/dev/null
if [ ! -d "$work/kernel" ]; then
  say "kernel $kernel"
  fetch "linux-image-$kernel" "$work/kernel"
  depmod -b "$work/kernel" "$kernel"
fi
[ -d "$work/gpio" ] || { say "gpio-sim"; build_gpio; }
build_root
if [ ! -f "$work/disk.ext4" ] || [ -n "$(find "$here/root" "$here/init" "$here/prepare.sh" "$work/root.tar" "$work/gpio" -newer "$work/disk.ext4")" ]; then
  build_disk
  build_initrd
fi
