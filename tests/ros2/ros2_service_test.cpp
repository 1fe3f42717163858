// SPDX-License-Identifier: Apache-2.0
// Services of a run.
#include "tests/ros2/client.h"
#include "tests/ros2/fed_run.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Services switch forces off, guidance and freezing, and answer each call to its own client") {
    FedRun run("/fathom,commands=on");
    Client off("/fathom/forces_off", "Trigger"), guidance("/fathom/guidance", "SetBool"),
        freeze("/fathom/freeze", "SetBool"), other("/fathom/freeze", "SetBool");
    CHECK_FALSE(run.observer().takeRequests().forcesOff);
    CHECK(off.call("") == "1 1 forces are switched off");
    CHECK(run.observer().takeRequests().forcesOff);
    CHECK(guidance.call("1") == "1 1 guidance is switched on");
    CHECK(run.observer().takeRequests().guidance == true);
    CHECK(guidance.call("0") == "2 1 guidance is switched off");
    CHECK(run.observer().takeRequests().guidance == false);
    CHECK(freeze.call("1") == "1 1 fixtures are frozen");
    CHECK(other.call("0") == "1 1 fixtures are released");
    const RemoteRequests asked = run.observer().takeRequests();
    CHECK(asked.frozen == false);
    CHECK_FALSE(asked.forcesOff);
    CHECK_FALSE(asked.guidance.has_value());
}

TEST_CASE("A request that ends within its header is skipped, and the next call is answered") {
    FedRun run("/fathom,commands=on");
    Client off("/fathom/forces_off", "Trigger");
    CHECK(off.call("short") == "ok");
    CHECK(off.call("") == "1 1 forces are switched off");
    CHECK(run.observer().takeRequests().forcesOff);
}
