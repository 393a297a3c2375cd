#!/bin/sh
# How much two shards on two processes save: a sweep whose cells share nothing, whole by one process and as two shards
# at the same time, each process with one thread. Prints both times and their ratio.
#   tests/bench/shards.sh PROGRAM [SCENE]
set -eu
program=$1 scene=${2:-courtyard}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
now() { date +%s.%N; }
sweep() {
  folder=$1
  shift
  LP_NUM_THREADS=1 "$program" sweep "$scene" --size 640x360 --threads 1 --map-size 512,1024 --slope-bias 0,1,2 \
    --camera-orbit 0,30/90,30 --quiet -o "$work/$folder" "$@"
}

begin=$(now)
sweep whole
whole=$(echo "$(now) - $begin" | bc)
begin=$(now)
sweep part1 --shard 1/2 &
first=$!
sweep part2 --shard 2/2
wait $first
parts=$(echo "$(now) - $begin" | bc)
"$program" merge "$work/part1" "$work/part2" -o "$work/merged" --quiet
cmp "$work/whole/sweep.jsonl" "$work/merged/sweep.jsonl"
printf 'one process %.2f s, two shards at once %.2f s: %.2f times as fast\n' "$whole" "$parts" "$(echo "$whole / $parts" | bc -l)"
