// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/drag.h"

#include "apps/profile/frame_sequence.h"
#include "apps/profile/wavy_wall.h"
#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/reference/contact_oracle.h"

#include <algorithm>
#include <deque>

namespace fathom::profile {

namespace {

constexpr double kWall = 0.2, kCircle = 0.08; // [m]
constexpr int kRises = 180;                   // positions at which a tool that is not a ball is lowered

// Height [m] of a ball's centre when it touches the wavy wall; `radius` includes the radius of the wall's
// spheres.
double ballOver(double x, double y, double radius) {
    constexpr double kStep = 0.002; // [m] search step; the slope at the contact is at most 0.2
    constexpr int kAround = 12;
    double height = -HUGE_VAL;
    for (int j = -kAround; j <= kAround; ++j) {
        for (int i = -kAround; i <= kAround; ++i) {
            const double dx = kStep * i, dy = kStep * j;
            height =
                std::max(height, wallHeight(x + dx, y + dy) + std::sqrt(radius * radius - dx * dx - dy * dy));
        }
    }
    return height;
}

struct EndTime {
    std::chrono::steady_clock::time_point end;
    static bool passed(const void* clock) {
        return std::chrono::steady_clock::now() >= static_cast<const EndTime*>(clock)->end;
    }
};

// One run of drag().
class Dragger {
public:
    explicit Dragger(const DragSetting& setting)
        : setting_(setting)
        , own_(ballTool(setting.leaves))
        , tool_(setting.tool != nullptr ? *setting.tool : own_)
        , wall_(wavyWall(static_cast<int>(kWall / setting.spacing), setting.spacing)) // 40 x 40 cm
        , proxy_(tool_, {}, setting.proxy, {dvec3(kCircle, 0, 0.5), dquat(1, 0, 0, 0)})
        , reach_(tool_.boundingRadius() + kWallRadius) {
        grid_.build(wall_.spheres);
        land();
        answer();
        std::swap(inForce_, *pending_.back().set);
        pending_.clear();
    }

    DragResult run() {
        for (uint32_t k = 0; k < setting_.ticks; ++k) {
            tick(k);
        }
        result_.lagRms = std::sqrt(lag_ / setting_.ticks);
        result_.spheres = wall_.spheres.size();
        return std::move(result_);
    }

private:
    struct Pending {
        uint32_t due;
        std::unique_ptr<ContactSet> set;
    };

    // Lowers the tool until it just touches at the centre of its circle.
    void land() {
        double low = 0.0, high = 0.5;
        for (int i = 0; i < 14; ++i) {
            height_ = 0.5 * (low + high);
            (oracleSmallestGap(tool_, handAt(0, height_), wall_) < 0.0 ? low : high) = height_;
        }
        height_ = high;
        findRises();
        proxy_.setPose(handAt(0, height_));
    }

    // For a tool that is not a ball: contact height relative to the start, at kRises positions on the circle.
    void findRises() {
        if (!setting_.follow || setting_.tool == nullptr) {
            return;
        }
        const double across = grid_.maxRadius() + 0.001; // [m] radius of the search
        for (int k = 0; k <= kRises; ++k) {
            const double angle = 2.0 * M_PI * k / kRises;
            Pose at{dvec3(kCircle * std::cos(angle), kCircle * std::sin(angle), 0.0), dquat(1, 0, 0, 0)};
            double low = height_ - 0.03, high = height_ + 0.03; // [m] range of the wall's waves
            for (int i = 0; i < 14; ++i) {
                at.position.z = 0.5 * (low + high);
                (touches(at, across) ? low : high) = at.position.z;
            }
            rises_.push_back(high - height_);
        }
    }

    bool touches(const Pose& pose, double across) const {
        bool any = false;
        for (const Sphere& leaf : tool_.leaves()) {
            const dvec3 centre = pose.position + pose.rotation * leaf.centre;
            grid_.forEachNear(centre, leaf.radius + across, [&](uint32_t i) {
                const dvec3 sphere(wall_.spheres.x[i], wall_.spheres.y[i], wall_.spheres.z[i]);
                any = any || glm::length(centre - sphere) < leaf.radius + wall_.spheres.radius[i];
            });
            if (any) {
                return true;
            }
        }
        return false;
    }

    double riseAt(double angle, double x, double y) const {
        if (rises_.empty()) {
            return ballOver(x, y, reach_) - ballOver(kCircle, 0.0, reach_);
        }
        const double at = std::fmod(angle / (2.0 * M_PI), 1.0) * kRises;
        const auto k = static_cast<size_t>(at);
        return rises_[k] + (at - static_cast<double>(k)) * (rises_[k + 1] - rises_[k]);
    }

    Pose handAt(uint32_t tick, double height) const {
        const double angle = setting_.speed / kCircle * 0.001 * tick;
        const double x = kCircle * std::cos(angle), y = kCircle * std::sin(angle);
        const double up = setting_.follow && tick > 0 ? riseAt(angle, x, y) : 0.0;
        return {dvec3(x, y, height + up), dquat(1, 0, 0, 0)};
    }

    void answer() {
        pending_.push_back({now_ + setting_.delay, std::make_unique<ContactSet>()});
        const Clocks clocks;
        cull_.query(tool_, proxy_.pose(), setting_.reach, wall_, grid_, *pending_.back().set);
        result_.queries.take(clocks);
    }

    void tick(uint32_t k) {
        now_ = k;
        answer();
        while (!pending_.empty() && pending_.front().due <= now_) {
            if (proxy_.accepts(*pending_.front().set)) {
                std::swap(inForce_, *pending_.front().set);
            }
            pending_.pop_front();
        }
        const Pose hand = handAt(k, height_ - setting_.press);
        EndTime clock{std::chrono::steady_clock::now() +
                      std::chrono::nanoseconds(static_cast<int64_t>(setting_.deadlineMicros * 1e3))};
        const Deadline deadline{setting_.deadlineMicros > 0.0 ? &EndTime::passed : nullptr, &clock};
        const Clocks clocks;
        const ProxyStep step = proxy_.step({hand, 0.05, &inForce_, deadline});
        result_.steps.take(clocks);
        note(k, hand, step);
    }

    void note(uint32_t k, const Pose& hand, const ProxyStep& step) {
        result_.stalled += step.stalled ? 1 : 0;
        result_.solves += step.solves;
        result_.rounds += step.rounds;
        result_.contacts += step.contact ? 1 : 0;
        dvec3 behind = hand.position - proxy_.pose().position;
        behind.z = 0.0; // distance normal to the wall is not lag
        lag_ += glm::dot(behind, behind);
        result_.poses.push_back(proxy_.pose());
        if (k % 64 == 0 || k + 1 == setting_.ticks) {
            result_.deepest = std::max(result_.deepest, -oracleSmallestGap(tool_, proxy_.pose(), wall_));
        }
    }

    DragSetting setting_;
    Tool own_;
    const Tool& tool_;
    HostFixtures wall_;
    RegionGrid grid_;
    CullCpu cull_;
    Proxy proxy_;
    ContactSet inForce_;
    std::deque<Pending> pending_;
    uint32_t now_ = 0;
    double reach_ = 0.0; // [m] tool's centre to wall points at contact
    double height_ = 0.0, lag_ = 0.0;
    std::vector<double> rises_; // [m]
    DragResult result_;
};

} // namespace

DragResult drag(const DragSetting& setting) {
    return Dragger(setting).run();
}

} // namespace fathom::profile
