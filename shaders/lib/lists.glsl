// SPDX-License-Identifier: Apache-2.0
// Lists of patches. Needs list, counters, kSubPatchGroup.

// Number of groups of `subs` sub-patches for a list that ends with the patch at this index.
uint groupsUpTo(uint place, uint subs) {
    return (place * 16u + 15u) / subs + 1u;
}

// Appends a patch with work to the first part of the list.
void appendListed(uint patchIndex) {
    uint place = atomicAdd(counters.patchGroups.x, 1u);
    list[place] = patchIndex;
    atomicMax(counters.subPatchGroups.x, groupsUpTo(place, kSubPatchGroup));
}
