// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/close_up.h"

#include "apps/operate/shape_marks.h"
#include "apps/operate/view_lines.h"
#include "apps/output/silhouette.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>

namespace fathom::operate {

namespace {

constexpr double kEyeAway = 50.0; // [m]
constexpr double kSlab = 0.01;    // [m] half thickness for points of the camera
constexpr size_t kCells = 96;     // per edge, for the section
constexpr double kMaxSamples = 20000.0;
constexpr ImU32 kPlateInk = IM_COL32(12, 16, 23, 215);

// The middle of the view [m] and the length from there to its edges [m]: of a tool with room around it, or of
// the nearest part of an arm. A rotation of the tool does not change the size.
struct Frame {
    dvec3 middle{0.0};
    double reach = 0.12;
};
Frame frameOf(const DepthCues& cues) {
    constexpr double kAround = 0.08, kMaxReach = 0.25; // [m]
    Frame frame;
    for (const Sphere& s : cues.tool) {
        frame.middle += s.centre / static_cast<double>(cues.tool.size());
    }
    double extent = 0.0;
    for (const Sphere& s : cues.tool) {
        extent = std::max(extent, glm::distance(frame.middle, s.centre) + s.radius);
    }
    if (extent + kAround > kMaxReach) { // an arm
        frame.middle = cues.nearest ? cues.nearest->from : cues.tool.back().centre;
        return frame;
    }
    frame.reach = std::max(frame.reach, extent + kAround);
    return frame;
}

// base_T_eye; camera axes are x right, y down, z forward.
Pose eyeOf(const Pose& baseTcamera, const dvec3& middle, CloseUpSide side) {
    const dquat& q = baseTcamera.rotation;
    const dvec3 x = q * dvec3(1, 0, 0), y = q * dvec3(0, 1, 0), z = q * dvec3(0, 0, 1);
    const glm::dmat3 axes = side == CloseUpSide::Right ? glm::dmat3(z, y, -x) : glm::dmat3(x, -z, y);
    return {middle - kEyeAway * axes[2], glm::quat_cast(axes)};
}

ViewPort portOf(const Pose& eye, double reach, const PixelRect& where) {
    ImageView view;
    view.lens.width = view.lens.height = static_cast<uint32_t>(std::max(2, where.width));
    view.lens.fx = view.lens.fy = kEyeAway * where.width / (2.0 * reach);
    view.lens.cx = view.lens.cy = 0.5 * where.width - 0.5;
    view.cameraTbase = inverse(eye);
    return {view, where};
}

// Cuts spheres with the plane at this depth [m] of the eye. Of many circles in a cell of the view, the
// largest.
std::vector<Sphere> sectionOf(const HostFixtures& set, const Pose& eyeTbase, double reach, double depth) {
    const double cellEdge = 2.0 * reach / static_cast<double>(kCells);
    std::vector<Sphere> cells(kCells * kCells, Sphere{dvec3(0.0), 0.0});
    const dvec3 along = glm::conjugate(eyeTbase.rotation) * dvec3(0.0, 0.0, 1.0); // base axes
    const double origin = eyeTbase.apply(set.origin).z - depth;
    const RegionSpheres& s = set.spheres;
    for (size_t i = 0; i < s.size(); ++i) {
        const double r = double{s.radius[i]};
        const double off =
            along.x * double{s.x[i]} + along.y * double{s.y[i]} + along.z * double{s.z[i]} + origin;
        if (std::abs(off) >= r) { // true for most spheres
            continue;
        }
        dvec3 c = eyeTbase.apply(regionCentre(set, i));
        const double edge = reach + r;
        if (std::abs(c.x) >= edge || std::abs(c.y) >= edge) {
            continue;
        }
        const auto cell = [&](double v) { // spheres beyond the edge count for the cell at the edge
            const double at = (std::clamp(v, -reach, reach) + reach) / cellEdge;
            return std::min(kCells - 1, static_cast<size_t>(at));
        };
        Sphere& kept = cells[cell(c.y) * kCells + cell(c.x)];
        const double radius = std::sqrt(r * r - off * off);
        if (radius > kept.radius) {
            c.z = depth;
            kept = {c, radius};
        }
    }
    const Pose baseTeye = inverse(eyeTbase);
    std::vector<Sphere> section;
    for (const Sphere& cut : cells) {
        if (cut.radius > 0.0) {
            section.push_back({baseTeye.apply(cut.centre), cut.radius});
        }
    }
    return section;
}

std::vector<dvec3> surfaceNear(const HostFixtures& set, const Pose& eyeTbase, double reach, double depth) {
    const Intrinsics& lens = set.camera.depth;
    std::vector<dvec3> points;
    if (set.depth.size() != lens.pixels()) {
        return points;
    }
    const auto step = std::max(1u, static_cast<uint32_t>(std::ceil(std::sqrt(lens.pixels() / kMaxSamples))));
    const Pose eyeTcamera = eyeTbase * set.baseTcamera;
    const dvec3 along = glm::conjugate(eyeTcamera.rotation) * dvec3(0.0, 0.0, 1.0); // camera axes
    const bool straight = lens.pinhole();
    const double perU = 1.0 / lens.fx, perV = 1.0 / lens.fy;
    for (uint32_t v = 0; v < lens.height; v += step) {
        for (uint32_t u = 0; u < lens.width; u += step) {
            const double z = set.depth[static_cast<size_t>(v) * lens.width + u] * set.camera.metresPerUnit;
            if (z <= 0.0) {
                continue;
            }
            const glm::dvec2 ray =
                straight ? glm::dvec2((u - lens.cx) * perU, (v - lens.cy) * perV) : lens.ray(u, v);
            const double off =
                z * (along.x * ray.x + along.y * ray.y + along.z) + eyeTcamera.position.z - depth;
            if (std::abs(off) >= kSlab) { // true for most points
                continue;
            }
            const dvec3 camera = z * dvec3(ray, 1.0), eye = eyeTcamera.apply(camera);
            if (std::abs(eye.x) < reach && std::abs(eye.y) < reach) {
                points.push_back(set.baseTcamera.apply(camera));
            }
        }
    }
    return points;
}

// Squares of 50 mm about the middle.
void drawSquares(ImDrawList& list, const ViewPort& port, double reach) {
    constexpr double kSquare = 0.05; // [m]
    const ImVec2 a = cornerOf(port.where), size = sizeOf(port.where);
    const double metre = port.where.width / (2.0 * reach);
    for (int i = -5; i <= 5; ++i) {
        const auto at = static_cast<float>(0.5 * port.where.width + i * kSquare * metre);
        list.AddLine({a.x + at, a.y}, {a.x + at, a.y + size.y}, IM_COL32(40, 50, 66, 255));
        list.AddLine({a.x, a.y + at}, {a.x + size.x, a.y + at}, IM_COL32(40, 50, 66, 255));
    }
}

void drawSection(ImDrawList& list, const CloseUp& view) {
    for (const dvec3& point : view.surface) {
        if (const auto at = view.port.of(point)) {
            list.AddRectFilled({at->x - 1.0f, at->y - 1.0f}, {at->x + 1.0f, at->y + 1.0f}, colour::kQuiet);
        }
    }
    std::vector<Circle> circles;
    for (const Sphere& s : view.section) {
        if (const auto at = view.port.of(s.centre)) {
            const double metresPerPixel = view.port.metresPerPixel(kEyeAway);
            circles.push_back({at->x, at->y, static_cast<float>(s.radius / metresPerPixel)});
        }
    }
    if (!circles.empty()) {
        fillUnion(list, circles, IM_COL32(237, 41, 36, 150));
    }
}

// Name, and where the camera is.
void drawNames(ImDrawList& list, const PixelRect& where, CloseUpSide side, ImFont* font) {
    const ImVec2 a = cornerOf(where), size = sizeOf(where);
    const float letter = font->FontSize;
    const auto name = [&](float y, ImU32 colour, const char* words) {
        const float width = font->CalcTextSizeA(letter, 1e9f, 0.0f, words).x;
        list.AddRectFilled({a.x + 2.0f, y - 1.0f}, {a.x + width + 8.0f, y + letter + 2.0f}, kPlateInk, 3.0f);
        list.AddText(font, letter, {a.x + 5.0f, y}, colour, words);
    };
    const bool right = side == CloseUpSide::Right;
    name(a.y + 3.0f, colour::kText, right ? "side" : "top");
    name(a.y + size.y - letter - 4.0f, colour::kQuiet, right ? "\xe2\x86\x90 camera" : "\xe2\x86\x93 camera");
    list.AddRect(a, {a.x + size.x, a.y + size.y}, IM_COL32(70, 84, 106, 255), 3.0f);
}

} // namespace

std::optional<CloseUp> closeUp(const HostFixtures& set, const DepthCues& cues, CloseUpSide side,
                               const PixelRect& where) {
    if (cues.tool.empty() || where.width <= 0) {
        return std::nullopt;
    }
    const Frame frame = frameOf(cues);
    const Pose eye = eyeOf(set.baseTcamera, frame.middle, side);
    CloseUp view{portOf(eye, frame.reach, where), frame.reach, {}, {}};
    const Pose& eyeTbase = view.port.view.cameraTbase;
    const bool near = cues.nearest && glm::distance(cues.nearest->to, frame.middle) < frame.reach;
    const double depth = near ? eyeTbase.apply(cues.nearest->from).z : kEyeAway;
    view.section = sectionOf(set, eyeTbase, frame.reach, depth);
    view.surface = surfaceNear(set, eyeTbase, frame.reach, depth);
    return view;
}

void drawCloseUp(Console& console, const CloseUp& view, CloseUpSide side, const DepthCues& cues,
                 std::span<const Shape> shapes, ImFont* font) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const PixelRect& where = view.port.where;
    const ImVec2 a = cornerOf(where), b{a.x + sizeOf(where).x, a.y + sizeOf(where).y};
    list.PushClipRect(a, b, true);
    list.AddRectFilled(a, b, IM_COL32(12, 16, 23, 255), 3.0f);
    drawSquares(list, view.port, view.reach);
    drawSection(list, view);
    for (const Shape& shape : shapes) {
        drawShape(list, view.port, shape);
    }
    const auto nothing = [](glm::dvec2) { return 0.0; }; // hides the tool
    drawBody(list, view.port, cues.tool, nothing, colour::kTool, 2.0f);
    drawTether(list, view.port, cues, false);
    drawNames(list, where, side, font);
    list.PopClipRect();
    markPlace(console, side == CloseUpSide::Right ? "close-up side" : "close-up top", a, sizeOf(where));
    explainArea(
        console, a, sizeOf(where),
        side == CloseUpSide::Right
            ? "The tool from the right of the camera, which is at the left. Red: regions in the plane "
              "through the tool. Grey: what the camera sees there. Squares of 50 mm"
            : "The tool from above; the camera is at the lower edge. Red: regions in the plane through "
              "the tool. Grey: what the camera sees there. Squares of 50 mm");
}

