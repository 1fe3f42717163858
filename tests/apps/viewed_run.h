// SPDX-License-Identifier: Apache-2.0
// The window's view of a run whose ticks the test makes.
#pragma once

#include "apps/operate/alarms.h"

#include <string>
#include <vector>

namespace fathom::operate {

struct NoSink final : RunSink {
    void frame(const PublishedFrame&, const HostFixtures&) override {}
    void query(const QueryNote&) override {}
    void step(const TickRow&, const ObeyedSet&) override {}
};

// A run with ticks made by the test.
struct ViewedRun {
    TickRow row;
    NoSink nothing;
    SnapshotSink sink{nothing};
    RunView view{sink};
    Alarms alarms;
    Console console;
    HapticOptions haptics;
    Scene scene;

    ViewedRun() {
        row.record.finite = true;
        row.record.sceneAge = 0.0;
        row.record.state = StepState::Free;
        row.record.marginPassive = 1.0;
    }
    void step(double dt) {
        row.record.t += dt;
        view.take(row);
    }
    void touch(uint32_t leaf, double beyond) {
        row.record.touchCount = 1;
        row.record.touches[0] = {};
        row.record.touches[0].fixture = 0;
        row.record.touches[0].leaf = leaf;
        row.record.touches[0].normal = {0.0, 0.0, -1.0};
        row.record.device.position = {0.0, 0.0, beyond};
        step(0.001);
    }
    // A tick of the run and a frame of the window.
    std::vector<std::string> step(const Health& health = {}) {
        step(0.001);
        alarms.step(console, view, haptics, scene, health);
        return alarms.inWords();
    }
};

} // namespace fathom::operate
