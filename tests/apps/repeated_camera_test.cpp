// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/open_source.h"
#include "apps/session/repeated_camera.h"
#include "engine/types/log.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A recording of three frames: one image is missing, and its poses have a name that is not read.
void writeDoubtful(const TemporaryFolder& folder) {
    writeSmallRecording(folder, 3);
    std::filesystem::remove(folder.path() / "depth/1.png");
    folder.write("groundtruth.txt", "0 0 0 0 0 0 0 1\n");
}

} // namespace

TEST_CASE("A repeated recording logs each warning once, and again if it is another one") {
    const TemporaryFolder folder;
    writeDoubtful(folder);
    Scene scene;
    FixtureClass valve;
    valve.name = "valve";
    valve.hue = Band{0.0, 30.0};
    scene.fixtures = {valve};
    const Listening log;
    RepeatedCamera camera([&] { return openCamera(scene, folder.path().string() + ",colour=none"); });
    for (int frame = 0; frame < 9; ++frame) {
        REQUIRE(camera.next());
        if (frame == 5) {
            std::filesystem::remove(folder.path() / "depth/2.png");
        }
    }
    CHECK(log.count("groundtruth.txt") == 1);
    CHECK(log.count("1.png") == 1);
    CHECK(log.count("2.png") == 1);
    CHECK(log.count("fixture 'valve' will have no point") == 1);
    CHECK_FALSE(camera.warnings().empty()); // of the newest round, for displays
}

TEST_CASE("A recording that is opened twice logs its warnings twice") {
    const TemporaryFolder folder;
    writeDoubtful(folder);
    const Listening log;
    openSource(folder.path().string(), Delivery::Newest);
    openSource(folder.path().string(), Delivery::Newest);
    CHECK(log.count("groundtruth.txt") == 2);
}

TEST_CASE("A live camera says an event each time it happens") {
    class StallingCamera final : public Camera {
    public:
        const CameraInfo& info() const override { return info_; }
        std::optional<Frame> next() override {
            log::warn("no depth frame for 3.0 s: restarted");
            return Frame(Frame::Content{}, [] {});
        }
        uint32_t skipped() const override { return 0; }
        bool live() const override { return true; }
        std::string description() const override { return "stalling camera"; }

    private:
        CameraInfo info_;
    };
    const Listening log;
    RepeatedCamera camera([] { return std::make_unique<StallingCamera>(); });
    for (int frame = 0; frame < 3; ++frame) {
        REQUIRE(camera.next());
    }
    CHECK(log.count("no depth frame") == 3);
}
