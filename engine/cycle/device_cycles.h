// SPDX-License-Identifier: Apache-2.0
// The compute device with its frame cycle and contact cycle: they are rebuilt together when the device is
// lost.
#pragma once

#include "engine/cycle/contact_cycle.h"
#include "engine/cycle/frame_cycle.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace fathom {

// While the device is lost, answer() uses the host copy of the newest set and the CPU query. The contact
// thread calls answer(), the frame thread everything else; the two may overlap.
class DeviceCycles {
public:
    // What is referred to must outlive this. arm: null = the tool moves freely.
    struct Parts {
        const gpu::Instance& instance;
        std::string selector; // as of gpu::Device
        const Scene& scene;
        CameraInfo camera;
        const Tool& tool;
        const ArmRig* arm = nullptr;
        uint32_t readers = 1; // leases on fixture sets held at once, by others than answer()
        gpu::Drawing drawing = gpu::Drawing::None;
    };
    using MakePlan = std::function<Plan(const DeviceFacts&)>;

    // Throws BadInput, Error, DeviceLost.
    DeviceCycles(const Parts& parts, const MakePlan& makePlan);

    const Plan& plan() const { return plan_; }
    const DeviceFacts& facts() const { return facts_; }
    const CameraInfo& camera() const { return parts_.camera; }
    // Both: not between a renew() that threw and one that did not. Who else has something on the device
    // destroys it before renew().
    gpu::Device& device() { return *device_; }
    FrameCycle& frames() { return *frames_; }
    const FrameCycle& frames() const { return *frames_; }
    QueryStatistics queryStatistics() const { return contact_.statistics(); } // after the run

    // Fills `out` for the newest fixture set; false when there was none yet. A device that is lost or has no
    // memory left for the query is no error here: the CPU answers from then on, until renew().
    bool answer(const ToolState& place, ContactSet& out);

    // Copies of the newest fixture set, also of a device that is gone; false when there was none yet.
    bool newestSet(Fixtures& set, RegionGrid& grid);

    // After frames() threw DeviceFailed: gives the device back and opens the same one again.
    // Origin, generations and edited fixtures continue (FrameCycle::Mark); held points are forgotten. Throws
    // DeviceFailed while no device is there: retry later.
    void renew();
    uint32_t renewals() const { return renewals_.load(); } // any thread

private:
    std::unique_ptr<FrameCycle> openFrames(gpu::Device& device) const;
    void close();

    Parts parts_;
    DeviceFacts facts_;
    Plan plan_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<FrameCycle> frames_; // null while there is no device
    std::mutex mutex_;                   // an answer, or the exchange of what answers are made from
    ContactCycle contact_;
    FrameCycle::Mark mark_;                  // where a new frame cycle resumes
    std::optional<cloud::FixtureSet> stale_; // host copy of the last set of a device that is gone
    std::atomic<uint32_t> renewals_{0};
};

} // namespace fathom
