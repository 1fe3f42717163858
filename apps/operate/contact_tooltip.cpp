// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/contact_tooltip.h"

#include "apps/operate/theme.h"
#include "apps/operate/why_panel.h"
#include "apps/output/silhouette.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::operate {

namespace {

constexpr float kNear = 18.0f;   // [pixels] mouse distance from a contact point
constexpr double kLasting = 0.1; // [s] since the last tick in which it stopped the tool

// The region sphere of a contact; shapes and surfaces are drawn anyway.
std::optional<Sphere> regionOf(const Touch& touch, const HostFixtures& set) {
    if (touch.kind != ContactRow::Kind::Sphere) {
        return std::nullopt;
    }
    const auto& sources = set.spheres.source;
    const auto at = std::find(sources.begin(), sources.end(), touch.source);
    if (at == sources.end()) {
        return std::nullopt;
    }
    const auto i = static_cast<size_t>(at - sources.begin());
    return Sphere{regionCentre(set, i), double{set.spheres.radius[i]}};
}

float pixelsBetween(ImVec2 a, ImVec2 b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

// The block whose contact is nearest to the mouse; null when none is near.
const Block* blockAt(const MarksInput& input, ImVec2 mouse) {
    const Block* best = nullptr;
    float least = kNear;
    for (const Block& block : input.run.blocks()) {
        const auto at = input.port.of(block.touch.point);
        const bool lasts = input.run.step().record.t - block.last < kLasting;
        if (at && lasts && pixelsBetween(*at, mouse) < least) {
            least = pixelsBetween(*at, mouse);
            best = &block;
        }
    }
    return best;
}

void drawRegion(ImDrawList& list, const MarksInput& input, const Touch& touch) {
    const auto sphere = regionOf(touch, input.run.scene().set);
    const auto at = sphere ? input.port.of(sphere->centre) : std::nullopt;
    if (!at) {
        return;
    }
    const double z = input.port.view.cameraTbase.apply(sphere->centre).z;
    const auto radius = static_cast<float>(sphere->radius / input.port.metresPerPixel(z));
    list.AddCircleFilled(*at, radius, IM_COL32(255, 236, 120, 40), 64);
    list.AddCircle(*at, radius, colour::kTouch, 64, 2.0f);
    list.AddCircleFilled(*at, 3.0f, colour::kTouch);
}

} // namespace

void drawContactTooltip(Console& console, ImDrawList& list, const MarksInput& input) {
    console.messages.contact.clear();
    console.places.erase("contact");
    if (!input.run.blocks().empty()) {
        const auto at = input.port.of(input.run.blocks().front().touch.point);
        if (at) {
            markPlace(console, "contact", {at->x - 2.0f, at->y - 2.0f}, {4.0f, 4.0f});
        }
    }
    const ImGuiIO& io = ImGui::GetIO();
    const bool held = ImGui::IsMouseDown(0) || ImGui::IsMouseDown(1);
    const Block* block =
        io.WantCaptureMouse || held || !input.port.holds(io.MousePos) ? nullptr : blockAt(input, io.MousePos);
    if (block == nullptr) {
        return;
    }
    console.messages.contact = whyBlocked(*block, input.scene, input.run.scene().set);
    drawRegion(list, input, block->touch);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(340.0f * console.scale());
    ImGui::TextColored(ImColor(colour::kTouch), "Stops the tool");
    ImGui::TextUnformatted(console.messages.contact.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

} // namespace fathom::operate
