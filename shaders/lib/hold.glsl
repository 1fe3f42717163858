// SPDX-License-Identifier: Apache-2.0
// Memory of points that a new frame does not contradict (design 4, hold). Two places a slot: the point the slot showed last
// frame, and the point that it holds. Needs params, points, seen, kept, keptTime, depth.glsl, lens.glsl.

// True while a point may stay: its pixel in the new picture shows nothing, or something nearer, or it lies outside.
bool uncontradicted(vec3 p) {
    vec3 q = transformPoint(params.cameraTbase, p);
    if (q.z <= 0.0) {
        return true;
    }
    ivec2 at = ivec2(round(projectPoint(q, params.lens, params.distortion, params.more.x)));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.size.xy)))) {
        return true;
    }
    float z = depthAt(uint(at.y) * params.size.x + uint(at.x));
    float margin = params.noise.z * (params.noise.x + params.noise.y * q.z * q.z);
    return z == 0.0 || z < q.z - margin;
}

// Moves the slot's memory on by one frame. Returns the held sphere (R < 0: none), its class, and counts what is remembered.
vec4 updateMemory(uint slot, uint now, out uint heldClass, inout uint remembered) {
    vec4 last = seen[slot], old = kept[slot];
    uint lastClass = floatBitsToUint(last.w), oldClass = floatBitsToUint(old.w);
    uint when = keptTime[slot];
    vec4 hold = vec4(0.0);
    if (lastClass != 0 && params.time.x - params.time.z <= params.time.y && uncontradicted(last.xyz)) {
        hold = last;
        when = params.time.z; // it was seen in the last frame
    } else if (oldClass != 0 && params.time.x - when <= params.time.y && uncontradicted(old.xyz)) {
        hold = old;
    }
    seen[slot] = now == kNone ? vec4(0.0) : vec4(points[slot].xyz, uintBitsToFloat(now + 1u));
    kept[slot] = hold;
    keptTime[slot] = when;
    uint holdClass = floatBitsToUint(hold.w);
    remembered += (now != kNone ? 1u : 0u) + (holdClass != 0 ? 1u : 0u);
    heldClass = holdClass != 0 ? holdClass - 1u : 0u;
    return vec4(hold.xyz, holdClass != 0 ? params.classes[heldClass].role.x : -1.0);
}
