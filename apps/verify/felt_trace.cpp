// SPDX-License-Identifier: Apache-2.0
#include "apps/verify/felt_trace.h"

#include "engine/types/median.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom {

namespace {

dvec3 meanOf(const std::vector<dvec3>& values) {
    dvec3 sum(0.0);
    for (const dvec3& v : values) {
        sum += v;
    }
    return values.empty() ? sum : sum / static_cast<double>(values.size());
}

double rmsOf(const std::vector<dvec3>& values) {
    const dvec3 mean = meanOf(values);
    double squares = 0.0;
    for (const dvec3& v : values) {
        squares += glm::dot(v - mean, v - mean);
    }
    return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

double largestStep(const std::vector<dvec3>& values) {
    double largest = 0.0;
    for (size_t i = 1; i < values.size(); ++i) {
        largest = std::max(largest, glm::distance(values[i], values[i - 1]));
    }
    return largest;
}

} // namespace

dvec3 FeltTrace::meanForce() const {
    return meanOf(force_);
}

double FeltTrace::forceRms() const {
    return rmsOf(force_);
}

double FeltTrace::torqueRms() const {
    return rmsOf(torque_);
}

// Sum of the discrete Fourier transform's bins in the band, each by Goertzel's recurrence.
double FeltTrace::band(const std::vector<dvec3>& values, double low, double high) const {
    const size_t n = values.size();
    const dvec3 mean = meanOf(values);
    const double span = period_ * static_cast<double>(n);
    double power = 0.0;
    for (size_t bin = 1; 2 * bin < n; ++bin) {
        const double hz = static_cast<double>(bin) / span;
        if (hz < low || hz >= high) {
            continue;
        }
        const double c =
            2.0 * std::cos(2.0 * std::numbers::pi * static_cast<double>(bin) / static_cast<double>(n));
        dvec3 a(0.0), b(0.0);
        for (const dvec3& v : values) {
            const dvec3 next = v - mean + c * a - b;
            b = a;
            a = next;
        }
        power += 2.0 * (glm::dot(a, a) + glm::dot(b, b) - c * glm::dot(a, b));
    }
    return n > 0 ? std::sqrt(std::max(0.0, power)) / static_cast<double>(n) : 0.0;
}

double FeltTrace::forceBand(double low, double high) const {
    return band(force_, low, high);
}

double FeltTrace::motionBand(double low, double high) const {
    return band(hand_, low, high);
}

double FeltTrace::motionPeakToPeak() const {
    dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const dvec3& v : hand_) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    const dvec3 span = high - low;
    return hand_.empty() ? 0.0 : std::max({span.x, span.y, span.z});
}

double FeltTrace::forceStep() const {
    return largestStep(force_);
}

double FeltTrace::torqueStep() const {
    return largestStep(torque_);
}

uint64_t FeltTrace::stepsOver(double newton) const {
    uint64_t count = 0;
    for (size_t i = 1; i < force_.size(); ++i) {
        count += glm::distance(force_[i], force_[i - 1]) > newton ? 1 : 0;
    }
    return count;
}

uint64_t FeltTrace::reversals(double newton) const {
    uint64_t count = 0;
    for (size_t i = 2; i < force_.size(); ++i) {
        const dvec3 before = force_[i - 1] - force_[i - 2], now = force_[i] - force_[i - 1];
        const bool both = glm::length(before) > newton && glm::length(now) > newton;
        count += both && glm::dot(before, now) < 0.0 ? 1 : 0;
    }
    return count;
}

double FeltTrace::steepestRise(double over) const {
    const auto ticks = static_cast<size_t>(std::max(1L, std::lround(over / period_)));
    double steepest = 0.0;
    for (size_t i = ticks; i < force_.size(); ++i) {
        const double rise = glm::length(force_[i]) - glm::length(force_[i - ticks]);
        steepest = std::max(steepest, rise / (period_ * static_cast<double>(ticks)));
    }
    return steepest;
}

double FeltTrace::sawtooth(const dvec3& axis, double window) const {
    const auto ticks = static_cast<size_t>(std::max(1L, std::lround(window / period_)));
    std::vector<double> spans;
    for (size_t begin = 0; begin + ticks <= force_.size(); begin += ticks / 4 + 1) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t i = begin; i < begin + ticks; ++i) {
            const double along = glm::dot(force_[i], axis);
            low = std::min(low, along);
            high = std::max(high, along);
        }
        spans.push_back(0.5 * (high - low));
    }
    return spans.empty() ? 0.0 : medianOf(spans);
}

} // namespace fathom
