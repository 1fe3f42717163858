// SPDX-License-Identifier: Apache-2.0
// Images of several cameras in one folder, by the numbers in their names.
#pragma once

#include "devices/recorded/name_number.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace fathom {

// The same `last` last numbers, from 0 or 1, behind each of `fronts` others.
struct ImageViews {
    size_t first = 0, second = 0; // which names are of one front and have the two least last numbers
    size_t last = 0, fronts = 0;
};

// names: the numbers of each. Nothing for images of one camera: a counter that begins anew each second or in
// each episode has such names, too.
std::optional<ImageViews> severalViews(const std::vector<std::vector<NameNumber>>& names);

} // namespace fathom
