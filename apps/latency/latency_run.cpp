// SPDX-License-Identifier: Apache-2.0
#include "apps/latency/latency_run.h"

#include "apps/session/path_hand.h"
#include "apps/session/session_feed.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

constexpr double kMemorySamples = 100.0; // samples per part
constexpr double kSettled = 0.05;        // of a part: until buffers have their final size

// Sends the first frame only, or all of them. A lost device ends the measurement.
class MeasuredFeed final : public SessionFeed {
public:
    MeasuredFeed(Session& session, bool moving)
        : SessionFeed(session)
        , moving_(moving) {}
    std::optional<uint32_t> fetch() override {
        const bool more = std::exchange(first_, false) || moving_;
        return more ? SessionFeed::fetch() : std::nullopt;
    }
    bool renewable() const override { return false; }

private:
    bool moving_, first_ = true;
};

class HistogramSink final : public RunSink {
public:
    HistogramSink(LatencyPart& part, double seconds, const std::atomic<bool>& stopRequested)
        : part_(part)
        , seconds_(seconds)
        , stopRequested_(stopRequested) {}

    void frame(const PublishedFrame&, const HostFixtures&) override { ++part_.frames; }
    void query(const QueryNote&) override {}
    void step(const TickRow& row, const ObeyedSet&) override {
        part_.late.add(row.wokenLate * 1e6);
        part_.tick.add(row.micros);
        part_.armTravel += first_ ? 0.0 : travel(row.record.arm.posture.q, before_);
        before_ = row.record.arm.posture.q;
        first_ = false;
        part_.seconds = row.record.t;
        const double due = seconds_ * (kSettled + static_cast<double>(part_.memory.size()) / kMemorySamples);
        if (row.record.t >= due) {
            part_.memory.push_back(residentMemory());
        }
        if (row.record.t >= seconds_ || stopRequested_.load()) {
            stop.store(true);
        }
    }

    std::atomic<bool> stop{false};

private:
    static double travel(const JointVector& to, const JointVector& from) {
        double sum = 0.0;
        for (size_t k = 0; k < to.size(); ++k) {
            sum += std::abs(to[k] - from[k]);
        }
        return sum;
    }

    LatencyPart& part_;
    JointVector before_{};
    bool first_ = true;
    double seconds_;
    const std::atomic<bool>& stopRequested_;
};

SessionOptions sessionOptions(const LatencyOptions& options) {
    SessionOptions o;
    o.scene = options.scene;
    o.source = options.source;
    o.endless = true;
    return o;
}

} // namespace

double residentMemory() {
    std::ifstream file("/proc/self/statm");
    double whole = 0.0, resident = 0.0;
    file >> whole >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

double LatencyPart::memoryGrowth() const {
    const size_t tenth = memory.size() / 10;
    if (tenth == 0) {
        return 0.0;
    }
    const auto last = memory.end() - static_cast<long>(tenth);
    return *std::max_element(last, memory.end()) -
           *std::max_element(memory.begin(), memory.begin() + static_cast<long>(tenth));
}

LatencyRun::LatencyRun(const LatencyOptions& options, const GlobalOptions& global, WindowLoad windowLoad,
                       const std::atomic<bool>& stop)
    : options_(options)
    , global_(global)
    , windowLoad_(std::move(windowLoad))
    , stop_(stop)
    , placement_(ThreadPlacement::ofThisProcess())
    , confined_(placement_.rest)
    , session_(sessionOptions(options), global, {}, stop)
    , haptics_(makeHapticOptions(session_.scene, session_.tool)) {}

std::string LatencyRun::device() const {
    return session_.cycles.facts().name;
}

std::string LatencyRun::placement() const {
    return describe(placement_);
}

double LatencyRun::rateHz() const {
    return 1.0 / haptics_.period;
}

LatencyPart LatencyRun::run(const std::string& load, bool moving) {
    LatencyPart part;
    part.load = load;
    MeasuredFeed feed(session_, moving);
    RealtimeOptions o;
    o.placement = placement_;
    o.hapticPeriod = haptics_.period;
    RealtimeRun run(feed, session_.contacts(), o);
    session_.requireFrame(run.firstFrame());
    const HandPath path = session_.path();
    PathHand hand(path);
    HapticCycle cycle(session_.tool, shapesOf(session_.scene), haptics_,
                      path.waypoints().front().deviceThandle, nullptr, session_.arm.get());
    HistogramSink sink(part, options_.seconds, stop_);
    run.run(cycle, hand, 2.0 * options_.seconds, sink, sink.stop); // the sink stops it earlier
    if (run.failure()) {
        std::rethrow_exception(run.failure());
    }
    part.take(run);
    return part;
}

void LatencyPart::take(const RealtimeRun& run) {
    framesLost = run.framesLost();
    periodsMissed = run.periodsMissed();
    recordsLost = run.recordsLost();
}

LatencyPart LatencyRun::idle() {
    return run("idle", false);
}

LatencyPart LatencyRun::frames() {
    return run("frames", true);
}

LatencyPart LatencyRun::window() {
    GlobalOptions global = global_;
    global.holdClock = false; // this session already locks the clock
    return windowLoad_(options_, global);
}

} // namespace fathom
