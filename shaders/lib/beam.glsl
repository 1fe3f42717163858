// SPDX-License-Identifier: Apache-2.0
// A sensor that measures along beams (engine/types/camera_info.h). Needs params.

// Standard deviation [m] of a point at a range [m].
float beamSigma(float range) {
    float along = params.beam.x + params.beam.y * range, across = params.beam.z * range;
    return sqrt(along * along + across * across);
}

// Camera point -> pixel of a fan, whose pixels are at equal angles. lens: fx, fy [pixels per radian], then
// the centre.
vec2 projectFan(vec3 p, vec4 lens) {
    return vec2(atan(p.x, p.z), atan(p.y, length(p.xz))) * lens.xy + lens.zw;
}
