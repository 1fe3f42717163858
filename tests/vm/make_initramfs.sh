#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The first file system of the virtual machine: busybox and the few modules that mount the host's root.
#   make_initramfs.sh KERNEL_TREE OUT.gz      (KERNEL_TREE: the kernel's package, unpacked)
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin
kernel=$1 out=$2
release=$(ls "$kernel/lib/modules" | head -1)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/bin "$tree"/proc "$tree"/sys "$tree"/dev "$tree"/modules
cp "$(command -v busybox)" "$tree/bin/busybox"
for applet in sh mount insmod switch_root mkdir; do ln -s busybox "$tree/bin/$applet"; done
[ -f "$kernel/lib/modules/$release/modules.dep" ] || depmod -b "$kernel" "$release"

for module in virtio_pci 9pnet_virtio 9p overlay; do
    modprobe -d "$kernel" -S "$release" --show-depends "$module" | awk '$1 == "insmod" { print $2 }'
done | awk '!seen[$0]++' | while read -r file; do
    name=$(basename "$file" .xz)
    case $file in *.xz) xz -dc "$file" ;; *) cat "$file" ;; esac >"$tree/modules/$name" # Debian 13 compresses them; busybox loads plain ones
    echo "$name"
done >"$tree/modules/order"

cat >"$tree/init" <<'INIT'
#!/bin/sh
mount -t devtmpfs dev /dev
while read -r module; do insmod "/modules/$module"; done </modules/order
nine="trans=virtio,version=9p2000.L,msize=512000"
mkdir -p /lower /scratch /newroot
mount -t 9p -o $nine,cache=loose,ro hostroot /lower
mount -t tmpfs scratch /scratch
mkdir -p /scratch/upper /scratch/work
mount -t overlay -o lowerdir=/lower,upperdir=/scratch/upper,workdir=/scratch/work root /newroot
cd /newroot
mkdir -p proc sys dev run lib/modules
mount -t proc proc proc
mount -t sysfs sys sys
mount -t devtmpfs dev dev
mount -t tmpfs run run
mkdir -p run/share
mount -t 9p -o $nine,cache=loose,ro modules lib/modules
mount -t 9p -o $nine share run/share
exec switch_root /newroot /bin/sh /run/share/guest-init
INIT
chmod +x "$tree/init"
(cd "$tree" && find . | cpio -o -H newc --quiet | gzip -1) >"$out.new"
mv "$out.new" "$out"
