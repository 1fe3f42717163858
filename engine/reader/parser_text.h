// SPDX-License-Identifier: Apache-2.0
// Changes a URDF's text so that urdfdom reads it as meant.
#pragma once

#include <string>

namespace fathom {

// XML reads tabs and line ends in an attribute as spaces, and spaces around a number have no meaning: the
// parser rejects both.
std::string withSpaces(const std::string& text);

// The text without what the parser does not know or rejects though nothing here reads it: capsules become
// meshes (kCapsuleFile), materials are left out, and an inertial keeps no values. Throws BadInput for a
// capsule without a size.
std::string textForParser(const std::string& text, const std::string& file);

} // namespace fathom
