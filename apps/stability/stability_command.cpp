// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/stability_command.h"

#include "apps/clock/clock_keeper.h"
#include "apps/output/output_folder.h"
#include "apps/stability/stability_plots.h"
#include "apps/stability/stability_report.h"
#include "engine/gpu/device.h"

#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

namespace fathom {

namespace {

struct StabilityOptions {
    std::vector<std::string> cases;
    std::filesystem::path out;
    bool brief = false;
    bool list = false;
};

struct ChosenDevice {
    gpu::Instance instance;
    gpu::Device device;
    ClockKeeper clock;
    explicit ChosenDevice(const GlobalOptions& global)
        : instance(global.validation())
        , device(instance, global.device)
        , clock(global, device.facts()) {}
};

void print(const stability::CaseResult& r) {
    std::cout << (r.outcome.holds() ? "holds  " : "BROKEN ") << std::left << std::setw(40) << r.name << " "
              << stability::comparison(r.outcome) << "  (" << std::setprecision(3) << r.seconds << " s)"
              << std::endl;
    if (!r.outcome.holds()) {
        std::cout << "       " << r.outcome.note << std::endl;
    }
}

int runStability(const StabilityOptions& options, const GlobalOptions& global) {
    std::optional<ChosenDevice> chosen;
    const stability::DeviceSource source = [&]() -> gpu::Device& {
        return (chosen ? *chosen : chosen.emplace(global)).device;
    };
    const auto cases = stability::chosenCases(stability::allCases(source), options.cases);
    if (options.list) {
        stability::listCases(std::cout, cases);
        return 0;
    }
    if (options.out.empty()) {
        throw CLI::RequiredError("--out");
    }
    const OutputLock lock(options.out);
    std::vector<stability::CaseResult> results;
    double seconds = 0.0;
    for (const stability::Case& one : cases) {
        results.push_back(stability::runCase(one, options.brief ? stability::RunLength::Short
                                                                : stability::RunLength::Full));
        seconds += results.back().seconds;
        print(results.back());
    }
    stability::writeReport(options.out, results, stability::deviceDescription(global.device));
    stability::writePlots(options.out, results);
    const bool holds = stability::allHold(results);
    std::cout << results.size() << " cases in " << seconds << " s, " << (holds ? "all hold" : "NOT all hold")
              << "; written to " << options.out.string() << std::endl;
    return holds ? 0 : 1;
}

} // namespace

void addStabilityCommand(CLI::App& app, const GlobalOptions& global, int& result) {
    auto options = std::make_shared<StabilityOptions>();
    CLI::App* command =
        app.add_subcommand("stability", "measure stiff and extreme cases against stated limits");
    command->add_option("CASE", options->cases, "cases or groups of cases, see --list (default: all)");
    command->add_flag("--short", options->brief, "run the shortened form of the tests, with the same limits");
    command->add_flag("--list", options->list, "list the chosen cases with their groups, and run none");
    command->add_option("--out", options->out,
                        "output folder; its files are replaced (required without --list)");
    command->callback([options, &global, &result] { result = runStability(*options, global); });
}

} // namespace fathom
