// SPDX-License-Identifier: Apache-2.0
// Bags that a program wrote after the recording: the stamps of headers are times, those of recording are not.
#include "devices/bag/stamped_stream.h"
#include "engine/types/colour_copy.h"
#include "tests/devices/played_bag.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

#include <functional>

using namespace fathom;
using namespace fathom::testing;
using testing::Listening;

namespace {

constexpr double kFrameStep = 0.033; // [s] between stamps

struct Written {
    int frames = 120;
    std::function<double(int)> depthAt, colourAt; // [s] of recording
    double colourLater = 0.0;                     // [s] in stamps
    int lostFrom = 0, lostTo = 0;                 // colour frames
    double setBack = 0.0;                         // [s] the clock of the stamps, in the middle
};

// Frame i has depth 500 + i and red 1 + i.
BagMaker writtenLater(const Written& written) {
    BagMaker maker;
    for (const char* topic : {"/c/depth/camera_info", "/c/rgb/camera_info"}) {
        maker.add(topic, "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    }
    for (int i = 0; i < written.frames; ++i) {
        const double t = 100.0 + kFrameStep * i - (2 * i < written.frames ? 0.0 : written.setBack);
        maker.add("/c/depth/image", "sensor_msgs/Image", written.depthAt(i),
                  imageMessage(t, depthImage(static_cast<uint16_t>(500 + i))));
        if (i < written.lostFrom || i >= written.lostTo) {
            const ImageMessage colour{.encoding = "rgb8",
                                      .pixels = filledColour(static_cast<uint8_t>(1 + i), 0, 0)};
            maker.add("/c/rgb/image", "sensor_msgs/Image", written.colourAt(i),
                      imageMessage(t + written.colourLater, colour));
        }
    }
    return maker;
}

// Number of frames that are played, each with its own colour and at its own time.
uint32_t playedWhole(BagCamera& camera) {
    uint32_t played = 0;
    while (const auto frame = camera.next()) {
        const uint32_t index = (*frame)->index;
        CHECK((*frame)->captureTime == doctest::Approx(100.0 + kFrameStep * index).epsilon(1e-9));
        CHECK((coloursOf(**frame)[0] & 0xff) == index + 1);
        ++played;
    }
    return played;
}

// Headers alone, whose reads are counted.
class CountedFile final : public MessageFile {
public:
    CountedFile(size_t messages, double recordedStep)
        : MessageFile("counted.bag") {
        topics_.push_back({"/depth", "sensor_msgs/Image", {}, false});
        for (size_t i = 0; i < messages; ++i) {
            topics_[0].messages.push_back(
                {static_cast<uint64_t>(1e12 + 1e9 * recordedStep * static_cast<double>(i)), 0, i});
        }
    }
    MessageBytes bytes(const MessageEntry& entry) override {
        ++read;
        const std::string header = stampedHeader(100.0 + kFrameStep * static_cast<double>(entry.offset), "c");
        return MessageBytes::of({header.begin(), header.end()});
    }
    size_t read = 0;
};

} // namespace

TEST_CASE("Images that a program wrote one topic after the other are paired by the stamps of their headers") {
    const TemporaryFolder folder;
    const auto at = [](double step, double from) { return [=](int i) { return 1000.0 + from + step * i; }; };
    const auto block = [](int later) {
        return [=](int i) {
            const int first = i / 40 * 80;
            return 1000.0 + 0.04 * (first + later + i % 40);
        };
    };
    for (const Written& written : {Written{.depthAt = at(0.01, 0.0), .colourAt = at(0.01, 1.2)},
                                   {.depthAt = at(0.001, 0.0), .colourAt = at(0.001, 0.12)},
                                   {.depthAt = at(0.033, 0.0), .colourAt = at(0.033, 4.0)},
                                   {.depthAt = at(0.0, 0.0), .colourAt = at(0.0, 0.0)},
                                   {.depthAt = block(0), .colourAt = block(40)}}) {
        const Listening log;
        BagCamera camera = playStreams(folder, writtenLater(written));
        CHECK(playedWhole(camera) == 120);
        CHECK(camera.skipped() == 0);
        CHECK(log.count("paired by the time of recording") == 0);
    }
}

TEST_CASE("Period, start and duration of a bag that was written faster or slower are those of its stamps") {
    const TemporaryFolder folder;
    for (const double step : {0.001, 0.3}) {
        const Written written{.depthAt = [=](int i) { return 1000.0 + step * i; },
                              .colourAt = [=](int i) { return 1000.0 + step * (i + 0.3); },
                              .colourLater = 0.01,
                              .lostFrom = 20,
                              .lostTo = 26};
        BagCamera camera = playStreams(folder, writtenLater(written));
        CHECK(playedWhole(camera) == 114);
        CHECK(camera.skipped() == 6); // no colour of another instant
        BagCamera part = playStreams(folder, writtenLater(written), {.start = 1.0, .duration = 1.0});
        CHECK(part.firstFrame() == 31);
        CHECK(playedWhole(part) == 30);
    }
}

TEST_CASE("Two clocks that differ by seconds are not taken for a file that was written later") {
    const TemporaryFolder folder;
    const Written written{.depthAt = [](int i) { return 1000.0 + kFrameStep * i; },
                          .colourAt = [](int i) { return 1000.005 + kFrameStep * i; },
                          .colourLater = 60 * kFrameStep};
    const Listening log;
    BagCamera camera = playStreams(folder, writtenLater(written));
    CHECK(log.count("paired by the time of recording") == 1);
    for (uint32_t i = 0; i < 120; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((coloursOf(**frame)[0] & 0xff) == i + 1);
    }
}

TEST_CASE("A duration without a depth image is named as such, not the start") {
    const TemporaryFolder folder;
    BagMaker maker;
    addStream(maker, "/c/depth/image_raw", depthImage(500));
    mentions(streamRefusal(folder, maker, {.start = 0.05, .duration = 0.02}),
             "duration: 0.020000 (allowed: a time with at least one depth image)");
    mentions(streamRefusal(folder, maker, {.start = 0.5, .duration = 0.02}),
             "start: 0.500000 (allowed: a time before the last depth image)");
}

TEST_CASE("A clock of a simulator that begins at 0 gives the times of frames") {
    const TemporaryFolder folder;
    BagMaker maker;
    maker.add("/c/depth/camera_info", "sensor_msgs/CameraInfo", 1.0, infoMessage({}));
    for (int i = 0; i < 4; ++i) {
        maker.add("/c/depth/image_raw", "sensor_msgs/Image", 1.0 + 0.04 * i,
                  imageMessage(0.1 * i, depthImage(500)));
    }
    BagCamera camera = playStreams(folder, maker);
    for (int i = 0; i < 4; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->captureTime == doctest::Approx(0.1 * i));
    }
}

TEST_CASE("Few headers of a long file are read to find its period and a message, in time or written later") {
    for (const double step : {kFrameStep, 0.002}) {
        CountedFile file(50'000, step);
        const MessageTopic& topic = file.topics()[0];
        StampedStream stream(file, topic);
        CHECK(stream.period() == doctest::Approx(kFrameStep));
        CHECK(stream.recordedInTime() == (step == kFrameStep));
        CHECK(file.read < 50);
        CHECK(stream.firstAfter(900.01) == 27'274);
        if (!stream.recordedInTime()) {
            stream.searchAll();
        }
        const size_t before = file.read;
        CHECK(stream.nearest(100.0 + kFrameStep * 40'000, topic.messages[40'000].time, 0.01) == 40'000);
        CHECK(file.read - before < 80);
    }
}

TEST_CASE("A bag whose clock was set back while it was recorded pairs and starts by the time of recording") {
    const TemporaryFolder folder;
    const auto inTime = [](int i) { return 1000.0 + kFrameStep * i; };
    const Written written{.depthAt = inTime, .colourAt = inTime, .setBack = 1.5};
    BagCamera camera = playStreams(folder, writtenLater(written));
    uint32_t played = 0;
    while (const auto frame = camera.next()) {
        CHECK((coloursOf(**frame)[0] & 0xff) == (*frame)->index + 1);
        ++played;
    }
    CHECK(played == 120);
    CHECK(playStreams(folder, writtenLater(written), {.start = 1.0}).firstFrame() == 31);
}

TEST_CASE("Colour that is recorded seconds late is paired by its stamps, where these are depth's own") {
    const TemporaryFolder folder;
    const auto at = [](double from) { return [=](int i) { return 1000.0 + from + kFrameStep * i; }; };
    for (const double late : {1.1, 2.0}) {
        const int unrecorded = static_cast<int>(late / kFrameStep); // the recorder stops at one time
        for (const Written& written : {Written{.depthAt = at(0.0), .colourAt = at(late)},
                                       {.depthAt = at(late), .colourAt = at(0.0)},
                                       {.frames = 250,
                                       .depthAt = at(0.0),
                                       .colourAt = at(late),
                                       .lostFrom = 250 - unrecorded,
                                       .lostTo = 250}}) {
            const Listening log;
            BagCamera camera = playStreams(folder, writtenLater(written));
            const auto lost = static_cast<uint32_t>(written.lostTo - written.lostFrom);
            CHECK(playedWhole(camera) == static_cast<uint32_t>(written.frames) - lost);
            CHECK(log.count("paired by the time of recording") == 0);
        }
    }
}

TEST_CASE("Stamps of a bag that count frames or are in another unit give way to the time of recording") {
    const TemporaryFolder folder;
    for (const double step : {1.0, 1000.0 * kFrameStep, 1e-6}) {
        BagMaker maker;
        for (const char* topic : {"/c/depth/camera_info", "/c/rgb/camera_info"}) {
            maker.add(topic, "sensor_msgs/CameraInfo", 1000.0, infoMessage({}));
        }
        for (int i = 0; i < 40; ++i) {
            const double at = 1000.0 + kFrameStep * i, stamp = 3.0 + step * i;
            maker.add("/c/depth/image", "sensor_msgs/Image", at, imageMessage(stamp, depthImage(500)));
            maker.add("/c/rgb/image", "sensor_msgs/Image", at, imageMessage(stamp, redImage()));
        }
        BagCamera camera = playStreams(folder, maker);
        REQUIRE(camera.warnings().size() == 1);
        mentions(camera.warnings()[0], "/c/depth/image: its stamps are no seconds");
        double last = 0.0;
        uint32_t played = 0;
        for (; const auto frame = camera.next(); ++played) {
            CHECK((last == 0.0 || (*frame)->captureTime - last == doctest::Approx(kFrameStep)));
            last = (*frame)->captureTime;
        }
        CHECK(played == 40);
    }
}
