// SPDX-License-Identifier: Apache-2.0
// Lists of patches.

// Groups of `subs` sub-patches that a list with patches up to this place fills.
uint groupsUpTo(uint place, uint subs) {
    return (place * 16u + 15u) / subs + 1u;
}
