// SPDX-License-Identifier: Apache-2.0
// Reads and sets the controls of a live camera in a thread of its own, because a camera answers in
// milliseconds.
#pragma once

#include "devices/camera_controls.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace fathom::operate {

// Window thread; no call waits for the camera.
class CameraControlThread {
public:
    // controls null: the source has none.
    explicit CameraControlThread(std::shared_ptr<CameraControls> controls);
    ~CameraControlThread();
    CameraControlThread(const CameraControlThread&) = delete;
    CameraControlThread& operator=(const CameraControlThread&) = delete;

    bool any() const { return controls_ != nullptr; }
    void show(bool shown); // reads the controls once per second while shown
    void request(const CameraControl& control, int64_t value); // the newest request counts

    struct Answer {
        bool known = false;                  // the controls were read since the tab is shown
        std::vector<CameraControl> controls; // empty: the camera is disconnected
        std::string fault;                   // of the last request; empty = none
    };
    Answer answer() const;

private:
    void serve();

    std::shared_ptr<CameraControls> controls_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool shown_ = false, ends_ = false;
    std::optional<std::pair<CameraControl, int64_t>> requested_;
    Answer answer_;
    std::thread thread_;
};

} // namespace fathom::operate
