// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/view_marks.h"

#include "apps/binding/scene_edits.h"
#include "apps/operate/shape_marks.h"
#include "apps/operate/theme.h"
#include "apps/operate/view_lines.h"
#include "engine/types/angle.h"
#include "engine/types/printed.h"

#include <cmath>

namespace fathom::operate {

namespace {

// The rectangle behind words.
ImVec4 plateOf(ImVec2 at, const std::string& words) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    return {at.x - 4.0f, at.y - 2.0f, at.x + size.x + 4.0f, at.y + size.y + 2.0f};
}

// `at`, or below the plate of other words where the two would overlap.
ImVec2 besideWords(ImVec2 at, const std::string& words, const ImVec4& taken) {
    const ImVec4 plate = plateOf(at, words);
    const bool overlaps = plate.x < taken.z && plate.z > taken.x && plate.y < taken.w && plate.w > taken.y;
    return overlaps ? ImVec2{at.x, taken.w + 4.0f} : at;
}

// The spheres of a small tool, where nothing hides them.
void leavesAt(ImDrawList& list, const MarksInput& input) {
    if (input.tool.leafCount() > 96 || !input.arm.empty()) {
        return;
    }
    for (const Sphere& leaf : input.cues.tool) {
        const auto at = input.port.of(leaf.centre);
        const double z = input.port.view.cameraTbase.apply(leaf.centre).z;
        const double under = at ? input.surface(input.port.toImage(*at)) : 0.0;
        if (at && (under == 0.0 || under > z)) {
            const auto r = static_cast<float>(leaf.radius / input.port.metresPerPixel(z));
            list.AddCircleFilled(*at, r, IM_COL32(235, 240, 248, 46));
            list.AddCircle(*at, r, IM_COL32(255, 255, 255, 96), 0, 1.0f);
        }
    }
}

// Where the hand is.
void ghostAt(ImDrawList& list, const MarksInput& input) {
    std::vector<Sphere> spheres;
    for (const Sphere& leaf : input.tool.leaves()) {
        spheres.push_back({input.run.step().record.device.apply(leaf.centre), leaf.radius});
    }
    outline(list, input.port, outlineOf(input.port.view, spheres), IM_COL32(190, 204, 224, 230), 2.0f, true);
}

// The hidden share of the arm's outline; 0 without an arm.
double armAt(ImDrawList& list, const MarksInput& input) {
    return input.arm.empty()
               ? 0.0
               : drawBody(list, input.port, input.arm, input.surface, IM_COL32(150, 196, 235, 235), 2.0f);
}

// The hidden share of the tool's outline.
double toolAt(ImDrawList& list, const MarksInput& input) {
    leavesAt(list, input);
    std::vector<Sphere> spheres;
    for (const Sphere& leaf : input.tool.leaves()) {
        spheres.push_back({input.run.step().record.tool.apply(leaf.centre), leaf.radius});
    }
    return drawBody(list, input.port, spheres, input.surface, colour::kTool, 2.0f);
}

// A real arm that is off its setpoint; grey when the last measurement is old.
void measuredAt(ImDrawList& list, const MarksInput& input) {
    const ShownArm& measured = input.measured;
    if (!measured.isOff()) {
        return;
    }
    const ImU32 colour = measured.known ? colour::kMeasured : colour::kQuiet;
    outline(list, input.port, outlineOf(input.port.view, measured.spheres), colour, 2.0f, true);
    const auto tip = input.port.of(measured.tip), tool = input.port.of(input.run.step().record.tool.position);
    if (!tip || !tool) {
        return;
    }
    dashed(list, *tip, *tool, colour, 1.4f, 4.0f);
    if (input.names) {
        const std::string text = measured.known ? printed("arm measured, %.0f mm off", measured.apart * 1e3)
                                                : printed("arm, last measured %.1f s ago", measured.age);
        const float right = static_cast<float>(input.port.where.x + input.port.where.width);
        const float room = right - ImGui::CalcTextSize(text.c_str()).x - 6.0f;
        drawWords(list, {std::min(tip->x + 12.0f, room), tip->y + 34.0f}, text, colour);
    }
}

void guidanceAt(ImDrawList& list, const MarksInput& input, const GuidancePose& guidance, bool active) {
    const auto at = input.port.of(guidance.position);
    if (!at) {
        return;
    }
    const ImU32 colour = active ? colour::kGuidance : IM_COL32(64, 153, 255, 130);
    if (guidance.planar) {
        const dvec3 n = guidance.normal;
        const dvec3 a = glm::normalize(glm::cross(std::abs(n.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), n));
        const dvec3 b = glm::cross(n, a);
        for (int i = 0; i < 48; ++i) {
            const auto p = input.port.of(
                guidance.position + 0.025 * (std::cos(kTurn * i / 48) * a + std::sin(kTurn * i / 48) * b));
            if (p) {
                list.PathLineTo(*p);
            }
        }
        list.PathStroke(colour, ImDrawFlags_Closed, active ? 2.6f : 1.6f);
        if (const auto tip = input.port.of(guidance.position + 0.05 * n)) {
            drawArrow(list, *at, *tip, colour, 2.2f);
        }
    }
    const float arm = active ? 10.0f : 7.0f;
    list.AddLine({at->x - arm, at->y - arm}, {at->x + arm, at->y + arm}, colour, 2.6f);
    list.AddLine({at->x - arm, at->y + arm}, {at->x + arm, at->y - arm}, colour, 2.6f);
    if (const auto goal = input.port.of(guidance.target.position)) {
        dashed(list, *at, *goal, colour, 1.4f, 4.0f);
        const ImVec2 corners[] = {{goal->x, goal->y - arm},
                                  {goal->x + arm, goal->y},
                                  {goal->x, goal->y + arm},
                                  {goal->x - arm, goal->y}};
        list.AddPolyline(corners, 4, colour, ImDrawFlags_Closed, 2.0f);
    }
    if (input.names && guidance.fixture < input.scene.fixtures.size()) {
        drawWords(list, {at->x + 14.0f, at->y - 26.0f},
                  input.scene.fixtures[guidance.fixture].name + (active ? ", guiding" : ""),
                  IM_COL32(184, 222, 255, 255));
    }
}

void touches(ImDrawList& list, const MarksInput& input) {
    const StepRecord& record = input.run.step().record;
    for (uint32_t i = 0; i < record.touchCount; ++i) {
        const Touch& touch = record.touches[i];
        const auto at = input.port.of(touch.point), tip = input.port.of(touch.point + 0.03 * touch.normal);
        if (at && tip && touch.normal != dvec3(0.0)) {
            drawArrow(list, *at, *tip, colour::kTouch, 2.0f);
            list.AddCircleFilled(*at, 4.5f, colour::kShade);
            list.AddCircleFilled(*at, 3.2f, colour::kTouch);
        }
    }
}

// taken: the plate of other words.
void force(ImDrawList& list, const MarksInput& input, const ImVec4& taken) {
    constexpr double kMetresPerNewton = 0.006, kMin = 0.05;
    const StepRecord& record = input.run.step().record;
    const double size = glm::length(record.wrench.force);
    const auto from = input.port.of(record.tool.position),
               to = input.port.of(record.tool.position + kMetresPerNewton * record.wrench.force);
    if (!(size > kMin) || !from || !to) {
        return;
    }
    drawArrow(list, *from, *to, colour::kForce, 3.4f);
    if (input.names) {
        const std::string text = printed("%.2f N", size);
        drawWords(list, besideWords({to->x + 10.0f, to->y - 8.0f}, text, taken), text, colour::kForce);
    }
}

} // namespace

