#!/usr/bin/env bash
# A campaign on a Slurm cluster: one array task a part, each going on where it was cut off.
#
#   ./s4tp run --seed 0                                                 (once: installs what is missing and builds)
#   sbatch --array=1-64 sim_host/campaign/slurm_array.sh --planner s4tp,idm_lane --episodes 500 --out out/big
#   ./s4tp eval merge out/big/part-*.jsonl --json out/big/results.json  (any time: says n of N done)
#
# Every option is eval's; the array's size is the number of parts. Submit it from the repository's root, which every
# node must see under the same path with the same build. A task that is killed or preempted goes on when requeued.
#SBATCH --job-name=s4tp-eval
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

: "${SLURM_ARRAY_TASK_ID:?submit it as an array: sbatch --array=1-N $0 EVAL-OPTIONS}"
if [[ ${SLURM_ARRAY_TASK_MIN} != 1 || ${SLURM_ARRAY_TASK_COUNT} != "${SLURM_ARRAY_TASK_MAX}" ]]; then
  echo "the array must be 1-N without gaps: each task is one part of N" >&2
  exit 2
fi
cd "${SLURM_SUBMIT_DIR:-.}"
exec "${S4TP_TOOL:-build/host/sim_host/s4tp_tool}" eval "$@" \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_MAX" --jobs "${SLURM_CPUS_PER_TASK:-1}"
