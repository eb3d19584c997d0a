#!/usr/bin/env bash
# What it costs to share a still's samples among tasks: processor time, since that does not depend on who else is working.
#
#     tests/farm/scale.sh [SCENE] [OPTIONS OF luxel render]
#
# Prints, for 1 to 64 tasks, the time of one task (their mean), of all, of the merge, and the time of the plain render over
# that of a task and the merge: what so many machines gain.
set -euo pipefail
scene=${1:-scenes/hero.ron}
options=("${@:2}")
[ "$#" -gt 1 ] || options=(--size 240x160 --spp 512)
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cargo build --release
luxel=target/release/luxel
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
TIMEFORMAT='%U %S'

# seconds COMMAND..: its processor time.
seconds() { { time "$@" >/dev/null 2>"$work/talk"; } 2>&1 | awk '{ print $1 + $2 }'; }

plain=$(seconds "$luxel" render "$scene" -o "$work/plain.exr" --threads 1 "${options[@]}")
echo "$scene ${options[*]}: $plain s"
echo "tasks  a task  all tasks  merge  gain"
for n in 4 16 64; do
    all=0
    for ((i = 0; i < n; i++)); do
        one=$(seconds "$luxel" render "$scene" -o "$work/s.exr" --threads 1 "${options[@]}" --shard "$i/$n")
        all=$(awk "BEGIN { print $all + $one }")
    done
    merge=$(seconds "$luxel" merge "$work"/s.exr.*-of-"$n".part -o "$work/s.exr")
    cmp "$work/plain.exr" "$work/s.exr"
    awk -v n=$n -v all="$all" -v merge="$merge" -v plain="$plain" 'BEGIN {
        printf "%5d %6.2f s %8.1f s %4.2f s %5.1f\n", n, all / n, all, merge, plain / (all / n + merge) }'
done