ImVec4 drawWords(ImDrawList& list, ImVec2 at, const std::string& words, ImU32 colour) {
    const ImVec4 plate = plateOf(at, words);
    list.AddRectFilled({plate.x, plate.y}, {plate.z, plate.w}, colour::kShade, 3.0f);
    list.AddText(at, colour, words.c_str());
    return plate;
}

void drawArrow(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float width) {
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length >= 2.0f)) {
        return;
    }
    const float head = std::min(11.0f, length), x = (b.x - a.x) / length, y = (b.y - a.y) / length;
    for (const auto& [c, w] : {std::pair(colour::kShade, width + 2.2f), std::pair(colour, width)}) {
        list.AddLine(a, b, c, w);
        for (float side : {-0.5f, 0.5f}) {
            list.AddLine(b, {b.x - head * x - side * head * y, b.y - head * y + side * head * x}, c, w);
        }
    }
}

std::vector<Sphere> armSpheres(const ArmSetup* arm, const ArmPosture& posture) {
    std::vector<Sphere> spheres;
    if (arm != nullptr) {
        const ArmFrames frames = arm->framesAt(posture);
        for (size_t i = 0; i < arm->model.leaves.size(); ++i) {
            spheres.push_back({arm->model.centre(frames, i), arm->model.leaves[i].sphere.radius});
        }
    }
    return spheres;
}

