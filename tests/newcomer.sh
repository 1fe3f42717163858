#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows the README like a new user: makes an empty Debian root with debootstrap, copies this commit into it and runs the two commands
# of the README there. Then builds the Debian packages in that root, installs them in a second empty root, plays an installed scene and
# builds the program of the install test on /usr. Prints time and download size of each step and of all together.
# Needs root, debootstrap and the network.
#   newcomer.sh [--suite bookworm|trixie] [demo|test|packages]...   only these steps; FATHOM_ROOT: where the root is made, and removed
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ "$(id -u)" = 0 ] || { echo "newcomer: needs root, for debootstrap and chroot" >&2; exit 2; }
suite=bookworm
if [ "${1:-}" = --suite ]; then
    suite=${2:-}
    case $suite in bookworm | trixie) ;; *) echo "newcomer: --suite: '$suite' (allowed: bookworm, trixie)" >&2; exit 2 ;; esac
    shift 2
fi
for word in "$@"; do
    case $word in demo | test | packages) ;; *) echo "newcomer: $word (allowed: demo, test, packages)" >&2; exit 2 ;; esac
done
wanted=" ${*:-demo test packages} "
# The lines of the README's blocks that run one of the two commands and nothing more.
commands=$(awk '/^```/ { block = !block; next } block && $1 == "./run" && ($2 == "demo" || $2 == "test") && (NF == 2 || $3 == "#") && !seen[$2]++ { print $1, $2 }' README.md)
[ "$(echo "$commands" | wc -l)" = 2 ] || { echo "newcomer: the README does not have its two commands: $commands" >&2; exit 1; }
root=${FATHOM_ROOT:-$(mktemp -d /var/tmp/fathom-newcomer.XXXXXX)}
second=$root.installed
# The mirror that this machine's sources name.
mirror=$(grep -hsoE '^(URIs:|deb) +http[^ ]*/debian/?( |$)' /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources | awk 'NR == 1 { print $2 }' || true)
leave() {
    local place
    for place in "$root" "$second"; do
        umount -l "$place/dev/pts" "$place/dev" "$place/sys" "$place/proc" 2>/dev/null || true
    done
    rm -rf --one-file-system "$root" "$second" "$root.cache" "$root".*log "$root.log"
}
trap leave EXIT
since() { echo $(($(date +%s) - $1)); }
megabytes() { du -smxc "$@" | tail -1 | cut -f1; }

# furnish ROOT: copies this commit and the settings that reach the mirror, and mounts what a running system has.
furnish() {
    git archive --prefix=fathom/ HEAD | tar -x -C "$1"
    cp /etc/resolv.conf "$1/etc/" 2>/dev/null || true
    for file in /etc/apt/apt.conf.d/*proxy*; do [ ! -e "$file" ] || cp "$file" "$1/etc/apt/apt.conf.d/"; done
    echo 'Binary::apt::APT::Keep-Downloaded-Packages "true"; APT::Keep-Downloaded-Packages "true";' >"$1/etc/apt/apt.conf.d/90keep"
    rm -f "$1/etc/apt/apt.conf.d/docker-clean"
    mount -t proc proc "$1/proc"
    mount -t sysfs -o ro sysfs "$1/sys"
    mount --bind /dev "$1/dev"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$1/dev/pts"
}

# step ROOT NAME COMMAND: runs the command in /fathom of that root. Prints its last line, its time and its download size, or on
# failure its last 20 lines.
step() {
    local start before log=$root.step.log
    start=$(date +%s)
    before=$(megabytes "$1/var/cache/apt/archives")
    chroot "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -c "cd /fathom && $3" \
        </dev/null >"$log" 2>&1 || { tail -20 "$log"; echo "newcomer: $2 failed"; exit 1; }
    tail -1 "$log"
    echo "newcomer: $2 in $(since "$start") s, $(($(megabytes "$1/var/cache/apt/archives") - before)) MB downloaded"
}

# Builds the packages as the documentation says. Builds only the program and the libraries unless the tests have been built.
make_packages() {
    local build="true"
    [ -e "$root/fathom/build/CMakeCache.txt" ] && [[ $wanted == *" test "* ]] ||
        build="cmake -G Ninja -S . -B build -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF && cmake --build build"
    step "$root" "packages made" "apt-get update -qq &&
        apt-get install -y -qq --no-install-recommends dpkg-dev fakeroot file \$(sed 's/ *#.*//' third_party/packages.txt) && $build &&
        cd build && rm -f *.deb && cpack -G DEB && ls *.deb | tr '\n' ' '"
}

install_packages() {
    furnish "$second"
    cp "$root"/fathom/build/*.deb "$second/fathom/"
    step "$second" "fathom installed" "apt-get update -qq && apt-get install -y -qq ./fathom_*.deb && fathom --version"
    step "$second" "an installed scene" "cd /root && fathom replay /usr/share/fathom/scenes/demo.yaml --device llvmpipe --out demo && ls demo | tr '\n' ' '"
    step "$second" "libfathom-dev installed" "apt-get install -y -qq --no-install-recommends ./libfathom0*.deb ./libfathom-dev_*.deb g++ cmake ninja-build pkg-config"
    step "$second" "a program on /usr" "cmake -DSOURCE=/fathom -DPREFIX=/usr -DCXX=g++ -DVERSION=\$(fathom --version | cut -d' ' -f2) -P tests/install/install_test.cmake"
    step "$second" "packages removed" "apt-get purge -y -qq fathom libfathom0.2 libfathom-dev && ! ls -d /usr/share/fathom /usr/include/fathom 2>/dev/null"
}

start=$(date +%s)
mkdir -p "$root" "$root.cache"
chmod 755 "$root" # tests that change to another user need access
debootstrap --cache-dir="$root.cache" --variant=minbase "$suite" "$root" "${mirror:-http://deb.debian.org/debian}" >"$root.log" 2>&1 || { tail -5 "$root.log"; exit 1; }
bootstrap=$(megabytes "$root.cache" "$root/var/lib/apt/lists")
echo "newcomer: empty $suite root in $(since "$start") s, $bootstrap MB downloaded, $(megabytes "$root") MB"
[[ $wanted != *" packages "* ]] || cp -a "$root" "$second"
furnish "$root"
begun=$(date +%s)
downloaded=$(megabytes "$root/var/cache/apt/archives")
while read -r line; do
    [[ $wanted != *" ${line#./run } "* ]] || step "$root" "$line" "$line"
done <<<"$commands"
[ "$wanted" = " packages " ] || echo "newcomer: all in $(since "$begun") s, $(($(megabytes "$root/var/cache/apt/archives") - downloaded)) MB downloaded, root of $(megabytes "$root") MB"
if [[ $wanted == *" packages "* ]]; then
    make_packages
    install_packages
fi
