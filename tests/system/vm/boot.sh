#!/usr/bin/env bash
# Boots the guest of prepare.sh, with a folder as its second drive whose program `run` it executes; then it powers off.
#   boot.sh WORK FOLDER LOG [time|instructions]
# What `run` prints goes to the standard output and to LOG, the guest's console to LOG.console.
#   time          two processors, the guest's clock is the host's (default)
#   instructions  one processor; the clock counts instructions, not time, so that what the host does meanwhile cannot
#                 be seen in the guest: latencies are the kernel's and the program's own
# The disk is not changed. TCG emulates the processor: neither KVM nor root is needed.
set -euo pipefail
work=$(realpath "$1") folder=$(realpath "$2") log=$3 mode=${4:-time}
kernel=$(cat "$work/release")
drive=$(mktemp -p "$work" drive.XXXXXX)
trap 'rm -f "$drive"' EXIT
megabytes=$(($(du -sm "$folder" | cut -f1) + 16))
mke2fs -q -t ext4 -O ^has_journal -d "$folder" "$drive" "${megabytes}M"

case $mode in
  time) processors=(-accel tcg,thread=multi -smp 2 -cpu max) ;;
  instructions)
    processors=(-accel tcg,thread=single -smp 1 -cpu max -icount shift=3,sleep=off,align=off -rtc clock=vm) ;;
  *) echo "boot.sh: unknown mode $mode" >&2; exit 2 ;;
esac
nice timeout "${BOOT_TIMEOUT_S:-1500}" qemu-system-x86_64 -machine q35 "${processors[@]}" -m 768 -display none \
  -monitor none -nic none -no-reboot -kernel "$work/kernel/boot/vmlinuz-$kernel" -initrd "$work/initrd.gz" \
  -append 'console=ttyS0 root=/dev/vda panic=-1 audit=0 nokaslr mitigations=off random.trust_cpu=on systemd.log_target=journal' \
  -drive "file=$work/disk.ext4,format=raw,if=virtio,snapshot=on" \
  -drive "file=$drive,format=raw,if=virtio,snapshot=on" -device virtio-rng-pci \
  -serial "file:$log.console" -serial stdio </dev/null | sed -u 's/\r//g' | tee "$log"
