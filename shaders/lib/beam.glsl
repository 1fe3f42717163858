// SPDX-License-Identifier: Apache-2.0
// A sensor that measures along beams (engine/types/camera_info.h). Needs params.

// Standard deviation of a point at that range [m].
float beamSigma(float range) {
    float along = params.beam.x + params.beam.y * range, across = params.beam.z * range;
    return sqrt(along * along + across * across);
}

// Camera point -> pixel of a fan: equal angles. lens: pixels a radian, centre.
vec2 projectFan(vec3 p, vec4 lens) {
    return vec2(atan(p.x, p.z), atan(p.y, length(p.xz))) * lens.xy + lens.zw;
}
