#!/usr/bin/env bash
# How quickly the shadow lab answers (docs/lab.md): 33 changes of the bias and the slope bias, each once the labels of the
# one before are there in full. Needs xvfb-run.
#
#   tests/bench/lab_answers.sh PROGRAM [SCENE]      default: courtyard
set -euo pipefail
program=${1:?which gnomon?} scene=${2-courtyard}
script=$(mktemp)
trap 'rm -f "$script"' EXIT
{
  echo "wait done"
  for step in $(seq 1 22); do printf 'set bias 0.%02dtexel\nwait done\n' $((4 * step)); done
  for step in $(seq 1 11); do printf 'set slope-bias 0.%02d\nwait done\n' $((8 * step)); done
} >"$script"
xvfb-run -a -s "-screen 0 1280x720x24" "$program" view "$scene" --map-size 1024 --size 1280x720 --script "$script"
