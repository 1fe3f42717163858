#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every block of a document that begins with ```runnable, and checks that links between documents resolve: files and headings.
# A block that follows a line '<!-- FILE -->' must equal that file, and some document must show each program of apps/examples.
# Each document runs in a folder that looks like the repository's root with the built tree at build/, so commands run as written and
# what they write stays out of the tree. The built program is first in PATH, and $OUT is an empty folder.
# The table of shaders/README.md must list the specialisation constants that each compute shader declares.
# Ends with 'docs: N passed, N failed'. A block is a case, and so are the links of a document, each example and each compute shader.
#   docs_test.sh BUILD_FOLDER
set -uo pipefail
build=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH="$build:$PATH"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0 blocks=0 shown=""

# Prints the anchors of a document as GitHub makes them: of its headings, and <a id="...">.
anchors() {
    awk '/^ *```/ { code = !code; next }
         code { next }
         /^#+ / { heading = tolower($0); sub(/^#+ /, "", heading); gsub(/\]\([^)]*\)/, "", heading)
                  gsub(/[^a-z0-9_ -]/, "", heading); gsub(/ /, "-", heading); print heading }
         { while (match($0, /<a id="[^"]+"/)) { print substr($0, RSTART + 7, RLENGTH - 8); $0 = substr($0, RSTART + RLENGTH) } }' "$1"
}

# Prints the links of a document that lead nowhere.
broken_links() {
    awk '/^ *```/ { code = !code; next }
         code { next }
         { while (match($0, /\]\([^) ]+\)/)) { print substr($0, RSTART + 2, RLENGTH - 3); $0 = substr($0, RSTART + RLENGTH) } }' "$1" |
        grep -vE '^[a-z]+:' | while read -r link; do
        local file=${link%%#*} target=$1
        [ -z "$file" ] || target=$(dirname "$1")/$file
        if [ ! -e "$target" ] || { [[ $link == *#* ]] && ! anchors "$target" | grep -qxF -- "${link#*#}"; }; then
            echo "$link"
        fi
    done
}

# Prints the files that a document shows, each a line '<!-- FILE -->' in front of a block.
shown_files() {
    sed -nE 's/^<!-- ([a-z0-9_./]+) -->$/\1/p' "$1"
}

# Prints the block behind the line '<!-- FILE -->' of a document.
shown_block() {
    awk -v mark="<!-- $2 -->" '/^```/ && inside { exit } inside { print } /^```/ && next_is { inside = 1 } { next_is = ($0 == mark) }' "$1"
}

# Prints the specialisation constants that a shader and its includes declare.
declared_constants() {
    sed -nE 's/.*constant_id = kSpec([A-Za-z]+).*/\1/p' "$1"
    local file
    for file in $(sed -nE 's/^#include "(shaders\/lib\/.*)"$/\1/p' "$1"); do
        declared_constants "$file"
    done
}

# Prints the specialisation constants that shaders/README.md lists for a shader: in its row of the table, or "`NAME` (constant A, B)".
listed_constants() {
    awk -F '|' -v name="\`$1\`" 'NF > 2 && index($2, name) { print $(NF - 1) }' shaders/README.md
    sed -nE "s/.*\`$1\` \(constant ([A-Za-z, ]+)\).*/\1/p" shaders/README.md
}

while read -r document; do
    for file in $(shown_files "$document"); do
        if shown_block "$document" "$file" | cmp -s - "$file"; then
            passed=$((passed + 1))
            shown+=" $file "
        else
            echo "ERROR: $document: the block behind '<!-- $file -->' differs from the file: copy the file into it"
            failed=$((failed + 1))
        fi
    done
    broken=$(broken_links "$document")
    if [ -z "$broken" ]; then
        passed=$((passed + 1))
    else
        echo "ERROR: $document: links lead nowhere:" $broken
        failed=$((failed + 1))
    fi
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
        blocks=$((blocks + 1))
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
for shader in shaders/*.comp; do
    declared=$(declared_constants "$shader" | sort -u | tr '\n' ' ')
    listed=$(listed_constants "$(basename "$shader" .comp)" | tr -cs '[:alpha:]' '\n' | sed '/^$/d' | sort | tr '\n' ' ')
    if [ "$declared" = "$listed" ]; then
        passed=$((passed + 1))
    else
        echo "ERROR: shaders/README.md lists the constants ${listed}for $shader, which declares $declared"
        failed=$((failed + 1))
    fi
done
for example in apps/examples/*.cpp; do
    [[ $shown == *" $example "* ]] || { echo "ERROR: no document shows $example as it is"; failed=$((failed + 1)); }
    [ "$(wc -l <"$example")" -le 60 ] || { echo "ERROR: $example has over 60 lines"; failed=$((failed + 1)); }
done
# The README's row on Embree has the extremes of the table. The benchmarks have the number of stability cases without recordings, and
# the ratios and exponents of the tables.
extremes=$(awk -F, '/^contact .* x (64|1024) leaves,Embree points,/ { if (!most || $19 < least) least = $19; if ($19 > most) most = $19 }
                    END { printf "%.2f to %.1f times as fast", least, most }' docs/peers.csv)
grep -qF "| $extremes |" README.md || { echo "ERROR: README.md: compared with Embree: not '$extremes'"; failed=$((failed + 1)); }
# Prints the exponent of the frame's time in a column of lavapipe's `scaling`: least squares of the logarithms.
exponent() {
    awk -F, -v source="$1" -v x="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) { at[$i] = i } next }
        $1 == source && $(at[x]) > 0 { a = log($(at[x])); b = log($(at["upload_to_published_p50_ms"])); n++; sa += a; sb += b; ab += a * b; aa += a * a }
        END { printf "^%.2f", (ab - sa * sb / n) / (aa - sa * sa / n) }' docs/lavapipe/scaling.csv
}
# Prints the ratios of lavapipe's `limit` in one case.
ratios() {
    awk -F, -v source="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) { at[$i] = i } next }
        $1 == source { r[$2] = $(at["ratio"]) }
        END { printf "`surface` %.1f, `thin` %.1f, `spheres` %.1f, `classify` %.1f, collecting %.1f, the grid %.1f", r["surface"], r["thin"],
                     r["spheres"], r["classify"], r["collect"], r["grid"] }' docs/lavapipe/limit.csv
}
benchmarks=$(tr -s ' \n' ' ' <docs/benchmarks.md)
for part in "with noise: $(ratios '100 % forbidden')." "Without noise: $(ratios '100 % forbidden; noise-free')." \
    "grows as pixels$(exponent 'size; every point forbidden' pixels), with" \
    "forbidden pixels as $(exponent 'forbidden share of 640x480' forbidden_percent)," \
    "classes as $(exponent 'classes; 10 % forbidden' classes) "; do
    [[ $benchmarks == *"$part"* ]] || { echo "ERROR: docs/benchmarks.md: not '$part'"; failed=$((failed + 1)); }
done
cases=$(fathom stability --list | grep -vc -- -recording-)
grep -qF "measures $cases cases" docs/benchmarks.md || { echo "ERROR: docs/benchmarks.md: not 'measures $cases cases'"; failed=$((failed + 1)); }
[ "$blocks" -gt 0 ] || { echo "ERROR: no document has a runnable block"; failed=$((failed + 1)); }
echo "docs: took $SECONDS s"
echo "docs: $passed passed, $failed failed"
[ "$failed" = 0 ]
