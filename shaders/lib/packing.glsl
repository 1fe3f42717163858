// SPDX-License-Identifier: Apache-2.0
// Marks which slots of the group's patch have spheres, by layer (seen, held), then slot. With kPack, packs
// these spheres into the run that the host reads. Needs counters, kPack, kThin, kByDepth, kLayers,
// patchSpheres, patchDepths, patchNotes and packedWords, places, runs.
//
// A run is a sequence of words. First come the seen spheres as depths z, because the host knows each pixel's
// ray:
// - no sphere has grown: one word each, the float bits of z;
// - some have grown: first the float bits of half the first z, then one word each: 24 bits of offset from
//   there in units of the last place, and 8 bits of growth steps;
// - 24 bits do not suffice (some z is below half or from twice the first z on): the float bits of each z,
//   then the steps as bytes.
// Then come the held spheres as centre and R, because their rays belong to earlier poses. With beams
// (kByDepth false) seen spheres are stored the same way: their radii need a root, which processors may round
// differently.

const uint kGrownHere = kRunGrown >> 16, kWideHere = kRunWide >> 16; // shifted to the upper half of runs[].y
const uint kRunAlign = 32u; // [words] so that no two groups write to the same 128 bytes of host memory
const uint kHalfRange = 0x800000u; // half the range of 24 bits
shared uint present[16];    // one bit per slot: seen spheres, then held ones
shared uint packedFrom, packedSeen, packedBase;
shared uint classesOfPatch; // one bit per class that occurs; kGrownHere
shared uint wideOfPatch;    // kWideHere, or 0
// Seen spheres in packed order: float bits of the depth.
shared uint packedDepths[kByDepth ? 256 : 1];
shared uint packedSteps[kByDepth && kThin != 0 ? 260 : 1]; // and growth in steps

void markPresent(uint place, float radius) {
    if (radius >= 0.0) {
        atomicOr(present[place >> 5], 1u << (place & 31u));
    }
}

// Most patches have one class, so only its first sphere costs an atomic.
void markClass(uint mark, float radius) {
    if (radius >= 0.0 && (classesOfPatch & mark) != mark) {
        atomicOr(classesOfPatch, mark);
    }
}

// Counts sub-patches with a sphere in either layer, by one atomic addition per group.
void countSubs() {
    uint subs = 0;
    for (uint w = 0; w < 8u; ++w) {
        uint here = present[w] | present[8u * (kLayers - 1u) + w];
        subs += ((here & 0xffffu) != 0 ? 1u : 0u) + (here >> 16 != 0 ? 1u : 0u);
    }
    if (subs != 0) {
        atomicAdd(counters.subs, subs);
    }
}

// Number of spheres before this slot in its layer.
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

bool wideHere() {
    return kThin != 0 && wideOfPatch != 0;
}

uint wordsOfSteps() {
    return wideHere() ? (packedSeen + 3u) / 4u : (grownHere() ? 1u : 0u);
}

uint wordsOfSeen() {
    return kByDepth ? packedSeen + wordsOfSteps() : 4u * packedSeen;
}

// Float bits of the depth of the patch's first seen sphere; there must be one.
uint firstDepth() {
    uint w = 0;
    while (w < 7u && present[w] == 0) {
        ++w;
    }
    return floatBitsToUint(patchDepths[kByDepth ? w * 32u + uint(findLSB(present[w])) : 0u]);
}

// Reserves space for the patch's run. Runs are in any order; the host sorts them.
void placeRun() {
    if (kPack != 0) {
        packedSeen = countOf(0);
        uint held = kLayers > 1u ? countOf(1) : 0u, steps = grownHere() ? (packedSeen + 3u) / 4u : 0u;
        uint words = (kByDepth ? packedSeen + steps : 4u * packedSeen) + 4u * held;
        words = (words + kRunAlign - 1u) / kRunAlign * kRunAlign;
        packedFrom = words != 0 ? atomicAdd(counters.packedWords, words) : 0u;
        packedBase = kByDepth && packedSeen != 0 ? firstDepth() - kHalfRange : 0u;
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

// Word w of the run's seen spheres.
uint seenWord(uint w) {
    if (!grownHere() || (wideHere() && w < packedSeen)) {
        return packedDepths[w];
    }
    if (wideHere()) {
        uint four = kThin != 0 ? 4u * (w - packedSeen) : 0u; // beyond the last one: unused
        return packedSteps[four] | (packedSteps[four + 1u] & 255u) << 8 | (packedSteps[four + 2u] & 255u) << 16 | packedSteps[four + 3u] << 24;
    }
    return w == 0 ? packedBase : (packedDepths[w - 1u] - packedBase) << 8 | packedSteps[w - 1u];
}

// Called by the whole group. Words are collected in shared memory, so that whole sectors cross the bus.
void packByDepth() {
    for (uint slot = gl_LocalInvocationID.x; slot < 256u; slot += gl_WorkGroupSize.x) {
        if (isPresent(slot)) {
            uint rank = rankOf(slot), bits = floatBitsToUint(patchDepths[slot]);
            packedDepths[rank] = bits;
            if (kThin != 0) {
                packedSteps[rank] = patchNotes[slot] >> 16;
            }
            if (grownHere() && bits - packedBase >= 2u * kHalfRange) {
                atomicOr(wideOfPatch, kWideHere);
            }
        }
    }
    barrier();
    uint words = wordsOfSeen();
    for (uint w = gl_LocalInvocationID.x; w < words; w += gl_WorkGroupSize.x) {
        packedWords[packedFrom + w] = seenWord(w);
    }
}

// Writes the occupied slots as bits, which takes fewer bytes than their indices.
void packPatch(uint patchIndex) {
    for (uint w = gl_LocalInvocationID.x; w < 8u * kLayers; w += gl_WorkGroupSize.x) {
        places[patchIndex * 16u + w] = present[w];
    }
    if (kByDepth) {
        packByDepth();
    }
    for (uint place = gl_LocalInvocationID.x + (kByDepth ? 256u : 0u); place < 256u * kLayers; place += gl_WorkGroupSize.x) {
        if (isPresent(place)) {
            packWhole(packedFrom + (place >= 256u ? wordsOfSeen() : 0u) + 4u * rankOf(place), patchSpheres[place]);
        }
    }
    if (gl_LocalInvocationID.x == 0) {
        uint held = kLayers > 1u ? countOf(1) : 0u;
        runs[patchIndex] = uvec2(packedFrom, packedSeen + held | (classesOfPatch | wideOfPatch) << 16);
    }
}
