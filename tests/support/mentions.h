// SPDX-License-Identifier: Apache-2.0
// Checks that a message contains a text.
#pragma once

#include <doctest/doctest.h>
#include <string>

namespace fathom::testing {

// Whether the text contains the part; a failed check shows both.
inline bool mentions(const std::string& text, const std::string& part) {
    CAPTURE(text);
    CAPTURE(part);
    const bool found = text.find(part) != std::string::npos;
    CHECK(found);
    return found;
}

} // namespace fathom::testing
