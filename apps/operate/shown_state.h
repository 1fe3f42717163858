// SPDX-License-Identifier: Apache-2.0
// The state that a live run and playback both write to --state.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/canvas.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/screen.h"
#include "apps/operate/state_log.h"
#include "apps/session/session.h"

namespace fathom::operate {

// The objects whose state is written; all outlive the call.
struct ShownState {
    const Console& console;
    const RunView& view;
    const Session& session;
    const Window& window;
    const Canvas& canvas;
    const Screen& screen;
    const Alarms& alarms;
    const FixtureEditor& editor;
    const HapticOptions& haptics;
};

StateExtras extrasOf(const ShownState& shown);

} // namespace fathom::operate