void drawRegionOutlines(ImDrawList& list, const ViewPort& port, const CameraViewImage& image) {
    outline(list, port, image.heldOutline(), colour::kRegionSoft, 2.0f, true);
    outline(list, port, image.seenOutline(), colour::kRegion, 3.0f, false);
}

void drawBounds(ImDrawList& list, const ViewPort& port, std::span<const Sphere> bounds) {
    for (const Sphere& bound : bounds) {
        const auto at = port.of(bound.centre);
        const double z = port.view.cameraTbase.apply(bound.centre).z;
        if (at) {
            list.AddCircle(*at, static_cast<float>(bound.radius / port.metresPerPixel(z)),
                           IM_COL32(255, 190, 60, 90), 32, 1.0f);
        }
    }
}

void drawCameraFrustum(ImDrawList& list, const ViewPort& port, const HostFixtures& set) {
    const Intrinsics& lens = set.camera.depth;
    if (lens.width == 0) {
        return;
    }
    constexpr double kDepth = 0.12; // [m]
    std::array<dvec3, 4> corners;
    for (size_t i = 0; i < 4; ++i) {
        const double u = i == 1 || i == 2 ? lens.width : 0.0, v = i >= 2 ? lens.height : 0.0;
        corners[i] = set.baseTcamera.apply(kDepth * dvec3(lens.ray(u, v), 1.0));
    }
    for (size_t i = 0; i < 4; ++i) {
        drawSegment(list, port, set.baseTcamera.position, corners[i], colour::kQuiet, 1.2f);
        drawSegment(list, port, corners[i], corners[(i + 1) % 4], colour::kQuiet, 1.2f);
    }
}

double drawMarks(ImDrawList& list, const MarksInput& input) {
    for (const Shape& shape : input.shapes) {
        drawShape(list, input.port, shape);
    }
    for (const FixtureClass& f : input.scene.fixtures) {
        if (f.isPoints() && f.box && !isSpare(f)) {
            Shape box;
            box.baseTshape.position = 0.5 * (f.box->min + f.box->max);
            box.size = f.box->max - f.box->min;
            drawBox(list, input.port, box, IM_COL32(160, 230, 190, 200));
        }
    }
    const StepRecord& record = input.run.step().record;
    const auto& guidance = input.run.scene().set.guidance;
    for (size_t i = 0; i < guidance.size(); ++i) {
        if (guidance[i].present) {
            guidanceAt(list, input, guidance[i],
                       record.guidance > 0.0 && record.guidanceClass == static_cast<int>(i));
        }
    }
    drawShadow(list, input.port, input.cues);
    if (!input.run.anyTick() || !isFinite(record.device)) {
        return 0.0;
    }
    ghostAt(list, input);
    if (!isFinite(record.tool)) { // recordings without tool poses
        return 0.0;
    }
    const double armHidden = armAt(list, input);
    measuredAt(list, input);
    const double toolHidden = toolAt(list, input);
    const auto hand = input.port.of(record.device.position), tool = input.port.of(record.tool.position);
    if (hand && tool) {
        dashed(list, *hand, *tool, IM_COL32(190, 204, 224, 230), 1.4f, 4.0f);
    }
    const ImVec4 distance = drawTether(list, input.port, input.cues, input.names);
    touches(list, input);
    force(list, input, distance);
    return input.arm.empty() ? toolHidden : armHidden;
}

} // namespace fathom::operate
