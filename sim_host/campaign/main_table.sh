#!/usr/bin/env bash
# The whole table of results: every planner, bare and guarded, in every scenario, in our traffic and in SUMO's.
#
#   sim_host/campaign/main_table.sh [--jobs N] [--episodes N] [--first-seed N] [--parts NAME,...] FOLDER
#
#   --jobs N       episodes at a time (default: one a core)
#   --episodes N   so many a cell, to try it (default: 100 in our traffic, 40 in SUMO's, and what is below)
#   --first-seed N the block of seeds (default: 10000; a table that decides something takes one nothing was looked at on)
#   --parts NAMES  of builtin, sumo, long, raw, real, networks and networks_sumo only these (default: all, in this order)
#
# Killed or interrupted, the same command goes on. FOLDER then holds a folder for each part, with its record
# (episodes.jsonl) and its numbers (results.json, against_PLANNER.json); report/index.html, with replays of failures; and
# docs/, which docs/results is a copy of.
set -euo pipefail
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")

jobs=$(nproc)
episodes=
first_seed=10000
parts=builtin,sumo,long,raw,real,networks,networks_sumo
while [[ ${1:-} == --* ]]; do
  case $1 in
    --jobs) jobs=$2 ;;
    --episodes) episodes=$2 ;;
    --first-seed) first_seed=$2 ;;
    --parts) parts=$2 ;;
    *) break ;;
  esac
  shift 2
done
if (($# != 1)) || [[ $1 == -* ]]; then
  sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
folder=$(realpath -m "$1")
cd "$root"

tool=${S4TP_TOOL:-build/host/sim_host/s4tp_tool}
[[ -n ${S4TP_TOOL:-} ]] || ./s4tp eval --help >/dev/null # installs what is missing, and builds
command -v sumo >/dev/null || { echo "main_table.sh: sumo is missing: apt-get install sumo" >&2; exit 2; }

all=s4tp,static_drf,drf_controller,predictive_decision,idm_lane,constant_speed
twins=s4tp_kinematic,predictive_decision_kinematic # the same without the learned predictor
mapfile -t networks < <(ls tests/networks/*.toml)
mapfile -t for_sumo < <(printf '%s\n' "${networks[@]}" | grep -v strange_names)  # it takes its edges' names apart
every_road=(--scenarios left_turn,left_turn_t,merge,cruise,overtake,cut_in --flavours smarts,social)
parts=(${parts//,/ })

# part NAME EPISODES PLANNERS EVAL-OPTIONS...
part() {
  local name=$1 most=$2 planners=$3 other
  shift 3
  [[ " ${parts[*]} " == *" $name "* ]] || return 0
  echo "== $name: part $((++number)) of ${#parts[@]}" >&2
  mkdir -p "$folder/$name"
  "$tool" eval --planner "$planners" "$@" --episodes "${episodes:-$most}" --first-seed "$first_seed" --jobs "$jobs" \
    --out "$folder/$name" >"$folder/$name/table.txt"
  for other in ${planners//,/ }; do
    [[ $other == s4tp ]] || "$tool" eval compare "$folder/$name/results.json" --planner s4tp --against "$other" \
      --json "$folder/$name/against_$other.json" >/dev/null
  done
}

number=0
part builtin 100 $all,$twins --guard on,off "${every_road[@]}"
part sumo 40 $all,sumo_driver --traffic sumo --guard on,off "${every_road[@]}"
part long 500 s4tp,static_drf,predictive_decision,idm_lane --scenarios left_turn,merge --flavours smarts,social
part raw 100 s4tp --guard on,off --scenarios left_turn --flavours smarts_raw
part real 40 $all --perception real "${every_road[@]}"
part networks 20 s4tp,static_drf,idm_lane --scenarios "$(IFS=,; echo "${networks[*]}")"
part networks_sumo 20 s4tp,idm_lane,sumo_driver --traffic sumo --guard on,off --scenarios "$(IFS=,; echo "${for_sumo[*]}")"

python3 -B sim_host/campaign/results_page.py "$folder" --out "$folder/docs" \
  --commit "$(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
"$tool" eval report "${parts[@]/#/$folder/}" --out "$folder/report" --replays 1 --jobs "$jobs"
echo "for the repository: cp $folder/docs/* docs/results/"
