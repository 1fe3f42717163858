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

vec3 transformPoint(vec4 rows[3], vec3 p) {
    vec4 h = vec4(p, 1.0);
    return vec3(dot(rows[0], h), dot(rows[1], h), dot(rows[2], h));
}
