#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Converts a replay to MCAP, and lets the npm packages that Foxglove is made of decode it (decode.cjs). They are not
# downloaded: FATHOM_NODE_MODULES names the folder node_modules of
#   npm install @mcap/core @foxglove/rosmsg @foxglove/rosmsg2-serialization fzstd
# Without it the test is skipped (exit code 77).
#   decode_test.sh BUILD_FOLDER
set -e
if ! command -v node > /dev/null || [[ ! -d ${FATHOM_NODE_MODULES:-/nowhere}/@mcap/core ]]; then
    echo "SKIPPED: no node, or FATHOM_NODE_MODULES names no folder with @mcap/core"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1/fathom" record apps/scenes/demo.yaml --seconds 0.5 --out "$folder/rec" > /dev/null
"$1/fathom" replay apps/scenes/demo.yaml --device llvmpipe --source "$folder/rec" --save-fixtures --out "$folder/out" > /dev/null
"$1/fathom" convert "$folder/rec" --format mcap --replay "$folder/out" --out "$folder/mcap" > /dev/null
node "$(dirname "$0")/decode.cjs" "$FATHOM_NODE_MODULES" "$folder/mcap/recording.mcap" "$folder/out"
