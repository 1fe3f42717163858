// SPDX-License-Identifier: Apache-2.0
// Options that every subcommand shares.
#pragma once

#include <string>

namespace fathom {

struct GlobalOptions {
    std::string device;   // --device NAME|INDEX; empty = the best there is
    std::string trace;    // --trace FILE; empty = none
    bool verbose = false; // -v
};

} // namespace fathom
