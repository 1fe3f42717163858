// SPDX-License-Identifier: Apache-2.0
#include "apps/latency/latency_run.h"

#include "apps/operate/live_feed.h"
#include "apps/operate/operator_run.h"
#include "apps/replay/realtime_replay.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <unistd.h>

namespace fathom {

namespace {

constexpr double kMemorySamples = 100.0; // over a part
constexpr double kSettled = 0.05;        // of a part: buffers reach their size

// The first picture only, or all of them.
class WatchedFeed final : public FrameFeed {
public:
    WatchedFeed(operate::LiveFeed& feed, bool moving)
        : feed_(feed)
        , moving_(moving) {}
    std::optional<uint32_t> fetch() override {
        const bool more = moving_ || first_;
        first_ = false;
        return more ? feed_.fetch() : std::nullopt;
    }
    void armAtCapture(const ToolState& place) override { feed_.armAtCapture(place); }
    void publish(double t, PublishedFrame& out) override { feed_.publish(t, out); }

private:
    operate::LiveFeed& feed_;
    bool moving_, first_ = true;
};

class HistogramSink final : public RunSink {
public:
    HistogramSink(LatencyPart& part, double seconds, const std::atomic<bool>& asked)
        : part_(part)
        , seconds_(seconds)
        , asked_(asked) {}

    void frame(const PublishedFrame&, const Fixtures&) override { ++part_.frames; }
    void query(const QueryNote&) override {}
    void step(const TickRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) override {
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
        if (row.record.t >= seconds_ || asked_.load()) {
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
    const std::atomic<bool>& asked_;
};

OperateOptions operateOptions(const LatencyOptions& options) {
    OperateOptions o;
    o.scene = options.scene;
    o.source = options.source;
    o.path = true;
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

struct LatencyRun::Session {
    Session(const LatencyOptions& options, const GlobalOptions& global, const std::atomic<bool>& stop)
        : placement(ThreadPlacement::ofThisProcess())
        , confined(placement.rest) // before the device: a software device's workers inherit it
        , operate(operateOptions(options), global, gpu::Drawing::None, {}, stop)
        , haptics(makeHapticOptions(operate.scene, operate.tool))
        , feed(operate)
        , answers(operate) {}

    ThreadPlacement placement;
    CpuConfinement confined;
    operate::OperateSession operate;
    HapticOptions haptics;
    operate::LiveFeed feed;
    operate::LiveAnswers answers;
};

LatencyRun::LatencyRun(const LatencyOptions& options, const GlobalOptions& global,
                       const std::atomic<bool>& stop)
    : options_(options)
    , global_(global)
    , stop_(stop)
    , session_(std::make_unique<Session>(options, global, stop)) {}

LatencyRun::~LatencyRun() = default;

std::string LatencyRun::device() const {
    return session_->operate.cycles.facts().name;
}

std::string LatencyRun::placement() const {
    return describe(session_->placement);
}

double LatencyRun::rateHz() const {
    return 1.0 / session_->haptics.period;
}

LatencyPart LatencyRun::run(const std::string& load, bool moving) {
    Session& s = *session_;
    LatencyPart part;
    part.load = load;
    WatchedFeed feed(s.feed, moving);
    RealtimeOptions o;
    o.placement = s.placement;
    o.hapticPeriod = s.haptics.period;
    o.staleAfter = s.haptics.staleAfter;
    RealtimeRun run(feed, s.operate.cycles.plan().query != Plan::Query::None ? &s.answers : nullptr, o);
    if (!run.firstFrame()) {
        throw BadInput(s.operate.camera->description(), "frames", "none usable", "at least one usable frame");
    }
    const HandPath path = s.operate.path();
    operate::PathHand hand(path);
    HapticCycle cycle(s.operate.tool, shapesOf(s.operate.scene), s.haptics,
                      path.waypoints().front().deviceThandle, nullptr, s.operate.arm.get());
    HistogramSink sink(part, options_.seconds, stop_);
    run.run(cycle, hand, 2.0 * options_.seconds, sink, sink.stop); // the sink ends it
    if (run.failure()) {
        std::rethrow_exception(run.failure());
    }
    part.framesLost = run.framesLost();
    part.periodsMissed = run.periodsMissed();
    part.recordsLost = run.recordsLost();
    return part;
}

LatencyPart LatencyRun::idle() {
    return run("idle", false);
}

LatencyPart LatencyRun::frames() {
    return run("frames", true);
}

LatencyPart LatencyRun::window() {
    LatencyPart part;
    part.load = "window";
    OperateOptions o = operateOptions(options_);
    o.ticks = options_.seconds; // not of the window, which may wait long for its first picture
    o.armed = true;             // as the other parts are
    o.offscreen = std::getenv("DISPLAY") == nullptr ? "1280x720" : "";
    GlobalOptions global = global_;
    global.holdClock = false; // the session here holds it
    operate::OperatorRun run(o, global);
    run.run();
    const operate::RunView& seen = run.view();
    for (size_t i = 0; i < seen.stepMicros().size(); ++i) {
        part.tick.add(static_cast<double>(seen.stepMicros()[i]));
        part.late.add(static_cast<double>(seen.wokenLateMicros()[i]));
    }
    part.seconds = seen.step().record.t;
    part.framesLost = run.engine().framesLost();
    part.periodsMissed = run.engine().periodsMissed();
    part.recordsLost = run.engine().recordsLost();
    return part;
}

} // namespace fathom
