// SPDX-License-Identifier: Apache-2.0
// The region sphere of a seen point. Needs params.glsl, kBeam, kThin, beam.glsl, forbidden.glsl.

// Three standard deviations of a beam sensor's point [m], from its range.
float grownBySigma(vec3 point) {
    vec3 camera = cameraCentre();
    return kBeam != 0 ? 3.0 * beamSigma(distance(point, camera)) : 0.0;
}

// The sphere of a seen point; R < 0 when there is no point or thinning removes it (grown < 0). more [m]:
// extra radius for its sigma.
vec4 seenSphere(vec4 point, uint c, float grown, float more) {
    precise float radius = radiusOf(c) + grown + more;
    return vec4(point.xyz, any(bvec2(c == kNone, grown < 0.0)) ? -1.0 : radius);
}

// A growth from thinning in whole steps; 0 without thinning.
uint stepsOf(float grown) {
    return kThin != 0 ? uint(max(grown, 0.0) * growthStepsPerMetre() + 0.5) : 0u;
}
