// SPDX-License-Identifier: Apache-2.0
#include "apps/latency/latency_command.h"

#include "apps/binding/open_source.h"
#include "apps/binding/stop_signals.h"
#include "apps/latency/latency_report.h"
#include "apps/latency/latency_run.h"
#include "apps/number_option.h"
#include "apps/output/try_output.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <utility>

namespace fathom {

namespace {

struct Request {
    LatencyOptions run;
    std::vector<std::string> loads;
    double soakMinutes = 0.0;
    bool secondsGiven = false;
    std::string out;
};

// Before the parts, which may take hours.
void check(const Request& request) {
    if (request.soakMinutes > 0.0 && (!request.loads.empty() || request.secondsGiven)) {
        throw BadInput("latency", request.secondsGiven ? "--seconds" : "--load", "given with --soak",
                       "none: a soak is one part with frames, of its own length");
    }
    noteInput(request.run.scene); // both are read after this check
    noteInput(request.run.source);
    tryOutput("latency", "--out", request.out);
}

// A signal ends the current part and skips the others. A part that it left without a tick is dropped.
std::vector<LatencyPart> measureParts(LatencyRun& run, const std::vector<std::string>& loads,
                                      const std::atomic<bool>& stop) {
    std::vector<LatencyPart> parts;
    size_t whole = 0;
    for (const std::string& load : loads) {
        if (stop.load()) {
            break;
        }
        LatencyPart part = load == "idle" ? run.idle() : load == "frames" ? run.frames() : run.window();
        whole += stop.load() ? 0 : 1;
        if (part.tick.count() > 0 || !stop.load()) {
            parts.push_back(std::move(part));
            printLatency(std::cout, parts.back());
            std::cout.flush();
        }
    }
    if (stop.load()) {
        log::warn("latency: ended by a signal, {} of {} parts are whole{}", whole, loads.size(),
                  parts.empty() ? ": no report" : "");
    }
    return parts;
}

int measure(const Request& request, const GlobalOptions& global, const WindowLoad& windowLoad) {
    check(request);
    const StopSignals signals;
    LatencyOptions options = request.run;
    std::vector<std::string> loads = request.loads;
    if (request.soakMinutes > 0.0) {
        options.seconds = request.soakMinutes * 60.0;
        loads = {"frames"};
    } else if (loads.empty()) {
        loads = {"idle", "frames", "window"};
    }
    LatencyRun run(options, global, windowLoad, signals.requested());
    std::cout << "rate         " << run.rateHz() << " ticks per second, " << options.seconds
              << " s per part; " << run.placement() << "\nframes       30 per second on " << run.device()
              << "\n";
    const std::vector<LatencyPart> parts = measureParts(run, loads, signals.requested());
    if (!parts.empty()) {
        printHistograms(std::cout, parts);
    }
    if (!parts.empty() && !request.out.empty()) {
        writeLatency(request.out, parts, run.rateHz(), run.device(), signals.requested().load());
    }
    if (request.soakMinutes > 0.0) {
        const bool holds = !parts.empty() && soakHolds(parts.back(), options.seconds);
        std::cout << "soak         " << (holds ? "kept" : "MISSED") << ": asked are "
                  << printed("%.1f", options.seconds)
                  << " s, no frame or record lost, memory grown by at most " << kMaxGrowth << " MiB\n";
        return holds ? 0 : 1;
    }
    return parts.empty() ? 1 : 0;
}

} // namespace

void addLatencyCommand(CLI::App& app, const GlobalOptions& global, WindowLoad windowLoad, int& result) {
    auto request = std::make_shared<Request>();
    CLI::App* command =
        app.add_subcommand("latency", "measure how late the haptic thread wakes, and how long a step takes");
    command->add_option("SCENE", request->run.scene, "scene file (YAML)")->required();
    command->add_option("--source", request->run.source, kSourceHelp);
    command->add_option("--seconds", request->run.seconds, "length of each part [s] (10)")
        ->check(numberIn(Range::between(0.5, 86400.0)));
    command->add_option("--load", request->loads, "idle, frames or window; may be repeated (default: all)")
        ->check(wordIn({"idle", "frames", "window"}));
    command
        ->add_option("--soak", request->soakMinutes,
                     "one run of this many minutes with frames; fails if a frame is lost or memory grows")
        ->check(numberIn(Range::between(0.01, 1440.0)));
    command->add_option("--out", request->out, "write the report as JSON, with all non-empty histogram bins");
    command->callback([request, command, &global, &result, windowLoad = std::move(windowLoad)] {
        request->secondsGiven = command->count("--seconds") > 0;
        result = measure(*request, global, windowLoad);
    });
}

} // namespace fathom
