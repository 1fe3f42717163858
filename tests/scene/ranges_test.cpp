// SPDX-License-Identifier: Apache-2.0
// The range of every numeric key, and the characters of every text.
#include "tests/realtime/listening.h"
#include "tests/scene/scene_file.h"

#include <doctest/doctest.h>
#include <vector>

using namespace fathom;

namespace {

// Every numeric key, with % for the number and values at the two ends of its range.
struct NumericKey {
    std::string text;
    std::string least, most;
};

std::vector<NumericKey> numericKeys() {
    const auto row = [](const std::string& keys) {
        return "fixtures: [{name: a, role: forbidden, " + keys + "}]\n" + kTool;
    };
    const auto more = [](const std::string& text) { return kMinimal + text + "\n"; };
    const std::string shape = "fixtures: [{name: a, role: forbidden, shape: box, ";
    return {
        {row("radius: %"), "0.0001", "10"},
        {row("standoff: %"), "-10", "10"},
        {row("trim: %"), "0", "0.5"},
        {row("range: [%, 10000]"), "0", "10000"},
        {row("box: {min: [%, 0, 0], max: [1e9, 1, 1]}"), "-1e9", "1e9"},
        {row("saturation: [%, 1]"), "0", "1"},
        {shape + "size: [1, 1, %]}]\n" + kTool, "0.0001", "10000"},
        {shape + "size: [1, 1, 1], base_T_shape: {xyz: [0, 0, %]}}]\n" + kTool, "-1e6", "1e6"},
        {"fixtures: []\ntool: {spheres: [[0, %, 0, 0.01]]}\n", "-50", "50"},
        {"fixtures: []\ntool: {spheres: [[0, 0, 0, %]]}\n", "1e-5", "10"},
        {more("camera: {near: %, far: 10000}"), "0.001", "9999"},
        {more("camera: {near: 0.001, far: %}"), "0.002", "10000"},
        {more("camera: {base_T_camera: {xyz: [%, 0, 0]}}"), "-1e6", "1e6"},
        {more("camera: {registration_sigma: %}"), "0", "1"},
        {more("camera: {near: 2, port: {distance: %}}"), "0", "1.9"},
        {more("camera: {port: {distance: 0.01, index: %}}"), "1", "2"},
        {more("camera: {beam: {width_deg: 1, sigma: %}}"), "0", "1"},
        {more("camera: {beam: {width_deg: 1, sigma_per_m: %}}"), "0", "1"},
        {more("camera: {beam: {width_deg: %}}"), "0", "30"},
        {more("camera: {attenuation: [%, 0, 0]}"), "0", "20"},
        {more("filter: {sigma: %}"), "1e-5", "10"},
        {more("filter: {edge: %}"), "0", "10"},
        {more("error_budget: %"), "1e-7", "0.1"},
        {more("hold_s: %"), "0", "3600"},
        {more("hand: {map: {scale: %}}"), "0.001", "100"},
        {more("hand: {loop: {mass: %}}"), "0.001", "100"},
        {more("hand: {loop: {damping: %}}"), "0", "10000"},
        {more("hand: {loop: {stiffness: %}}"), "0", "1e6"},
        {more("haptics: {rate_hz: %}"), "100", "10000"},
        {more("haptics: {stiffness: %}"), "0.001", "1e6"},
        {more("haptics: {rotational_stiffness: %}"), "1e-6", "1e5"},
        {more("haptics: {step_cap: %}"), "1e-5", "0.05"},
        {more("haptics: {friction: %}"), "0", "1"},
        {more("haptics: {damping: %}"), "0", "100"},
        {more("haptics: {margin: %}"), "0.05", "1"},
        {more("haptics: {limits: {force: %}}"), "0", "10000"},
        {more("haptics: {limits: {torque: %}}"), "0", "1000"},
        {more("haptics: {limits: {slew_N_per_s: %}}"), "0.1", "1e9"},
        {more("haptics: {limits: {slew_Nm_per_s: %}}"), "0.001", "1e9"},
        {more("haptics: {limits: {lowpass_hz: %}}"), "0.1", "499"},
        {more("haptics: {guidance_pull: {force: %}}"), "0", "100"},
        {more("haptics: {guidance_pull: {torque: %}}"), "0", "10"},
        {more("haptics: {guidance_pull: {speed: %}}"), "0.001", "2"},
        {more("contact: {reach: %}"), "0.0001", "1"},
        {more("window: {yaw: %}"), "-1000", "1000"},
        {more("window: {pitch: %}"), "-1.5", "1.5"},
        {more("pilots: [{name: p, scale: %}]"), "0.001", "100"},
    };
}

} // namespace

