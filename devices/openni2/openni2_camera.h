// SPDX-License-Identifier: Apache-2.0
// A camera of OpenNI2: a live device (PrimeSense, Xtion, Orbbec's older ones) or a recorded .oni file.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/skipped_frames.h"

#include <OpenNI.h>
#include <filesystem>
#include <optional>

namespace fathom {

// Throws BadInput with OpenNI2's last error message.
[[noreturn]] void refuseOpenNi2(const std::string& uri, const std::string& field, const std::string& allowed);

// Depth in mm or 0.1 mm; colour registered by the device or skipped; mirroring is undone. The lens is a
// pinhole with the device's field of view and a centred principal point, as in OpenNI2's own conversion,
// unless intrinsics are given. Depth and colour are paired when their stamps differ by at most half a frame.
// Live frames are stamped on arrival, recorded ones by the device's clock. Only one process at a time can use
// a device.
class OpenNi2Camera final : public Camera {
public:
    // uri: empty = the first device; a file's path. registered: colour of the file is registered to depth.
    // Throws BadInput.
    OpenNi2Camera(const std::string& uri, const std::filesystem::path& intrinsics, bool registered);
    OpenNi2Camera(const OpenNi2Camera&) = delete;
    OpenNi2Camera& operator=(const OpenNi2Camera&) = delete;
    ~OpenNi2Camera() override;

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override; // throws DeviceLost if no usable one arrives for 2 s
    uint32_t skipped() const override { return skipped_.count(); }
    bool live() const override { return !file_; }
    uint64_t lost() const override { return lost_; }
    std::optional<double> framePeriod() const override { return period_; }
    std::string description() const override { return name_; }

    struct Library { // OpenNI2 is reference-counted. Throws BadInput.
        Library();
        ~Library();
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    };

private:
    struct Stream {
        openni::VideoStream stream;
        openni::VideoFrameRef newest;
        bool mirrored = false, fresh = false, any = false;
        uint64_t stamp = 0; // of the newest frame, if any
    };
    void open(const std::string& uri);
    void openDepth();
    void openColour(bool registered);
    void readLens(const std::filesystem::path& intrinsics);
    bool readAny(); // false: end of file, or nothing arrived
    bool paired() const;
    Frame deliver();

    Library library_;
    openni::Device device_;
    Stream depth_, colour_;
    bool file_ = false, hasColour_ = false;
    CameraInfo info_;
    std::string name_;
    double period_ = 1.0 / 30.0; // [s]
    bool ended_ = false;         // all of the file
    int64_t left_ = 0;           // depth frames left in the file
    uint32_t index_ = 0;
    SkippedFrames skipped_;
    int lastNumber_ = -1;
    uint64_t lost_ = 0;
    std::optional<FrameSlots> slots_;
};

} // namespace fathom
