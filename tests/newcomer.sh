#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows the README as somebody who has nothing: an empty Debian 12 root (debootstrap), this commit in it, then the two commands of
# its block, as they stand there. Prints how long each took and how much was downloaded, and of both together. Needs root, debootstrap and the network.
#   newcomer.sh [demo|test]...      only these of them; FATHOM_ROOT: where the root is made (removed at the end)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ "$(id -u)" = 0 ] || { echo "newcomer: needs root, for debootstrap and chroot" >&2; exit 2; }
wanted=" ${*:-demo test} "
# The lines of the block below "## Two commands" that run one of them without anything more.
commands=$(awk '/^## /{on = /Two commands/} on && /^```/{block = !block; next} on && block && $1 == "./run" && ($2 == "demo" || $2 == "test") && ($3 == "#") {print $1, $2}' README.md)
[ "$(echo "$commands" | wc -l)" = 2 ] || { echo "newcomer: the README does not have its two commands: $commands" >&2; exit 1; }
root=${FATHOM_ROOT:-$(mktemp -d /var/tmp/fathom-newcomer.XXXXXX)}
# The mirror that this machine uses, if it says one for bookworm.
mirror=$(grep -hsoE '^(URIs:|deb) +http[^ ]*/debian/?( |$)' /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources | awk 'NR == 1 { print $2 }' || true)
leave() {
    umount -l "$root/dev/pts" "$root/dev" "$root/sys" "$root/proc" 2>/dev/null || true
    rm -rf --one-file-system "$root" "$root".*log
}
trap leave EXIT
since() { echo $(($(date +%s) - $1)); }

start=$(date +%s)
debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}" >"$root.log" 2>&1 || { tail -5 "$root.log"; exit 1; }
echo "newcomer: empty root in $(since "$start") s, $(du -smx "$root" | cut -f1) MB"
git archive --prefix=fathom/ HEAD | tar -x -C "$root"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
for file in /etc/apt/apt.conf.d/*proxy*; do [ ! -e "$file" ] || cp "$file" "$root/etc/apt/apt.conf.d/"; done
echo 'Binary::apt::APT::Keep-Downloaded-Packages "true"; APT::Keep-Downloaded-Packages "true";' >"$root/etc/apt/apt.conf.d/90keep"
rm -f "$root/etc/apt/apt.conf.d/docker-clean"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"
mount --bind /dev "$root/dev"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
begun=$(date +%s)
downloaded=$(du -sm "$root/var/cache/apt/archives" | cut -f1)
echo "$commands" | while read -r line; do
    command=${line#./run }
    [[ $wanted == *" $command "* ]] || continue
    start=$(date +%s)
    before=$(du -sm "$root/var/cache/apt/archives" | cut -f1)
    chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 sh -c "cd /fathom && $line" </dev/null \
        >"$root.$command.log" 2>&1 || { tail -20 "$root.$command.log"; echo "newcomer: ./run $command failed"; exit 1; }
    tail -1 "$root.$command.log"
    echo "newcomer: ./run $command in $(since "$start") s, $(($(du -sm "$root/var/cache/apt/archives" | cut -f1) - before)) MB downloaded"
    rm -f "$root.$command.log"
done
echo "newcomer: all in $(since "$begun") s, $(($(du -sm "$root/var/cache/apt/archives" | cut -f1) - downloaded)) MB downloaded, root of $(du -smx "$root" | cut -f1) MB"
rm -f "$root.log"
