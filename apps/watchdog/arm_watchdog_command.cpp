// SPDX-License-Identifier: Apache-2.0
#include "apps/watchdog/arm_watchdog_command.h"

#include "apps/binding/arm_watchdog.h"
#include "apps/number_option.h"
#include "devices/serial/line_watchdog.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <CLI/CLI.hpp>
#include <csignal>
#include <memory>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom {

namespace {

void watchArm(const std::string& protocol) {
    using Protocol = SceneArm::Driver::Protocol;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
        std::signal(signal, SIG_IGN); // a signal to the whole group also ends the engine, which is when this
                                      // process is needed
    }
    int kind = 0;
    socklen_t size = sizeof kind;
    if (::getsockopt(kWatchdogEngine, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 ||
        ::isatty(kWatchdogLine) == 0) {
        throw BadInput(kArmWatchdogCommand, "started by", "a user", "this program, for a real arm");
    }
    const StandStill still = protocol == protocolName(Protocol::ReachAlpha5) ? reachStandStill()
                             : protocol == protocolName(Protocol::ReachBravo7)
                                 ? reachStandStill(ReachKind::Bravo7)
                                 : ecaStandStill();
    const int found = watchLine(kWatchdogEngine, kWatchdogLine, still);
    if (found > 0) {
        log::warn("arm watchdog: the engine ended or was silent for {} s, {} times: the arm was stopped",
                  LineWatchdog::kSilence, found);
    }
}

} // namespace

void addArmWatchdogCommand(CLI::App& app) {
    auto protocol = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand(kArmWatchdogCommand, "stop a real arm when the engine ends");
    command->group(""); // not in the help
    command->add_option("PROTOCOL", *protocol)
        ->required()
        ->check(wordIn({protocolName(SceneArm::Driver::Protocol::ReachAlpha5),
                        protocolName(SceneArm::Driver::Protocol::ReachBravo7),
                        protocolName(SceneArm::Driver::Protocol::Eca5e)}));
    command->callback([protocol] { watchArm(*protocol); });
}

} // namespace fathom
