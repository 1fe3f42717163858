// SPDX-License-Identifier: Apache-2.0
// A live depth camera, with colour where it has any, through the kernel's V4L2, without vendor libraries.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/skipped_frames.h"
#include "devices/v4l2/choose_nodes.h"
#include "devices/v4l2/frame_pairing.h"
#include "devices/v4l2/v4l2_controls.h"
#include "engine/types/clock.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

namespace fathom {

// Depth in 16-bit rows without gaps is leased in place (no copy, also for a GPU that imports host memory)
// while the driver keeps two buffers; other depth is unpacked. Colour is copied as it is sent, motion JPEG is
// decoded to its planes; the driver's stamps pair it. Capture times are CLOCK_MONOTONIC [s]: arrival of the
// first bytes (UVC drivers call it start of exposure), or the actual start of exposure where a RealSense D4xx
// and the kernel report it (frame_metadata.h). Frame indices start at 0; the source number is index + 1.
//
// next() returns the newest pair (with everyFrame: every pair, in order), none from before a pause in which
// the driver ran out of buffers. Unusable frames are skipped and counted, each cause is logged once. A stream
// without frames for `silence` is restarted. When unplugged, after twice that, or after 2.5 times that with
// unusable frames only, next() throws DeviceLost; each later call searches the same camera again.
class V4l2Camera final : public Camera {
public:
    // Throws BadInput for an unknown device, an unavailable format or size (lists the available ones), or
    // missing intrinsics.
    explicit V4l2Camera(const CameraRequest& request);
    ~V4l2Camera() override;

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_.count(); }
    std::string description() const override;
    bool live() const override { return true; }
    // Gaps in the driver's depth counter plus frames superseded before they were read. A missing colour frame
    // loses no pair while a neighbour is close enough; it is logged once.
    uint64_t lost() const override;
    std::optional<double> framePeriod() const override { return depthPeriod_; }
    std::shared_ptr<CameraControls> controls() const override { return controls_; }
    std::vector<CameraStream> delivered() const override;
    bool stampsExposure() const override { return exposureStamps_.load() > 0; }

    uint64_t restarts() const { return restarts_; } // restarts of silent streams

    // For tests.
    uint64_t lostColour() const;                // gaps in the driver's counter of colour
    uint64_t copied() const { return copied_; } // frames whose depth was not leased in place
    // Frames whose capture time is the start of exposure from the camera's metadata.
    uint64_t exposureStamps() const { return exposureStamps_; }

private:
    struct Streams;
    struct Arrival {
        bool depth = false;
        CapturedBuffer buffer;
    };
    struct Watch {              // over one stream
        Clock::time_point last; // time of the newest frame, or deadline of the first
        bool restarted = false; // since then
    };

    void open();
    std::vector<V4l2Controls::Node> controlNodes() const;
    void reopen();
    void close();
    void gather();
    void wait();
    void watch(bool depth, CaptureStream& stream, Watch& watch);
    bool starved() const;
    void giveUpStale();
    std::optional<Frame> settle();
    std::optional<Frame> lease(const FramePairing::Pair& pair);
    std::string fill(const FramePairing::Pair& pair, FrameSlot& slot, Frame::Content& content);
    std::string fillColour(const CapturedBuffer& colour, FrameSlot& slot, Frame::Content& content);
    bool fillDepth(const CapturedBuffer& depth, FrameSlot& slot, Frame::Content& content);
    void recycle();

    CameraRequest request_;
    CameraInfo info_;
    std::string description_;
    StreamRequest depthRequest_, colourRequest_;
    std::optional<KnownCamera> known_;
    std::unique_ptr<FrameSlots> slots_;
    std::unique_ptr<Streams> streams_;
    std::vector<std::unique_ptr<Streams>> retired_; // their last leases still live
    FramePairing pairing_{0.0};
    std::vector<Arrival> arrivals_; // taken, not yet paired; oldest first
    Watch depthWatch_, colourWatch_;
    Clock::time_point firstBy_; // deadline of the first frame
    double depthPeriod_ = 0.0, lastStamp_ = 0.0, lastCapture_ = 0.0;
    uint32_t delivered_ = 0;
    SkippedFrames skipped_;
    uint64_t overtaken_ = 0, copied_ = 0, restarts_ = 0, missingBefore_ = 0, missingColourBefore_ = 0;
    std::atomic<uint64_t> exposureStamps_{0};
    std::shared_ptr<V4l2Controls> controls_;
};

} // namespace fathom
