// SPDX-License-Identifier: Apache-2.0
// The region sphere of a point that the picture shows. Needs params, kBeam, kThin, beam.glsl, forbidden.glsl, thinning.glsl.

// Three sigma of a point, by its range from the camera [m].
float grownBySigma(vec3 point) {
    vec3 camera = vec3(params.baseTcamera[0].w, params.baseTcamera[1].w, params.baseTcamera[2].w);
    return kBeam != 0 ? 3.0 * beamSigma(distance(point, camera)) : 0.0;
}

// The sphere of the point seen now in pixel p of a sub-patch; R < 0 when there is none or the budget leaves it out. more: for its
// sigma [m].
vec4 seenSphere(vec4 point, const uint p, uint c, float more, CellsAround around) {
    float grown = kThin != 0 ? keptGrowth(p, around) : 0.0;
    float radius = radiusOf(c) + grown + more;
    return vec4(point.xyz, any(bvec2(c == kNone, grown < 0.0)) ? -1.0 : radius);
}
