// SPDX-License-Identifier: Apache-2.0
// A haptic device on a bridge socket whose handle the test moves.
#pragma once

#include "devices/bridge/socket_server.h"
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace fathom {

// The handle is at `z`, and the force on it is in `fz`.
struct PlayedDevice {
    explicit PlayedDevice(const std::filesystem::path& endpoint)
        : server({endpoint, "falcon", "played device", 8.0, 0.0})
        , thread([this] {
            while (!stop) {
                server.poll();
                HandSample sample;
                sample.deviceThandle.position.z = z;
                sample.buttons = buttons;
                server.send(sample, FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED);
                const double felt = server.wrench().force.z;
                lettings += fz < -1e-3 && felt == 0.0 ? 1 : 0;
                fz = felt;
                strongest = std::min<double>(strongest, fz);
                silent = server.gate().silent(socketClock());
                std::this_thread::sleep_for(std::chrono::microseconds(500));
            }
        }) {}
    ~PlayedDevice() {
        stop = true;
        thread.join();
    }
    // Waits for the first wrench: the ticks run.
    bool awaitWrench() const {
        return testing::eventually([this] { return !silent; });
    }
    // Moves the handle within 0.5 s.
    void push(double to) {
        const double from = z;
        for (int i = 1; i <= 50; ++i) {
            z = from + (to - from) * i / 50.0;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    // On a busy machine the engine may lose the device for a moment. The tool then stays, and the handle
    // starts from its new place, so this repeats until the force is in range.
    bool pushUntil(double least, double most) {
        for (int tries = 0; tries < 10; ++tries) {
            push(z + 0.035);
            if (feels(least, most, 2000)) {
                return true;
            }
            if (fz < -1e-3) { // not lost: the force is late or wrong
                return feels(least, most);
            }
        }
        return false;
    }
    bool feels(double least, double most, int milliseconds = 20000) const {
        for (int i = 0; i < milliseconds; ++i) {
            if (const double f = fz; f >= least && f <= most) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
    // The machine interrupted the engine so often that no soft start ever finished.
    bool hopeless() const { return lettings > 20; }

    std::atomic<double> z{0.0}, fz{0.0}, strongest{0.0};
    std::atomic<uint32_t> buttons{0}; // down
    std::atomic<int> lettings{0}; // times that the force went to zero, as when the engine loses the device
    std::atomic<bool> stop{false}, silent{true};
    SocketServer server;
    std::thread thread;
};

// A red wall 0.6 m away. The tool starts 20 mm in front of its region and moves with the device.
inline void setUpNearWall(const Stage& stage) {
    stage.recording(std::vector<Image>(3, Image(kWidth, kHeight, 600).paint({0, 0, kWidth, kHeight}, kRed)));
    SceneText scene;
    scene.hand = "path: start.csv";
    stage.scene(scene);
    stage.write("start.csv", handCsv({{0.0, {0.0, 0.0, 0.53}}}));
}

} // namespace fathom
