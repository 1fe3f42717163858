// SPDX-License-Identifier: Apache-2.0
// Window frames drawn by the CPU: which pixels, and that unchanged ones are not drawn again.
#include "apps/operate/frame_pace.h"
#include "apps/operate/panel_raster.h"
#include "tests/apps/laid_screen.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

namespace {

// An ImGui context and an image of the window.
class RasterRig {
public:
    static constexpr int kWidth = 200, kHeight = 130;

    RasterRig() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = {kWidth, kHeight};
        ImGui::GetIO().DeltaTime = 0.01f;
        raster.takeFonts();
    }
    ~RasterRig() { ImGui::DestroyContext(); }
    RasterRig(const RasterRig&) = delete;
    RasterRig& operator=(const RasterRig&) = delete;

    // Draws a frame; returns the boxes that changed.
    template <class Content>
    std::vector<PixelBox> draw(Content&& content, std::span<const Layer> layers = {}) {
        ImGui::NewFrame();
        content(*ImGui::GetBackgroundDrawList());
        ImGui::Render();
        const auto changed = raster.draw(pixels, kWidth, kHeight, layers, *ImGui::GetDrawData());
        return {changed.begin(), changed.end()};
    }
    uint32_t at(int x, int y) const { return pixels[static_cast<size_t>(y * kWidth + x)]; }
    uint32_t redAt(int x, int y) const { return at(x, y) >> 16 & 0xffu; }

    PanelRaster raster;
    std::vector<uint32_t> pixels = std::vector<uint32_t>(size_t{kWidth} * kHeight);
};

void square(ImDrawList& list, float x, float y) {
    list.AddRectFilled({x, y}, {x + 10.0f, y + 10.0f}, IM_COL32(255, 0, 0, 255));
}

} // namespace

TEST_CASE("A frame without changes draws nothing again, and a change draws only the tiles that it touches") {
    RasterRig rig;
    rig.draw([](ImDrawList& list) { square(list, 70.0f, 10.0f); });
    CHECK(rig.raster.tiles() == 4 * 3);
    CHECK(rig.draw([](ImDrawList& list) { square(list, 70.0f, 10.0f); }).empty());
    CHECK(rig.raster.tiles() == 4 * 3);
    const auto changed = rig.draw([](ImDrawList& list) { square(list, 72.0f, 10.0f); });
    REQUIRE(changed.size() == 1);
    CHECK(changed[0] == PixelBox{64, 0, 128, 64});
    CHECK(rig.raster.tiles() == 4 * 3 + 1);
    CHECK(rig.at(71, 12) == kBackground);
    CHECK(rig.at(81, 12) == 0xffff0000u);
    const auto wider = rig.draw([](ImDrawList& list) { square(list, 120.0f, 60.0f); });
    CHECK(rig.raster.tiles() == 4 * 3 + 1 + 4);
    CHECK(wider.size() == 2);
}

TEST_CASE("What an opaque rectangle hides may change without being drawn again") {
    RasterRig rig;
    const auto hidden = [](float x) {
        return [x](ImDrawList& list) {
            square(list, x, 70.0f);
            list.AddRectFilled({0.0f, 0.0f}, {200.0f, 130.0f}, IM_COL32(20, 30, 40, 255));
        };
    };
    rig.draw(hidden(10.0f));
    CHECK(rig.draw(hidden(20.0f)).empty());
    CHECK(rig.at(15, 75) == 0xff141e28u);
}

