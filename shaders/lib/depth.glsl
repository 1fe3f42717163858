// SPDX-License-Identifier: Apache-2.0
// Depth words to metres and pixels to rays. Needs params, depths, rays and kRays.

uint rawDepth(uint pixel) {
    return texelFetch(depths, int(pixel)).x;
}

// Metres along the optical axis; 0 when there is no measurement in near..far.
float metresOf(uint raw) {
    return all(bvec2(raw >= params.depthBand.x, raw <= params.depthBand.y)) ? float(raw) * params.more.z : 0.0;
}

float depthAt(uint pixel) {
    return metresOf(rawDepth(pixel));
}

// (x / z, y / z) of the ray through a pixel's centre; any value for a pixel outside the image. No division:
// the host works out the same points (engine/cloud/seen_points.h), and a division may be rounded in any way here.
vec2 rayOf(uvec2 pixel) {
    if (kRays != 0) {
        return rays[min(pixel.y * params.size.x + pixel.x, params.size.x * params.size.y - 1u)];
    }
    precise vec2 ray = (vec2(pixel) - params.lens.zw) * params.steps.xy;
    return ray;
}
