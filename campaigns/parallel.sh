#!/usr/bin/env bash
# A part of a campaign in each job of GNU parallel, over ssh: HOSTS is a list as --sshlogin takes it (":" = this machine).
#     campaigns/parallel.sh N 4/alice,8/bob upsets --moments 65
# The same line again runs only what failed or is missing. All together: target/release/endat-gen campaign merge parts/*.csv --out upsets.csv
set -euo pipefail
parts="$1"
hosts="$2"
shift 2
program="${ENDAT_GEN:-target/release/endat-gen}"
mkdir -p parts
# The program goes to each host, the parts come back.
seq "$parts" | parallel --will-cite --sshlogin "$hosts" --basefile "$program" --workdir . \
    --return "parts/{}.csv" --cleanup --joblog parts/log --resume-failed --retries 3 \
    "mkdir -p parts && $program campaign $* --threads 1 --shard {}/$parts --out parts/{}.csv"
