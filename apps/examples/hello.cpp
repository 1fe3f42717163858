// SPDX-License-Identifier: Apache-2.0
// Frames and a hand made in code: a tool is pressed 10 mm into a protected wall and must feel 10 N.
#include <fathom/fathom.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

// Runs until stopped: 30 Hz, the wall 0.6 m away.
static void sendFrames(fathom::CameraPort port, const std::atomic<bool>& stop) {
    const std::vector<std::uint16_t> depth(160 * 120, 600);
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(33))) {
        if (const auto status = port.submit({.depth = depth.data(), .stamp = fathom::now()});
            status != fathom::SubmitStatus::Accepted) {
            std::fprintf(stderr, "frame rejected: %s\n", fathom::name(status));
        }
    }
}

int main() {
    // A wall of points, protected by 40 mm; the tool is a ball of 10 mm; a spring of 1000 N/m.
    const auto scene = fathom::Scene::fromText(R"(
camera: { near: 0.1, far: 3.0 }
error_budget: 0
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { device: ideal, stiffness: 1000 }
)");
    fathom::CameraModel model;
    model.depth = {.width = 160, .height = 120, .fx = 140, .fy = 140, .cx = 80, .cy = 60};
    fathom::setLogCallback([](fathom::LogLevel, std::string_view line) {
        std::fprintf(stderr, "%.*s\n", static_cast<int>(line.size()), line.data());
    });
    fathom::Engine engine(scene, model);
    std::atomic<bool> stop{false};
    std::thread camera(sendFrames, engine.camera(), std::cref(stop));

    // The tool touches the wall at z = 0.6 - 0.04 - 0.01 = 0.55 m. The hand continues to 0.56 m.
    fathom::Hand hand;
    hand.deviceThandle.position = {0, 0, 0.5};
    auto port = engine.openHand({.deviceThandle = hand.deviceThandle});
    fathom::Step step;
    auto due = std::chrono::steady_clock::now();
    for (int tick = 0, pressed = 0; tick < 20000 && pressed < 500; ++tick) {
        std::this_thread::sleep_until(due += std::chrono::milliseconds(1));
        step = port.step(hand, fathom::now());
        double& z = hand.deviceThandle.position[2];
        z = std::fmin(0.56, z + (step.frame >= 0 ? 0.0002 : 0));
        pressed += z == 0.56 ? 1 : 0;
    }
    stop = true;
    camera.join();
    std::printf("fathom %s on %s: force %.3f N\n", fathom::version(), engine.computeDeviceName().c_str(),
                -step.wrench.force[2]);
    return step.state == fathom::State::Contact && std::fabs(step.wrench.force[2] + 10.0) < 0.01 ? 0 : 1;
}
