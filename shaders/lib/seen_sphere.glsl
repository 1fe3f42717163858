// SPDX-License-Identifier: Apache-2.0
// The region sphere of a point that the frame shows. Needs params, kBeam, kThin, beam.glsl, forbidden.glsl.

// Three sigma of a point, by its range from the camera [m].
float grownBySigma(vec3 point) {
    vec3 camera = vec3(params.baseTcamera[0].w, params.baseTcamera[1].w, params.baseTcamera[2].w);
    return kBeam != 0 ? 3.0 * beamSigma(distance(point, camera)) : 0.0;
}

// The sphere of a point seen now; R < 0 when there is none or the budget leaves it out (grown < 0). more: for its sigma [m].
vec4 seenSphere(vec4 point, uint c, float grown, float more) {
    precise float radius = radiusOf(c) + grown + more;
    return vec4(point.xyz, any(bvec2(c == kNone, grown < 0.0)) ? -1.0 : radius);
}

// Whole steps of a growth that thinning decided; 0 without it.
uint stepsOf(float grown) {
    return kThin != 0 ? uint(max(grown, 0.0) * params.steps.w + 0.5) : 0u;
}
