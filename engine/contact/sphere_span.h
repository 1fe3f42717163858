// SPDX-License-Identifier: Apache-2.0
// Consecutive region spheres in columns, as kernels read them.
#pragma once

#include <algorithm>
#include <cstddef>

namespace fathom {

// About one origin [m]. Kernels take it by value, so that the compiler knows that no store changes it.
struct SphereSpan {
    const float* x;
    const float* y;
    const float* z;
    const float* radius;
    size_t count;
};

// At most `most` spheres of a run from `begin` on.
inline SphereSpan part(const SphereSpan& run, size_t begin, size_t most) {
    return {run.x + begin, run.y + begin, run.z + begin, run.radius + begin,
            std::min(most, run.count - begin)};
}

} // namespace fathom
