// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/boundary.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

namespace fathom::stability {

namespace {

constexpr double kAccuracy = 1e-4;

// Largest K with grows(K) == false between guess / 8 and guess * 8.
double bisect(double guess, const std::function<bool(double)>& grows) {
    double lo = guess / 8.0, hi = guess * 8.0;
    if (grows(lo)) {
        return 0.0;
    }
    if (!grows(hi)) {
        return hi;
    }
    while (hi - lo > kAccuracy * lo) {
        const double middle = std::sqrt(lo * hi);
        (grows(middle) ? hi : lo) = middle;
    }
    return lo;
}

// Energy of a swing over a window of ticks. The sin^2 weight makes the result insensitive to the phase at
// which the window starts and ends.
class Window {
public:
    Window(size_t begin, size_t length)
        : begin_(begin)
        , length_(length) {}
    void add(size_t i, double x) {
        if (i >= begin_ && i < begin_ + length_) {
            const double s = std::sin(std::numbers::pi * (static_cast<double>(i - begin_) + 0.5) /
                                      static_cast<double>(length_));
            sum_ += s * s * x * x;
        }
    }
    double sum() const { return sum_; }

private:
    size_t begin_, length_;
    double sum_ = 0.0;
};

// Returns whether the swing at stiffness k grows: compares ten early periods with the last ten.
bool swingGrows(LoopSpec spec, double k, bool rotational) {
    const double kk = spec.armLength * spec.armLength;
    const double linear = rotational ? k / kk : k;
    if (rotational) {
        spec.stiffness = linear;
        spec.rotationalStiffness = k;
    } else {
        spec.stiffness = k;
        spec.rotationalStiffness = k * 1e-4;
    }
    const double pace = std::sqrt((linear + spec.hand.stiffness) / spec.wholeMass());
    const auto ticks = static_cast<size_t>(std::ceil(2.0 * std::numbers::pi / pace / spec.period()));
    // Skips the force ramp at the start; the springs have full stiffness after it.
    const auto first = std::max(4 * ticks, static_cast<size_t>(1.1 * HapticCycle::kRampTime / spec.period()));
    LoopRig rig(spec);
    Window early(first, 10 * ticks), late(first + 26 * ticks, 10 * ticks);
    for (size_t i = 0; i < first + 36 * ticks; ++i) {
        rig.tick();
        const Pose& handle = rig.hand().handle();
        const double x = rotational ? rotationLog(handle.rotation).x : handle.position.x;
        if (!(std::abs(x) < 1.0)) { // 1 m or 1 rad, or NaN: certainly grown
            return true;
        }
        early.add(i, x);
        late.add(i, x);
    }
    return late.sum() > early.sum();
}

// Eigenvalues of the loop over one period. State: x, v, x at the previous tick, and the delayed forces.
bool modelGrows(const SampledLoop& loop, double k) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero(); // x, v and the constant force
    a(0, 1) = 1.0;
    a(1, 0) = -loop.handStiffness / loop.mass;
    a(1, 1) = -loop.damping / loop.mass;
    a(1, 2) = 1.0 / loop.mass;
    const Eigen::Matrix3d step = (a * loop.period).exp();
    const int n = static_cast<int>(loop.delay);
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(3 + n, 3 + n);
    Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(3 + n); // force written this tick
    force(0) = -k - loop.virtualDamping / loop.period;
    force(2) = loop.virtualDamping / loop.period;
    Eigen::RowVectorXd felt = n == 0 ? force : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(3 + n, 2 + n));
    for (int row = 0; row < 2; ++row) {
        m(row, 0) = step(row, 0);
        m(row, 1) = step(row, 1);
        m.row(row) += step(row, 2) * felt;
    }
    m(2, 0) = 1.0;
    for (int i = 0; i < n; ++i) {
        m.row(3 + i) = i == 0 ? force : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(3 + n, 2 + i));
    }
    return m.eigenvalues().cwiseAbs().maxCoeff() > 1.0 + 1e-12;
}

} // namespace

double measuredBoundary(LoopSpec spec, double guess, bool rotational) {
    spec.controller = spec.limited = false;
    Shape line = lineShape({0.0, 0.0, 1.0});
    if (rotational) {
        line = lineShape({0.0, 0.0, 1.0});
        line.kind = ShapeKind::Axis;
        spec.path = {wayAt(0.0, dvec3(0.0), {0.02, 0.0, 0.0}), wayAt(1e-9, dvec3(0.0))};
    } else {
        spec.path = {wayAt(0.0, {0.002, 0.0, 0.0}), wayAt(1e-9, dvec3(0.0))};
    }
    spec.shapes = {line};
    return bisect(guess, [&](double k) { return swingGrows(spec, k, rotational); });
}

double computedBoundary(const SampledLoop& loop, double guess) {
    return bisect(guess, [&](double k) { return modelGrows(loop, k); });
}

double lawOfBoundary(double damping, double virtualDamping, double period, uint32_t delay) {
    return (damping + virtualDamping) / (period * (0.5 + delay));
}

} // namespace fathom::stability
