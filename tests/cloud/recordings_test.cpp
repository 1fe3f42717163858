// SPDX-License-Identifier: Apache-2.0
// Pixel counts on the real recordings, compared with a plain float64 count and with figures measured outside
// the project.
#include "tests/support/cloud_rig.h"
#include "tests/support/sanitized.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Object {
    std::string name;
    Band hue, saturation, lightness;
};

// Points counted outside the project on the decoded frame with the same gates. How that count rounded hues is
// unknown.
struct Figure {
    uint32_t frame, cls, pixels;
};

struct Recording {
    std::string folder;
    std::vector<uint32_t> frames; // empty = all
    std::vector<Object> objects;
    std::vector<Figure> figures;
};

const std::vector<Recording> kRecordings = {
    {"valve_globe_d435",
     {},
     {{"wheel", {345, 20}, {0.45, 1}, {0.05, 0.9}}, {"body", {55, 84}, {0.24, 0.35}, {0.13, 0.27}}},
     {{45, 0, 694}}},
    {"valve_ball_d435", {}, {{"lever", {110, 165}, {0.25, 1}, {0.05, 0.6}}}, {{12, 0, 1024}}},
    {"ycb_posecnn_demo",
     {},
     {{"yellow", {38, 60}, {0.5, 1}, {0.3, 0.85}},
      {"drill", {335, 12}, {0.55, 1}, {0.12, 0.6}},
      {"bowl", {330, 352}, {0.5, 1}, {0, 1}},
      {"pitcher", {212, 250}, {0.3, 1}, {0, 1}}},
     {{0, 0, 15432}, {0, 1, 24928}}},
    {"tum_fr1_single", {}, {{"yellow", {44, 64}, {0.5, 1}, {0.2, 0.8}}}, {{0, 0, 5936}}},
};

Scene sceneOf(const Recording& recording) {
    Scene scene = plainScene();
    scene.nearZ = 0.001, scene.farZ = 60.0;
    scene.fixtures.clear();
    for (const Object& object : recording.objects) {
        FixtureClass f =
            scene.fixtures.size() % 2 == 0 ? forbiddenClass(object.name, 0.02) : guidanceClass(object.name);
        f.hue = object.hue, f.saturation = object.saturation, f.lightness = object.lightness;
        scene.fixtures.push_back(f);
    }
    return scene;
}

// Counts of the twin: valid, forbidden, per class.
struct Count {
    uint32_t valid = 0, forbidden = 0;
    std::vector<uint32_t> classes;
};

Count countOf(const CloudRig& rig) {
    const reference::ClassImage twin = reference::classify(rig.view(), nullptr);
    Count count{reference::validPixels(rig.view()), 0, std::vector<uint32_t>(rig.scene().fixtures.size(), 0)};
    for (const uint32_t mask : twin.masks) {
        count.forbidden += reference::forbiddenClass(rig.scene(), mask) >= 0;
        for (size_t c = 0; c < count.classes.size(); ++c) {
            count.classes[c] += mask >> c & 1;
        }
    }
    return count;
}

} // namespace

TEST_CASE("Valid, forbidden and class pixels of every recorded frame equal a plain float64 count and are "
          "near the measured figures") {
    for (const Recording& recording : kRecordings) {
        if (kSanitized && &recording != &kRecordings.front()) {
            break;
        }
        const RecordedShots shots = recordedShots(recording.folder, recording.frames);
        if (shots.images.empty()) {
            continue;
        }
        CAPTURE(recording.folder);
        CloudRig rig(sceneOf(recording), shots.camera);
        uint64_t marked = 0;
        for (uint32_t k = 0; k < shots.images.size(); ++k) {
            CAPTURE(k);
            const FrameReport report = rig.run(shots.images[k]);
            const Count count = countOf(rig);
            CHECK(report.counts.valid == count.valid);
            CHECK(report.counts.forbidden == count.forbidden);
            CHECK(report.counts.classPixels == count.classes);
            for (const Figure& figure : recording.figures) {
                if (figure.frame == k) {
                    const double off =
                        static_cast<double>(report.counts.classPixels[figure.cls]) / figure.pixels - 1.0;
                    CHECK(std::abs(off) < 0.03);
                    MESSAGE(recording.folder, " ", recording.objects[figure.cls].name, ": ",
                            report.counts.classPixels[figure.cls], " pixels, measured outside ",
                            figure.pixels);
                }
            }
            marked += count.forbidden;
        }
        MESSAGE(recording.folder, ": ", shots.images.size(), " frames, ", marked,
                " forbidden pixels, all counts equal");
        CHECK(marked > 5000);
    }
}
