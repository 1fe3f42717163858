// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/device_cycles.h"

#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printable.h"

namespace fathom {

DeviceCycles::DeviceCycles(const Parts& parts, const MakePlan& makePlan)
    : parts_(parts)
    , device_(openDevice())
    , facts_(device_ ? device_->facts() : noDevice())
    , plan_(makePlan(facts_))
    , contact_(parts.tool, parts.scene.contact.reach, parts.arm) {
    if (device_ == nullptr && !parts.selector.empty()) {
        log::warn("device '{}' is not used: no fixture uses points", printable(parts.selector));
    }
    frames_ = openFrames();
    useDevice();
}

void DeviceCycles::useDevice() {
    const cloud::QueryContext context{device_.get(), plan_, frames_->layout(), frames_->sets()};
    contact_.use(context);
    if (contact_.onDevice()) {
        gaps_.use(context);
    }
}

std::unique_ptr<gpu::Device> DeviceCycles::openDevice() const {
    return parts_.instance == nullptr
               ? nullptr
               : std::make_unique<gpu::Device>(*parts_.instance, parts_.selector, parts_.drawing);
}

std::unique_ptr<FrameCycle> DeviceCycles::openFrames() const {
    auto frames =
        std::make_unique<FrameCycle>(device_.get(), parts_.scene, parts_.camera, plan_, kFixtureSets - 2);
    frames->resumeFrom(resumeState_);
    return frames;
}

// Destroys users of the device before the device. The newest set is kept on the host.
void DeviceCycles::close() {
    const std::lock_guard noBatch(batchMutex_);
    const std::lock_guard lock(answerMutex_);
    if (frames_) {
        if (const auto newest = frames_->sets().newest()) {
            auto last = std::make_shared<cloud::FixtureSet>();
            last->host = newest->host;
            last->largestRadius = newest->largestRadius;
            last->grid.build(last->host.spheres, nullptr);
            lastSet_ = std::move(last);
        }
        resumeState_ = frames_->resumeState();
    }
    contact_.dropDevice();
    gaps_.dropDevice();
    frames_.reset();
    device_.reset();
}

void DeviceCycles::renew() {
    close();
    try { // without the lock: this takes seconds, during which the CPU answers
        device_ = openDevice();
        if (device_->facts().name != facts_.name) {
            throw DeviceLost(facts_.name + " is not there; " + device_->facts().name +
                             " would need a different plan");
        }
        auto frames = openFrames();
        const std::lock_guard noBatch(batchMutex_);
        const std::lock_guard lock(answerMutex_);
        frames_ = std::move(frames);
        useDevice();
        ++renewals_;
    } catch (const OutOfMemory&) {
        throw;
    } catch (const Error& e) { // a restarting driver may report any error, or be missing for a while
        throw DeviceLost(e.what());
    }
}

bool DeviceCycles::copyNewestSet(HostFixtures& set, RegionGrid& grid) {
    if (const auto newest = frames_ ? frames_->sets().newest() : cloud::FixturePool::Lease()) {
        set = newest->host;
        grid = newest->grid.get();
        return true;
    }
    const std::lock_guard lock(answerMutex_); // waits for answer() to release it
    if (lastSet_) {
        set = lastSet_->host;
        grid = lastSet_->grid.get();
    }
    return lastSet_ != nullptr;
}

// The set may not have its host copy yet.
bool DeviceCycles::answerOnDevice(const QueryPlace& at, ContactSet& out) {
    const auto completed =
        frames_ && contact_.onDevice() ? frames_->sets().newestEarly() : cloud::FixturePool::Lease();
    if (!completed) {
        return false;
    }
    try {
        contact_.query(*completed, at, out);
        return true;
    } catch (const DeviceFailed& e) {
        log::warn("contact query: {}: the CPU answers", e.what());
        contact_.dropDevice();
        return false;
    }
}

bool DeviceCycles::answer(const QueryPlace& at, ContactSet& out) {
    const std::lock_guard lock(answerMutex_);
    if (lastSet_ && frames_ && frames_->sets().newest()) { // not earlier: the device may be lost again
        lastSet_.reset();
    }
    if (answerOnDevice(at, out)) {
        return true;
    }
    const auto newest = frames_ ? frames_->sets().newest() : cloud::FixturePool::Lease();
    if (!newest && !lastSet_) {
        return false;
    }
    contact_.query(newest ? *newest : *lastSet_, at, out);
    return true;
}

DeviceCycles::SetInUse DeviceCycles::leaseNewestSet() {
    const std::lock_guard lock(answerMutex_);
    return {frames_ ? frames_->sets().newest() : cloud::FixturePool::Lease(), lastSet_};
}

void DeviceCycles::findGaps(const cloud::FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
                            std::vector<SmallestGap>& out) {
    try {
        gaps_.find(set, tool, baseTtool, out);
    } catch (const DeviceFailed& e) {
        log::warn("batch of poses: {}: the CPU answers", e.what());
        gaps_.dropDevice();
        gaps_.find(set, tool, baseTtool, out);
    }
}

void DeviceCycles::smallestGaps(std::span<const Pose> baseTtool, GapBatch& out) {
    const std::lock_guard lock(batchMutex_);
    const SetInUse set = leaseNewestSet();
    out.frame = -1;
    out.gaps.clear();
    if (set.get() != nullptr) {
        out.frame = set.get()->host.frame;
        out.captureTime = set.get()->host.captureTime;
        out.origin = set.get()->host.origin;
        findGaps(*set.get(), parts_.tool, baseTtool, out.gaps);
    }
}

double DeviceCycles::clearance(const ToolPlace& place) {
    const std::lock_guard lock(batchMutex_);
    const SetInUse set = leaseNewestSet();
    if (set.get() == nullptr) {
        return kNotKnown;
    }
    std::vector<SmallestGap> gap;
    if (parts_.arm != nullptr) { // the arm's leaves are already in the base frame
        const Pose base;
        findGaps(*set.get(), parts_.arm->toolAt(place.arm), {&base, 1}, gap);
    } else {
        findGaps(*set.get(), parts_.tool, {&place.pose, 1}, gap);
    }
    return gap.front().gap;
}

} // namespace fathom
