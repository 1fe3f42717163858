// SPDX-License-Identifier: Apache-2.0
#include "engine/run/realtime_run.h"

#include "engine/run/run_alarms.h"
#include "engine/types/blocked_signals.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace fathom {

namespace {

constexpr double kWriterBacklog = 8.0; // [s] of steps that the writer may fall behind
constexpr double kHeadStart = 0.02;    // [s] for the threads to get ready before t = 0
constexpr auto kWriterPause = std::chrono::milliseconds(2);

uint64_t tickCapacity(double period) {
    return static_cast<uint64_t>(std::max(1024.0, std::ceil(kWriterBacklog / period)));
}

// Sets the flag and joins the thread at the end of the scope, also on exceptions. Other threads take the
// program's signals.
class StoppedThread {
public:
    template <class Body>
    StoppedThread(std::atomic<bool>& stop, Body&& body)
        : stop_(stop) {
        const BlockedSignals quiet;
        thread_ = std::thread(std::forward<Body>(body));
    }
    StoppedThread(const StoppedThread&) = delete;
    StoppedThread& operator=(const StoppedThread&) = delete;
    ~StoppedThread() {
        stop_.store(true);
        thread_.join();
    }

private:
    std::atomic<bool>& stop_;
    std::thread thread_;
};

// Releases the memory that the haptic thread locked, also on exceptions.
class LockedMemory {
public:
    LockedMemory() = default;
    LockedMemory(const LockedMemory&) = delete;
    LockedMemory& operator=(const LockedMemory&) = delete;
    ~LockedMemory() { releaseLockedMemory(); }
};

// Puts the alarms between the drain and the sink.
class WatchedSink final : public ForwardingSink {
public:
    WatchedSink(RunSink& sink, bool warnWhenStale)
        : ForwardingSink(sink)
        , alarm_(warnWhenStale) {}
    void step(const TickRow& row, const ObeyedSet& obeyed) override {
        alarm_.see(row.record);
        numbers_.see(row);
        ForwardingSink::step(row, obeyed);
    }
    uint64_t staleTicks() const { return alarm_.staleTicks(); }

private:
    AgeAlarm alarm_;
    NumberAlarm numbers_;
};

} // namespace

RealtimeRun::RealtimeRun(FrameFeed& frames, ContactAnswers* contacts, const RealtimeOptions& options)
    : options_(options)
    , channels_(tickCapacity(options.hapticPeriod))
    , frames_(frames, channels_, clock_, options.framePeriod, options.trace) {
    channels_.arm = options.arm;
    if (contacts != nullptr) {
        contact_.emplace(*contacts, channels_, clock_, 0.5 * options.hapticPeriod, options.trace);
        clearance_.emplace(*contacts, channels_, clock_);
    }
}

void RealtimeRun::setShapes(std::span<const Shape> shapes) {
    ShapeList& list = channels_.shapes.back();
    if (shapes.size() > list.shapes.size()) {
        throw Error("fixtures: " + std::to_string(shapes.size()) + " placed shapes (allowed: at most " +
                    std::to_string(list.shapes.size()) + ")");
    }
    list.count = static_cast<uint32_t>(shapes.size());
    std::copy_n(shapes.begin(), list.count, list.shapes.begin());
    channels_.shapes.publish();
}

void RealtimeRun::guarded(const std::function<void()>& body) noexcept {
    try {
        body();
    } catch (...) {
        const std::lock_guard lock(failureMutex_);
        failure_ = failure_ ? failure_ : std::current_exception();
        ending_.store(true);
    }
}

void RealtimeRun::run(HapticCycle& cycle, HapticDevice& hand, double pathDuration, RunSink& sink,
                      const std::atomic<bool>& stop) {
    HapticLoop haptic(cycle, hand, channels_, clock_, {pathDuration, options_.framePeriod}, options_.trace);
    WatchedSink watched(sink, options_.warnWhenStale);
    RecordDrain drain(channels_, watched);
    channels_.queryAt.back() = {cycle.place()};
    channels_.queryAt.publish();
    const auto runOn = [this](const auto& processors, auto& loop) {
        guarded([&] {
            pinThread(processors);
            loop.run(ending_);
        });
    };
    clock_.start(kHeadStart);
    {
        const LockedMemory untilThreadsEnd;
        StoppedThread camera(ending_, [&] { runOn(options_.placement.rest, frames_); });
        std::optional<StoppedThread> contact, clearance;
        if (contact_) {
            contact.emplace(ending_, [&] { runOn(options_.placement.contact, *contact_); });
            clearance.emplace(ending_, [&] { runOn(options_.placement.rest, *clearance_); });
        }
        StoppedThread ticks(ending_, [this, &haptic, &stop] {
            std::string refused;
            guarded([&] { refused = makeHapticThread(options_.placement); });
            if (!refused.empty()) {
                log::warn("haptic thread: the system refused {}; the thread will wake later "
                          "(how to permit it: man fathom, PERMISSIONS)",
                          refused);
            }
            haptic.run(ending_, stop); // not only ending_, which the writer sets: its output may be blocked
        });
        write(drain, stop);
    }
    drain.drain(true);
    missed_ = haptic.missed();
    staleTicks_ = watched.staleTicks();
    last_ = drain.newest();
}

void RealtimeRun::write(RecordDrain& drain, const std::atomic<bool>& stop) {
    for (bool done = false; !done;) {
        done = channels_.hapticDone.load(std::memory_order_acquire);
        drain.drain();
        if (options_.trace != nullptr) {
            options_.trace->file().drain();
        }
        if (options_.progress) {
            options_.progress(clock_.now(), drain.frames());
        }
        if (stop.load(std::memory_order_relaxed)) {
            ending_.store(true);
        }
        if (!done) {
            std::this_thread::sleep_for(kWriterPause);
        }
    }
}

} // namespace fathom
