// SPDX-License-Identifier: Apache-2.0
// Colours shared by all plots.
#pragma once

#include "apps/output/image.h"

namespace fathom {

constexpr Colour kPaper{1.0, 1.0, 1.0};
constexpr Colour kInk{0.10, 0.14, 0.19};
constexpr Colour kQuietInk{0.39, 0.43, 0.48};
constexpr Colour kGrid{0.885, 0.895, 0.91};

} // namespace fathom
