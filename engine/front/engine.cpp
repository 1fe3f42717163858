// SPDX-License-Identifier: Apache-2.0
#include "engine/front/arm_port.h"
#include "engine/front/camera_port.h"
#include "engine/front/float_mode.h"
#include "engine/front/hand_port.h"
#include "engine/front/observer_port.h"
#include "engine/run/clearance.h"
#include "engine/run/contact_loop.h"
#include "engine/run/cycle_answers.h"
#include "engine/run/frame_loop.h"
#include "engine/types/blocked_signals.h"
#include "engine/types/clock.h"
#include "engine/types/frame.h"
#include "engine/types/log.h"

#include <cmath>
#include <limits>
#include <mutex>
#include <thread>

namespace fathom::front {

// Feeds submitted frames to the frame loop. Frame thread only, except observe() and `deviceLost`.
class SubmittedFeed final : public FrameFeed {
public:
    SubmittedFeed(v0::CameraPort::Impl& camera, ComputeState& compute, PortState& shared)
        : camera_(camera)
        , compute_(compute)
        , shared_(shared) {}

    std::optional<uint32_t> fetch() override {
        for (PublishedFrame* done = nullptr;
             shared_.channels.frames.pop(done);) { // not recorded: return them at once
            shared_.channels.emptied.push(done);
        }
        next_ = camera_.take();
        return next_ ? std::optional((*next_)->index) : std::nullopt;
    }
    std::optional<RunClock::Time> captured() const override {
        return next_ ? std::optional(RunClock::sinceBoot((*next_)->captureTime)) : std::nullopt;
    }
    void armAtCapture(const ArmPosture& arm) override { compute_.setArm(arm); }
    void publish(double t, PublishedFrame& out) override {
        const double captured = (*next_)->captureTime;
        next_->retime(t);
        std::optional<fathom::Frame> frame = std::exchange(next_, std::nullopt);
        try {
            out.report = compute_.process(std::move(*frame));
        } catch (const DeviceFailed&) {
            deviceLost.store(true);
            throw;
        }
        out.changed = !out.report.unchanged;
        if (const auto set = compute_.cycles.frames().sets().newest(); out.changed && set) {
            out.fixtures.frame = set->host.frame;
            out.fixtures.generation = set->host.generation;
            out.fixtures.guidance = set->host.guidance;
            const std::lock_guard lock(showing_);
            shown_ = {set->host.frame, std::llround(captured * 1e9)};
            if (observed_) {
                show(set->host);
            }
        }
        ++camera_.processed;
    }
    bool renewable() const override { return true; }
    void renew(const std::atomic<bool>&) override {
        const std::lock_guard lock(showing_); // observe() reads a set that this frees
        compute_.renew();
        deviceLost.store(false);
    }

    // Any thread: publishes the regions of the newest frame, and from now on those of each frame.
    void observe() {
        const std::lock_guard lock(showing_);
        observed_ = true;
        const DeviceCycles::SetInUse newest = compute_.cycles.leaseNewestSet();
        if (newest.get() != nullptr && newest.get()->host.frame == shown_.frame) { // else publish() shows it
            show(newest.get()->host);
        }
    }

    std::atomic<bool> deviceLost{false}; // since a pass failed, until renew()

private:
    // Under the lock.
    void show(const HostFixtures& set) {
        fill(shared_.regions.back(), set);
        shared_.regions.back().stamp = shown_.stamp;
        shared_.regions.publish();
    }

    v0::CameraPort::Impl& camera_;
    ComputeState& compute_;
    PortState& shared_;
    std::optional<fathom::Frame> next_;
    std::mutex showing_; // between publish() and observe()
    bool observed_ = false;
    struct {
        int64_t frame = -1;
        v0::Nanoseconds stamp = 0;
    } shown_; // the newest set that publish() has seen
};

} // namespace fathom::front

