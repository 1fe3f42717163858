// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/why_panel.h"

#include "apps/binding/scene_edits.h"
#include "apps/operate/theme.h"
#include "engine/types/printed.h"

namespace fathom::operate {

namespace {

std::string obstacle(const Block& block, const Scene& scene, const HostFixtures& set) {
    const Touch& touch = block.touch;
    const std::string name = touch.fixture < scene.fixtures.size() && !isSpare(scene.fixtures[touch.fixture])
                                 ? "'" + scene.fixtures[touch.fixture].name + "'"
                                 : "a removed fixture";
    switch (touch.kind) {
    case ContactRow::Kind::Sphere: {
        const uint32_t width = std::max(1u, set.camera.depth.width),
                       pixels = std::max(1u, set.camera.depth.pixels());
        const uint32_t pixel = touch.source % pixels;
        const char* kept = touch.source >= 2 * pixels ? "), frozen" // FrozenClasses' range
                           : touch.source >= pixels   ? "), held: not seen now"
                                                      : ")";
        return name + ", region sphere of pixel (" + std::to_string(pixel % width) + ", " +
               std::to_string(pixel / width) + kept;
    }
    case ContactRow::Kind::Shape:
        return name + ", a placed shape";
    case ContactRow::Kind::Equality:
        return name + ", a line to slide along";
    case ContactRow::Kind::Behind:
        return "the visible surface: the tool is behind it";
    case ContactRow::Kind::Joint:
        break; // joint limits are not listed as contacts
    }
    return name;
}

} // namespace

std::string whyBlocked(const Block& block, const Scene& scene, const HostFixtures& set) {
    return obstacle(block, scene, set) +
           printed(": tool sphere %u stopped; the hand is %.1f mm beyond (at most %.1f), %.2f N, since frame "
                   "%lld (%.2f s)",
                   block.touch.leaf, block.beyond * 1e3, block.deepest * 1e3, block.force,
                   static_cast<long long>(block.sinceFrame), block.since);
}

void drawWhy(const RunView& run, const Scene& scene, const std::vector<std::string>& armHolds) {
    constexpr double kNow = 0.1; // [s]
    const double now = run.step().record.t;
    if (run.step().record.state == StepState::Trapped) {
        ImGui::TextColored(ImColor(colour::kWarning), "Trapped: no motion satisfies every region.");
    }
    if (run.step().record.stalled) {
        ImGui::TextColored(ImColor(colour::kCaution),
                           "The tool moves fast: waiting for the next contact set.");
    }
    for (const std::string& hold : armHolds) {
        ImGui::TextColored(ImColor(colour::kCaution), "NOW  the arm: %s", hold.c_str());
    }
    if (run.blocks().empty()) {
        ImGui::TextDisabled("Nothing has stopped the tool yet.");
    }
    for (const Block& block : run.blocks()) {
        const bool active = now - block.last < kNow;
        colouredText(active ? colour::kTouch : colour::kQuiet,
                     ((active ? "NOW  " : "over ") + whyBlocked(block, scene, run.scene().set)).c_str());
    }
}

} // namespace fathom::operate
