// SPDX-License-Identifier: Apache-2.0
// What a replay in lockstep and one in real time are both built from.
#pragma once

#include "apps/replay/replay_command.h"
#include "apps/replay/replay_recorder.h"
#include "apps/replay/tool_audit.h"
#include "apps/session/session.h"
#include "engine/contact/shapes.h"
#include "engine/cycle/haptic_cycle.h"
#include "engine/cycle/start_notes.h"

#include <optional>
#include <vector>

namespace fathom {

// Session, options and recorder must outlive it.
class ReplayParts {
protected:
    ReplayParts(Session& session, const ReplayOptions& options, ReplayRecorder& recorder)
        : session_(session)
        , options_(options)
        , recorder_(recorder)
        , shapes_(shapesOf(session.scene))
        , haptics_(makeHapticOptions(session.scene, session.tool))
        , audit_(session.tool, session.arm.get()) {}

    // hand: its first raw pose. tool0: where the tool starts; null = where the hand commands it.
    void makeCycle(const Pose& hand, const Pose* tool0) {
        cycle_.emplace(session_.tool, shapes_, haptics_, hand, tool0, session_.arm.get());
        warnOfStart(session_.scene, session_.tool, session_.arm.get(), cycle_->place());
    }

    Session& session_;
    const ReplayOptions& options_;
    ReplayRecorder& recorder_;
    std::vector<Shape> shapes_;
    HapticOptions haptics_;
    std::optional<HapticCycle> cycle_; // built when the path is known
    ToolAudit audit_;
};

} // namespace fathom
