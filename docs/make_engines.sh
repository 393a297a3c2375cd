#!/bin/sh
# Writes docs/engines.md: docs/make_engines.sh [PROGRAM [FOLDER]]. Needs the adapters' packages (npm install --prefix adapters),
# Chromium, xvfb-run and Blender; takes about a quarter of an hour. What it draws stays in FOLDER [default build/engines].
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
program=${1:-$root/build/release/app/gnomon}
folder=${2:-$root/build/engines}
page=$(mktemp)
trap 'rm -f "$page"' EXIT
node "$root/adapters/engines_page.mjs" "$program" "$folder" >"$page"
cp "$page" "$root/docs/engines.md"
