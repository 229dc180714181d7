#!/usr/bin/env bash
# Runs a command on a kernel that has CAN, where the host's has none: a small virtual machine that sees the host's files
# (read-only; what it writes is thrown away), has a vcan that is up, and no network but that.
#
#   vcan_machine.sh [--seconds N] [--interface NAME] [--writable DIR]... COMMAND [ARGUMENT...]
#   vcan_machine.sh --build
#
#   --seconds N        ends the command after N seconds (default 300) with code 124
#   --interface NAME   of the vcan (default vcan0)
#   --writable DIR     what the command writes below DIR stays
#   --build            only gets the machine ready
#
# One argument alone is taken as a line for bash. Output and exit code are the command's; 125: the machine itself failed.
# The kernel is Debian's, unpacked once into build/machine (installed: ~/.cache/s4tp); nothing is installed. Emulated without the help of the
# processor (nested virtualisation is not to be relied on), so about a tenth of the host's speed.
set -euo pipefail

modules=(virtio_pci 9pnet_virtio 9p overlay vcan can-raw can-bcm sch_tbf)
packages=(qemu-system-x86 busybox-static cpio iproute2 can-utils)
# In the sources; an installed script has a folder of the user's.
cache_root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
[[ -e $cache_root/CMakeLists.txt ]] && cache_root=$cache_root/build/machine || cache_root=${XDG_CACHE_HOME:-$HOME/.cache}/s4tp

die() {
  echo "vcan_machine.sh: $*" >&2
  exit 125
}

# First program of the machine: the host's root under a throw-away layer, then the job.
init_program() {
  cat <<INIT
#!/bin/busybox sh
export PATH=/bin
busybox mkdir -p /proc /sys /dev /host /layer /root
busybox mount -t proc proc /proc
busybox --install -s /bin
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mkdir -p /dev/pts /dev/shm
mount -t devpts pts /dev/pts
mount -t tmpfs shm /dev/shm
for module in ${modules[*]}; do modprobe \$module; done
over=trans=virtio,version=9p2000.L,msize=524288
mount -t 9p -o \$over,cache=loose,ro host /host
mount -t tmpfs layer /layer
mkdir /layer/new /layer/work
mount -t overlay -o lowerdir=/host,upperdir=/layer/new,workdir=/layer/work overlay /root
for folder in proc sys dev; do mount --rbind /\$folder /root/\$folder; done
mount -t tmpfs run /root/run
mkdir /root/run/job
mount -t 9p -o \$over job /root/run/job
chroot /root /bin/bash /run/job/start >/dev/kmsg 2>&1
sync
poweroff -f
INIT
}

# The package linux-image-amd64 stands for, unpacked here.
fetch_kernel() {
  kernel=$(apt-cache depends linux-image-amd64 2>/dev/null | sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*\)$/\1/p' | head -n 1)
  [[ -n $kernel ]] || { echo "apt knows no linux-image-amd64; its lists are missing: apt-get update"; return 1; }
  apt-get download -q "$kernel" && dpkg -x "$kernel"_*.deb . && rm "$kernel"_*.deb
}

