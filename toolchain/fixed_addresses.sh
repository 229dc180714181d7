#!/bin/sh
# Runs a program without address randomisation where that is allowed: with many random bits (vm.mmap_rnd_bits of 32)
# the thread sanitizer finds its shadow memory taken. Where it is not allowed, the program runs as it is.
if setarch -R true 2>/dev/null; then exec setarch -R "$@"; fi
exec "$@"
