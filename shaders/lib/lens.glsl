// SPDX-License-Identifier: Apache-2.0
// Lens with distortion, forward direction (point -> pixel). k = (k1, k2, p1, p2), divisor = (k4, k5, k6,
// square of the reach); kLensEquidistant: k = (k1, k2, k3, k4). The models are those of Intrinsics
// (engine/types/camera_info.h). A point beyond the reach gets a pixel far outside the image.
// kLens is a specialisation constant because lavapipe compiles a shader anew for each dispatch if a branch
// depends on a uniform alone.

layout(constant_id = kSpecLens) const uint kLens = kLensNone;

const vec2 kUnseen = vec2(-1e9);

vec2 projectPoint(vec3 p, vec4 lens, vec4 k, float k3, vec4 divisor) {
    vec2 r = p.xy / p.z;
    float rr = dot(r, r);
    float radial = 1.0 + rr * (k.x + rr * (k.y + rr * k3));
    vec2 q = r;
    if (kLens == kLensNone) {
        return r * lens.xy + lens.zw;
    }
    if (kLens == kLensEquidistant) {
        float slope = sqrt(rr), t = atan(slope), tt = t * t;
        float bent = t * (1.0 + tt * (k.x + tt * (k.y + tt * (k.z + tt * k.w))));
        return rr <= divisor.w ? (slope > 0.0 ? r * (bent / slope) : r) * lens.xy + lens.zw : kUnseen;
    }
    if (kLens != kLensPlain) {
        radial /= 1.0 + rr * (divisor.x + rr * (divisor.y + rr * divisor.z));
        q = kLens == kLensScaledTangential ? r * radial : r;
    }
    vec2 d = vec2(r.x * radial + 2.0 * k.z * q.x * q.y + k.w * (rr + 2.0 * q.x * q.x),
                  r.y * radial + k.z * (rr + 2.0 * q.y * q.y) + 2.0 * k.w * q.x * q.y);
    return rr <= divisor.w ? d * lens.xy + lens.zw : kUnseen;
}
