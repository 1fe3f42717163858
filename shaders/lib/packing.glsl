// SPDX-License-Identifier: Apache-2.0
// Which places of a group's patch have spheres, by layer (seen, held), then slot; and (kPack) these into the row that the host
// reads. Needs counters, kPack, kLayers, ofPatch and packedSpheres, places, runs.

shared uint present[16]; // bit a place: spheres of the patch, then held ones
shared uint packedFrom;
shared uint classesOfPatch; // bit a class that a sphere is of

void markPresent(uint place, float radius) {
    if (radius >= 0.0) {
        atomicOr(present[place >> 5], 1u << (place & 31u));
    }
}

// Most patches have one class: after the first nobody has to wait for its bit.
void markClass(uint bit, float radius) {
    if (radius >= 0.0 && (classesOfPatch & bit) == 0) {
        atomicOr(classesOfPatch, bit);
    }
}

// Sub-patches with a sphere of either layer: one addition to the counter, which all groups share.
void countSubs() {
    uint subs = 0;
    for (uint w = 0; w < 8u; ++w) {
        uint here = present[w] | present[8u * (kLayers - 1u) + w];
        subs += ((here & 0xffffu) != 0 ? 1u : 0u) + (here >> 16 != 0 ? 1u : 0u);
    }
    if (subs != 0) {
        atomicAdd(counters.nodes, subs);
    }
}

// Spheres of the patch before this place.
uint rankOf(uint place) {
    uint rank = bitCount(present[place >> 5] & ((1u << (place & 31u)) - 1u));
    for (uint w = 0; w < place >> 5; ++w) {
        rank += bitCount(present[w]);
    }
    return rank;
}

// Where the patch's spheres go. Patches come in any order: the host puts them in theirs.
void placeRun(uint patchIndex) {
    if (kPack != 0) {
        uint count = 0;
        for (uint w = 0; w < 8u * kLayers; ++w) {
            count += bitCount(present[w]);
        }
        packedFrom = count != 0 ? atomicAdd(counters.spheres, count) : 0u;
        runs[patchIndex] = uvec2(packedFrom, count | classesOfPatch << 16);
    }
}

// Slots are not said one by one: the bits of those that are there are less to send.
void packPatch(uint patchIndex) {
    for (uint w = gl_LocalInvocationID.x; kPack != 0 && w < 8u * kLayers; w += gl_WorkGroupSize.x) {
        places[patchIndex * 16u + w] = present[w];
    }
    for (uint place = gl_LocalInvocationID.x; kPack != 0 && place < 256u * kLayers; place += gl_WorkGroupSize.x) {
        if ((present[place >> 5] >> (place & 31u) & 1u) != 0) {
            packedSpheres[packedFrom + rankOf(place)] = ofPatch[place];
        }
    }
}
