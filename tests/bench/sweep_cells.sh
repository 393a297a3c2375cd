#!/bin/sh
# What a sweep saves: a sweep of 6 map sizes x 6 slope biases x 4 techniques, and before and after it separate comparisons
# of eight of its cells. Prints seconds per cell and their ratio.
#   tests/bench/sweep_cells.sh PROGRAM [SCENE]
set -eu
program=$1 scene=${2:-courtyard}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
now() { date +%s.%N; }
compared=0
compare() {
  begin=$(now)
  for technique in hard pcf second-depth pcss; do
    for size in 512 2048; do
      "$program" compare "$scene" --size 1280x720 --map-size $size --slope-bias 1 --technique $technique --quiet -o "$work/alone"
    done
  done
  compared=$(echo "$compared + $(now) - $begin" | bc)
}
compare
begin=$(now)
"$program" sweep "$scene" --size 1280x720 --map-size 256,512,768,1024,1536,2048 --slope-bias 0:2.5:6 \
  --technique hard,pcf,second-depth,pcss --quiet -o "$work/sweep"
cell=$(echo "($(now) - $begin) / 144" | bc -l)
compare
alone=$(echo "$compared / 16" | bc -l)
printf 'a cell of the sweep %.2f s, a comparison of its own %.2f s: %.1f times as fast\n' "$cell" "$alone" \
  "$(echo "$alone / $cell" | bc -l)"
