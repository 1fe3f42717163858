// SPDX-License-Identifier: Apache-2.0
#include "apps/inspect/inspect_command.h"

#include "apps/binding/open_recording.h"
#include "apps/binding/open_source.h"
#include "apps/inspect/frame_study.h"
#include "apps/inspect/stream_report.h"
#include "engine/scene/camera_limits.h"
#include "engine/types/log_once.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace fathom {

namespace {

void describe(const Camera& camera, std::ostream& out) {
    const CameraInfo& info = camera.info();
    out << "depth     " << lensText(info.depth) << "; " << info.metresPerUnit << " m per unit\n";
    if (info.hasColour) {
        const dvec3 t = info.colourTdepth.position;
        out << "colour    " << lensText(info.colour) << "; " << nameOf(info.colourFormat) << "; ";
        if (info.registered) {
            out << "registered to depth\n";
        } else {
            out << "by extrinsics, " << 1000.0 * glm::length(t) << " mm from depth\n";
        }
    }
}

// The source with the streams that are chosen, each named once.
std::string withStreams(const std::string& source, const Camera& camera) {
    const SourceOptions given = parseSource(source).options,
                        chosen = parseSource(camera.streamOptions()).options;
    const auto more = [](const char* key, const std::string& has, const std::string& wants) {
        return has.empty() && !wants.empty() ? key + wants : "";
    };
    return source + more(",depth=", given.depth, chosen.depth) +
           more(",colour=", given.colour, chosen.colour);
}

// One word of a shell.
std::string inShellQuotes(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return quoted + "'";
}

void inspect(const std::string& source, const std::optional<std::filesystem::path>& folder) {
    if (source.empty()) {
        throw BadInput("inspect", "SOURCE", "empty", "a recording or camera");
    }
    log::LoggedLines logged;
    const log::LogOnce once(logged);              // the source is opened twice
    if (const auto file = openMessages(source)) { // shown although the source may be rejected
        writeStreams(*file, parseSource(source).options.info, std::cout);
        std::cout << std::flush;
    }
    const std::unique_ptr<Camera> camera = openSource(source, Delivery::Newest);
    checkCamera(camera->info(), camera->description());
    std::cout << "source    " << source << "\n";
    std::cout << "taken     " << (camera->streams().empty() ? camera->description() : camera->streams())
              << "\n";
    describe(*camera, std::cout);
    FrameStudy(*camera, folder).write(std::cout);
    for (const std::string& warning : camera->warnings()) {
        std::cout << "warning   " << warning << "\n";
    }
    std::cout << "use       --source " << inShellQuotes(withStreams(source, *camera)) << "\n";
    if (folder) {
        std::cout << "written   " << folder->string() << "\n";
    }
}

} // namespace

void addInspectCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "inspect", "print what a recording or camera contains, and which streams Fathom uses");
    const auto source = std::make_shared<std::string>();
    const auto out = std::make_shared<std::string>();
    command->add_option("SOURCE", *source, "a recording or a live camera, as for --source")->required();
    command->add_option("--out", *out,
                        "folder for the first frame as depth.png and colour.png, and for histograms.png");
    command->callback([source, out] {
        inspect(*source, out->empty() ? std::nullopt : std::optional<std::filesystem::path>(*out));
    });
}

} // namespace fathom
