// SPDX-License-Identifier: Apache-2.0
// Plays bags of 8 x 6 images that a test makes.
#pragma once

#include "devices/bag/bag_camera.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>

namespace fathom::testing {

inline ImageMessage depthImage(uint16_t value, const std::string& frame = "camera",
                               const std::string& encoding = "16UC1") {
    return {.frame = frame, .encoding = encoding, .pixels = filled(value)};
}

inline ImageMessage redImage(const std::string& frame = "camera") {
    return {.frame = frame, .encoding = "rgb8", .pixels = filledColour(200, 10, 10)};
}

constexpr uint32_t kRedPixel = 0xff0a0ac8;

inline BagCamera playStreams(const TemporaryFolder& folder, const BagMaker& maker,
                             const SourceOptions& options = {}) {
    folder.write("a.bag", maker.bag());
    return BagCamera(folder.path() / "a.bag", options);
}

inline std::string streamRefusal(const TemporaryFolder& folder, const BagMaker& maker,
                                 const SourceOptions& options = {}) {
    return testing::refusalOf([&] { playStreams(folder, maker, options); });
}

inline double firstDepth(BagCamera& camera) {
    const auto frame = camera.next();
    REQUIRE(frame);
    return (*frame)->depth[0] * camera.info().metresPerUnit;
}

} // namespace fathom::testing
