// SPDX-License-Identifier: Apache-2.0
// Lists of patches.

// Number of groups of `subs` sub-patches for a list that ends with the patch at this index.
uint groupsUpTo(uint place, uint subs) {
    return (place * 16u + 15u) / subs + 1u;
}
