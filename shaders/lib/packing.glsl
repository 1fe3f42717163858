// SPDX-License-Identifier: Apache-2.0
// A group's patch into the row that the host reads, by layer (seen, held), then slot. Needs counters, kPack, kLayers, ofPatch,
// notesOfPatch and packedSpheres, tags, runs.

shared uint present[16]; // bit a place: spheres of the patch, then held ones
shared uint packedFrom;

void markPresent(uint place, float radius) {
    if (radius >= 0.0) {
        atomicOr(present[place >> 5], 1u << (place & 31u));
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
        runs[patchIndex] = uvec2(packedFrom, count);
    }
}

void packPatch() {
    for (uint place = gl_LocalInvocationID.x; kPack != 0 && place < 256u * kLayers; place += gl_WorkGroupSize.x) {
        if ((present[place >> 5] >> (place & 31u) & 1u) != 0) {
            uint to = packedFrom + rankOf(place);
            uint both = notesOfPatch[place & 255u] >> 8;
            packedSpheres[to] = ofPatch[place];
            tags[to] = place * 8u + ((place >= 256u ? both >> 4 : both) & 7u);
        }
    }
}
