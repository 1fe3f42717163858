// SPDX-License-Identifier: Apache-2.0
// The interface of cameras: live, recorded or simulated.
#pragma once

#include "devices/camera_controls.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"
#include "engine/types/sphere_tree.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// Called by one thread. A source that has ended (a recording, a scripted scene) returns no frame from then
// on.
class Camera {
public:
    virtual ~Camera() = default;
    virtual const CameraInfo& info() const = 0;
    // The next valid frame; blocks until there is one. An invalid frame is skipped, counted and logged. At
    // most kFramesInFlight leases may be alive at once. Throws DeviceLost when a live camera is gone.
    virtual std::optional<Frame> next() = 0;
    // Number of unusable frames so far.
    virtual uint32_t skipped() const = 0;
    // Warnings so far about skipped frames and suspicious files: one sentence each, already logged, at most a
    // few dozen.
    virtual std::vector<std::string> warnings() const { return {}; }
    // True when frames arrive by themselves, stamped with CLOCK_MONOTONIC; false when they are read on
    // request.
    virtual bool live() const { return false; }
    // Live: number of frames lost or superseded so far.
    virtual uint64_t lost() const { return 0; }
    // Simulated cameras draw these spheres, base frame [m], from the next frame on. Others ignore the call.
    virtual void showArm(std::span<const Sphere>) {}
    // Recordings: number of frames, invalid ones included; 0 when the source cannot seek. seek() makes next()
    // continue at `index`; false when that is impossible.
    virtual uint32_t frameCount() const { return 0; }
    // Recordings that are played from a later time on: index of the frame that begins there.
    virtual uint32_t firstFrame() const { return 0; }
    virtual bool seek(uint32_t) { return false; }
    // [s] frame period, when the source knows it.
    virtual std::optional<double> framePeriod() const { return std::nullopt; }
    // Recordings of several streams: which ones are played, and what else there is, in one line.
    virtual std::string streams() const { return ""; }
    // The same as options after the name of the recording: ",depth=TOPIC,colour=TOPIC"; empty = one stream
    // only.
    virtual std::string streamOptions() const { return ""; }
    // Why no colour gate can pass: no colour stream, one that is not read, or grey; empty = there is colour.
    virtual std::string whyNoColour() const { return info().hasColour ? "" : "the source has no colour"; }
    // Exposure, gain and others of a live camera; null = the source has none. Any thread.
    virtual std::shared_ptr<CameraControls> controls() const { return nullptr; }
    // What it delivers: depth first. Call before another thread uses the camera.
    virtual std::vector<CameraStream> delivered() const;
    // The capture time is the start of exposure, not of arrival. Any thread.
    virtual bool stampsExposure() const { return false; }
    // One word and a name, e.g. "recorded FOLDER".
    virtual std::string description() const = 0;

    static constexpr uint32_t kFramesInFlight = 4;
};

} // namespace fathom
