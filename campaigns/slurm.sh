#!/usr/bin/env bash
# A part of a campaign in each task of a Slurm array job. N is how many parts there are; all nodes see this folder.
#     sbatch --array=1-N campaigns/slurm.sh N upsets --moments 65
# A part that got lost: sbatch --array=7 campaigns/slurm.sh N upsets --moments 65
# All together: target/release/endat-gen campaign merge parts/*.csv --out upsets.csv
#SBATCH --job-name=campaign
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=parts/%a.log
set -euo pipefail
parts="$1"
shift
program="${ENDAT_GEN:-target/release/endat-gen}"
mkdir -p parts
exec "$program" campaign "$@" --threads 1 \
    --shard "$SLURM_ARRAY_TASK_ID/$parts" --out "parts/$SLURM_ARRAY_TASK_ID.csv"
