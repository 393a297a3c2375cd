#!/bin/sh
# Writes the chapters of docs/manual/ that the program makes of itself: docs/make_manual.sh PROGRAM
# PROGRAM: the gnomon to ask [default build/release/app/gnomon].
set -eu
program=${1:-build/release/app/gnomon}
manual=$(cd "$(dirname "$0")" && pwd)/manual
for chapter in options json techniques; do
  "$program" --manual $chapter >"$manual/$chapter.md"
done
