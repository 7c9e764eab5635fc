#!/usr/bin/env bash
#SBATCH --job-name=fingertip-sweep
#SBATCH --array=1-4
#SBATCH --cpus-per-task=2
#SBATCH --time=01:00:00
#
# sbatch slurm_array.sh, then, when all tasks have ended (or in a job with --dependency=afterany):
#   fingertip sweep --collect --out results
# A task that was killed is submitted again as it was: sbatch --array=3 --export=ALL,SHARDS=4 ...
# FINGERTIP: the program, build/release/bin/fingertip; compute nodes should not install or compile.
set -euo pipefail

exec "${FINGERTIP:-fingertip}" sweep --config "${SWEEP:-sweep.toml}" --out "${RESULTS:-results}" \
  --shard "$SLURM_ARRAY_TASK_ID/${SHARDS:-$SLURM_ARRAY_TASK_COUNT}" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" --progress off
