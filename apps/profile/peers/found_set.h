// SPDX-License-Identifier: Apache-2.0
// The spheres found so far in one query, each once, and the exact test for candidates. All peers share the
// test, so that it favours none in time or precision.
#pragma once

#include "engine/contact/host_fixtures.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fathom::peers {

class FoundSet {
public:
    void begin(size_t spheres) { marks_.assign(spheres, 0); }
    // Adds sphere i if d <= limit + R, with limit = reach + r_t [m].
    void test(const RegionSpheres& s, uint32_t i, float x, float y, float z, float limit,
              std::vector<uint32_t>& found) {
        if (marks_[i] != 0) {
            return;
        }
        const float dx = x - s.x[i], dy = y - s.y[i], dz = z - s.z[i], far = limit + s.radius[i];
        if (dx * dx + dy * dy + dz * dz <= far * far) {
            marks_[i] = 1;
            found.push_back(i);
        }
    }

private:
    std::vector<uint8_t> marks_;
};

inline float largestRadius(const RegionSpheres& s) {
    return s.radius.empty() ? 0.0f : *std::max_element(s.radius.begin(), s.radius.end());
}

} // namespace fathom::peers
