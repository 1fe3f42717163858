// SPDX-License-Identifier: Apache-2.0
// Pinhole with Brown-Conrady distortion, forward direction (point -> pixel). k = (k1, k2, p1, p2).

vec2 projectPoint(vec3 p, vec4 lens, vec4 k, float k3) {
    vec2 r = p.xy / p.z;
    float rr = dot(r, r);
    float radial = 1.0 + rr * (k.x + rr * (k.y + rr * k3));
    vec2 d = vec2(r.x * radial + 2.0 * k.z * r.x * r.y + k.w * (rr + 2.0 * r.x * r.x),
                  r.y * radial + k.z * (rr + 2.0 * r.y * r.y) + 2.0 * k.w * r.x * r.y);
    return d * lens.xy + lens.zw;
}

// The order of operations is the host's (engine/cloud/seen_points.h).
vec3 transformPoint(vec4 rows[3], vec3 p) {
    precise vec3 moved = vec3(rows[0].x, rows[1].x, rows[2].x) * p.x + vec3(rows[0].y, rows[1].y, rows[2].y) * p.y +
                         vec3(rows[0].z, rows[1].z, rows[2].z) * p.z + vec3(rows[0].w, rows[1].w, rows[2].w);
    return moved;
}
