// SPDX-License-Identifier: Apache-2.0
// A realtime run without camera and device: hand-made walls, the CPU query, a hand on a path, and a sink that
// audits.
#pragma once

#include "devices/simulated/simulated_hand.h"
#include "engine/contact/cull_cpu.h"
#include "engine/reference/penetration_audit.h"
#include "engine/run/realtime_run.h"
#include "tests/cycle/haptic_rig.h"

#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

namespace fathom::testing {

// A fixture set with its grid, as one lease.
struct FakeSet {
    HostFixtures host;
    RegionGrid grid;
};

// `frames` frames of a wall with its top at z = 0; every other frame it is 0.5 mm higher.
class FakeFeed final : public FrameFeed {
public:
    FakeFeed(LeasePool<FakeSet>& pool, uint32_t frames)
        : pool_(pool)
        , frames_(frames) {}

    std::function<void(uint32_t)> beforeFetch = [](uint32_t) {};
    std::function<void(uint32_t)> beforePublish = [](uint32_t) {};
    std::function<void()> onRenew; // empty: the device cannot be opened again
    uint32_t published = 0, renewed = 0;
    bool deviceLost = false; // lost elsewhere than in publish()
    std::vector<double> captured;

    bool lost() const override { return deviceLost; }
    bool renewable() const override { return static_cast<bool>(onRenew); }
    void renew(const std::atomic<bool>&) override {
        onRenew();
        deviceLost = false;
        ++renewed;
    }

    std::optional<uint32_t> fetch() override {
        beforeFetch(index_);
        return index_ < frames_ ? std::optional(index_) : std::nullopt;
    }

    void publish(double t, PublishedFrame& out) override {
        beforePublish(index_);
        FakeSet& set = pool_.back();
        set.host = wallSet(index_ + 1);
        set.host.frame = index_;
        set.host.captureTime = t;
        for (float& z : set.host.spheres.z) {
            z += index_ % 2 == 0 ? 0.0f : 0.0005f;
        }
        set.grid.build(set.host.spheres);
        out.fixtures = set.host;
        out.grid = set.grid;
        out.report.index = index_;
        out.changed = true;
        pool_.publish();
        captured.push_back(t);
        ++published;
        ++index_;
    }

private:
    LeasePool<FakeSet>& pool_;
    uint32_t frames_;
    uint32_t index_ = 0;
};

// Answers contact queries on the CPU over the newest set.
class FakeAnswers final : public ContactAnswers {
public:
    FakeAnswers(LeasePool<FakeSet>& pool, const Tool& tool)
        : pool_(pool)
        , tool_(tool) {}

    std::function<void()> before = [] {}, beforeClearance = [] {};

    double clearance(const ToolPlace&) override {
        beforeClearance();
        return kSomeClearance;
    }
    static constexpr double kSomeClearance = 0.125; // [m]

    bool answer(const QueryPlace& at, ContactSet& out) override {
        before();
        const auto set = pool_.newest();
        if (!set) {
            return false;
        }
        cull_.query(tool_, at.place.pose, 0.01, set->host, set->grid, out);
        return true;
    }

private:
    LeasePool<FakeSet>& pool_;
    const Tool& tool_;
    CullCpu cull_;
};

// A hand on a path that keeps the last wrench and counts writes.
class FakeHand final : public HapticDevice {
public:
    explicit FakeHand(HandPath path)
        : path_(std::move(path)) {}
    HandSample read(double t) noexcept override {
        HandSample sample = path_.at(t);
        spoil(t, sample);
        return sample;
    }
    void write(const Wrench& wrench, double) noexcept override {
        last = wrench;
        ++writes;
        zero.store(writes > 1 && wrench.force == dvec3(0.0) && wrench.torque == dvec3(0.0));
    }
    Wrench last{dvec3(1.0), dvec3(1.0)};
    uint64_t writes = 0;
    std::atomic<bool> zero{false}; // the last wrench, for other threads
    std::function<void(double, HandSample&)> spoil = [](double, HandSample&) {}; // changes samples

private:
    HandPath path_;
};

// Keeps every tick and audits its penetration.
struct AuditingSink final : RunSink {
    explicit AuditingSink(const Tool& tool)
        : audit(tool) {}
    std::function<void(const TickRow&)> onTurn = [](const TickRow&) {};
    PenetrationAudit audit;
    std::vector<TickRow> rows;
    uint64_t frames = 0, queries = 0, unknown = 0;

    void frame(const PublishedFrame& frame, const HostFixtures& set) override {
        CHECK(set.frame == static_cast<int64_t>(frames));
        CHECK(frame.t == set.captureTime);
        ++frames;
    }
    void query(const QueryNote&) override { ++queries; }
    void step(const TickRow& row, const ObeyedSet& obeyed) override {
        unknown += obeyed.known ? 0 : 1;
        if (obeyed.frame != nullptr) {
            audit.tick(obeyed.frame->fixtures, obeyed.frame->grid, row.start.pose, row.record.tool,
                       obeyed.behind);
        }
        rows.push_back(row);
        onTurn(row);
    }
};

// Presses 10 mm into the wall and wipes over it at up to 0.13 m/s.
inline HandPath wipingPath(double seconds) {
    std::vector<HandWaypoint> waypoints{{0.0, at(0.0, 0.0, 0.03), 0}};
    for (double t = 0.2; t <= seconds; t += 0.01) {
        waypoints.push_back({t, at(0.04 * std::sin(3.2 * (t - 0.2)), 0.0, 0.0), 0});
    }
    return HandPath(std::move(waypoints));
}

// Presses and stays there.
inline HandPath pressingPath(double seconds) {
    return HandPath(
        {{0.0, at(0.0, 0.0, 0.03), 0}, {0.2, at(0.0, 0.0, 0.0), 0}, {seconds, at(0.0, 0.0, 0.0), 0}});
}

// With fixed stiffness: automatic springs would soften when this machine is late.
inline Scene sceneOfGivenSprings() {
    Scene scene = handScene();
    scene.haptics.stiffness = 1000.0;
    return scene;
}

// A realtime run of all these parts.
struct FakeRun {
    FakeRun(uint32_t frames, HandPath handPath)
        : path(handPath)
        , pool(2, [] { return std::make_unique<FakeSet>(); })
        , tool(ballTool())
        , feed(pool, frames)
        , answers(pool, tool)
        , hand(std::move(handPath))
        , options(makeHapticOptions(sceneOfGivenSprings(), tool))
        , sink(tool) {
        realtime.placement = ThreadPlacement::ofThisProcess();
    }

    void go(bool withContacts = true) {
        run.emplace(feed, withContacts ? &answers : nullptr, realtime);
        REQUIRE(run->firstFrame());
        cycle.emplace(tool, std::span<const Shape>{}, options, path.at(0.0).deviceThandle);
        run->run(*cycle, hand, path.duration(), sink, stop);
    }

    // Visits the rows with t in [from, to).
    template <class Visit>
    void during(double from, double to, Visit&& visit) const {
        for (const TickRow& row : sink.rows) {
            if (row.record.t >= from && row.record.t < to) {
                visit(row.record);
            }
        }
    }

    HandPath path;
    LeasePool<FakeSet> pool;
    Tool tool;
    FakeFeed feed;
    FakeAnswers answers;
    FakeHand hand;
    HapticOptions options;
    RealtimeOptions realtime;
    AuditingSink sink;
    std::atomic<bool> stop{false};
    std::optional<HapticCycle> cycle;
    std::optional<RealtimeRun> run;
};

} // namespace fathom::testing
