// SPDX-License-Identifier: Apache-2.0
// What a pilot can set on a live camera, and the streams that it delivers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fathom {

// One stream of a camera.
struct CameraStream {
    std::string name; // "depth", "colour"
    uint32_t width = 0, height = 0;
    double rate = 0.0; // [1/s] as the driver set it; 0 = not known
    std::string format;
};

// One control and its value now.
struct CameraControl {
    std::string stream; // "depth", "colour"
    std::string name;   // "exposure", "gain", ...
    std::string unit;   // of the value; empty = none
    bool isSwitch = false;
    int64_t least = 0, most = 0, step = 1, value = 0; // a switch: 0 or 1
    std::string fixed;                                // why it cannot be changed; empty = it can
    uint32_t number = 0;
    bool operator==(const CameraControl&) const = default;
};

// Any thread; calls take milliseconds, since they wait for the camera.
class CameraControls {
public:
    virtual ~CameraControls() = default;
    // All controls, also those that this camera lacks; empty while it is disconnected.
    virtual std::vector<CameraControl> read() = 0;
    // Returns the fault, or empty.
    virtual std::string set(const CameraControl& control, int64_t value) = 0;
};

} // namespace fathom
