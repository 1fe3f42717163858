#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every block of every document of the tree that begins with ```runnable. Each document has a folder of its own that looks like the
# repository's root with the built tree at build/, so commands run as printed and write nothing into the tree. The built program is
# first in PATH; $OUT is an empty folder. A block is a case. Ends with 'docs: N passed, N failed'.
#   docs_test.sh BUILD_FOLDER
set -uo pipefail
build=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH="$build:$PATH"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0
while read -r document; do
    root=$scratch/${document//\//_}
    export OUT=$root.out
    mkdir -p "$root" "$OUT"
    for entry in *; do
        case $entry in build | out) ;; *) ln -s "$PWD/$entry" "$root/" ;; esac
    done
    ln -s "$build" "$root/build"
    awk -v to="$scratch/block" '/^```runnable/ { n++; file = sprintf("%s.%02d", to, n); next } /^```/ { file = "" } file { print > file }' "$document"
    for block in "$scratch"/block.*; do
        [ -e "$block" ] || continue
        if grep -qE '(^|[;&|(]|build/) *(\./run|ctest)( |$)' "$block"; then
            echo "ERROR: $document: a runnable block must not build or run the tests"
            failed=$((failed + 1))
        elif (cd "$root" && timeout 240 bash -euo pipefail "$block") </dev/null >"$scratch/log" 2>&1; then
            passed=$((passed + 1))
        else
            echo "ERROR: $document: this does not run:"
            cat "$block"
            tail -5 "$scratch/log"
            failed=$((failed + 1))
        fi
        rm -f "$block"
    done
done < <(find . \( -name build -o -name out -o -name '.?*' \) -prune -o -name '*.md' -print | cut -c3- | sort)
[ "$passed" -gt 0 ] || { echo "ERROR: no document has a runnable block"; failed=$((failed + 1)); }
echo "docs: took $SECONDS s"
echo "docs: $passed passed, $failed failed"
[ "$failed" = 0 ]
