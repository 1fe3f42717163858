// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/proxy.h"

#include "engine/haptics/proxy_limits.h"

#include <algorithm>
#include <cmath>

namespace fathom {

Proxy::Proxy(const Tool& tool, std::span<const Shape> shapes, const ProxyOptions& options, const Pose& start)
    : places_(tool)
    , boundingRadius_(tool.boundingRadius())
    , shapes_(shapes.begin(), shapes.end())
    , options_(options)
    , pose_(start)
    , narrow_(tool, proxy::kMostPairRows, options.rows.cone)
    , trust_(tool.leafCount())
    , solver_(6, proxy::kMostRows)
    , rows_(proxy::kMostRows)
    , rowViolations_(proxy::kMostRows)
    , loaded_(proxy::kMostRows)
    , isLoaded_(proxy::kMostRows, 0)
    , violations_(proxy::kMostViolations)
    , exempt_(tool.leafCount(), dvec3(0.0))
    , clearance_(tool.leafCount(), 0.0)
    , leaves_(tool.leafCount())
    , next_(tool.leafCount()) {
    for (const Sphere& leaf : tool.leaves()) {
        radius_.push_back(leaf.radius);
    }
    pose_.rotation = glm::normalize(pose_.rotation);
    shapes_.reserve(std::max(kSpareShapes, shapes_.size()));
    setMetric(0.1);
}

void Proxy::setShapes(std::span<const Shape> shapes) noexcept {
    const size_t count = std::min(shapes.size(), shapes_.capacity());
    shapes_.assign(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(count));
}

void Proxy::setPose(const Pose& pose) noexcept {
    if (isFinite(pose)) {
        pose_ = {pose.position, glm::normalize(pose.rotation)};
    }
}

bool Proxy::covers(const ContactSet& contacts) noexcept {
    places_.place(pose_, contacts.origin, leaves_);
    return TrustRegion::covers(contacts, leaves_);
}

void Proxy::setMetric(double radius) noexcept {
    // Kept inside what float64 can factor, so that setMetric of the solver cannot refuse it.
    const double k = std::isfinite(radius) ? std::clamp(radius, 1e-4, 1e4) : 0.1;
    if (k == metricRadius_) {
        return;
    }
    metricRadius_ = k;
    std::array<double, 36> metric{};
    for (size_t i = 0; i < 6; ++i) {
        metric[i * 7] = i < 3 ? 1.0 : k * k;
    }
    solver_.setMetric(metric);
}

ProxyStep Proxy::step(const ProxyInput& input) noexcept {
    ProxyStep out;
    activeCount_ = 0;
    setMetric(input.metricRadius);
    const ContactSet* contacts = input.contacts;
    const bool usable = contacts == nullptr || contacts->leafAtQuery.size() == places_.count();
    origin_ = contacts != nullptr ? contacts->origin : pose_.position;
    places_.place(pose_, origin_, leaves_);
    if (usable && isFinite(input.target)) { // otherwise hold
        out.uncovered = contacts != nullptr && !TrustRegion::covers(*contacts, leaves_);
        Budget budget{options_.escapePerTurn, options_.stepCap};
        for (uint32_t k = 0; k < options_.solves; ++k) {
            firstSolve_ = k == 0;
            if (k > 0 && input.deadline.passed != nullptr && input.deadline.passed(input.deadline.context)) {
                break;
            }
            if (!step(input, budget, out)) {
                break;
            }
        }
    }
    out.pose = pose_;
    out.active = {active_.data(), activeCount_};
    out.contact = activeCount_ > 0;
    if (contacts != nullptr && usable) {
        out.minGap = narrow_.smallestGapAt(*contacts, leaves_);
    }
    return out;
}

} // namespace fathom
