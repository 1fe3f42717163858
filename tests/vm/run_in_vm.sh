#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command on Debian's own kernel in a virtual machine whose root is this machine's own (read only below a scratch layer), so
# that the program and its libraries need no installation. Exits with the command's exit code.
#   run_in_vm.sh [-m "MODULE [OPTION...]"]... [-e NAME=VALUE]... [-o DIR] [-t SECONDS] [-i] -- COMMAND [ARGUMENT...]
# -m loads a kernel module; -o: files that the command leaves in $FATHOM_VM_OUT come back into DIR, with kernel.log.
# -i: the guest's clock counts its instructions, 2 ns each, and skips what it sleeps. Programs there see a processor of the
# same speed regardless of the load of this machine; SECONDS are those of this machine.
# Exit 77: no virtual machine can start here, the reason is printed; 125: the guest did not finish (the kernel's last words follow).
# Environment: FATHOM_VM_CACHE (the kernel, default build/vm), FATHOM_VM_MIB (memory, default 2048), FATHOM_VM_ACCEL (tcg or kvm).
# Nothing reaches the network but one apt-get download of the kernel's package, which is unpacked and never installed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=${FATHOM_VM_CACHE:-$here/../../build/vm}

skip() {
    echo "SKIPPED: no virtual machine: $1"
    exit 77
}

modules=() variables=() out="" seconds=170 counted=""
while getopts "m:e:o:t:i" option; do
    case $option in
    m) modules+=("$OPTARG") ;;
    e) variables+=("$OPTARG") ;;
    o) out=$OPTARG ;;
    t) seconds=$OPTARG ;;
    i) counted=yes ;;
    *) sed -n '5,10p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))
[ $# -gt 0 ] || { sed -n '5,10p' "${BASH_SOURCE[0]}" >&2; exit 2; }

for tool in qemu-system-x86_64 busybox cpio modprobe depmod dpkg-deb apt-get flock; do
    command -v $tool >/dev/null || PATH=$PATH:/usr/sbin:/sbin command -v $tool >/dev/null || skip "$tool is not installed"
done
PATH=$PATH:/usr/sbin:/sbin
mkdir -p "$cache"
cache=$(cd "$cache" && pwd)

# The kernel of this Debian, fetched once.
fetch_kernel() {
    local package
    package=$(apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends: linux-image/ { print $2; exit }')
    [ -n "$package" ] || skip "the package index knows no linux-image-amd64 (apt-get update)"
    rm -rf "$cache"/kernel.new "$cache"/*.deb
    (cd "$cache" && apt-get download "$package" >download.log 2>&1) || skip "the kernel's package $package cannot be downloaded"
    dpkg-deb -x "$cache"/"$package"_*.deb "$cache/kernel.new"
    rm -f "$cache"/*.deb
    [ -e "$cache/kernel.new/lib" ] || ln -s usr/lib "$cache/kernel.new/lib" # Debian 13 has modules in /usr/lib
    mv "$cache/kernel.new" "$cache/kernel"
}
exec 9>"$cache/lock"
flock 9
[ -d "$cache/kernel" ] || fetch_kernel
[ "$cache/initramfs.gz" -nt "$here/make_initramfs.sh" ] || "$here/make_initramfs.sh" "$cache/kernel" "$cache/initramfs.gz"
flock -u 9

# A nested kernel module without VMX or SVM also opens, but runs a stock kernel far slower than plain emulation. With
# emulation one processor is steadier than two.
accel=${FATHOM_VM_ACCEL:-tcg}
if [ -z "${FATHOM_VM_ACCEL:-}$counted" ] && [ -w /dev/kvm ] && grep -qwE 'vmx|svm' /proc/cpuinfo; then
    accel=kvm
fi
machine=(-accel tcg,tb-size=256 -cpu max,la57=off -smp 1)
[ -n "$counted" ] && accel=tcg && machine+=(-icount shift=1,sleep=off)
[ "$accel" = kvm ] && machine=(-accel kvm -cpu host -smp 2)

share=$(mktemp -d "$cache/share.XXXXXX")
trap 'rm -rf "$share"' EXIT
mkdir "$share/out"
{
    echo 'exec >/dev/ttyS1 2>&1 </dev/null; stty -F /dev/ttyS1 raw -echo'
    echo 'export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8'
    echo 'export FATHOM_VM=1 FATHOM_VM_OUT=/run/share/out'
    echo 'mkdir -p /dev/pts /dev/shm; mount -t devpts devpts /dev/pts; mount -t tmpfs shm /dev/shm'
    for variable in "${variables[@]}"; do printf 'export %q\n' "$variable"; done
    for module in "${modules[@]}"; do echo "modprobe $module || echo 'run_in_vm: no module $module'"; done
    printf 'cd %q || cd /\n' "$PWD"
    printf '%q ' "$@"
    printf '\n%s\n' 'rc=$?; echo $rc >/run/share/rc; sync; echo o >/proc/sysrq-trigger; while :; do sleep 1; done'
} >"$share/guest-init"

# no_timer_check: a busy machine delays the emulated timer so much at boot that the kernel considers it broken and panics.
readonly_share() { echo "-fsdev local,id=$1,path=$2,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=$1,mount_tag=$1"; }
status=0
# shellcheck disable=SC2046  # one word an option
timeout --foreground "$seconds" qemu-system-x86_64 -M pc "${machine[@]}" -m "${FATHOM_VM_MIB:-2048}" -nodefaults -no-user-config -no-reboot \
    -display none -serial file:"$share/kernel.log" -serial stdio -kernel "$cache"/kernel/boot/vmlinuz-* -initrd "$cache/initramfs.gz" \
    -append "console=ttyS0 panic=-1 nokaslr mitigations=off random.trust_cpu=on no_timer_check" -device virtio-rng-pci \
    $(readonly_share hostroot /) $(readonly_share modules "$(realpath "$cache/kernel/lib/modules")") \
    -fsdev local,id=share,path="$share",security_model=none -device virtio-9p-pci,fsdev=share,mount_tag=share </dev/null || status=$?

if [ -n "$out" ]; then
    mkdir -p "$out"
    cp -r "$share/out/." "$share/kernel.log" "$out/"
fi
[ -f "$share/rc" ] && exit "$(cat "$share/rc")"
[ "$status" = 1 ] && [ ! -s "$share/kernel.log" ] && skip "qemu cannot start"
echo "run_in_vm: the guest did not finish within $seconds s (qemu ended with $status); its kernel's last words:"
tail -15 "$share/kernel.log"
exit 125
