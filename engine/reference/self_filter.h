// SPDX-License-Identifier: Apache-2.0
// Twin of the self-filter in shaders/classify.comp: a pixel whose unfiltered point is inside a sphere of the
// arm has no class.
#pragma once

#include "engine/reference/classify.h"
#include "engine/types/sphere_tree.h"

#include <span>

namespace fathom::reference {

// spheres: base frame [m], padding included; all are tested. Points within 5e-6 m of a surface become unsure.
void removeArm(const FrameView& view, std::span<const Sphere> spheres, ClassImage& image);

} // namespace fathom::reference
