// SPDX-License-Identifier: Apache-2.0
#include "engine/types/processors.h"

#include <algorithm>
#include <sched.h>
#include <thread>

namespace fathom {

uint32_t usableProcessors() noexcept {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) { // more CPUs than the set can hold
        return std::max(1u, std::thread::hardware_concurrency());
    }
    return static_cast<uint32_t>(std::max(1, CPU_COUNT(&allowed)));
}

} // namespace fathom
