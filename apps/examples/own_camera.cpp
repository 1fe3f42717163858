// SPDX-License-Identifier: Apache-2.0
// Connects your own camera: depth in metres, YUYV colour with a lens of its own, a pose per frame. The frames
// made here show a red plate of 10 cm 0.5 m ahead.
#include <fathom/fathom.h>

#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

constexpr std::uint32_t kWidth = 160, kHeight = 120;

// Replace this by what your camera gives.
struct MyCamera {
    std::vector<float> depth = std::vector<float>(kWidth * kHeight, 1.0f);
    std::vector<std::uint32_t> colour = std::vector<std::uint32_t>(kWidth * kHeight / 2, 0x80808080u); // grey
    MyCamera() {
        for (int y = -14; y <= 14; ++y) {
            for (int x = -14; x <= 14; ++x) {
                const std::size_t pixel = (60 + y) * kWidth + (80 + x);
                depth[pixel] = 0.5f;
                colour[pixel / 2] = 0xf0515a51u; // bytes Y U Y V of pure red
            }
        }
    }
    void wait() const { std::this_thread::sleep_for(std::chrono::milliseconds(33)); }
};

int main() {
    const auto scene = fathom::Scene::fromText(R"(
fixtures: [{ name: plate, role: forbidden, hue: [340, 20], saturation: [0.5, 1], radius: 0.03 }]
tool: { spheres: [[0, 0, 0, 0.01]] }
)");
    fathom::CameraModel model;
    model.name = "wrist";
    model.depth = {.width = kWidth, .height = kHeight, .fx = 140, .fy = 140, .cx = 80, .cy = 60};
    model.depthFormat = fathom::DepthFormat::Metres;
    model.colourFormat = fathom::ColourFormat::Yuyv;
    model.colour =
        fathom::Intrinsics{.width = kWidth, .height = kHeight, .fx = 142, .fy = 142, .cx = 80, .cy = 60};
    model.colourTdepth.position = {0.002, 0, 0}; // the colour lens sits 2 mm to the left
    fathom::Engine engine(scene, model);

    MyCamera camera;
    auto port = engine.camera("wrist"); // belongs to this thread
    for (int frame = 0; frame < 300 && port.processed() < 10; ++frame) {
        camera.wait();
        const fathom::Pose baseTcamera{.position = {0, 0, 0.001 * frame}};
        const auto status =
            port.submit({camera.depth.data(), camera.colour.data(), baseTcamera, fathom::now()});
        if (status != fathom::SubmitStatus::Accepted) {
            std::fprintf(stderr, "frame %d rejected: %s\n", frame, fathom::name(status));
            return 1;
        }
    }
    std::printf("%llu frames processed, %llu dropped, on %s\n",
                static_cast<unsigned long long>(port.processed()),
                static_cast<unsigned long long>(port.dropped()), engine.computeDeviceName().c_str());
    return port.processed() >= 10 ? 0 : 1;
}
