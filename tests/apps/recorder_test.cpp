// SPDX-License-Identifier: Apache-2.0
// Recordings of the window, also with a full disk or a killed process.
#include "apps/operate/recorder.h"

#include "apps/operate/tick_log.h"
#include "devices/recorded/hand_csv.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/eventually.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

constexpr uint32_t kWidth = 64, kHeight = 48;

CameraInfo someCamera() {
    CameraInfo camera;
    camera.depth = {kWidth, kHeight, 60.0, 60.0, 31.5, 23.5};
    camera.metresPerUnit = 0.001;
    camera.hasColour = false;
    return camera;
}

// Frames at 30 Hz, each followed by ticks with one touch.
class RecordedRun {
public:
    explicit RecordedRun(Recorder& recorder, int ticks = 33)
        : recorder_(recorder)
        , ticks_(ticks) {}

    void image() {
        PublishedFrame frame;
        frame.t = static_cast<double>(frames_) / 30.0;
        frame.report.index = frames_++;
        HostFixtures set;
        set.depth.resize(size_t{kWidth} * kHeight);
        for (uint16_t& depth : set.depth) { // noise, which does not compress
            noise_ = noise_ * 1664525u + 1013904223u;
            depth = static_cast<uint16_t>(noise_ >> 16 | 1u);
        }
        recorder_.frame(frame, set);
        for (int k = 0; k < ticks_; ++k) {
            TickRow row;
            row.record.t = frame.t + 0.001 * k;
            row.record.touchCount = 1;
            row.record.touches[0].multiplier = 1.0 / 3.0;
            recorder_.step(row, {});
        }
    }

private:
    Recorder& recorder_;
    int ticks_;
    uint32_t frames_ = 0, noise_ = 1;
};

uint32_t imagesIn(const std::filesystem::path& folder) {
    RecordedCamera camera(folder);
    uint32_t images = 0;
    while (camera.next()) {
        ++images;
    }
    CHECK(camera.skipped() == 0);
    return images;
}

// Checks that every file can be read and no line is cut.
void checkWhole(const std::filesystem::path& folder, size_t ticks) {
    for (const char* name : {"hand.csv", "wrench.csv", "touches.csv"}) {
        CAPTURE(name);
        const std::string text = textOf(folder / name);
        REQUIRE_FALSE(text.empty());
        CHECK(text.back() == '\n');
    }
    const TickLog log = readTickLog(folder);
    CHECK(log.ticks.size() >= ticks);
    CHECK(readHandCsv(folder / "hand.csv").size() >= log.ticks.size());
}

} // namespace

TEST_CASE("A stopped recording is complete: every frame, and every tick until the end of the last frame") {
    const ScratchFolder scratch;
    const auto folder = scratch.path() / "rec";
    Recorder recorder;
    RecordedRun session(recorder);
    session.image(); // before the recording starts
    recorder.start(folder, "camera: {}\n", someCamera());
    CHECK(recorder.recording());
    for (int i = 0; i < 10; ++i) {
        session.image();
    }
    recorder.stop();
    CHECK_FALSE(recorder.recording());
    recorder.finish();
    CHECK_FALSE(recorder.writing());
    CHECK(recorder.failure() == "");
    CHECK(recorder.frames() == 10);
    CHECK(recorder.seconds() == doctest::Approx(9.0 / 30.0));
    CHECK(recorder.bytes() > 10 * 6000); // of noise
    CHECK(imagesIn(folder) == 10);
    checkWhole(folder, 9 * 33 + 30);
    CHECK(textOf(folder / "scene.yaml") == "camera: {}\n");
    CHECK_THROWS_AS(recorder.start(folder, "", someCamera()), BadInput); // never overwrites a recording
    CHECK(imagesIn(folder) == 10);
}

TEST_CASE(
    "When no frame comes for ten seconds, the ticks of the last one are written and later ones are not") {
    const ScratchFolder scratch;
    const auto folder = scratch.path() / "rec";
    Recorder recorder;
    RecordedRun session(recorder);
    recorder.start(folder, "camera: {}\n", someCamera());
    session.image();
    session.image();
    TickRow row;
    for (row.record.t = 0.1; row.record.t < 12.0; row.record.t += 0.01) {
        recorder.step(row, {});
    }
    CHECK(readTickLog(folder).ticks.size() == 2 * 33);
    session.image();
    recorder.stop();
    recorder.finish();
    CHECK(recorder.failure() == "");
    CHECK(imagesIn(folder) == 3);
    CHECK(readTickLog(folder).ticks.size() == 3 * 33);
}

TEST_CASE("A full disk ends a recording with a message that names the file, and the files up to there can be "
          "read") {
    const ScratchFolder scratch;
    struct Case {
        rlim_t bytes;
        int ticks; // number of ticks per frame
        const char* file;
    };
    for (const auto& [bytes, ticks, file] : {Case{30000, 33, "wrench.csv"}, Case{3000, 0, "000000.png"}}) {
        const std::string named = file;
        CAPTURE(named);
        const auto folder = scratch.path() / std::to_string(bytes);
        Recorder recorder;
        {
            const FileSizeLimit disk(bytes);
            RecordedRun session(recorder, ticks);
            recorder.start(folder, "camera: {}\n", someCamera());
            CHECK(eventually([&] {
                session.image();
                return !recorder.recording();
            }));
            recorder.stop();
            recorder.finish();
        }
        CHECK_MESSAGE(recorder.failure().find(folder.string()) == 0, recorder.failure());
        CHECK_MESSAGE(recorder.failure().find(std::string(file) + ": cannot be written") != std::string::npos,
                      recorder.failure());
        if (ticks > 0) {
            checkWhole(folder, 33);
        }
        recorder.start(scratch.path() / (std::string("after ") + file), "", someCamera()); // there is room
        CHECK(recorder.failure() == "");
        RecordedRun(recorder).image();
        recorder.stop();
        recorder.finish();
        CHECK(recorder.failure() == "");
    }
}

TEST_CASE("A process that is killed while it records leaves a recording up to that time") {
    const ScratchFolder scratch;
    const auto folder = scratch.path() / "rec";
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        Recorder recorder;
        RecordedRun session(recorder);
        recorder.start(folder, "camera: {}\n", someCamera());
        for (;;) {
            session.image();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
    CHECK(eventually([&] { return std::filesystem::exists(folder / "depth" / "000030.png"); }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    CHECK(imagesIn(folder) >= 29);
    checkWhole(folder, 29 * 33);
}

TEST_CASE("A recording that is stopped for a reason is complete and keeps the reason") {
    const ScratchFolder scratch;
    Recorder recorder;
    RecordedRun session(recorder);
    recorder.start(scratch.path() / "rec", "", someCamera());
    session.image();
    session.image();
    recorder.stop("only 98 MB of the disk left");
    recorder.finish();
    CHECK(recorder.failure() == "only 98 MB of the disk left");
    CHECK(imagesIn(scratch.path() / "rec") == 2);
    recorder.start(scratch.path() / "next", "", someCamera());
    CHECK(recorder.failure().empty());
}
