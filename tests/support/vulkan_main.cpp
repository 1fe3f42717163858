// SPDX-License-Identifier: Apache-2.0
// Test programs that use the device: every validation message fails the program.
#define DOCTEST_CONFIG_IMPLEMENT
#include "engine/gpu/software_threads.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>
#include <iostream>
#include <memory>

namespace {
std::unique_ptr<fathom::testing::Vulkan> shared;
}

fathom::testing::Vulkan& fathom::testing::vulkan() {
    if (!shared) {
        shared = std::make_unique<Vulkan>();
    }
    return *shared;
}

int main(int argc, char** argv) {
    fathom::gpu::askForSoftwareThreads();
    doctest::Context context(argc, argv);
    int result = context.run();
    shared.reset(); // destruction may also cause messages
    const uint32_t messages = fathom::gpu::validationMessages();
    if (messages != 0) {
        std::cout << "validation: " << messages << " messages, none is allowed\n";
        result = result == 0 ? 1 : result;
    }
    return result;
}
