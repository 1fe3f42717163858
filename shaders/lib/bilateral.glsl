// SPDX-License-Identifier: Apache-2.0
// The filter of paper eq. 1-2 in parts. Needs params.glsl, kRadius, kWeights, pixel_point.glsl.
//
// Windows hold points in units of sigma, so that a squared distance needs no factor to become a weight.

// A point without depth has z = 0 and this x: it is near to no other, and its weight is 0.
const float kNowhere = 1e6;

// Units of a window in one metre; without a filter, metres.
float windowScale() {
    const float share = kWeights == kWeightsPolynomial ? 1.0 / 16.68 : kWeights == kWeightsQuartic ? 1.0 / 16.0 : 1.0;
    return kRadius != 0u ? sqrt(filterSharpness() * share) : 1.0;
}

// Camera-frame point of a window at depth z [m].
vec3 windowPointAt(ivec2 at, float z) {
    precise float scaled = z * windowScale();
    vec3 p = pointAt(at, scaled);
    return vec3(z != 0.0 ? p.x : kNowhere, p.yz);
}

// Weight of paper eq. 2, exp(-t) with t = distance^2 / (2 sigma^2), for a squared distance of window points.
// The quartic's error is at most 0.000002, the polynomial's 0.008; both equal exp(-t) at 0. Numbers that are
// not negative compare as their bits; CPU devices take three instructions for the minimum of two reals, which
// may be NaN.
float weightOf(float square) {
    if (kWeights == kWeightsExponential) {
        return exp(-square);
    }
    float w, least = 0.0;
    if (kWeights == kWeightsPolynomial) {
        w = intBitsToFloat(max(floatBitsToInt(1.0 - square), 0));
    } else {
        float x = intBitsToFloat(min(floatBitsToInt(square), floatBitsToInt(1.6)));
        // Coefficients of least error, found by search.
        w = 1.0 - x * (0.99999185 - x * (0.49992039 - x * (0.16689947 - x * 0.04115473)));
        least = 6.244682e-10; // at 1.6
    }
    w *= w;
    w *= w;
    w *= w;
    return w * w - least;
}

// Sums differences from the centre, so that the mean of a distant surface loses no digits.
struct Mean {
    float sum, weights;
};

// Precise, so that all variants of the pass round the same sums.
Mean addToMean(Mean mean, float beyond, float weight) {
    precise float sum = mean.sum + beyond * weight;
    precise float weights = mean.weights + weight;
    return Mean(sum, weights);
}

Mean addWeighted(Mean mean, vec3 q, vec3 p) {
    vec3 apart = q - p;
    return addToMean(mean, apart.z, weightOf(dot(apart, apart)));
}

// Depth z [m] of the window's point p moved to the mean, along its ray by at most filterLimit(): a region
// still contains the point that was measured. weights >= 1, because the centre counts 1.
float filteredDepth(Mean mean, vec3 p, float z) {
    float scale = windowScale(), most = filterLimit() * p.z * inversesqrt(dot(p, p));
    return z + clamp(mean.sum / mean.weights * (1.0 / scale), -most, most);
}
