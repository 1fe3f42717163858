// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/convert_command.h"

#include "apps/binding/open_source.h"
#include "apps/binding/stop_signals.h"
#include "apps/convert/mcap_recording.h"
#include "apps/convert/tum_folder.h"
#include "apps/output/output_folder.h"
#include "apps/output/progress.h"
#include "engine/scene/camera_limits.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <CLI/CLI.hpp>
#include <atomic>
#include <iostream>
#include <memory>

namespace fathom {

namespace {

struct ConvertOptions {
    std::string source, out, format = "tum", replay;
};

std::unique_ptr<FrameSink> openSink(const ConvertOptions& options, const Camera& camera) {
    const std::filesystem::path out = options.out;
    if (options.format == "tum") {
        return std::make_unique<TumFolder>(out, camera.info());
    }
    auto recording = std::make_unique<McapRecording>(out / "recording.mcap", camera.info());
    if (!options.replay.empty()) {
        recording->addReplay(options.replay, camera.frameCount());
    }
    return recording;
}

void check(const ConvertOptions& options) {
    if (options.format != "tum" && options.format != "mcap") {
        throw BadInput("convert", "--format", options.format, "tum, mcap");
    }
    if (!options.replay.empty() && options.format != "mcap") {
        throw BadInput("convert", "--replay", options.replay, "with --format mcap");
    }
}

// Returns the number of frames: all, or at least one after a signal.
uint64_t convertFrames(Camera& camera, FrameSink& sink, const std::atomic<bool>& stop) {
    uint64_t frames = 0;
    const uint64_t first = camera.firstFrame(), end = camera.frameCount();
    Progress progress;
    bool ended = false;
    for (auto frame = camera.next(); frame; frame = camera.next()) {
        ended = frames > 0 && stop.load();
        if (ended) {
            break;
        }
        sink.add(*frame);
        ++frames;
        progress.update({.framesDone = (*frame)->index + 1 - first,
                         .framesTotal = end > first ? end - first : 0,
                         .framesOnly = true});
    }
    progress.finish();
    if (ended) {
        log::warn("convert: ended by a signal after {} frames", frames);
    }
    return frames;
}

void convert(const ConvertOptions& options) {
    check(options);
    const auto camera = openSource(options.source, Delivery::Every);
    if (camera->live()) {
        throw BadInput("convert", "SOURCE", options.source,
                       "a recording; 'record' makes one of a live camera");
    }
    checkCamera(camera->info(), camera->description());
    const StopSignals signals; // until the files are complete
    const OutputLock lock(options.out);
    const std::unique_ptr<FrameSink> sink = openSink(options, *camera);
    const uint64_t frames = convertFrames(*camera, *sink, signals.requested());
    sink->finish();
    std::cout << "converted    " << frames << " frames, " << camera->skipped() << " skipped\n"
              << "from         " << (camera->streams().empty() ? camera->description() : camera->streams())
              << "\nwritten to   " << options.out << (options.format == "mcap" ? "/recording.mcap" : "")
              << "\n";
}

} // namespace

void addConvertCommand(CLI::App& app) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = app.add_subcommand("convert", "write a recording as a TUM RGB-D folder or as MCAP");
    command->add_option("SOURCE", options->source, "a recording, as for --source")->required();
    command->add_option("--out", options->out, "folder of the result; must not contain a recording yet")
        ->required();
    command->add_option("--format", options->format,
                        "tum: a folder of PNG images (default); mcap: recording.mcap with messages of ROS 2");
    command->add_option(
        "--replay", options->replay,
        "folder of 'replay --out' of this source: adds wrench, poses and regions to the MCAP");
    command->callback([options] { convert(*options); });
}

} // namespace fathom
