// SPDX-License-Identifier: Apache-2.0
#include "apps/record/record_command.h"

#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/stop_signals.h"
#include "apps/number_option.h"
#include "apps/output/output_folder.h"
#include "apps/record/hand_log.h"
#include "devices/recorded/recording_writer.h"
#include "engine/types/error.h"

#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

namespace fathom {

namespace {

struct RecordOptions {
    std::string scene, source, out, handDevice;
    double seconds = 0.0; // 0 = until the source ends or a signal
};

// Records frames until the source ends, `seconds` have passed on its own clock, or a signal.
double copyFrames(Camera& camera, RecordingWriter& writer, HandLog* hand, double seconds,
                  const std::atomic<bool>& stop) {
    std::optional<double> first;
    double last = 0.0;
    while (!stop.load()) {
        const std::optional<Frame> frame = camera.next();
        if (!frame) {
            break;
        }
        first = first.value_or((*frame)->captureTime);
        if (seconds > 0.0 && (*frame)->captureTime - *first >= seconds) {
            break;
        }
        writer.add(*frame);
        if (hand != nullptr) {
            hand->frame((*frame)->captureTime);
        }
        last = (*frame)->captureTime;
    }
    return first ? last - *first : 0.0;
}

// A live hand needs live frames: otherwise they have no common clock.
std::unique_ptr<LiveHand> openHand(const RecordOptions& options, Scene scene, const Camera& camera) {
    if (options.handDevice.empty()) {
        return nullptr;
    }
    if (!camera.live()) {
        throw BadInput("record", "--hand-device", camera.description(),
                       "a live camera, because the hand is live");
    }
    return openLiveHand(options.handDevice, scene);
}

void printRecorded(const RecordOptions& options, const Camera& camera, const HandLog* hand, uint32_t frames,
                   double length) {
    if (hand != nullptr) {
        std::cout << "hand         " << hand->samples() << " readings of " << hand->hand().description()
                  << " in hand.csv\n";
    }
    std::cout << std::setprecision(4) << "recorded     " << frames << " frames in " << length << " s, "
              << camera.skipped() << " skipped, " << camera.lost() << " lost\n"
              << "from         " << camera.description() << "\nwritten to   " << options.out << "\n";
}

int runRecord(const RecordOptions& options) {
    const Scene scene = openScene(options.scene);
    const auto camera = openCamera(
        scene, options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source),
        Delivery::Every);
    const StopSignals signals;
    std::unique_ptr<LiveHand> device = openHand(options, scene, *camera);
    const OutputLock lock(options.out);
    RecordingWriter writer(options.out, camera->info(), 2);
    std::unique_ptr<HandLog> hand;
    if (device) {
        hand = std::make_unique<HandLog>(std::move(device), std::filesystem::path(options.out) / "hand.csv");
    }
    double length = 0.0;
    std::string gone;
    try {
        length = copyFrames(*camera, writer, hand.get(), options.seconds, signals.requested());
    } catch (const DeviceLost& e) {
        gone = e.what(); // frames up to then are kept
    }
    writer.finish();
    if (hand) {
        hand->finish();
    }
    if (writer.frames() > 0) {
        printRecorded(options, *camera, hand.get(), writer.frames(), length);
    }
    if (!gone.empty()) {
        throw DeviceLost(gone);
    }
    if (writer.frames() == 0) {
        throw BadInput(camera->description(), "frames", "none usable", "at least one usable frame");
    }
    if (camera->lost() > 0) {
        std::cerr << "fathom: record: " << camera->lost() << " frames lost: disk or processor too slow\n";
        return 1;
    }
    return 0;
}

} // namespace

void addRecordCommand(CLI::App& app, int& result) {
    auto options = std::make_shared<RecordOptions>();
    CLI::App* command = app.add_subcommand("record", "record the frames of the scene's camera for replay");
    command->add_option("SCENE", options->scene, "scene file (YAML)")->required();
    command->add_option("--source", options->source, kSourceHelp);
    command->add_option("--hand-device", options->handDevice,
                        "also record a live hand as hand.csv, for replay --operator; it gets no forces");
    command
        ->add_option("--seconds", options->seconds,
                     "end after this time [s]; default: until the source ends or Ctrl-C")
        ->check(numberIn(Range::between(0.001, 604800.0)));
    command->add_option("--out", options->out, "folder of the recording; must not contain one yet")
        ->required();
    command->callback([options, &result] { result = runRecord(*options); });
}

} // namespace fathom