TEST_CASE("Every numeric key rejects NaN, infinity and what float32 cannot hold, and accepts the ends of its "
          "range") {
    const auto with = [](const NumericKey& key, const std::string& number) {
        std::string text = key.text;
        return text.replace(text.find('%'), 1, number);
    };
    for (const NumericKey& key : numericKeys()) {
        CAPTURE(key.text);
        for (const char* number : {".nan", "nan", ".inf", "-.inf", "1e300", "-1e300", "1e30"}) {
            CAPTURE(number);
            const std::string message = refusal(with(key, number));
            CHECK(message.find(number) != std::string::npos);
            CHECK(message.find("a number from ") != std::string::npos);
        }
        if (std::stod(key.least) > 0.0) {
            CHECK(refusal(with(key, "1e-160")).find("a number from ") != std::string::npos);
        }
        CHECK(refusal(with(key, key.least)) == "");
        CHECK(refusal(with(key, key.most)) == "");
    }
}

TEST_CASE("Texts with line breaks, control characters, reordering marks or bytes that are not UTF-8 are "
          "rejected, and other letters are not") {
    const auto named = [](const std::string& name) {
        return "fixtures: [{name: \"" + name + "\", role: forbidden}]\n" + kTool;
    };
    for (const char* name :
         {"r\\n", "a\\tb", "a\\0b", "a\\x1b[2J", "a\\u202eb", "a\\u2028b", "a\\u0085b", "a\\u200bb"}) {
        CAPTURE(name);
        const std::string message = refusal(named(name));
        CHECK(message.find("fixtures[0].name: ") != std::string::npos);
        CHECK(message.find("control characters") != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
    CHECK(refusal(named("V\u00e4lve \u5f01 \u00b1 \u2264")) == "");
}

TEST_CASE(
    "The number of frames of a simulated camera is `frames`, or its former name, and of no other source") {
    const auto with = [](const std::string& source) {
        return kMinimal + "camera: {source: {" + source + "}}\n";
    };
    for (const char* key : {"frames", "pictures"}) {
        const SceneFile file(with("simulated: tank, " + std::string(key) + ": 7"));
        CHECK(loadScene(file.path()).source.images == 7);
    }
    CHECK(refusal(with("simulated: tank, frames: 7, pictures: 7")).find("former name of frames") !=
          std::string::npos);
    CHECK(refusal(with("simulated: tank, frames: 0"))
              .find("camera.source.frames: 0 (allowed: a whole number from 1 to 100000)") !=
          std::string::npos);
    CHECK(
        refusal(with("recorded: dive.mcap, frames: 7"))
            .find(
                "camera.source.frames: 7 (allowed: none: only a simulated camera has a selectable number; of "
                "a recording, ,start=S and ,duration=S behind PATH play a part)") != std::string::npos);
}

TEST_CASE("A quaternion that is far from length 1 has a warning with its field") {
    const std::string text = kMinimal + "camera: {base_T_camera: {quat_xyzw: ";
    for (const char* quat : {"[90, 0, 0, 1]", "[0, 0, 45, 1]", "[0, 0, 1, 1]", "[0.1, 0.2, 0.3, 0.4]"}) {
        CAPTURE(quat);
        const testing::Listening log;
        loadScene(SceneFile(text + quat + "}}\n").path());
        CHECK(log.count(std::string("camera.base_T_camera.quat_xyzw: ") + quat + " is scaled to length 1") ==
              1);
        CHECK(log.count("a quaternion x y z w, in this order, of length 1; its length is ") == 1);
    }
    for (const char* quat : {"[0.707, 0, 0, 0.707]", "[0, 0.0065, 0.0052, 1]", "[0.5, -0.5, 0.5, 0.5]",
                             "[0.7, 0, 0, 0.7]", "[0.58, 0.58, 0.58, 0]"}) {
        CAPTURE(quat);
        const testing::Listening log;
        loadScene(SceneFile(text + quat + "}}\n").path());
        CHECK(log.count("quat_xyzw") == 0);
    }
    const testing::Listening log;
    loadScene(SceneFile(kMinimal + "hand: {map: {base_R_device: [0, 0, 90, 1]}}\n").path());
    CHECK(log.count("hand.map.base_R_device: [0, 0, 90, 1] is scaled") == 1);
}
