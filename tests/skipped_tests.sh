#!/usr/bin/env bash
# Names every test that the last run of ctest skipped for no reason of tests/allowed_skips.txt, and fails if there is
# one. Says nothing otherwise. Usage: skipped_tests.sh BUILD_FOLDER
set -euo pipefail
here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")
log=$1/Testing/Temporary/LastTest.log
# GoogleTest prints the reason on the line before, as "FILE:LINE: Skipped" and then the text; a script prints
# "skipped: REASON".
reasons=$(awk '
  /: Skipped$/ { getline; print "GoogleTest: " $0 }
  /^(skipped|SKIPPED): / { print }
' "$log" | sort | uniq -c)
allowed=$(sed -e 's/[[:space:]]*#.*//' -e '/^$/d' "$here/allowed_skips.txt")
unexpected=$(grep -v -E -f <(printf '%s\n' "$allowed") <<<"$reasons" | sed '/^$/d' || true)
[[ -z $unexpected ]] && exit 0
printf 'Skipped, though no reason of tests/allowed_skips.txt holds:\n%s\n' "$unexpected" >&2
exit 1
