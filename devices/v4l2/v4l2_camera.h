// SPDX-License-Identifier: Apache-2.0
// A live depth camera, with colour where it has any, through the kernel's V4L2: no maker's library.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/v4l2/choose_nodes.h"
#include "devices/v4l2/frame_pairing.h"

#include <chrono>
#include <memory>
#include <vector>

namespace fathom {

// Depth of 16-bit rows without gaps is leased where the driver put it (no copy, and a GPU that imports the
// host's memory reads it there) while the driver keeps two buffers; anything else is unpacked into memory of
// the camera's own. Colour is unpacked, too, but for YUYV and UYVY of an even width, which are copied as they
// are. Capture times are CLOCK_MONOTONIC [s]: when the first bytes of the picture came from a UVC camera,
// which its driver calls the start of exposure; when the exposure began where a RealSense D4xx and the kernel
// tell it (frame_metadata.h). Colour is paired by the driver's stamps. Frames count from 0; each is new
// (source number index + 1).
//
// next() gives the newest pair there is, none from before a pause in which the driver ran out of buffers
// (every one, in order, with everyFrame). A damaged, short or unpaired picture is skipped, counted, named in
// the log. A stream without pictures for `silence` is started anew, and after twice that the camera counts as
// lost. When it is lost (unplugged), next() throws DeviceLost, and looks for the same camera again at each
// later call.
class V4l2Camera final : public Camera {
public:
    // Throws BadInput: no such device, no such format or size (it says what there is), no intrinsics.
    explicit V4l2Camera(const CameraRequest& request);
    ~V4l2Camera() override;

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    std::string description() const override;
    bool live() const override { return true; }
    // Gaps in the driver's counter of depth, and pictures that a newer one overtook before they were asked
    // for. A colour picture that is missing costs no pair as long as its neighbour is near enough.
    uint64_t lost() const override;
    uint64_t lostColour() const; // gaps in the driver's counter of colour
    std::optional<double> framePeriod() const override { return depthPeriod_; }

    uint64_t overtaken() const { return overtaken_; }
    uint64_t copied() const { return copied_; }     // frames whose depth was not leased in place
    uint64_t restarts() const { return restarts_; } // silent streams that were started anew
    // Frames whose capture time is the start of exposure as the camera's own metadata tell it.
    uint64_t exposuresTold() const { return exposuresTold_; }

private:
    struct Streams;
    struct Arrival {
        bool depth = false;
        CapturedBuffer buffer;
    };
    struct Watch {                                  // over one stream
        std::chrono::steady_clock::time_point last; // its newest picture, or when the first must be here
        bool restarted = false;                     // since then
    };

    void open();
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
    void skip(uint32_t sequence, const std::string& fault);
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
    double depthPeriod_ = 0.0, lastStamp_ = 0.0, lastCapture_ = 0.0;
    uint32_t delivered_ = 0, skipped_ = 0;
    uint64_t overtaken_ = 0, copied_ = 0, restarts_ = 0, exposuresTold_ = 0, missingBefore_ = 0,
             missingColourBefore_ = 0;
};

} // namespace fathom
