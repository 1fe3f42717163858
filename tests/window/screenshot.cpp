// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/png_image.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <doctest/doctest.h>
#include <thread>

namespace fathom::window {

double Screenshot::share(const std::array<double, 4>& place,
                         const std::function<bool(int, int, int)>& accepts) const {
    size_t all = 0, good = 0;
    for (auto v = static_cast<uint32_t>(place[1]); v < std::min<double>(height, place[1] + place[3]); ++v) {
        for (auto u = static_cast<uint32_t>(place[0]); u < std::min<double>(width, place[0] + place[2]);
             ++u) {
            const uint32_t p = pixels[v * width + u];
            ++all;
            good += accepts(p & 0xff, p >> 8 & 0xff, p >> 16 & 0xff) ? 1 : 0;
        }
    }
    return all == 0 ? 0.0 : static_cast<double>(good) / static_cast<double>(all);
}

Screenshot WindowRig::shoot(const std::string& keep) const {
    const auto before = state()["console"]["shots"].get<int>();
    std::filesystem::path file;
    for (int i = 1; file.empty() || std::filesystem::exists(file);
         ++i) { // a later program continues the numbering
        file = folder_.path() / ("screenshot-" + std::to_string(i) + ".png");
    }
    key("F12");
    REQUIRE(await([&](const nlohmann::json& s) { return s["console"]["shots"] > before; }));
    Screenshot shot;
    for (int tries = 0; tries < 100 && !readPngSize(file); ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const auto size = readPngSize(file);
    REQUIRE(size);
    shot.width = size->width;
    shot.height = size->height;
    shot.pixels.resize(static_cast<size_t>(size->width) * size->height);
    REQUIRE(readColourPng(file, *size, shot.pixels) == "");
    if (const char* kept = std::getenv("FATHOM_KEEP_SCREENSHOTS")) { // a folder in which to keep them
        std::filesystem::copy_file(file, std::filesystem::path(kept) / (keep + ".png"),
                                   std::filesystem::copy_options::overwrite_existing);
    }
    return shot;
}

} // namespace fathom::window
