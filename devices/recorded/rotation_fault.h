// SPDX-License-Identifier: Apache-2.0
// Rotations in files of other programs: why a matrix or four numbers are none.
#pragma once

#include "engine/types/pose.h"

#include <glm/mat3x3.hpp>
#include <string>

namespace fathom {

// "mirrored", "scaled by 1.1", "sheared" or "not finite"; empty for a rotation, whose R R^T is within 0.01 of
// the identity in each entry.
std::string rotationFault(const glm::dmat3& matrix);

// What is allowed where the length is over 2 % from 1, as that of other columns or of degrees; empty for a
// length of 1. order: of the four names, as "qx qy qz qw".
std::string quaternionFault(const dquat& q, const std::string& order);

} // namespace fathom
