// SPDX-License-Identifier: Apache-2.0
// The floating-point mode of all computations, whatever mode the calling program uses.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace fathom::front {

// Sets round to nearest, denormals kept, no traps; the destructor restores the caller's mode. Threads inherit
// the mode of the thread that starts them, so the engine's own threads use it, too.
class FloatMode {
public:
#if defined(__SSE2__)
    FloatMode() noexcept
        : before_(_mm_getcsr()) {
        _mm_setcsr(kDefault);
    }
    ~FloatMode() {
        _mm_setcsr(before_);
    }
#else
    FloatMode() noexcept = default;
    ~FloatMode() {} // not trivial, so that a guard counts as used
#endif
    FloatMode(const FloatMode&) = delete;
    FloatMode& operator=(const FloatMode&) = delete;

private:
#if defined(__SSE2__)
    static constexpr unsigned kDefault = 0x1f80;
    unsigned before_;
#endif
};

} // namespace fathom::front
