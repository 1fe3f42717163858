// SPDX-License-Identifier: Apache-2.0
// Distances of spheres in float32. docs/architecture/query.md proves the margins of callers.

float squaredDistance(vec3 a, vec3 b) {
    precise float dx = a.x - b.x;
    precise float dy = a.y - b.y;
    precise float dz = a.z - b.z;
    precise float d2 = dx * dx + dy * dy + dz * dz;
    return d2;
}

// The gap of two spheres is at most `limit` [m], up to rounding. Without a root or a division, which devices
// may round as they like.
bool nearerThan(float limit, vec4 a, vec4 b) {
    float d2 = squaredDistance(a.xyz, b.xyz);
    precise float far = limit + a.w + b.w;
    precise float far2 = far * far;
    return far >= 0.0 && d2 <= far2;
}

// [m] Gap of two spheres, with a root. Vulkan leaves the root of 0 open.
float gapBetween(vec4 a, vec4 b) {
    precise float gap = sqrt(max(squaredDistance(a.xyz, b.xyz), 1e-30)) - (a.w + b.w);
    return gap;
}

// A point in the frame of the tool's leaves: q = rows * (s - t). rows: a row of the rotation and one
// component of t [m] each.
vec3 inFrameOf(vec4 rows[3], vec3 s) {
    precise vec3 d = s - vec3(rows[0].w, rows[1].w, rows[2].w);
    precise vec3 q = vec3(rows[0].x * d.x + rows[0].y * d.y + rows[0].z * d.z,
                          rows[1].x * d.x + rows[1].y * d.y + rows[1].z * d.z,
                          rows[2].x * d.x + rows[2].y * d.y + rows[2].z * d.z);
    return q;
}
