// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_output.h"

#include "apps/binding/ros2_topics.h"
#include "apps/binding/shape_box.h"
#include "engine/types/log.h"
#include "engine/types/spsc_queue.h"
#include "engine/types/triple_buffer.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace fathom {

namespace {

// Wakes the publishing thread.
class Bell {
public:
    void ring(bool stop = false) {
        {
            const std::lock_guard lock(mutex_);
            rung_ = true;
            stop_ = stop_ || stop;
        }
        woken_.notify_one();
    }
    // Waits for a ring, at most that long. False: stop.
    bool wait(std::chrono::milliseconds most) {
        std::unique_lock lock(mutex_);
        woken_.wait_for(lock, most, [this] { return rung_; });
        rung_ = false;
        return !stop_;
    }

private:
    std::mutex mutex_;
    std::condition_variable woken_;
    bool rung_ = false, stop_ = false;
};

// The writer thread copies what is due into mailboxes; the thread of this class makes and sends messages.
class Ros2Output final : public RunObserver {
public:
    Ros2Output(const Ros2OutputRequest& request, const std::vector<Ros2Joint>& joints)
        : topics_(request, joints)
        , pace_(1.0 / request.rate)
        , thread_([this] { run(); }) {}
    ~Ros2Output() override {
        bell_.ring(true);
        thread_.join();
    }

    void step(const TickRow& row) override;
    void frame(const HostFixtures& set) override {
        set_ = &set;
        totals_.sets += 1;
    }
    void setShapes(std::span<const Shape> shapes) override { shapes_.set(shapes); }
    void forget() noexcept override { set_ = nullptr; }
    RemoteRequests takeRequests() override { return topics_.takeRequests(); }

private:
    void offerRegions(const TickRow& row, uint64_t time);
    void run();
    void publish();

    // Regions are sent when they change, at most so often, and again for whoever subscribes later [s].
    static constexpr double kRegionPause = 0.1, kRegionRepeat = 1.0;
    static constexpr uint64_t kQueue = 256;                            // steps
    static constexpr auto kPollPeriod = std::chrono::milliseconds(50); // for subscribers of regions
    static constexpr auto kSilence = std::chrono::milliseconds(100);   // of the run: a robot stands still

    Ros2Topics topics_;
    // Writer thread.
    MessagePace pace_;
    TickStamps stamps_;
    RunTotals totals_;
    const HostFixtures* set_ = nullptr;
    double regionsAt_ = -kRegionRepeat; // [s] time of the run
    uint64_t generation_ = 0;           // of the newest queued regions
    // Thread of this class.
    std::chrono::steady_clock::time_point tickAt_; // of the newest tick
    bool moves_ = false;                           // ticks came since the last rest message
    // Between the threads.
    SpscQueue<Ros2Tick> ticks_{kQueue};
    TripleBuffer<Ros2Regions> regions_;
    std::atomic<bool> watched_{false};
    Bell bell_;
    ShapeBox shapes_;
    std::thread thread_; // last, so that it ends before what it uses
};

void Ros2Output::step(const TickRow& row) {
    totals_.ticks += 1;
    totals_.late += row.late ? 1 : 0;
    totals_.missed += row.missed;
    totals_.worstMicros = std::max(totals_.worstMicros, row.micros);
    const double t = row.record.t;
    const uint64_t time = stamps_.at(t);
    if (!pace_.due(t)) {
        return;
    }
    regionsAt_ = std::min(regionsAt_, t); // a new run begins at 0
    ticks_.push({time, row.record, row.driven, row.armStatus.state, totals_,
                 set_ != nullptr ? std::optional(set_->baseTcamera) : std::nullopt});
    offerRegions(row, time);
    bell_.ring();
}

void Ros2Output::offerRegions(const TickRow& row, uint64_t time) {
    const double pause = row.record.t - regionsAt_;
    if (!watched_.load(std::memory_order_relaxed) || pause < kRegionPause) {
        return;
    }
    static const HostFixtures kEmpty; // of a scene with shapes only
    const HostFixtures& set = set_ != nullptr ? *set_ : kEmpty;
    if (set.generation == generation_ && !shapes_.changed() && pause < kRegionRepeat) {
        return;
    }
    Ros2Regions& out = regions_.back();
    shapes_.copyTo(out.shapes);
    const RegionSpheres& spheres = set.spheres;
    const dvec3& origin = set.origin;
    out.time = time;
    out.points.resize(spheres.size());
    for (size_t i = 0; i < spheres.size(); ++i) {
        out.points[i] = {static_cast<float>(origin.x + static_cast<double>(spheres.x[i])),
                         static_cast<float>(origin.y + static_cast<double>(spheres.y[i])),
                         static_cast<float>(origin.z + static_cast<double>(spheres.z[i])), spheres.radius[i],
                         static_cast<float>(spheres.fixture[i])};
    }
    regions_.publish();
    generation_ = set.generation;
    regionsAt_ = row.record.t;
}

void Ros2Output::run() {
    try {
        while (bell_.wait(kPollPeriod)) {
            publish();
        }
    } catch (const std::exception& e) { // out of memory
        topics_.rest();
        log::error("ros2: {}: nothing more is published", e.what());
    }
}

void Ros2Output::publish() {
    topics_.receive();
    watched_.store(topics_.regionsWatched(), std::memory_order_relaxed);
    const auto now = std::chrono::steady_clock::now();
    for (Ros2Tick tick; ticks_.pop(tick); moves_ = true) {
        topics_.tick(tick);
        tickAt_ = now;
    }
    // A change of pilot, a blocked writer and the end of a run leave no tick that says so.
    if (moves_ && now - tickAt_ > kSilence) {
        topics_.rest();
        moves_ = false;
    }
    if (regions_.refresh()) {
        topics_.regions(regions_.front());
    }
}

} // namespace

std::unique_ptr<RunObserver> openRos2Output(const Ros2OutputRequest& request,
                                            const std::vector<Ros2Joint>& joints) {
    return std::make_unique<Ros2Output>(request, joints);
}

} // namespace fathom
