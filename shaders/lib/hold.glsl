// SPDX-License-Identifier: Apache-2.0
// Memory of points that new frames do not contradict. Each slot stores two points: the one seen in the
// previous frame and the held one. Needs params.glsl, forbidden.glsl, depth.glsl, lens.glsl, transform.glsl,
// beam.glsl, seen, kept, keptTime, kHold, kFan, kBeam.

// The memory after the previous frame. The including shader defines how to read it.
vec4 seenAt(uint slot);
vec4 keptAt(uint slot);
uint keptTimeAt(uint slot);

// The stored note of a point: class + 1 in four bits (0 = no point); with beams, above these, the growth of
// its sphere in 18 bits, rounded up to 10 um, or to 5.12 mm if the bit above is set (growth over 2.6 m). The
// value is small enough to survive storage as a float.
const float kFineGrowth = 1e-5, kCoarseGrowth = 512.0 * kFineGrowth; // [m]

uint noteOf(uint c, float grown) {
    float fine = ceil(grown / kFineGrowth);
    bool coarse = fine > 262143.0;
    uint steps = uint(coarse ? min(ceil(grown / kCoarseGrowth), 262143.0) : fine);
    return kBeam != 0 ? (c + 1u) | steps << 4 | (coarse ? 1u << 22 : 0u) : c + 1u;
}

float growthOfNote(uint note) {
    return float(note >> 4 & 0x3ffffu) * ((note >> 22) != 0u ? kCoarseGrowth : kFineGrowth);
}

uint classOfNote(uint note) {
    return kBeam != 0 ? note & 15u : note;
}

// True if the new frame does not contradict the point: its pixel is outside the image, has no depth or shows
// a nearer surface. No branches, as in this whole file.
bool uncontradicted(vec3 p) {
    vec3 q = transformPoint(params.cameraTbase, p);
    bool before = q.z > 0.0;
    q.z = before ? q.z : 1.0;
    vec2 pixel = kFan != 0 ? projectFan(q, params.lens) : projectPoint(q, params.lens, params.distortion, depthK3(), params.lensDivisor);
    ivec2 at = ivec2(round(pixel));
    bool inside = all(lessThan(uvec2(at), depthSize())); // a negative number converts to a large one
    float z = depthAt(inside ? uint(at.y) * depthWidth() + uint(at.x) : 0u);
    float sigma = kBeam != 0 ? beamSigma(length(q)) : depthSigma(q.z);
    float margin = sigmasOfDifference() * sigma;
    return any(bvec4(!before, !inside, z == 0.0, z < q.z - margin));
}

// True for a class that tests colour while the colour image is dark: then no pixel contradicts its points.
bool isUnseen(uint note) {
    return (darkMask() << 1 >> classOfNote(note) & 1u) != 0u;
}

// Updates the memory of a slot with the new frame's `point` of class `now` (kNone: no point), whose sphere
// grows by `grown` [m] for its sigma. Returns the held sphere (R < 0: none), its class, and flags: 1 = the
// seen point is remembered, 2 = the held one is. holding: as for handlePixel.
vec4 updateMemory(uint slot, vec3 point, uint now, float grown, bool holding, out uint heldClass, out uint remembered) {
    vec4 last = seenAt(slot), old = vec4(0.0);
    uint lastNote = floatBitsToUint(last.w), when = 0;
    bool lastStays = all(bvec3(lastNote != 0u, captureTime() - previousTime() <= holdTime(), any(bvec2(uncontradicted(last.xyz), isUnseen(lastNote)))));
    bool oldStays = false;
    if (holding) { // uniform within a patch
        old = keptAt(slot);
        when = keptTimeAt(slot);
        oldStays = all(bvec3(floatBitsToUint(old.w) != 0u, captureTime() - when <= holdTime(),
                             any(bvec2(uncontradicted(old.xyz), isUnseen(floatBitsToUint(old.w))))));
    }
    vec4 hold = lastStays ? last : (oldStays ? old : vec4(0.0));
    seen[slot] = now == kNone ? vec4(0.0) : vec4(point, uintBitsToFloat(noteOf(now, grown)));
    uint seenTime = lastStays ? previousTime() : when; // [us] last seen: in the previous frame, or before
    // Skips the store for most slots, which hold nothing in either frame.
    if (any(bvec2(seenTime != when, any(notEqual(floatBitsToUint(hold), floatBitsToUint(old)))))) {
        kept[slot] = hold;
        keptTime[slot] = seenTime;
    }
    uint note = floatBitsToUint(hold.w), holdClass = classOfNote(note);
    remembered = (now != kNone ? 1u : 0u) | (holdClass != 0 ? 2u : 0u);
    heldClass = max(holdClass, 1u) - 1u;
    float more = kBeam != 0 ? growthOfNote(note) : 0.0;
    return vec4(hold.xyz, holdClass != 0 ? radiusOf(heldClass) + more : -1.0);
}