namespace fathom::v0 {

namespace {

const CameraModel& onlyOne(std::span<const CameraModel> cameras) {
    if (cameras.size() != 1) {
        throw BadInput("cameras: " + std::to_string(cameras.size()) +
                       " (allowed: 1; several cameras are not supported yet)");
    }
    return cameras.front();
}

// Makes the only port of its kind. If that throws, the port may still be opened.
template <class Make>
auto openOnce(std::atomic<bool>& open, const std::string& port, Make&& make) {
    if (open.exchange(true)) {
        throw Error(port + ": it is open already (allowed: one " + port + " per engine)");
    }
    try {
        return make();
    } catch (...) {
        open.store(false);
        throw;
    }
}

} // namespace

struct Engine::Impl {
    Impl(const Scene& scene, const CameraModel& model, const EngineOptions& options)
        : camera(std::make_shared<CameraPort::Impl>(front::CameraSetup(model, scene.data().scene)))
        , shared(std::make_shared<front::PortState>(scene.data().scene, camera->info, options))
        , compute(shared->haptic, camera->info, options.computeDevice)
        , feed(*camera, compute, *shared)
        , answers(compute.cycles)
        // A nominal period: submitted frames have their own times.
        , frames(feed, shared->channels, shared->clock, kLockstepFramePeriod, nullptr)
        , contacts(answers, shared->channels, shared->clock, 0.5 * shared->haptic.options.period, nullptr)
        , clearance(answers, shared->channels, shared->clock) {
        const BlockedSignals quiet;
        try {
            threads.emplace_back([this] { guarded([this] { frames.run(stop); }); });
            if (compute.cycles.plan().query != Plan::Query::None) {
                threads.emplace_back([this] { guarded([this] { contacts.run(stop); }); });
                threads.emplace_back([this] { guarded([this] { clearance.run(stop); }); });
            } else { // no regions of points, ever
                shared->channels.clearance.back() = std::numeric_limits<double>::infinity();
                shared->channels.clearance.publish();
            }
        } catch (...) { // std::system_error: threads already started would use a destroyed engine
            end();
            throw;
        }
    }
    ~Impl() { end(); }

    void end() {
        stop.store(true);
        shared->ended.store(true);
        camera->close();
        for (std::thread& thread : threads) {
            thread.join();
        }
    }

    // An exception in a thread ends the input of frames, and the forces.
    template <class Body>
    void guarded(Body&& body) noexcept {
        const front::FloatMode mode;
        try {
            body();
            return;
        } catch (const std::exception& e) {
            const std::lock_guard lock(failureMutex);
            failure = failure.empty() ? e.what() : failure;
            log::error("engine: forces are off: {}", e.what());
        }
        shared->ended.store(true);
        camera->close();
    }

    const pid_t processId = ::getpid();
    std::shared_ptr<CameraPort::Impl> camera;
    std::shared_ptr<front::PortState> shared;
    front::ComputeState compute;
    front::SubmittedFeed feed;
    CycleAnswers answers;
    FrameLoop frames;
    ContactLoop contacts;
    ClearanceLoop clearance;
    std::atomic<bool> stop{false};
    mutable std::mutex failureMutex;
    std::string failure;
    std::vector<std::thread> threads;
};

Engine::Engine(const Scene& scene, const CameraModel& camera, const EngineOptions& options)
    : Engine(scene, std::span(&camera, 1), options) {}

Engine::Engine(const Scene& scene, std::span<const CameraModel> cameras, const EngineOptions& options)
    : impl_(front::translated([&] {
        const front::FloatMode mode;
        return std::make_unique<Impl>(scene, onlyOne(cameras), options);
    })) {}

Engine::~Engine() {
    front::leakInForkedChild(impl_->processId, impl_);
}

CameraPort Engine::camera(std::size_t index) {
    if (index != 0) {
        throw BadInput("camera: " + std::to_string(index) + " (allowed: 0)");
    }
    return CameraPort(impl_->camera);
}

CameraPort Engine::camera(std::string_view name) {
    if (name != impl_->camera->model.name) {
        throw BadInput("camera: '" + printable(name) + "' (allowed: '" +
                       printable(impl_->camera->model.name) + "')");
    }
    return CameraPort(impl_->camera);
}

HandPort Engine::openHand(const HandStart& start) {
    return front::translated([&] {
        const front::FloatMode mode;
        return openOnce(impl_->shared->handOpen, "hand",
                        [&] { return HandPort(std::make_unique<HandPort::Impl>(impl_->shared, start)); });
    });
}

ArmPort Engine::openArm() {
    return front::translated([&] {
        if (impl_->shared->channels.arm == nullptr) {
            throw BadInput("options: measuredArm: false (allowed: true, for a real arm)");
        }
        return openOnce(impl_->shared->armOpen, "arm",
                        [&] { return ArmPort(std::make_unique<ArmPort::Impl>(impl_->shared)); });
    });
}

ObserverPort Engine::openObserver() {
    return front::translated([&] {
        return openOnce(impl_->shared->observerOpen, "observer", [&] {
            ObserverPort port(std::make_unique<ObserverPort::Impl>(impl_->shared));
            impl_->feed.observe();
            return port;
        });
    });
}

void Engine::clearances(std::span<const Pose> baseTtool, Clearances& out) {
    front::translated([&] {
        const front::FloatMode mode;
        const double t = impl_->compute.clearances(baseTtool, out);
        out.stamp = out.frame < 0 ? 0 : nanosecondsOf(impl_->shared->clock.timeAt(t));
    });
}

bool Engine::computeDeviceLost() const noexcept {
    return impl_->feed.deviceLost.load();
}

std::string Engine::failure() const {
    const std::lock_guard lock(impl_->failureMutex);
    return impl_->failure;
}

std::string Engine::computeDeviceName() const {
    return impl_->compute.cycles.facts().name;
}

} // namespace fathom::v0
