#!/usr/bin/env bash
# Runs an image of one target where it can run: natively, in QEMU's user mode, or on QEMU's board. The console and the
# UART are this process's own input and output.
#   run_image.sh [--count] [--can DESCRIPTOR] TARGET IMAGE [ARGUMENT...]
# --count: one instruction takes 64 ns, so that SysTick counts instructions (1.6 ticks each on m7, 2.048 on m55).
# --can: this open socket is the other end of UART 1.
set -euo pipefail
count=()
can=()
if [[ ${1:-} == --count ]]; then
  count=(-icount shift=6)
  shift
fi
if [[ ${1:-} == --can ]]; then
  can=(-chardev "socket,id=can,fd=$2" -serial chardev:can)
  shift 2
fi
target=$1 image=$2
shift 2
semihosting=enable=on,target=native,arg=image
for argument; do semihosting+=",arg=$argument"; done
board=(-display none -monitor none -serial stdio "${can[@]}" "${count[@]}" -semihosting-config "$semihosting" -kernel "$image")
case $target in
  host) exec "$image" "$@" ;;
  m7) exec qemu-system-arm -M mps2-an500 "${board[@]}" 2>&1 ;;
  m55) exec qemu-system-arm -M mps3-an547 "${board[@]}" 2>&1 ;;
  r52) exec qemu-arm -cpu max "$image" "$@" 2>&1 ;;
  aarch64) exec qemu-aarch64 "$image" "$@" ;;
  *) echo "run_image.sh: no such target: $target" >&2; exit 2 ;;
esac
