#!/usr/bin/env bash
# Cases of the target tests: case.sh CASE RUNNER TARGET IMAGE [LOG]
set -uo pipefail
case=$1 runner=("$2") target=$3 image=$4 log=${5:-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

run() { # run LOG: the image's output and exit code
  timeout 550 "${runner[@]}" "$target" "$image" "$@" </dev/null >"$scratch/out"
  code=$?
  cat "$scratch/out"
}

expect() { # expect CODE PATTERN
  [[ $code == "$1" ]] || { echo "exit code $code instead of $1"; exit 1; }
  grep -Eq "$2" "$scratch/out" || { echo "no line like: $2"; exit 1; }
}

first_ticks() { # the log's first 3000 lines are enough to see a fault, and quick in QEMU
  head -n 3000 "$log"
}

case $case in
  self_test) # CORE-012 on the processor itself
    run
    expect 0 'self-test passed'
    ;;
  replay) # TARGET-001
    run "$log"
    expect 0 '^[0-9]+ ticks, [0-9]+ plans, [0-9]+ missed, [0-9]{3,} frames compared, 0 differ'
    ;;
  optimizer_check) # CORE-010: optimizer_check.cpp judges
    run
    expect 0 '^optimizer bits'
    ;;
  network_check) # SATP-020, SATP-030: network_check.cpp judges
    timeout 500 "${runner[@]}" --count "$target" "$image" </dev/null >"$scratch/out"
    code=$?
    cat "$scratch/out"
    expect 0 '^network bits'
    ;;
  changed_frame) # one hexadecimal digit of one Command frame
    first_ticks | awk '/ 008#/ && ++n == 40 { d = substr($0, length($0)); sub(/.$/, d == "7" ? "6" : "7") } { print }' \
      >"$scratch/changed.log"
    run "$scratch/changed.log"
    expect 1 '^first difference at tick 40,.*recorded Command 008#'
    ;;
  other_parameters) # TARGET-002
    first_ticks | sed '1s/parameters [0-9]*/parameters 1/' >"$scratch/other.log"
    run "$scratch/other.log"
    expect 2 'driven with other parameters'
    ;;
  flipped) # the image differs from the others in the last digit of one constant
    run "$log"
    expect 1 '^first difference at tick'
    ;;
  ecu_image) # it boots, control runs at 100 Hz in the timer interrupt, the UART speaks, the watchdog stays quiet
    # -icount: the board's time is its instructions', so that a busy host does not let the watchdog bite.
    timeout 90 "${runner[@]}" --count "$target" "$image" </dev/null >"$scratch/out" &
    pid=$!
    for ((i = 0; i < 800; ++i)); do
      (($(grep -c '^tick ' "$scratch/out") >= 3)) && break
      sleep 0.1
    done
    kill $pid
    wait $pid 2>/dev/null
    cat "$scratch/out"
    code=0
    expect 0 '^s4tp ecu: kOk'
    expect 0 '^tick 30[0-9] at 30[0-9][0-9] ms mode 0 '
    (($(grep -c '^s4tp ecu' "$scratch/out") == 1)) || { echo "it was reset"; exit 1; }
    ;;
  hal_check) # hal_check.cpp judges; -icount makes its times exact; the UART gets what it waits for
    printf 'A' | timeout 60 "${runner[@]}" --count "$target" "$image" >"$scratch/out"
    code=$?
    cat "$scratch/out"
    expect 0 '^reset by the watchdog'
    ;;
  map_cost) # WIRE-035: map_cost.cpp judges; -icount counts instructions
    timeout 60 "${runner[@]}" --count "$target" "$image" </dev/null >"$scratch/out"
    code=$?
    cat "$scratch/out"
    expect 0 '^within the limit'
    ;;
  *) echo "no such case: $case"; exit 2 ;;
esac
