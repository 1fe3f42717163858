// SPDX-License-Identifier: Apache-2.0
// Vectors of long double, for checks that must round less than what they check.
#pragma once

#include <Eigen/Core>

#include <span>

namespace fathom {

using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

inline LongVector longVector(std::span<const double> v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()))
        .cast<long double>();
}

} // namespace fathom
