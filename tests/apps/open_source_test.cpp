// SPDX-License-Identifier: Apache-2.0
// Which cameras and recordings the port and the decimation of a scene change.
#include "apps/binding/open_source.h"

#include "devices/recorded/recording_writer.h"
#include "tests/realtime/listening.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// One frame of a wall 1 m away.
void record(const std::filesystem::path& folder, const CameraInfo& camera) {
    const std::vector<uint16_t> depth(camera.depth.pixels(), 1000);
    Frame::Content content;
    content.sourceNumber = 1;
    content.depth = depth;
    RecordingWriter writer(folder, camera, 1);
    writer.add(Frame(content, nullptr));
    writer.finish();
}

CameraInfo plainCamera() {
    CameraInfo camera;
    camera.depth = {.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5};
    camera.colour = camera.depth;
    camera.hasColour = false;
    return camera;
}

} // namespace

TEST_CASE("A recording of raw frames is corrected for the port, a recording of processed frames is not") {
    const ScratchFolder folder;
    Scene scene;
    scene.port = FlatPort{0.03, 1.34};
    record(folder.path() / "raw", plainCamera());
    const auto corrected = openCamera(scene, folder.path() / "raw", Delivery::Newest);
    const CameraInfo used = corrected->info();
    CHECK(used.inWater);
    CHECK(used.sigma > 0.0);
    CHECK(used.depth.fx > 1.2 * 60.0);
    record(folder.path() / "used", used);
    const auto again = openCamera(scene, folder.path() / "used", Delivery::Newest);
    CHECK(again->info().inWater);
    CHECK(again->info().sigma == doctest::Approx(used.sigma).epsilon(1e-9));
    CHECK(again->info().depth.fx == doctest::Approx(used.depth.fx).epsilon(1e-9));
    const auto frame = again->next();
    REQUIRE(frame);
    CHECK((*frame)->depth[24 * 64 + 32] == 1000); // unchanged
}

TEST_CASE("A recording is decimated as its scene says, unless it was recorded so or is being recorded") {
    const ScratchFolder folder;
    Scene scene;
    scene.decimation = 2;
    record(folder.path() / "raw", plainCamera());
    const auto small = openCamera(scene, folder.path() / "raw");
    const CameraInfo used = small->info();
    CHECK(used.depth.width == 32);
    CHECK(used.depth.height == 24);
    const auto frame = small->next();
    REQUIRE(frame);
    CHECK((*frame)->depth.size() == 32 * 24);
    record(folder.path() / "used", used);
    const auto again = openCamera(scene, folder.path() / "used");
    CHECK(again->info().decimation == 2);
    CHECK(again->info().depth.width == 32);
    CHECK(openCamera(scene, folder.path() / "raw", Delivery::Every)->info().depth.width == 64);
}

TEST_CASE(
    "A source without colour is named once for a class that asks for colour, and not for spare classes") {
    const ScratchFolder folder;
    record(folder.path() / "grey", plainCamera());
    Scene scene;
    FixtureClass valve;
    valve.name = "valve";
    valve.hue = Band{0.0, 30.0};
    scene.fixtures = {valve};
    const std::string words = "fixture 'valve' will have no point: it asks for colour";
    const Listening log;
    openCamera(scene, folder.path() / "grey", Delivery::Newest);
    CHECK(log.count(words) == 1);
    scene.fixtures[0].name = ""; // spare
    openCamera(scene, folder.path() / "grey", Delivery::Newest);
    CHECK(log.count("will have no point") == 1);
}