TEST_CASE("Triangles with a common edge cover each pixel once, whatever their slope") {
    RasterRig rig;
    const ImVec2 middle{97.3f, 61.7f};
    constexpr int kParts = 17;
    const auto rim = [&](int i) {
        const float angle = 6.2831853f * static_cast<float>(i % kParts) / kParts;
        return ImVec2{middle.x + 55.0f * std::cos(angle), middle.y + 55.0f * std::sin(angle)};
    };
    rig.draw([&](ImDrawList& list) {
        list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
        for (int i = 0; i < kParts; ++i) {
            list.AddTriangleFilled(middle, rim(i), rim(i + 1), IM_COL32(200, 0, 0, 128));
        }
    });
    int inside = 0, wrong = 0;
    for (int y = 0; y < RasterRig::kHeight; ++y) {
        for (int x = 0; x < RasterRig::kWidth; ++x) {
            const float off =
                std::hypot(static_cast<float>(x) + 0.5f - middle.x, static_cast<float>(y) + 0.5f - middle.y);
            if (off < 53.0f) {
                ++inside;
                wrong += std::abs(static_cast<int>(rig.redAt(x, y)) - 105) > 2 ? 1 : 0; // once over 9
            }
        }
    }
    CHECK(inside > 8000);
    CHECK(wrong == 0);
}

TEST_CASE("An image is drawn below the panels, kept while it is the same, and drawn again when it is new") {
    RasterRig rig;
    const std::vector<uint32_t> blue(4 * 3, 0xffff0000u), green(4 * 3, 0xff00ff00u);
    const auto panel = [](ImDrawList& list) { square(list, 60.0f, 10.0f); };
    const auto layer = [](std::span<const uint32_t> pixels) { return Layer{pixels, 4, 3, {10, 5, 100, 60}}; };
    const Layer first = layer(blue), same = layer({}), next = layer(green);
    rig.draw(panel, {&first, 1});
    CHECK(rig.at(11, 6) == 0xff0000ffu);
    CHECK(rig.at(109, 64) == 0xff0000ffu);
    CHECK(rig.at(110, 64) == kBackground);
    CHECK(rig.at(65, 15) == 0xffff0000u);
    CHECK(rig.draw(panel, {&same, 1}).empty());
    CHECK(rig.draw(panel, {&next, 1}).size() == 2); // rows of tiles
    CHECK(rig.at(11, 6) == 0xff00ff00u);
    Layer outside = same;
    outside.where.x = 150; // a window that has just shrunk
    rig.draw(panel, {&outside, 1});
    CHECK(rig.at(11, 6) == kBackground);
}

TEST_CASE("A window whose run stands still is laid out again, but not drawn again") {
    testing::LaidScreen laid;
    constexpr int kWidth = 1000, kHeight = 620;
    laid.loadFontsFor({kWidth, kHeight}, 1.0);
    PanelRaster raster;
    raster.takeFonts();
    std::vector<uint32_t> pixels(size_t{kWidth} * kHeight);
    const auto drawn = [&](bool fresh) { // number of tiles
        laid.draw(1);
        std::vector<Layer> layers(laid.screen.layers().begin(), laid.screen.layers().end());
        for (Layer& layer : layers) {
            layer.pixels = fresh ? layer.pixels : std::span<const uint32_t>();
        }
        const uint64_t before = raster.tiles();
        raster.draw(pixels, kWidth, kHeight, layers, *ImGui::GetDrawData());
        return raster.tiles() - before;
    };
    laid.draw();
    CHECK(drawn(true) == 16 * 10);
    CHECK(drawn(false) == 0);
    laid.run.console.panels.tracesPaused = true; // changes a button
    const uint64_t button = drawn(false);
    CHECK(button > 0);
    CHECK(button < 16);
}

TEST_CASE("A window on a device that is the CPU draws less often the more its frames cost") {
    FramePace free(false), limited(true);
    double cpu = 0.0;
    const auto run = [&](double cost) {
        for (int i = 0; i < 300; ++i) {
            cpu += cost;
            free.note(cpu);
            limited.note(cpu);
        }
    };
    run(0.001);
    CHECK(limited.period() == FramePace::kFastest);
    run(0.010);
    CHECK(limited.cost() == doctest::Approx(0.010).epsilon(0.01));
    CHECK(limited.period() == doctest::Approx(0.010 / FramePace::kShare).epsilon(0.01));
    run(0.5);
    CHECK(limited.period() == FramePace::kSlowest);
    CHECK(free.period() == FramePace::kFastest);
}
