// SPDX-License-Identifier: Apache-2.0
// A point in other axes: rows[i] = (row i of the rotation, translation).

// The order of operations is the host's (engine/cloud/seen_points.h).
vec3 transformPoint(vec4 rows[3], vec3 p) {
    precise vec3 moved = vec3(rows[0].x, rows[1].x, rows[2].x) * p.x + vec3(rows[0].y, rows[1].y, rows[2].y) * p.y +
                         vec3(rows[0].z, rows[1].z, rows[2].z) * p.z + vec3(rows[0].w, rows[1].w, rows[2].w);
    return moved;
}
