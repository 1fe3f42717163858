#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs what the documents say can be run: every line of a block that begins with ```runnable, from the repository root, with the
# built program in front of the search path. Prints 'docs: N passed, N failed'; a block is a case.
#   docs_test.sh BUILD_FOLDER
set -uo pipefail
build=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH="$build:$PATH"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export OUT=$scratch
passed=0 failed=0
for document in README.md ARCHITECTURE.md CONTRIBUTING.md docs/*.md; do
    awk -v to="$scratch/block" '/^```runnable/ { n++; file = to "." n; next } /^```/ { file = "" } file { print > file }' "$document"
    for block in "$scratch"/block.*; do
        [ -e "$block" ] || continue
        if grep -qE '(\./)?run test' "$block"; then
            echo "ERROR: $document: a runnable block must not run the tests"
            failed=$((failed + 1))
        elif timeout 120 bash -euo pipefail "$block" >"$scratch/log" 2>&1; then
            passed=$((passed + 1))
        else
            echo "ERROR: $document: this does not run:"
            cat "$block"
            tail -5 "$scratch/log"
            failed=$((failed + 1))
        fi
        rm -f "$block"
    done
done
[ "$passed" -gt 0 ] || { echo "ERROR: no document has a runnable block"; failed=$((failed + 1)); }
echo "docs: $passed passed, $failed failed"
[ "$failed" = 0 ]
