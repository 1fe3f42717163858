// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/software_threads.h"

#include "engine/types/processors.h"

#include <cstdlib>
#include <string>

namespace fathom::gpu {

std::optional<uint32_t> softwareThreads(uint32_t processors) noexcept {
    return processors == 2 ? std::optional<uint32_t>(4) : std::nullopt;
}

void askForSoftwareThreads() noexcept {
    if (const std::optional<uint32_t> threads = softwareThreads(usableProcessors())) {
        ::setenv("LP_NUM_THREADS", std::to_string(*threads).c_str(),
                 0); // fails only when out of memory: then the default applies
    }
}

} // namespace fathom::gpu
