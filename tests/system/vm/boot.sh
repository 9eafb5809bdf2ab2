#!/usr/bin/env bash
# Boots the guest system of prepare.sh. A folder is its second drive. The guest runs the file `run` in this folder and
# powers off.
#   boot.sh WORK FOLDER LOG
# The output of `run` goes to standard output and to LOG. The console of the guest goes to LOG.console. The disk is not
# changed. QEMU emulates one processor, so neither KVM nor root is needed. The clock of the guest counts instructions (8
# ns each). Therefore the load of the host does not affect the guest, and sleeping takes no time on the host.
set -euo pipefail
work=$(realpath "$1") folder=$(realpath "$2") log=$3
kernel=$(cat "$work/release")
drive=$(mktemp -p "$work" drive.XXXXXX)
trap 'rm -f "$drive"' EXIT
megabytes=$(($(du -sm "$folder" | cut -f1) + 16))
mke2fs -q -t ext4 -O ^has_journal -d "$folder" "$drive" "${megabytes}M"

nice timeout "${BOOT_TIMEOUT_S:-1500}" qemu-system-x86_64 -machine q35 -cpu max -smp 1 -m 768 \
  -accel tcg,thread=single -icount shift=3,sleep=off,align=off -rtc clock=vm \
  -display none -monitor none -nic none -no-reboot \
  -kernel "$work/kernel/boot/vmlinuz-$kernel" -initrd "$work/initrd.gz" \
  -append 'console=ttyS0 root=/dev/vda panic=-1 audit=0 nokaslr mitigations=off random.trust_cpu=on' \
  -drive "file=$work/disk.ext4,format=raw,if=virtio,snapshot=on" \
  -drive "file=$drive,format=raw,if=virtio,snapshot=on" -device virtio-rng-pci \
  -serial "file:$log.console" -serial stdio </dev/null | sed -u 's/\r//g' | tee "$log"
