// SPDX-License-Identifier: Apache-2.0
// The compute device with its frame cycle and contact cycle. They are rebuilt together after the device is
// lost.
#pragma once

#include "engine/cycle/contact_cycle.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/gap_cycle.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace fathom {

// The device answers about the newest set whose passes have completed, the CPU about the newest one with a
// host copy. While the device is lost, answer() uses the CPU query on the newest host copy, which may be
// older than the device's last answer; sets and answers carry their own generation and capture time. The
// contact thread calls answer(), any thread smallestGaps() and clearance(), the frame thread
// everything else; the calls may overlap.
class DeviceCycles {
public:
    // Referenced objects must outlive this. arm: null = the tool moves freely.
    struct Parts {
        const gpu::Instance* instance; // null: no device is opened; only for a scene without passes
        std::string selector;          // as for gpu::Device
        const Scene& scene;
        CameraInfo camera;
        const Tool& tool;
        const ArmSetup* arm = nullptr;
        gpu::Drawing drawing = gpu::Drawing::None;
    };
    using MakePlan = std::function<Plan(const DeviceFacts&)>;

    // Throws BadInput, Error, DeviceFailed. Warns if a selector is given without an instance.
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

    // Fills `out` for the newest fixture set, which may lack its host copy where the device answers; false
    // when there is none yet. If the device is lost or out of memory, the CPU answers from then on until
    // renew().
    bool answer(const QueryPlace& at, ContactSet& out);

    // Answers of a batch, and the set that they are about.
    struct GapBatch {
        int64_t frame = -1;       // HostFixtures::frame; -1 = no set yet
        double captureTime = 0.0; // [s]
        dvec3 origin{0.0};        // [m] base frame: origin of SmallestGap::sphere
        std::vector<SmallestGap> gaps;
    };
    // Fills `out` for the newest fixture set with a host copy and the scene's tool, an arm's tip included:
    // one gap per pose base_T_tool, or none while there is no set. Only regions of points count, no placed
    // shapes. Batches run one after the other and do not delay answer() on the host; on the device they share
    // its queue. If the device fails, the CPU answers until renew().
    void smallestGaps(std::span<const Pose> baseTtool, GapBatch& out);
    // The smallest gap [m] of the tool, or of all links of the arm, where it is; NaN while there is no set.
    double clearance(const ToolPlace& place);

    // Copies the newest fixture set with a host copy, also after the device is lost; false when there is none
    // yet.
    bool copyNewestSet(HostFixtures& set, RegionGrid& grid);

    struct SetInUse { // one of the two, or none
        cloud::FixturePool::Lease lease;
        std::shared_ptr<const cloud::FixtureSet> last; // host copy of the newest set of a lost device
        const cloud::FixtureSet* get() const { return lease ? &*lease : last.get(); }
    };
    // Leases the newest fixture set with a host copy, also after the device is lost. Release it soon: it
    // occupies one of the frame cycle's leases. Any thread, but not while renew() runs: it frees the sets.
    SetInUse leaseNewestSet();

    // Call after frames() threw DeviceFailed: closes the device and opens it again. Origin, generations and
    // edited fixtures continue (FrameCycle::ResumeState); held points are dropped. Throws DeviceFailed while
    // the device is missing: retry later.
    void renew();
    uint32_t renewals() const { return renewals_.load(); } // any thread

private:
    std::unique_ptr<gpu::Device> openDevice() const;
    std::unique_ptr<FrameCycle> openFrames() const;
    void useDevice();
    void close();
    bool answerOnDevice(const QueryPlace& at, ContactSet& out);
    void findGaps(const cloud::FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
                  std::vector<SmallestGap>& out);

    Parts parts_;
    std::unique_ptr<gpu::Device> device_;
    DeviceFacts facts_;
    Plan plan_;
    std::unique_ptr<FrameCycle> frames_; // null from the loss of the device until renew() succeeds
    // batchMutex_: held during a batch of gaps. answerMutex_: held during a contact answer. renew() takes
    // both, in this order.
    std::mutex batchMutex_, answerMutex_;
    ContactCycle contact_;
    GapCycle gaps_;
    FrameCycle::ResumeState resumeState_;              // where a new frame cycle resumes
    std::shared_ptr<const cloud::FixtureSet> lastSet_; // host copy of the newest set of a lost device
    std::atomic<uint32_t> renewals_{0};
};

} // namespace fathom