CloseUpRooms closeUpRooms(PixelRect& gap, float scale) {
    constexpr int kBetween = 6; // [pixels]
    const int bar = static_cast<int>(84.0f * scale), least = static_cast<int>(90.0f * scale),
              most = static_cast<int>(300.0f * scale);
    const int width = gap.width - bar - 2 * kBetween;
    const int below = std::min(width, (gap.height - kBetween) / 2),
              beside = std::min((width - kBetween) / 2, gap.height);
    const int edge = std::min(most, std::max(below, beside));
    CloseUpRooms rooms;
    if (edge < least) { // both above the bar
        const int barHigh = static_cast<int>(200.0f * scale);
        const int above = std::min(gap.width - 2 * kBetween, (gap.height - barHigh) / 2 - kBetween);
        if (above >= least) {
            rooms.side = {gap.x + kBetween, gap.y, above, above};
            rooms.top = {rooms.side.x, gap.y + above + kBetween, above, above};
            const int high = 2 * (above + kBetween);
            gap = {gap.x, gap.y + high, gap.width, gap.height - high};
        }
        return rooms;
    }
    const bool stacked = below >= beside;
    rooms.side = {gap.x + kBetween, gap.y, edge, edge};
    rooms.top = {rooms.side.x + (stacked ? 0 : edge + kBetween), gap.y + (stacked ? edge + kBetween : 0),
                 edge, edge};
    const int used = kBetween + (stacked ? edge : 2 * edge + kBetween);
    gap = {gap.x + used, gap.y, gap.width - used, gap.height};
    return rooms;
}

} // namespace fathom::operate
