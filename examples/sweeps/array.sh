#!/bin/sh
# A point of field.json as a task of a Slurm array:
#     sbatch --array=0-$(($(spinneb sweep field.json --count) - 1)) array.sh
#     spinneb collect field.json                         when all are done
# What is done is not run again: the same lines run what was lost to a time limit.
#SBATCH --job-name=field
#SBATCH --cpus-per-task=1
#SBATCH --time=00:10:00
spinneb sweep field.json --index "$SLURM_ARRAY_TASK_ID" --threads "${SLURM_CPUS_PER_TASK:-1}"
