// SPDX-License-Identifier: Apache-2.0
// Memory of points that a new frame does not contradict (design 4, hold). Two places a slot: the point the slot showed last
// frame, and the point that it holds. Needs params, forbidden.glsl, seen, kept, keptTime, depth.glsl, lens.glsl.

// True while a point may stay: its pixel in the new picture shows nothing, or something nearer, or it lies outside. Unbranched, as
// all of this.
bool uncontradicted(vec3 p) {
    vec3 q = transformPoint(params.cameraTbase, p);
    bool before = q.z > 0.0;
    q.z = before ? q.z : 1.0;
    ivec2 at = ivec2(round(projectPoint(q, params.lens, params.distortion, params.more.x)));
    bool inside = all(lessThan(uvec2(at), params.size.xy)); // below zero is beyond the end
    float z = depthAt(inside ? uint(at.y) * params.size.x + uint(at.x) : 0u);
    float margin = params.noise.z * (params.noise.x + params.noise.y * q.z * q.z);
    return any(bvec4(!before, !inside, z == 0.0, z < q.z - margin));
}

// Moves the slot's memory on by one frame, which shows `point` of class `now` (kNone: no point) there. Returns the held sphere
// (R < 0: none), its class, and counts what is remembered.
vec4 updateMemory(uint slot, vec3 point, uint now, out uint heldClass, inout uint remembered) {
    vec4 last = seen[slot], old = kept[slot];
    uint lastClass = floatBitsToUint(last.w), oldClass = floatBitsToUint(old.w), when = keptTime[slot];
    bool lastStays = all(bvec3(lastClass != 0u, params.time.x - params.time.z <= params.time.y, uncontradicted(last.xyz)));
    bool oldStays = all(bvec3(oldClass != 0u, params.time.x - when <= params.time.y, uncontradicted(old.xyz)));
    vec4 hold = lastStays ? last : (oldStays ? old : vec4(0.0));
    seen[slot] = now == kNone ? vec4(0.0) : vec4(point, uintBitsToFloat(now + 1u));
    kept[slot] = hold;
    keptTime[slot] = lastStays ? params.time.z : when; // it was seen in the last frame
    uint holdClass = floatBitsToUint(hold.w);
    remembered += (now != kNone ? 1u : 0u) + (holdClass != 0 ? 1u : 0u);
    heldClass = max(holdClass, 1u) - 1u;
    return vec4(hold.xyz, holdClass != 0 ? radiusOf(heldClass) : -1.0);
}
