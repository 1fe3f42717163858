// SPDX-License-Identifier: Apache-2.0
// Which channel of an OpenEXR image is depth, by the names that renderers give.
#include "devices/images/exr_channel.h"
#include "engine/types/error.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::vector<ExrChannel> channelsOf(const std::vector<std::string>& names) {
    std::vector<ExrChannel> channels;
    for (const std::string& name : names) {
        channels.push_back({name, 2});
    }
    return channels;
}

std::string chosen(const std::vector<std::string>& names) {
    return names[chooseExrDepth(channelsOf(names)).depth];
}

std::string whyNone(const std::vector<std::string>& names) {
    try {
        chosen(names);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("Depth of an EXR image with several layers is neither a part of a vector nor a mist") {
    CHECK(chosen({"A", "B", "G", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R", "Z"}) == "Z"); // Arnold
    CHECK(chosen({"A", "B", "G", "R", "dd.y", "nn.X", "nn.Y", "nn.Z"}) == "dd.y");             // Mitsuba
    CHECK(chosen({"L.Combined.B", "L.Combined.G", "L.Combined.R", "L.Depth.Z", "L.Mist.Z", "L.Normal.X",
                  "L.Normal.Y", "L.Normal.Z"}) == "L.Depth.Z"); // Blender
    CHECK(chosen({"L.Denoising Depth.Z", "L.Depth.Z"}) == "L.Depth.Z");
    CHECK(chosen({"B", "G", "R", "WorldDepth.B", "WorldDepth.G", "WorldDepth.R"}) == "WorldDepth.R");
    CHECK(chosen({"camera.Z"}) == "camera.Z");
    CHECK(chosen({"V"}) == "V");
    CHECK(chosen({"A", "Y"}) == "Y");
}

TEST_CASE("Depth in the R of an EXR image comes with the channels that tell colours from it") {
    CHECK(chooseExrDepth(channelsOf({"A", "B", "G", "R"})).equal == std::vector<size_t>{2, 1});
    CHECK(chooseExrDepth(channelsOf({"R"})).equal.empty());
}

TEST_CASE("EXR images without a channel of depth, or with two, are refused by the names of their channels") {
    CHECK(whyNone({"L.Combined.B", "L.Combined.G", "L.Combined.R", "L.Mist.Z"})
              .find("channels: L.Combined.B, L.Combined.G, L.Combined.R, L.Mist.Z (allowed: Z, depth") !=
          std::string::npos);
    CHECK(whyNone({"Mist.V"}).find("channels: Mist.V (allowed") != std::string::npos);
    CHECK(whyNone({"N.X", "N.Y", "N.Z"}).find("channels: N.X, N.Y, N.Z") != std::string::npos);
    CHECK(whyNone({"Back.Depth.Z", "Camera.Depth.Z"}) ==
          "EXR: channels: Back.Depth.Z and Camera.Depth.Z (allowed: one that may be depth)");
}
