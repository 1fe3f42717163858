// SPDX-License-Identifier: Apache-2.0
// Depth words to metres and pixels to rays. Needs params.glsl, depths, rays and kRays.

uint rawDepth(uint pixel) {
    return texelFetch(depths, int(pixel)).x;
}

// Depth along the optical axis [m]; 0 without a measurement in near..far.
float metresOf(uint raw) {
    return all(bvec2(raw >= smallestRaw(), raw <= largestRaw())) ? float(raw) * metresPerUnit() : 0.0;
}

// The same for the four pixels of a texel (kFour).
vec4 metresOfFour(uvec4 raw) {
    return vec4(metresOf(raw.x), metresOf(raw.y), metresOf(raw.z), metresOf(raw.w));
}

float depthAt(uint pixel) {
    return metresOf(rawDepth(pixel));
}

// (x / z, y / z) of the ray through a pixel's centre; undefined outside the image. No division: the host
// computes the same points (engine/cloud/seen_points.h), and devices may round divisions differently.
vec2 rayOf(uvec2 pixel) {
    if (kRays != 0) {
        return rays[min(pixel.y * depthWidth() + pixel.x, depthWidth() * depthSize().y - 1u)];
    }
    precise vec2 ray = (vec2(pixel) - opticalCentre()) * rayStep();
    return ray;
}
