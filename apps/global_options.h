// SPDX-License-Identifier: Apache-2.0
// Options that every subcommand shares.
#pragma once

#include "engine/gpu/instance.h"

#include <string>

namespace fathom {

struct GlobalOptions {
    std::string device;     // --device NAME|INDEX; empty = the best there is
    std::string trace;      // --trace FILE; empty = none
    bool validate = false;  // --validate: a message of the Vulkan layers ends in exit code 1
    bool holdClock = false; // --hold-clock: apps/clock/clock_keeper.h
    bool verbose = false;   // -v

    // Of every instance that a command makes.
    gpu::Validation validation() const { return {validate, false}; }
};

} // namespace fathom
