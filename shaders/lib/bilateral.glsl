// SPDX-License-Identifier: Apache-2.0
// The filter of paper eq. 1-2 in parts. Needs params and kPolynomial.

// Weight of paper eq. 2 for t = distance^2 / (2 sigma^2). The polynomial equals exp(-t) at 0; its error is at
// most 0.008.
float weightOf(float t) {
    if (kPolynomial == 0) {
        return exp(-t);
    }
    float w = max(0.0, 1.0 - t * (1.0 / 16.68));
    w *= w;
    w *= w;
    w *= w;
    return w * w;
}

// Sums differences from the centre, so that the mean of a distant surface loses no digits.
struct Mean {
    float sum, weights;
};

Mean weighed(Mean mean, vec3 q, vec3 p) {
    vec3 apart = q - p;
    float weight = weightOf(dot(apart, apart) * params.filterParams.x);
    weight = q.z != 0.0 ? weight : 0.0;
    return Mean(mean.sum + (q.z - p.z) * weight, mean.weights + weight);
}

// Depth [m] of p moved to the mean, along its ray by at most params.noise.w: a region still contains the point
// that was measured. weights >= 1, because the centre counts 1.
float filteredDepth(Mean mean, vec3 p) {
    float most = params.noise.w * p.z * inversesqrt(dot(p, p));
    return p.z + clamp(mean.sum / mean.weights, -most, most);
}