# Kernel and first file system, in a folder of the cache named after what they are made from.
build() {
  local folder=$1 work kernel version tree list
  mkdir -p "$cache_root"
  exec 8>"$cache_root/lock"
  flock 8
  [[ -d $folder ]] && return # another one has just built it
  rm -rf "$cache_root"/build.*
  work=$(mktemp -d "$cache_root/build.XXXXXX")
  echo "unpacking Debian's kernel for the virtual machine (once)" >&2
  cd "$work"
  # Lists that are missing or old are the usual reason; who may not refresh them is told so by the second attempt.
  if ! fetch_kernel >log 2>&1; then
    { apt-get update || sudo -n apt-get update; } >>log 2>&1 || true
    fetch_kernel >>log 2>&1 || { tail -n 8 log >&2; rm -rf "$work"; die "cannot fetch the kernel for the machine"; }
  fi
  cd - >/dev/null
  version=$(basename "$work"/lib/modules/*)
  tree=$work/lib/modules/$version
  busybox depmod -b "$work" "$version"
  list=$work/list
  for module in "${modules[@]}"; do
    grep -E "(^|/)$module\.ko:" "$tree/modules.dep" | tr -d : | tr ' ' '\n' || die "$kernel has no module $module"
  done | sort -u >"$list"
  mkdir -p "$work/first/bin" "$work/first/lib/modules/$version"
  cp /bin/busybox "$work/first/bin/"
  cp "$tree"/modules.{order,builtin,builtin.modinfo} "$work/first/lib/modules/$version/"
  (cd "$tree" && cpio -pdm "$work/first/lib/modules/$version" <"$list" 2>/dev/null)
  busybox depmod -b "$work/first" "$version"
  init_program >"$work/first/init"
  chmod +x "$work/first/init"
  mkdir "$work/done"
  (cd "$work/first" && find . | cpio -o -H newc 2>/dev/null) | gzip -1 >"$work/done/first.gz"
  cp "$work/boot/vmlinuz-$version" "$work/done/kernel"
  rm -rf "$cache_root"/machine-*
  mv "$work/done" "$folder"
  rm -rf "$work"
  exec 8>&-
}

seconds=300
interface=vcan0
writable=()
build_only=0
if [[ ${1:-} == --build ]]; then
  build_only=1
  shift
fi
while [[ ${1:-} == --* ]]; do
  case $1 in
    --seconds) seconds=$2 ;;
    --interface) interface=$2 ;;
    --writable)
      folder=$(realpath -e "$2") || die "--writable $2: no such folder"
      [[ " ${writable[*]} " == *" $folder "* ]] || writable+=("$folder")
      ;;
    *) die "unknown option $1" ;;
  esac
  shift 2
done
((build_only || $#)) || die "which command?"
[[ $(uname -m) == x86_64 ]] || die "only on x86-64 hosts"
for tool in qemu-system-x86_64 busybox cpio ip candump; do
  command -v $tool >/dev/null || die "$tool is missing: apt-get install ${packages[*]}"
done

machine=$cache_root/machine-$(init_program | sha256sum | cut -c 1-12)
[[ -d $machine ]] || build "$machine"
((build_only)) && exit 0

job=$(mktemp -d)
running=()
trap 'kill "${running[@]}" 2>/dev/null || true; rm -rf "$job"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
shares=()
{
  echo "export PATH=$(printf %q "$PATH"):/usr/sbin:/sbin HOME=$(printf %q "$HOME") LANG=C.UTF-8"
  echo "ip link set lo up && ip link add $(printf %q "$interface") type vcan && ip link set $(printf %q "$interface") mtu 72 up"
  for i in "${!writable[@]}"; do
    shares+=(-virtfs "local,path=${writable[i]},mount_tag=share$i,security_model=none")
    echo "mount -t 9p -o trans=virtio,version=9p2000.L,msize=524288 share$i $(printf %q "${writable[i]}")"
  done
  echo "cd $(printf %q "$PWD")"
  command=("$@")
  (($# > 1)) || command=(bash -c "$1")
  echo "timeout -k 5 $seconds $(printf '%q ' "${command[@]}") </dev/null >/run/job/out 2>/run/job/err"
  echo 'echo $? >/run/job/code'
} >"$job/start"
: >"$job/out" >"$job/err"

# One processor: a program that moves to another between two frames may see them overtake each other on a vcan.
timeout -k 5 $((seconds + 60)) qemu-system-x86_64 -accel tcg,thread=multi -cpu max -smp 1 -m 2G \
  -display none -monitor none -nic none -no-reboot -serial "file:$job/console" \
  -kernel "$machine/kernel" -initrd "$machine/first.gz" -append 'console=ttyS0 quiet panic=-1 mitigations=off audit=0' \
  -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
  -virtfs local,path="$job",mount_tag=job,security_model=none "${shares[@]}" </dev/null >"$job/qemu" 2>&1 &
qemu=$!
# Waited for as jobs: a signal ends a wait at once, but not a program in the foreground.
tail -q -n +1 -f -s 0.2 --pid=$qemu "$job/out" 2>/dev/null &
running=($qemu $!)
tail -q -n +1 -f -s 0.2 --pid=$qemu "$job/err" >&2 2>/dev/null &
running+=($!)
wait "${running[@]}" || true
running=()
if [[ ! -s $job/code ]]; then
  tail -n 20 "$job/qemu" "$job/console" >&2
  die "the machine did not finish"
fi
exit "$(cat "$job/code")"
