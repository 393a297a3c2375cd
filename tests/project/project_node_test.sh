#!/bin/sh
# Debian 12 brings Node.js 18: no npm package that the tests, the adapters or the page's build take may want a newer one.
# Usage: SOURCE
set -eu
cd -- "$1"
locks="tests/browser/package-lock.json adapters/package-lock.json report/page/package-lock.json"
# A range that admits 18: one of its alternatives begins at 18 or below.
newer=$(grep -nE '"node": "' $locks | grep -vE '(>=?|\^) *(1[0-8]|[0-9])(\.[0-9.]+)?( |"|$)' || true)
[ "$(grep -cE '"node": "' tests/browser/package-lock.json)" -gt 0 ] || { echo "no package says which Node.js it wants"; exit 1; }
[ -z "$newer" ] || { printf 'not for Node.js 18:\n%s\n' "$newer"; exit 1; }
