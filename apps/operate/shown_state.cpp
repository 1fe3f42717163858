// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/shown_state.h"

#include "apps/operate/why_panel.h"
#include "engine/gpu/instance.h"

#include <imgui.h>

namespace fathom::operate {

StateExtras extrasOf(const ShownState& s) {
    StateExtras extras;
    extras.mode = modeOf(s.console, s.view).word;
    const Canvas::Counts counts = s.canvas.counts();
    extras.begun = static_cast<uint64_t>(ImGui::GetFrameCount());
    extras.windowFrames = counts.drawn;
    extras.yielded = counts.yielded;
    extras.swapchains = counts.swapchains;
    extras.deviceThere = s.canvas.isOpen() && !s.session.handover->gone();
    extras.renewals = s.session.cycles.renewals();
    const VkExtent2D size = s.window.size();
    extras.width = size.width;
    extras.height = size.height;
    extras.validationMessages = gpu::validationMessages();
    extras.unknownShare = s.screen.unknownShare();
    extras.alarms = s.alarms.inWords();
    extras.scene = &s.editor.scene();
    extras.shapes = s.editor.shapes().size();
    extras.selected = s.editor.selectedPoints();
    extras.stiffness = s.haptics.springs.stiffness;
    extras.forceLimit = s.haptics.forceLimit;
    extras.armHolds = armHolds(s.session.arm.get(), s.view.step().record);
    if (!s.view.blocks().empty()) {
        extras.why = whyBlocked(s.view.blocks().front(), s.editor.scene(), s.view.scene().set);
    }
    return extras;
}

} // namespace fathom::operate
