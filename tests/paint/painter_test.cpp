// SPDX-License-Identifier: Apache-2.0
// The same frame of the window drawn by the device and by the CPU, and a device without memory.
#include "apps/operate/painter.h"
#include "apps/output/image.h"
#include "devices/recorded/png_image.h"
#include "engine/types/error.h"
#include "tests/apps/laid_screen.h"
#include "tests/rig/losing.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

using namespace fathom;
using namespace fathom::operate;

namespace {

constexpr VkExtent2D kSize{1000, 620};

std::vector<uint32_t> drawnBy(Painter::By drawer, gpu::Instance& instance, gpu::Device& device,
                              std::span<const Layer> layers) {
    const testing::ScratchFolder folder;
    Painter painter(instance, device, nullptr, drawer);
    REQUIRE(painter.draw(kSize, layers, ImGui::GetDrawData(), [] { return false; }));
    const std::unique_ptr<Image> image = painter.frameImage(0);
    REQUIRE(image);
    image->writePng(folder.path() / "window.png");
    std::vector<uint32_t> pixels(size_t{kSize.width} * kSize.height);
    REQUIRE(readColourPng(folder.path() / "window.png", {kSize.width, kSize.height}, pixels).empty());
    return pixels;
}

// The largest difference of a channel, and the mean over all channels.
struct Difference {
    int most = 0;
    double mean = 0.0;
    double far = 0.0; // share of the pixels that differ by more than 24 levels
};
Difference differenceOf(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
    Difference d;
    for (size_t i = 0; i < a.size(); ++i) {
        int worst = 0;
        for (int shift = 0; shift < 24; shift += 8) {
            const int off =
                std::abs(static_cast<int>(a[i] >> shift & 0xffu) - static_cast<int>(b[i] >> shift & 0xffu));
            worst = std::max(worst, off);
            d.mean += off / (3.0 * static_cast<double>(a.size()));
        }
        d.most = std::max(d.most, worst);
        d.far += worst > 24 ? 1.0 / static_cast<double>(a.size()) : 0.0;
    }
    return d;
}

// A window drawn by a device that fails on request.
struct FailingWindow {
    const testing::ScratchFolder folder;
    const std::filesystem::path trigger = folder / "trigger";
    const Losing losing{trigger.string(), 0};
    gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, testing::Vulkan::selector(), gpu::Drawing::Offscreen};
    testing::LaidScreen laid;
    std::optional<Painter> painter;

    explicit FailingWindow(Painter::By drawer = Painter::By::Device) {
        laid.loadFontsFor({kSize.width, kSize.height}, 1.0);
        laid.draw();
        painter.emplace(instance, device, nullptr, drawer);
        REQUIRE(draws(kSize));
    }
    bool draws(VkExtent2D size) {
        return painter->draw(size, {}, ImGui::GetDrawData(), [] { return false; });
    }
    // The next call of this kind fails.
    void fail(const char* call) const { std::ofstream(trigger) << call; }
};

} // namespace

TEST_CASE("Device and CPU draw the same window") {
    gpu::Instance instance(testing::Vulkan::validation());
    gpu::Device device(instance, testing::Vulkan::selector(), gpu::Drawing::Offscreen);
    testing::LaidScreen laid;
    laid.run.console.switches.forces = true;
    laid.run.console.panels.tab = Tab::Help;
    laid.loadFontsFor({kSize.width, kSize.height}, 1.0);
    laid.draw();
    std::mt19937 noise(7); // an image of large squares: resampling shows at their borders only
    std::vector<uint32_t> image(320 * 240);
    for (uint32_t block = 0; block < 12; ++block) {
        const uint32_t colour = 0xff000000u | (noise() & 0xffffffu);
        for (size_t i = 0; i < image.size(); ++i) {
            image[i] = (i / 320 / 80) * 4 + i % 320 / 80 == block ? colour : image[i];
        }
    }
    std::vector<Layer> layers(laid.screen.layers().begin(), laid.screen.layers().end());
    layers[0] = {image, 320, 240, layers[0].where};
    const auto byDevice = drawnBy(Painter::By::Device, instance, device, layers);
    const auto byCpu = drawnBy(Painter::By::Cpu, instance, device, layers);
    const Difference d = differenceOf(byDevice, byCpu);
    MESSAGE("largest " << d.most << ", mean " << d.mean << ", far " << d.far);
    CHECK(d.mean < 0.2);
    CHECK(d.far < 0.001);
}

TEST_CASE("A window that finds no memory for a new size still draws at the old one") {
    FailingWindow window;
    REQUIRE(window.painter->frameImage(0)); // the frame is done
    window.fail("allocating");
    CHECK_THROWS_AS(window.draws({kSize.width + 8, kSize.height}), OutOfMemory);
    CHECK_FALSE(std::filesystem::exists(window.trigger));
    CHECK(window.draws(kSize));
}

TEST_CASE("A screenshot waits for a frame that takes long, and never records over it") {
    FailingWindow window;
    window.fail("unfinished");
    CHECK_THROWS_WITH_AS(window.painter->frameImage(0),
                         "the window: the device did not finish a frame within 10 s", DeviceFailed);
    CHECK(window.painter->frameImage(0));
}

TEST_CASE("A frame that was skipped has no image, not the one of the frame before") {
    for (const auto drawer : {Painter::By::Device, Painter::By::Cpu}) {
        CAPTURE((drawer == Painter::By::Cpu));
        FailingWindow window(drawer);
        window.fail("unfinished"); // the frame before
        const uint64_t drawn = window.painter->drawn();
        CHECK_FALSE(window.draws(kSize));
        CHECK(window.painter->drawn() == drawn);
        CHECK_FALSE(window.painter->frameImage(0));
        window.painter->awaitFrame(); // longer than draw() does
        REQUIRE(window.draws(kSize));
        CHECK(window.painter->drawn() == drawn + 1);
        CHECK(window.painter->frameImage(0));
    }
}

TEST_CASE(
    "A screenshot that is requested while the frame before still runs waits for it and is not skipped") {
    FailingWindow window;
    window.painter->awaitFrame();
    window.fail("unfinished");
    CHECK(window.draws(kSize));                     // there is nothing left to wait for
    CHECK(std::filesystem::remove(window.trigger)); // it was there: no wait asked for it
}
