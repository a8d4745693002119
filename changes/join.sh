#!/usr/bin/env bash
# Joins the files of changes to the section of a new version in CHANGELOG.md, and removes them.
set -euo pipefail
shopt -s nullglob
cd "$(dirname "${BASH_SOURCE[0]}")"

die() {
    printf 'join.sh: %s\n' "$*" >&2
    exit 1
}

version=${1:-}
[[ $# -eq 1 && $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || die "Usage: changes/join.sh VERSION, as 0.3.0"
log=../CHANGELOG.md
! grep -qxF "## $version" "$log" || die "CHANGELOG.md has a section of $version already"
joined=(*.update.md *.added.md *.changed.md *.fixed.md)
[ ${#joined[@]} -gt 0 ] || die "there is no change since the newest version"

section() { # TITLE FILES...
    [ $# -gt 1 ] || return 0
    printf '\n### %s\n' "$1"
    for file in "${@:2}"; do printf -- '- %s\n' "$(<"$file")"; done
}

text=$(
    sed '/^## /,$d' "$log"
    printf '## %s\n' "$version"
    section "To do when you update" *.update.md
    section Added *.added.md
    section Changed *.changed.md
    section Fixed *.fixed.md
    printf '\n'
    sed -n '/^## /,$p' "$log"
)
printf '%s\n' "$text" >"$log"
rm "${joined[@]}"
