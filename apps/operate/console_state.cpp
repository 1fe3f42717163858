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

} // namespace

nlohmann::json stateOf(const Console& c) {
    return {{"forces", c.forces},
            {"guidance", c.guidance},
            {"grasp", c.grasp},
            {"panels", c.panels},
            {"frozen", c.frozen},
            {"large", c.spaceIsLarge ? "space" : "camera"},
            {"paused", c.paused},
            {"recording", c.recording},
            {"kept_s", c.keptSeconds},
            {"choices", c.openCard.on ? json(c.openCard.choices) : json::array()},
            {"recorded",
             {{"seconds", c.recorded.seconds},
              {"bytes", c.recorded.bytes},
              {"left", c.recorded.left ? json(*c.recorded.left) : json(nullptr)}}},
            {"tree_level", c.treeLevel},
            {"text_scale", c.textScale},
            {"monitor_scale", c.monitorScale},
            {"drawn_scale", c.drawnScale},
            {"layout", c.pilotLayout ? "pilot" : "engineer"},
            {"panel_open", c.panelOpen},
            {"full_screen", c.fullScreen},
            {"tab", static_cast<int>(c.shownTab)},
            {"orbit", orbitOf(c.orbit)},
            {"cursor", c.cursor ? json{c.cursor->x, c.cursor->y} : json(nullptr)},
            {"picking", c.pick.active},
            {"picked", c.pick.taken},
            {"pick_warnings", c.pick.warnings},
            {"pick_parts",
             {{"only_clicked", c.pick.rules.onlyClicked},
              {"no_specks", c.pick.rules.noSpecks},
              {"parts", c.pick.found.parts},
              {"taken", c.pick.found.taken},
              {"specks", c.pick.found.specks},
              {"others", c.pick.found.others}}},
            {"renaming", c.renamed},
            {"notice", c.notice},
            {"tones", c.tones},
            {"last_tone", c.lastTone},
            {"tone_count", c.toneCount},
            {"tooltip", c.tooltip},
            {"shots", c.shots},
            {"asks_to_close", c.closing == Closing::Asks},
            {"time_line", timeLineOf(c.timeLine)},
            {"places", c.places}};
}

} // namespace fathom::operate
