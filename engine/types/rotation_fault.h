// SPDX-License-Identifier: Apache-2.0
// Rotations in files of other programs: why a matrix or four numbers are none.
#pragma once

#include "engine/types/pose.h"

#include <glm/mat3x3.hpp>
#include <string>

namespace fathom {

// "mirrored", "scaled by 1.1", "sheared" or "not finite"; empty for a rotation, whose R R^T is within
// `mostOff` of the identity in each entry; the usual value is for numbers of two digits.
std::string rotationFault(const glm::dmat3& matrix, double mostOff = 0.04);

// What is allowed where the length is over 5 % from 1, as that of other columns or of degrees; empty for a
// length of 1. order: of the four names, as "qx qy qz qw".
std::string quaternionFault(const dquat& q, const std::string& order);

} // namespace fathom
