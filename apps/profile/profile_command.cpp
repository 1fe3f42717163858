// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/profile_command.h"

#include "apps/clock/clock_keeper.h"
#include "apps/output/output_folder.h"
#include "apps/profile/profile_trace.h"
#include "apps/profile/report.h"
#include "apps/profile/studies.h"
#include "apps/profile/study_plot.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/suggestion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <iostream>
#include <iterator>
#include <memory>

namespace fathom {

namespace {

using namespace profile;

std::string studyNames() {
    return joined(allStudies(), &StudyEntry::name);
}

void checkNames(const Settings& settings) {
    for (const std::string& name : settings.studies) {
        const auto named = [&](const StudyEntry& entry) { return name == entry.name; };
        if (std::ranges::none_of(allStudies(), named)) {
            if (name == "peers") {
                throw BadInput("profile", "STUDY", "'peers' is not in this build",
                               "a build with -DFATHOM_PEERS=ON, which './run peers' makes and runs");
            }
            std::vector<std::string_view> names;
            std::ranges::transform(allStudies(), std::back_inserter(names), &StudyEntry::name);
            throw BadInput("profile", "STUDY", "'" + name + "'" + suggestion(name, names), studyNames());
        }
    }
}

// Before folder and device are opened.
void checkSource(const std::filesystem::path& source) {
    if (source.empty() || std::filesystem::is_directory(source)) {
        return;
    }
    const std::string text = source.string();
    const bool options = std::filesystem::exists(text.substr(0, text.find(',')));
    throw BadInput(text, "--source",
                   std::filesystem::exists(source) ? "a file"
                   : options                       ? "options after a comma"
                                                   : "missing",
                   "a recording folder (TUM RGB-D) alone; 'fathom convert' makes one of other recordings");
}

bool wanted(const Settings& settings, const std::string& name) {
    return settings.studies.empty() || std::ranges::find(settings.studies, name) != settings.studies.end();
}

// The command that produced the files, to reproduce a table. Shows only the last part of folder names.
std::string commandOf(const Settings& settings, const GlobalOptions& global) {
    std::string command = "fathom";
    command += global.device.empty() ? "" : " --device " + global.device;
    command += global.holdClock ? " --hold-clock" : "";
    command += " profile";
    for (const std::string& name : settings.studies) {
        command += " " + name;
    }
    command += settings.source.empty() ? "" : " --source " + settings.source.filename().string();
    command += settings.scene.empty() ? "" : " --scene " + settings.scene.filename().string();
    return command + (settings.quick ? " --quick" : "") + " --out DIR";
}

std::string subtitleOf(const Facts& facts) {
    std::string text;
    for (const auto& [name, value] : facts) {
        if (name == "device" || name == "driver" || name == "host_cpu") {
            text += (text.empty() ? "" : " · ") + value;
        }
    }
    return text;
}

void writeStudy(const Study& study, const Facts& facts, const std::filesystem::path& folder) {
    writeStudyCsv(study, folder / (study.name + ".csv"));
    studyPlot(study, subtitleOf(facts)).writePng(folder / (study.name + ".png"));
    std::cout << study.name << ": " << study.rows.size() << " settings, verified: " << study.verified << "\n"
              << "  measured: " << study.served << "\n";
    for (const std::string& finding : study.findings) {
        std::cout << "  " << finding << "\n";
    }
    std::cout.flush();
}

void runProfile(const Settings& settings, const GlobalOptions& global) {
    checkNames(settings);
    checkSource(settings.source);
    const OutputLock lock(settings.out);
    const gpu::Instance instance(global.validation());
    gpu::Device device(instance, global.device);
    ClockKeeper clock(global, device.facts());
    const bool held = clock.held();
    const StudyContext context{device, settings};
    const auto began = Clock::now();
    Facts facts = runFacts(device, settings, commandOf(settings, global));
    if (!global.trace.empty()) { // first, because its file may turn out not to be writable
        writeTimeLine(context, global.trace);
    }
    std::vector<Study> studies;
    for (const StudyEntry& entry : allStudies()) {
        if (wanted(settings, entry.name)) {
            studies.push_back(entry.run(context));
            studies.back().served = servedBy(entry.name, settings);
            writeStudy(studies.back(), facts, settings.out);
        }
    }
    const RunTime time{secondsSince(began), static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
    if (global.holdClock) {
        facts.emplace_back("clock", !held          ? "as the driver sees fit"
                                    : clock.held() ? "held"
                                                   : "held at first");
    }
    writeProfileJson(facts, studies, time, settings.out / "profile.json");
    writeReportHtml(facts, studies, settings.out);
    std::cout << "took " << digits(time.wall) << " s; written to " << settings.out.string() << "\n";
}

} // namespace

void addProfileCommand(CLI::App& app, const GlobalOptions& global) {
    auto settings = std::make_shared<Settings>();
    CLI::App* command = app.add_subcommand("profile", "measure error against run time");
    command->add_option("STUDY", settings->studies, "studies to run (" + studyNames() + "); default: all");
    command->add_option("--source", settings->source, "recording folder instead of the analytic scenes");
    command->add_option("--scene", settings->scene,
                        "scene file instead of the built-in classes and settings");
    command->add_flag("--quick", settings->quick,
                      "few settings, small frames, few repeats: under two minutes");
    command->add_option("--out", settings->out, "output folder; its files are replaced")->required();
    command->callback([settings, &global] { runProfile(*settings, global); });
}

} // namespace fathom
