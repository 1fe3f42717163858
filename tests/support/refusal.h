// SPDX-License-Identifier: Apache-2.0
// The message of an expected exception.
#pragma once

#include "engine/types/error.h"

#include <string>
#include <utility>

namespace fathom::testing {

// The message of the `Thrown` that attempt() throws; empty when it throws nothing. Any other exception fails
// the test.
template <class Thrown = BadInput, class Attempt>
std::string refusalOf(Attempt&& attempt) {
    try {
        std::forward<Attempt>(attempt)();
    } catch (const Thrown& e) {
        return e.what();
    }
    return "";
}

} // namespace fathom::testing
