// SPDX-License-Identifier: Apache-2.0
// Connects your own haptic device: a loop at 1 kHz that reads the handle, steps and writes the wrench. The
// device made here is a mass on a spring that wants to go through a wall; the forces must stop it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fathom/fathom.h>
#include <thread>
#include <vector>

// Replace this by your device's driver. z only; 0.2 kg, 5 N s/m, pulled to 0.57 m by 300 N/m.
struct MyDevice {
    double z = 0.5, speed = 0.0, force = 0.0;
    bool held = true; // does not move
    fathom::Pose pose() const { return {.position = {0, 0, z}}; }
    void write(const fathom::Wrench& wrench) {
        force = wrench.force[2];
        speed += held ? 0.0 : 0.001 * (force + 300.0 * (0.57 - z) - 5.0 * speed) / 0.2;
        z += 0.001 * speed;
    }
};

int main() {
    const auto scene = fathom::Scene::fromText(R"(
fixtures: [{ name: wall, role: forbidden, radius: 0.04 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
haptics: { device: ideal, rate_hz: 1000 }
)");
    fathom::CameraModel model;
    model.depth = {.width = 160, .height = 120, .fx = 140, .fy = 140, .cx = 80, .cy = 60};
    fathom::Engine engine(scene, model);
    const std::jthread camera([port = engine.camera()](std::stop_token stop) mutable {
        const std::vector<std::uint16_t> depth(160 * 120, 600); // a wall 0.6 m away
        for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(33))) {
            (void)port.submit({.depth = depth.data(), .stamp = fathom::now()});
        }
    });

    MyDevice device;
    auto hand = engine.openHand({.deviceThandle = device.pose()}); // belongs to this thread from here on
    fathom::Step step;
    const std::chrono::nanoseconds period(static_cast<std::int64_t>(1e9 * hand.period()));
    auto due = std::chrono::steady_clock::now();
    for (int tick = 0, shown = 0; tick < 20000 && shown < 2000; ++tick) {
        due = std::max(due + period, std::chrono::steady_clock::now() - period); // skips late ticks
        std::this_thread::sleep_until(due);
        step = hand.step({.deviceThandle = device.pose()}, fathom::now());
        shown += step.frame >= 0 ? 1 : 0;
        device.held = step.frame < 0; // until the engine has seen a frame
        device.write(step.wrench);    // in every tick: some drivers repeat the last force otherwise
        if (step.warnings != fathom::StepWarning::None && tick % 500 == 0) {
            std::fprintf(stderr, "warning: %s\n", fathom::name(step.warnings));
        }
    }
    device.write({}); // no force stays on the hand
    std::printf("handle at %.4f m, tool at %.4f m, force %.2f N\n", device.z, step.baseTtool.position[2],
                step.wrench.force[2]);
    return step.baseTtool.position[2] < 0.551 && step.wrench.force[2] < -1.0 ? 0 : 1;
}
