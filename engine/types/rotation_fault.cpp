// SPDX-License-Identifier: Apache-2.0
#include "engine/types/rotation_fault.h"

#include "engine/types/number_text.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace fathom {

namespace {

bool nearIdentity(const glm::dmat3& matrix, double mostOff) {
    bool same = true;
    for (int i = 0; i < 9; ++i) {
        same = same && std::abs(matrix[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)) < mostOff;
    }
    return same;
}

} // namespace

std::string rotationFault(const glm::dmat3& matrix, double mostOff) {
    const glm::dmat3 product = matrix * glm::transpose(matrix);
    const double determinant = glm::determinant(matrix), scale = std::cbrt(determinant);
    if (!std::isfinite(determinant)) {
        return "not finite";
    }
    if (determinant < 0.0) {
        return "mirrored";
    }
    if (nearIdentity(product, mostOff)) {
        return "";
    }
    return nearIdentity(product / (scale * scale), mostOff) ? "scaled by " + significant(scale, 4)
                                                            : "sheared";
}

std::string quaternionFault(const dquat& q, const std::string& order) {
    constexpr double kShortest = 1e-6, kMaxOff = 0.05; // of numbers with one digit, as 0.6 0.6 0.6 0
    const double length = glm::length(q);
    if (!(length > kShortest)) {
        return "a quaternion " + order + " of non-zero length";
    }
    return std::abs(length - 1.0) <= kMaxOff
               ? ""
               : "a quaternion " + order + ", in this order, of length 1; its length is " +
                     significant(length, 4);
}

} // namespace fathom
