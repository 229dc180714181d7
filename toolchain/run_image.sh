#!/usr/bin/env bash
# Runs an image of one target where it can run: natively, in QEMU's user mode, or on QEMU's board.
#   run_image.sh [--count] TARGET IMAGE [ARGUMENT]
# --count: one instruction takes a fixed time, so that SysTick counts instructions (1.6 ticks each on m7, 2.048 on m55).
set -euo pipefail
count=()
if [[ ${1:-} == --count ]]; then
  count=(-icount shift=6)
  shift
fi
target=$1 image=$2 argument=${3:-}
semihosting="enable=on,target=native,arg=image${argument:+,arg=$argument}"
board=(-display none -monitor none -serial stdio "${count[@]}" -semihosting-config "$semihosting" -kernel "$image")
case $target in
  host | asan) exec "$image" ${argument:+"$argument"} ;;
  m7) exec qemu-system-arm -M mps2-an500 "${board[@]}" </dev/null 2>&1 ;;
  m55) exec qemu-system-arm -M mps3-an547 "${board[@]}" </dev/null 2>&1 ;;
  r52) exec qemu-arm -cpu max "$image" ${argument:+"$argument"} 2>&1 ;;
  aarch64) exec qemu-aarch64 "$image" ${argument:+"$argument"} ;;
  *) echo "run_image.sh: no such target: $target" >&2; exit 2 ;;
esac
