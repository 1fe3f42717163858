// SPDX-License-Identifier: Apache-2.0
// Ranges of numbers in English.
#include "engine/scene/yaml_node.h"
#include "engine/types/number_text.h"

namespace fathom {

std::string Range::words() const {
    if (hi == std::numeric_limits<double>::max()) {
        return "a finite number";
    }
    return (orZero ? "0, or a number from " : "a number from ") + significant(lo, 6) + " to " +
           significant(hi, 6);
}

} // namespace fathom
