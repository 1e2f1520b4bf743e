#!/bin/sh
# A study on Slurm: an array of as many tasks as there are shares. A task that was killed, or whose node went away, is
# put back into the queue and goes on with the cases that are missing. The folder must be one that all nodes share.
#
#   sbatch --array=1-64 --cpus-per-task=4 studies/cluster/slurm.sh studies/finishing_feed.toml
#
#SBATCH --job-name=gearcut
#SBATCH --requeue
#SBATCH --open-mode=append
set -eu
export RAYON_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}"
exec gearcut study "$1" --quiet --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
