#!/bin/bash
# A list of recordings on Slurm, an eighth of it a task, then the tables of all:
#     job=$(sbatch --parsable slurm.sh list.csv runs)
#     sbatch --dependency=afterany:$job --wrap 'sinew batch list.csv --out runs'
# The same commands again do what is missing.
#SBATCH --job-name=sinew
#SBATCH --array=1-8
#SBATCH --cpus-per-task=4
#SBATCH --time=04:00:00
# A minute before the time is up, so that the tables are written.
#SBATCH --signal=TERM@60

srun sinew batch "$1" --out "$2" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --jobs "$SLURM_CPUS_PER_TASK" --progress
status=$?
# 65: some recordings have no result, and status_I_of_N.csv says why.
[ "$status" -eq 65 ] || exit "$status"
