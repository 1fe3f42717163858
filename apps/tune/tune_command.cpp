// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_command.h"

#include "apps/binding/open_source.h"
#include "apps/number_option.h"
#include "apps/tune/tune_run.h"
#include "engine/types/error.h"

#include <memory>

namespace fathom {

namespace {

void checkRequest(const tune::Request& request) {
    if (request.error.has_value() == request.time.has_value()) {
        throw BadInput("tune", "--error, --time", request.error ? "both" : "neither",
                       "exactly one of the two");
    }
}

} // namespace

void addTuneCommand(CLI::App& app, const GlobalOptions& global, int& result) {
    auto settings = std::make_shared<tune::TuneSettings>();
    CLI::App* command = app.add_subcommand(
        "tune", "choose filter, memory, error budget, friction, reach and image size by measuring");
    command->add_option("SCENE", settings->scene, "scene file (YAML)")->required();
    command->add_option("--source", settings->source, kSourceHelp);
    command
        ->add_option("--error", settings->request.error,
                     "largest RMS error of the felt surface [mm]; the fastest settings within it are chosen; "
                     "one of --error and --time is required")
        ->check(numberIn(Range::between(1e-4, 1e3)));
    command
        ->add_option("--time", settings->request.time,
                     "longest time from camera to force [ms], p50; the most accurate settings within it are "
                     "chosen; one of --error and --time is required")
        ->check(numberIn(Range::between(1e-4, 1e5)));
    command->add_option("--frames", settings->frames, "frames per point (24)")->check(wholeNumberIn(8, 240));
    command->add_option("--limit", settings->limit, "measure for about this long at most [s] (120)")
        ->check(numberIn(Range::between(1.0, 1e5)));
    command->add_option("--out", settings->out, "output folder; its files are replaced")->required();
    command->callback([settings, &global, &result] {
        checkRequest(settings->request);
        result = tune::runTune(*settings, global);
    });
}

} // namespace fathom
