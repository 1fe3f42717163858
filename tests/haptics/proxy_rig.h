// SPDX-License-Identifier: Apache-2.0
// Runs a tool, a fixture set and a proxy tick by tick like the haptic cadence, with late or lost contact
// answers, and checks every pose by brute force over the whole set.
#pragma once

#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/haptics/proxy.h"
#include "engine/reference/contact_oracle.h"
#include "tests/contact/clouds.h"

#include <deque>
#include <memory>

namespace fathom::testing {

class ProxyRig {
public:
    ProxyRig(Tool tool, HostFixtures fixtures, const Pose& start, const ProxyOptions& options = {},
             std::span<const Shape> shapes = {}, double reach = 0.01)
        : tool_(std::move(tool))
        , fixtures_(std::move(fixtures))
        , reach_(reach)
        , proxy_(tool_, shapes, options, start) {
        grid_.build(fixtures_.spheres);
        answer(inForce_);
    }

    // New data. Present overlaps are allowed and may only shrink.
    void replace(HostFixtures fixtures) {
        fixtures_ = std::move(fixtures);
        grid_.build(fixtures_.spheres);
        pending_.clear();
    }

    // One tick with the answer of the query from `delay` ticks ago (the previous answer if there is none);
    // lost = no query.
    ProxyStep step(const Pose& target, uint32_t delay = 0, bool lost = false) {
        if (!lost) {
            pending_.push_back({now_ + delay, std::make_unique<ContactSet>()});
            answer(*pending_.back().set);
        }
        while (!pending_.empty() && pending_.front().due <= now_) {
            if (proxy_.accepts(*pending_.front().set)) {
                std::swap(inForce_, *pending_.front().set);
            } else {
                ++refused;
            }
            pending_.pop_front();
        }
        ++now_;
        return proxy_.step({target, metricRadius, &inForce_, {}});
    }

    // A tick without delay, in halves.
    void query() { answer(inForce_); }
    ProxyStep turnOnly(const Pose& target) { return proxy_.step({target, metricRadius, &inForce_, {}}); }

    // [m] largest depth beyond the allowed one in any sphere; < 0 when clear.
    double depth() const { return -oracleSmallestGap(tool_, proxy_.pose(), fixtures_); }

    Proxy& proxy() { return proxy_; }
    const Tool& tool() const { return tool_; }
    const HostFixtures& fixtures() const { return fixtures_; }
    const ContactSet& inForce() const { return inForce_; }
    BehindTracker& behind() { return behind_; }

    double metricRadius = 0.05;
    uint64_t refused = 0;

private:
    void answer(ContactSet& set) {
        cull_.query(tool_, proxy_.pose(), reach_, fixtures_, grid_, set);
        behind_.update(tool_, fixtures_, grid_.maxRadius(), set);
    }
    struct Pending {
        uint64_t due;
        std::unique_ptr<ContactSet> set;
    };
    Tool tool_;
    HostFixtures fixtures_;
    double reach_;
    RegionGrid grid_;
    CullCpu cull_;
    BehindTracker behind_;
    Proxy proxy_;
    ContactSet inForce_;
    std::deque<Pending> pending_;
    uint64_t now_ = 0;
};

} // namespace fathom::testing
