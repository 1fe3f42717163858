// SPDX-License-Identifier: Apache-2.0
// The compute device with its frame cycle and contact cycle. They are rebuilt together after the device is
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

// While the device is lost, answer() uses the CPU query on the host copy of the newest set. The contact
// thread calls answer(), the frame thread everything else; the calls may overlap.
class DeviceCycles {
public:
    // Referenced objects must outlive this. arm: null = the tool moves freely.
    struct Parts {
        const gpu::Instance* instance; // null: no device is opened; only for a scene without passes
        std::string selector;          // as for gpu::Device
        const Scene& scene;
        CameraInfo camera;
        const Tool& tool;
        const ArmRig* arm = nullptr;
        uint32_t readers = 1; // leases on fixture sets held at once, not counting answer()
        gpu::Drawing drawing = gpu::Drawing::None;
    };
    using MakePlan = std::function<Plan(const DeviceFacts&)>;

    // Throws BadInput, Error, DeviceLost.
    DeviceCycles(const Parts& parts, const MakePlan& makePlan);

    const Plan& plan() const { return plan_; }
    const DeviceFacts& facts() const { return facts_; } // noDevice() without one
    const CameraInfo& camera() const { return parts_.camera; }
    // Without an instance there is no device(). device() and frames() are invalid between a renew() that
    // threw and one that succeeded. Destroy all other objects on the device before renew().
    gpu::Device& device() { return *device_; }
    FrameCycle& frames() { return *frames_; }
    const FrameCycle& frames() const { return *frames_; }
    QueryStatistics queryStatistics() const { return contact_.statistics(); } // after the run

    // Fills `out` for the newest fixture set; false when there is none yet. If the device is lost or out of
    // memory, the CPU answers from then on until renew().
    bool answer(const ToolState& place, ContactSet& out);

    // Copies the newest fixture set, also after the device is lost; false when there is none yet.
    bool newestSet(Fixtures& set, RegionGrid& grid);

    // Call after frames() threw DeviceFailed: closes the device and opens it again. Origin, generations and
    // edited fixtures continue (FrameCycle::Mark); held points are dropped. Throws DeviceFailed while the
    // device is missing: retry later.
    void renew();
    uint32_t renewals() const { return renewals_.load(); } // any thread

private:
    std::unique_ptr<gpu::Device> openDevice() const;
    std::unique_ptr<FrameCycle> openFrames() const;
    void close();

    Parts parts_;
    std::unique_ptr<gpu::Device> device_;
    DeviceFacts facts_;
    Plan plan_;
    std::unique_ptr<FrameCycle> frames_; // null while there is no device
    std::mutex mutex_;                   // held for an answer and while the device is replaced
    ContactCycle contact_;
    FrameCycle::Mark mark_;                  // where a new frame cycle resumes
    std::optional<cloud::FixtureSet> stale_; // host copy of the newest set of a lost device
    std::atomic<uint32_t> renewals_{0};
};

} // namespace fathom
