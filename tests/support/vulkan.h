// SPDX-License-Identifier: Apache-2.0
// One Vulkan device with validation for all tests of a program, and functions that read device-local buffers.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/device.h"
#include "tests/support/validation_wanted.h"

#include <cstdlib>
#include <vector>

namespace fathom::testing {

struct Vulkan {
    gpu::Instance instance;
    gpu::Device device;
    // FATHOM_TEST_DEVICE selects the device.
    Vulkan()
        : instance(validation())
        , device(instance, selector()) {}

    static gpu::Validation validation() { return {validationWanted(), validationSetting() == "gpu"}; }
    static std::string selector() {
        const char* set = std::getenv("FATHOM_TEST_DEVICE");
        return set != nullptr ? set : "llvmpipe";
    }
};

// The device shared by the tests of one program; destroyed when the program ends.
Vulkan& vulkan();

} // namespace fathom::testing
