// SPDX-License-Identifier: Apache-2.0
// Rewrites a URDF so that urdfdom accepts it.
#pragma once

#include <string>

namespace fathom {

// Replaces tabs and line ends in attributes by spaces, and trims numbers: urdfdom rejects both.
std::string withNormalisedTags(const std::string& text);

// Removes what Fathom does not read and the parser may reject: capsules become meshes (kCapsuleFile),
// materials are dropped, an inertial keeps no values, and a limit neither its effort nor infinite values.
// Throws BadInput for a capsule without a size, and for infinite limits of a joint that needs finite ones.
std::string textForParser(const std::string& text, const std::string& file);

} // namespace fathom
