// SPDX-License-Identifier: Apache-2.0
// A camera of OpenNI2: a live device (PrimeSense, Xtion, Orbbec's older ones) or a recorded .oni file.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"

#include <OpenNI.h>
#include <filesystem>
#include <optional>

namespace fathom {

// Throws BadInput with what OpenNI2 says of its last fault.
[[noreturn]] void refuseOpenNi2(const std::string& uri, const std::string& field, const std::string& allowed);

// Depth in mm or 0.1 mm, colour registered to it by the device or left out; mirrored pictures are turned
// back. The lens is a pinhole of the device's field of view, centre in the middle, as OpenNI2's own
// conversion has it, unless intrinsics are given. Depth and colour belong together when their stamps are at
// most half a frame apart. A live picture is stamped when it arrives; a recorded one by the device's clock.
// At most one process at a time uses a device.
class OpenNi2Camera final : public Camera {
public:
    // uri: empty = the first device; a file's path. registered: the file's colour is, which it does not tell.
    // Throws BadInput.
    OpenNi2Camera(const std::string& uri, const std::filesystem::path& intrinsics, bool registered);
    OpenNi2Camera(const OpenNi2Camera&) = delete;
    OpenNi2Camera& operator=(const OpenNi2Camera&) = delete;
    ~OpenNi2Camera() override;

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override; // throws DeviceLost after two seconds without a picture
    uint32_t skipped() const override { return skipped_; }
    bool live() const override { return !file_; }
    uint64_t lost() const override { return lost_; }
    std::optional<double> framePeriod() const override { return period_; }
    std::string description() const override { return name_; }

    struct Library { // OpenNI2 counts its users. Throws BadInput.
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
        uint64_t stamp = 0; // of the newest, where there is any
    };
    void open(const std::string& uri);
    void openDepth();
    void openColour(bool registered);
    void readLens(const std::filesystem::path& intrinsics);
    bool readAny(); // false: the file ended, or nothing came
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
    int64_t left_ = 0;           // depth pictures of the file that are to come
    uint32_t index_ = 0, skipped_ = 0;
    int lastNumber_ = -1;
    uint64_t lost_ = 0;
    std::optional<FrameSlots> slots_;
};

} // namespace fathom
