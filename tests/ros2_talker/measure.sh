#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Measures ROS 2 on loopback, as docs/guide/ros2.md reports it: latency from the stamp of a depth image to its
# published set, wrenches on arrival, and dropped frames. Prints rows of a Markdown table.
#   tests/ros2_talker/measure.sh [BUILD [SECONDS [DOMAIN]]]
# "transport" has no classes of points, so no pass runs; "wall" has a forbidden plane that fills the image.
set -euo pipefail
build=$(realpath "${1:-build}")
seconds=${2:-20}
domain=${3:-77}
folder=$(mktemp -d)
pids=()
cleanUp() {
    kill "${pids[@]}" 2> /dev/null || true
    rm -rf "$folder"
}
trap cleanUp EXIT
mkfifo "$folder/in" "$folder/listen"

echo "t_s,x,y,z,qw,qx,qy,qz,button" > "$folder/hand.csv"
for t in 0 "$seconds"; do
    echo "$t,0,0,0.3,1,0,0,0,0" >> "$folder/hand.csv"
done
scene() { # FIXTURE
    printf 'camera: {source: {ros2: "depth=%s,domain=%s,wait=60"}, near: 0.1, far: 2}\n' \
        /camera/depth/image_rect_raw "$domain"
    printf 'fixtures:\n  - {%s}\ntool: {spheres: [[0, 0, 0, 0.01]]}\nhand: {path: hand.csv}\n' "$1"
}
scene "name: wall, role: forbidden, radius: 0.02" > "$folder/wall.yaml"
scene "name: plate, role: forbidden, shape: box, base_T_shape: {xyz: [0, 0, 0.5]}, size: [1, 1, 0.1]" \
    > "$folder/transport.yaml"

measure() { # SCENE WIDTH HEIGHT RATE
    "$build/ros2_talker" "$domain" < "$folder/in" > /dev/null 2>&1 &
    local talker=$!
    exec 3> "$folder/in"
    pids+=("$talker")
    printf '%s\n' "colour 0" "width $2" "height $3" "fx $2" "rate $4" >&3
    "$build/ros2_listener" "$domain" /measure/wrench WrenchStamped 1000000 \
        < "$folder/listen" > "$folder/ages" 2> /dev/null &
    local listener=$!
    exec 4> "$folder/listen"
    pids+=("$listener")
    "$build/fathom" replay "$folder/$1.yaml" --realtime --ros2 "/measure,domain=$domain" --out "$folder/out" \
        > "$folder/said" 2> "$folder/warned" || cat "$folder/warned"
    exec 4>&- 3>&-
    wait "$listener" "$talker" || true
    local used lost exposed
    used=$(awk '/^frames  /{print $2}' "$folder/said")
    lost=$(awk '/^  frames  /{print $2}' "$folder/said")
    exposed=$(awk '/^  exposed/{print $3 " / " $5}' "$folder/said")
    awk -v name="$1 $2x$3 at $4 Hz" -v used="$used" -v lost="$lost" -v exposed="$exposed" '
        /^age/ {age = $3 " / " $5} /^gap/ {gap = $3 " / " $5}
        END {printf "| %s | %s | %d of %d | %s | %s |\n", name, exposed, lost, used + lost, age, gap}' "$folder/ages"
}

echo "load $(cut -d' ' -f1-3 /proc/loadavg)"
echo "| images | stamp to set [ms] p50 / p99 | frames dropped | wrench age [ms] p50 / p99 | wrench gap [ms] p50 / p99 |"
echo "|---|---|---|---|---|"
for scene in transport wall; do
    for size in "640 480" "1280 720"; do
        for rate in 30 90; do
            # shellcheck disable=SC2086 # two words
            measure "$scene" $size "$rate"
        done
    done
done
