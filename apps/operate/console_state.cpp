// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/console_state.h"

namespace fathom::operate {

namespace {

using nlohmann::json;

json marksOf(const TimeLine& line) {
    json times = json::array();
    for (const EventMark& mark : line.marks) {
        times.push_back(mark.t);
    }
    return times;
}

json orbitOf(const Orbit& orbit) {
    return {{"yaw", orbit.yaw}, {"pitch", orbit.pitch}, {"distance", orbit.distance}};
}

json timeLineOf(const TimeLine& line) {
    return {{"on", line.on},
            {"t", line.t},
            {"duration", line.duration},
            {"picture", line.frame},
            {"pictures", line.frames},
            {"playing", line.playing},
            {"marks", marksOf(line)},
            {"speed", line.speed},
            {"whole_memory", line.wholeMemory}};
}

json recordedOf(const Console& c) {
    return {{"seconds", c.status.recorded.seconds},
            {"bytes", c.status.recorded.bytes},
            {"left", c.status.recorded.left ? json(*c.status.recorded.left) : json(nullptr)}};
}

json pickedPartsOf(const Console& c) {
    return {{"only_clicked", c.pick.rules.onlyClicked},
            {"no_specks", c.pick.rules.noSpecks},
            {"parts", c.pick.found.parts},
            {"taken", c.pick.found.taken},
            {"specks", c.pick.found.specks},
            {"others", c.pick.found.others}};
}

} // namespace

nlohmann::json stateOf(const Console& c) {
    return {{"forces", c.switches.forces},
            {"guidance", c.switches.guidance},
            {"grasp", c.switches.grasp},
            {"panels", c.panels.haveKeys},
            {"frozen", c.switches.frozen},
            {"large", c.settings.spaceIsLarge ? "space" : "camera"},
            {"paused", c.panels.tracesPaused},
            {"recording", c.switches.recording},
            {"kept_s", c.status.keptSeconds},
            {"choices", c.openCard.on ? json(c.openCard.choices) : json::array()},
            {"recorded", recordedOf(c)},
            {"tree_level", c.settings.treeLevel},
            {"text_scale", c.settings.textScale},
            {"monitor_scale", c.status.monitorScale},
            {"drawn_scale", c.status.drawnScale},
            {"layout", c.settings.pilotLayout ? "pilot" : "engineer"},
            {"panel_open", c.panels.open},
            {"full_screen", c.settings.fullScreen},
            {"tab", static_cast<int>(c.panels.shownTab)},
            {"orbit", orbitOf(c.settings.orbit)},
            {"cursor", c.cursor ? json{c.cursor->x, c.cursor->y} : json(nullptr)},
            {"picking", c.pick.active},
            {"picked", c.pick.taken},
            {"pick_warnings", c.pick.warnings},
            {"pick_parts", pickedPartsOf(c)},
            {"renaming", c.editing.renamed},
            {"notice", c.messages.notice},
            {"tones", c.settings.tones},
            {"last_tone", c.status.lastTone},
            {"tone_count", c.status.toneCount},
            {"tooltip", c.messages.tooltip},
            {"shots", c.status.shots},
            {"asks_to_close", c.closing.stage == ClosingStage::Asks},
            {"time_line", timeLineOf(c.timeLine)},
            {"places", c.places}};
}

} // namespace fathom::operate
