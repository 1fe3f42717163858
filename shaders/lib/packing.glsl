// SPDX-License-Identifier: Apache-2.0
// Which places of a group's patch have spheres, by layer (seen, held), then slot; and (kPack) these into the run that the host
// reads. Needs counters, kPack, kThin, kByDepth, kLayers, ofPatch, zOfPatch, notesOfPatch and packedWords, places, runs.
//
// A run is of words: the depths z of the seen spheres, for the host knows the ray of each pixel; if one of them has grown, 16 bits
// each, of how many steps; then centre and R of the held ones, whose rays were of earlier poses. With beams (kByDepth false) the
// seen ones are whole, too: their radii come by a root, which no two processors need to round alike.

const uint kGrownHere = kRunGrown >> 16; // of classesOfPatch: a seen sphere has grown
const uint kRunAlign = 32u;        // words: no two groups write to one sector of memory
shared uint present[16];           // bit a place: spheres of the patch, then held ones
shared uint packedFrom, packedSeen;
shared uint classesOfPatch;        // bit a class that a sphere is of; kGrownHere
shared uint ofRank[kByDepth ? 256 : 1];                    // a seen sphere, as packed: its depth
shared uint stepsOfRank[kByDepth && kThin != 0 ? 257 : 1]; // and what it has grown by

void markPresent(uint place, float radius) {
    if (radius >= 0.0) {
        atomicOr(present[place >> 5], 1u << (place & 31u));
    }
}

// Most patches have one class: after the first nobody has to wait for its bits.
void markClass(uint mark, float radius) {
    if (radius >= 0.0 && (classesOfPatch & mark) != mark) {
        atomicOr(classesOfPatch, mark);
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

// Spheres of the place's layer before it.
uint rankOf(uint place) {
    uint rank = bitCount(present[place >> 5] & ((1u << (place & 31u)) - 1u));
    for (uint w = place >> 8 << 3; w < place >> 5; ++w) {
        rank += bitCount(present[w]);
    }
    return rank;
}

uint countOf(uint layer) {
    uint count = 0;
    for (uint w = 8u * layer; w < 8u * layer + 8u; ++w) {
        count += bitCount(present[w]);
    }
    return count;
}

bool grownHere() {
    return kThin != 0 && (classesOfPatch & kGrownHere) != 0;
}

uint wordsOfSeen() {
    return kByDepth ? packedSeen + (grownHere() ? (packedSeen + 1u) / 2u : 0u) : 4u * packedSeen;
}

// Where the patch's spheres go. Patches come in any order: the host puts them in theirs.
void placeRun(uint patchIndex) {
    if (kPack != 0) {
        packedSeen = countOf(0);
        uint held = kLayers > 1u ? countOf(1) : 0u;
        uint words = (wordsOfSeen() + 4u * held + kRunAlign - 1u) / kRunAlign * kRunAlign;
        packedFrom = words != 0 ? atomicAdd(counters.packedWords, words) : 0u;
        runs[patchIndex] = uvec2(packedFrom, packedSeen + held | classesOfPatch << 16);
    }
}

bool isPresent(uint place) {
    return (present[place >> 5] >> (place & 31u) & 1u) != 0;
}

void packWhole(uint at, vec4 sphere) {
    for (uint k = 0; k < 4u; ++k) {
        packedWords[at + k] = floatBitsToUint(sphere[k]);
    }
}

// All of the group call it. By way of shared memory: what crosses the bus are whole sectors, and not the few words of each that
// neighbours happen to have.
void packByDepth() {
    for (uint slot = gl_LocalInvocationID.x; slot < 256u; slot += gl_WorkGroupSize.x) {
        if (isPresent(slot)) {
            uint rank = rankOf(slot);
            ofRank[rank] = floatBitsToUint(zOfPatch[slot]);
            if (kThin != 0) {
                stepsOfRank[rank] = notesOfPatch[slot] >> 16;
            }
        }
    }
    barrier();
    uint words = wordsOfSeen();
    for (uint w = gl_LocalInvocationID.x; w < words; w += gl_WorkGroupSize.x) {
        uint pair = w < packedSeen || kThin == 0 ? 0u : 2u * (w - packedSeen); // of the last odd one the second is nobody's
        packedWords[packedFrom + w] = w < packedSeen ? ofRank[w] : stepsOfRank[pair] | stepsOfRank[kThin != 0 ? pair + 1u : 0u] << 16;
    }
}

// Slots are not said one by one: the bits of those that are there are less to send.
void packPatch(uint patchIndex) {
    for (uint w = gl_LocalInvocationID.x; w < 8u * kLayers; w += gl_WorkGroupSize.x) {
        places[patchIndex * 16u + w] = present[w];
    }
    if (kByDepth) {
        packByDepth();
    }
    for (uint place = gl_LocalInvocationID.x + (kByDepth ? 256u : 0u); place < 256u * kLayers; place += gl_WorkGroupSize.x) {
        if (isPresent(place)) {
            packWhole(packedFrom + (place >= 256u ? wordsOfSeen() : 0u) + 4u * rankOf(place), ofPatch[place]);
        }
    }
}
