// SPDX-License-Identifier: Apache-2.0
// Memory of points that a new frame does not contradict. Each slot has two places: the point that it showed in
// the last frame, and the point that it holds. Needs params, forbidden.glsl, depth.glsl, lens.glsl, beam.glsl,
// seen, kept, keptTime, kHold, kFan, kBeam.

// The memory as the last frame left it. The including shader says how it is read.
vec4 seenAt(uint slot);
vec4 keptAt(uint slot);
uint keptTimeAt(uint slot);

// What is remembered of a point beside its place: class + 1, 0 = nothing; with beams, above these four bits, what its sphere
// grows by, rounded up to 10 um. Small enough for any float to keep the bits.
uint noteOf(uint c, float grown) {
    return kBeam != 0 ? (c + 1u) | uint(min(ceil(grown * 1e5), 524287.0)) << 4 : c + 1u;
}

uint classOfNote(uint note) {
    return kBeam != 0 ? note & 15u : note;
}

// True while a point may stay: its pixel in the new image shows nothing or something nearer, or lies outside.
// Without branches, like this whole file.
bool uncontradicted(vec3 p) {
    vec3 q = transformPoint(params.cameraTbase, p);
    bool before = q.z > 0.0;
    q.z = before ? q.z : 1.0;
    vec2 pixel = kFan != 0 ? projectFan(q, params.lens) : projectPoint(q, params.lens, params.distortion, params.more.x);
    ivec2 at = ivec2(round(pixel));
    bool inside = all(lessThan(uvec2(at), params.size.xy)); // below zero is beyond the end
    float z = depthAt(inside ? uint(at.y) * params.size.x + uint(at.x) : 0u);
    float sigma = kBeam != 0 ? beamSigma(length(q)) : params.noise.x + params.noise.y * q.z * q.z;
    float margin = params.noise.z * sigma;
    return any(bvec4(!before, !inside, z == 0.0, z < q.z - margin));
}

// Moves the slot's memory on by one frame, which shows `point` of class `now` (kNone: no point) there, whose sphere
// grows by `grown` for its sigma [m]. Returns the held sphere
// (R < 0: none), its class, and what is remembered: 1 = the point, 2 = the held one. holding: as handlePixel.
vec4 updateMemory(uint slot, vec3 point, uint now, float grown, bool holding, out uint heldClass, out uint remembered) {
    vec4 last = seenAt(slot), old = vec4(0.0);
    uint lastNote = floatBitsToUint(last.w), when = 0;
    bool lastStays = all(bvec3(lastNote != 0u, params.time.x - params.time.z <= params.time.y, uncontradicted(last.xyz)));
    bool oldStays = false;
    if (holding) { // the same for a whole patch
        old = keptAt(slot);
        when = keptTimeAt(slot);
        oldStays = all(bvec3(floatBitsToUint(old.w) != 0u, params.time.x - when <= params.time.y, uncontradicted(old.xyz)));
    }
    vec4 hold = lastStays ? last : (oldStays ? old : vec4(0.0));
    seen[slot] = now == kNone ? vec4(0.0) : vec4(point, uintBitsToFloat(noteOf(now, grown)));
    uint keptAt = lastStays ? params.time.z : when; // it was seen in the last frame
    if (any(bvec2(keptAt != when, any(notEqual(floatBitsToUint(hold), floatBitsToUint(old)))))) { // most slots hold nothing in both frames
        kept[slot] = hold;
        keptTime[slot] = keptAt;
    }
    uint note = floatBitsToUint(hold.w), holdClass = classOfNote(note);
    remembered = (now != kNone ? 1u : 0u) | (holdClass != 0 ? 2u : 0u);
    heldClass = max(holdClass, 1u) - 1u;
    float more = kBeam != 0 ? float(note >> 4) * 1e-5 : 0.0;
    return vec4(hold.xyz, holdClass != 0 ? radiusOf(heldClass) + more : -1.0);
}
