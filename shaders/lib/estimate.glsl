// SPDX-License-Identifier: Apache-2.0
// The estimate of a pixel's depth over frames. Needs params.glsl, estimatesBefore, estimates, lens.glsl,
// transform.glsl, slots.glsl, pixel_point.glsl.
//
// An estimate is the mean over at most mostAveraged() frames. It is trusted while the depth as measured is
// within 3 sigma of it, and the recent mean of its differences from the filtered depth within a tighter gate.
// The filter has averaged noise over its window, so this reveals slow motion. Otherwise the plain depth is
// used at once and the mean starts anew. In each frame the mean is drawn within another gate of the filtered
// depth, which limits its error while a motion is not yet noticed.

const float kDriftUnit = 1e-6; // [m]
const uint kWellKnown = 8u, kSudden = 2u; // [frames]
const float kFarther = 0.01; // [m]
const float kDriftGain = 0.25; // the recent mean spans about 4 frames

// Stored in four words: mean; shown; drift [um] (16 bits), class bits (8), weight (8); frame (24), missed
// (8).
struct Estimate {
    float mean;   // depth [m] averaged over `weight` frames
    float shown;  // depth [m] of the point; follows the mean when that leaves a dead band, so it rests mostly
    float drift;  // recent mean of filtered depth - mean [m]
    uint weight;  // 0 = no estimate
    uint classes; // class bits of the pixel when it was last seen
    uint missed;  // frames since then
};

uint slotsOfHalf() {
    return patchCount() * 256u;
}

Estimate estimateAt(uint slot) {
    uvec4 s = texelFetch(estimatesBefore, int(slot + ((frameNumber() & 1u) != 0u ? 0u : slotsOfHalf())));
    bool fresh = all(bvec2(s.w >> 8 == estimatesFrom(), estimatesFrom() != 0u)); // else of an unlisted patch
    return Estimate(uintBitsToFloat(s.x), uintBitsToFloat(s.y), float(int(s.z) >> 16) * kDriftUnit, fresh ? s.z & 255u : 0u,
                    s.z >> 8 & 255u, s.w & 255u);
}

void store(uint slot, Estimate e) {
    uint drift = uint(int(floor(clamp(e.drift / kDriftUnit, -32767.0, 32767.0) + 0.5))) << 16;
    estimates[slot + ((frameNumber() & 1u) != 0u ? slotsOfHalf() : 0u)] =
        uvec4(floatBitsToUint(e.mean), floatBitsToUint(e.shown), drift | e.classes << 8 | e.weight, frameNumber() << 8 | e.missed);
}

// The estimate of the surface that a pixel shows at depth z [m], from the four pixels around it in the frame
// before; none unless all four have one of that surface.
Estimate carried(uvec2 at, float z) {
    vec3 q = transformPoint(params.previousTbase, basePoint(ivec2(at), z).xyz);
    bool before = all(bvec2(z != 0.0, q.z > 0.0));
    q.z = before ? q.z : 1.0;
    vec2 pixel = projectPoint(q, params.lens, params.distortion, depthK3(), params.lensDivisor);
    ivec2 from = ivec2(floor(pixel));
    vec2 f = pixel - vec2(from);
    // A negative number converts to a large one.
    before = all(bvec2(before, all(lessThan(uvec2(from), depthSize() - 1u))));
    bool inside = before;
    vec4 share = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    Estimate sum = Estimate(0.0, 0.0, 0.0, 0u, 255u, 0u);
    float weight = 0.0;
    [[unroll]] for (uint k = 0; k < 4u; ++k) {
        Estimate e = estimateAt(slotOfPixel(inside ? uvec2(from) + uvec2(k & 1u, k >> 1) : uvec2(0)));
        sum.mean += share[k] * (e.mean - q.z);
        sum.shown += share[k] * (e.shown - q.z);
        sum.drift += share[k] * e.drift;
        weight += share[k] * float(e.weight);
        before = all(bvec3(before, e.weight != 0u, abs(e.mean - q.z) <= 3.0 * sigmasOfDifference() * depthSigma(q.z)));
        sum.classes &= e.classes;
        sum.missed = max(sum.missed, e.missed);
    }
    float sigma = depthSigma(z);
    // The error of the poses and of the interpolation adds to the variance sigma^2 / weight.
    weight = max(floor(weight / (1.0 + weight * movedPoseVariance() / (sigma * sigma)) + 0.5), 1.0);
    return Estimate(z + sum.mean, z + sum.shown, sum.drift, before ? uint(weight) : 0u, sum.classes, sum.missed);
}

// The depth as measured shows a surface far behind a well-known one, for at most the second frame. At
// silhouettes depth flickers between both.
bool isSuddenlyFarther(Estimate e, float raw) {
    return all(bvec4(e.weight >= kWellKnown, e.missed < kSudden, raw - e.mean > max(sigmasOfDifference() * depthSigma(e.mean), kFarther),
                     (e.classes & forbiddenMask()) != 0u));
}

// A pixel with a point at depth z [m]; raw: its depth as measured.
Estimate updated(Estimate e, float z, float raw, uint classes) {
    float sigma = depthSigma(z), most = jumpLimit(sigma);
    float drift = e.drift + kDriftGain * (z - e.mean - e.drift);
    float slow = driftLimit(sigma);
    bool same = all(bvec4(e.weight != 0u, abs(raw - e.mean) <= sigmasOfDifference() * sigma, drift <= slow, -2.0 * drift <= slow));
    uint weight = same ? min(e.weight + 1u, mostAveraged()) : 1u;
    float near = clamp(e.mean, z - most, z + most);
    float mean = same ? near + (z - near) / float(weight) : z;
    bool still = all(bvec3(same, e.shown <= z + most, abs(mean - e.shown) <= unshownChange(sigma)));
    return Estimate(mean, still ? e.shown : mean, same ? drift : 0.0, weight, classes, 0u);
}

// A pixel without a point, or whose surface is suddenly farther. One of a forbidden class keeps class and
// estimate for mostMissed() frames, unless its depth differs.
Estimate outlasting(Estimate e, float raw) {
    bool agrees = any(bvec2(raw == 0.0, abs(raw - e.mean) <= sigmasOfDifference() * depthSigma(e.mean)));
    uint classes = e.classes & forbiddenMask();
    agrees = any(bvec2(agrees, isSuddenlyFarther(e, raw)));
    bool stays = all(bvec4(e.weight != 0u, e.missed < mostMissed(), agrees, classes != 0u));
    return Estimate(e.mean, e.shown, e.drift, stays ? e.weight : 0u, classes, min(e.missed + 1u, 255u));
}
