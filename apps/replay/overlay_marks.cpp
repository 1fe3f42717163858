// SPDX-License-Identifier: Apache-2.0
// The marks of overlay.png: guidance targets, tool and hand, force.
#include "apps/output/plot_axis.h"
#include "apps/output/silhouette.h"
#include "apps/replay/overlay_layers.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom::overlay {

namespace {

using Pixel = std::optional<glm::dvec2>;

constexpr double kDiscRadius = 0.025, kNormalLength = 0.05; // [m] of a target
constexpr double kTargetArm = 11.0;                         // [pixels] of its cross

// Text whose left end (or right end, with `toLeft`) is at `at`, shifted to stay inside the image.
void words(const Canvas& canvas, glm::dvec2 at, const std::string& text, Colour colour, bool toLeft = false) {
    const double size = 14.0 * canvas.size;
    const double width = canvas.image.textWidth(text, size, true);
    at.x = std::clamp(toLeft ? at.x - width : at.x, 6.0, std::max(6.0, canvas.view.width() - width - 8.0));
    at.y = std::clamp(at.y, 1.6 * size, canvas.view.height() - 8.0);
    canvas.image.box(at.x - 5.0, at.y - 1.08 * size, width + 10.0, 1.5 * size, kShade.alpha(0.66));
    canvas.image.text(at.x, at.y, text, size, colour, Align::Left, true);
}

void disc(const Canvas& canvas, const dvec3& centre, const dvec3& normal) {
    constexpr int kCorners = 64;
    const dvec3 a =
        glm::normalize(glm::cross(std::abs(normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), normal));
    const dvec3 b = glm::cross(normal, a);
    cairo_t* cr = canvas.image.cr();
    for (int i = 0; i < kCorners; ++i) {
        const double angle = kTurn * i / kCorners;
        const Pixel pixel =
            canvas.view.ofBase(centre + kDiscRadius * (std::cos(angle) * a + std::sin(angle) * b));
        if (!pixel) {
            cairo_new_path(cr);
            return;
        }
        cairo_line_to(cr, pixel->x, pixel->y);
    }
    cairo_close_path(cr);
    canvas.image.setColour(kGuidance.alpha(0.28));
    cairo_fill_preserve(cr);
    strokeOnShade(canvas, kGuidance, 2.0);
}

void target(const Canvas& canvas, const GuidancePose& guidance) {
    const Pixel position = canvas.view.ofBase(guidance.position);
    if (!position) {
        return;
    }
    if (guidance.planar) {
        disc(canvas, guidance.position, guidance.normal);
        if (const Pixel tip = canvas.view.ofBase(guidance.position + kNormalLength * guidance.normal)) {
            arrow(canvas, *position, *tip, kGuidance, 2.6);
        }
    }
    cairo_t* cr = canvas.image.cr();
    const double arm = kTargetArm * canvas.size;
    const Pixel goal = canvas.view.ofBase(guidance.target.position);
    if (goal && glm::distance(*goal, *position) > 3.0) {
        cairo_move_to(cr, position->x, position->y);
        cairo_line_to(cr, goal->x, goal->y);
        strokeOnShade(canvas, kGuidance, 1.6, true);
        cairo_move_to(cr, goal->x, goal->y - arm);
        cairo_line_to(cr, goal->x + arm, goal->y);
        cairo_line_to(cr, goal->x, goal->y + arm);
        cairo_line_to(cr, goal->x - arm, goal->y);
        cairo_close_path(cr);
        strokeOnShade(canvas, kGuidance, 2.2);
    }
    for (double direction : {-1.0, 1.0}) {
        cairo_move_to(cr, position->x - arm, position->y - direction * arm);
        cairo_line_to(cr, position->x + arm, position->y + direction * arm);
    }
    strokeOnShade(canvas, kGuidance, 3.0);
}

// Columns of the target's marks, from the leftmost to the rightmost.
std::pair<double, double> extentOf(const Canvas& canvas, const GuidancePose& guidance, glm::dvec2 position) {
    const double arm = kTargetArm * canvas.size;
    std::pair extent(position.x - arm, position.x + arm);
    const auto include = [&](const Pixel& p, double around) {
        if (p) {
            extent = {std::min(extent.first, p->x - around), std::max(extent.second, p->x + around)};
        }
    };
    include(canvas.view.ofBase(guidance.target.position), arm);
    if (guidance.planar) {
        const dvec3 right = glm::conjugate(canvas.view.cameraTbase.rotation) * dvec3(kDiscRadius, 0.0, 0.0);
        include(canvas.view.ofBase(guidance.position + right), 0.0);
        include(canvas.view.ofBase(guidance.position - right), 0.0);
        include(canvas.view.ofBase(guidance.position + kNormalLength * guidance.normal), arm);
    }
    return extent;
}

void toolOutline(const Canvas& canvas, std::span<const Sphere> leaves, const Pose& pose, bool dashed) {
    std::vector<Sphere> spheres;
    for (const Sphere& leaf : leaves) {
        spheres.push_back({pose.apply(leaf.centre), leaf.radius});
    }
    if (!dashed) { // the outline of a tool that leaves the image is open
        tracePath(canvas, areaOf(canvas.view, spheres));
        canvas.image.setColour(kTool.alpha(0.16));
        cairo_fill(canvas.image.cr());
    }
    tracePath(canvas, outlineOf(canvas.view, spheres));
    strokeOnShade(canvas, kTool, dashed ? 1.8 : 2.4, dashed);
}

// Outlines of the single leaves, as in the paper's figures. Skipped if so many would only form a grey area.
void leafCircles(const Canvas& canvas, std::span<const Sphere> leaves, const Pose& pose) {
    constexpr size_t kMaxOutlined = 96;
    if (leaves.size() < 2 || leaves.size() > kMaxOutlined) {
        return;
    }
    cairo_t* cr = canvas.image.cr();
    for (const Sphere& leaf : leaves) {
        const dvec3 centre = canvas.view.cameraTbase.apply(pose.apply(leaf.centre));
        if (const Pixel pixel = canvas.view.ofCamera(centre)) {
            cairo_new_sub_path(cr);
            cairo_arc(cr, pixel->x, pixel->y,
                      canvas.view.lens.fx * canvas.view.scale * leaf.radius / centre.z, 0.0, kTurn);
        }
    }
    canvas.image.setColour(kTool.alpha(0.45));
    cairo_set_line_width(cr, canvas.size);
    cairo_stroke(cr);
}

} // namespace

void tracePath(const Canvas& canvas, const std::vector<OutlineLine>& lines) {
    for (const OutlineLine& line : lines) {
        cairo_move_to(canvas.image.cr(), line.front().x, line.front().y);
        for (const glm::dvec2& point : line) {
            cairo_line_to(canvas.image.cr(), point.x, point.y);
        }
    }
}

void strokeOnShade(const Canvas& canvas, Colour colour, double width, bool dashed) {
    cairo_t* cr = canvas.image.cr();
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    const double dashes[] = {7.0 * canvas.size, 7.0 * canvas.size};
    if (dashed) {
        cairo_set_dash(cr, dashes, 2, 0.0);
    }
    canvas.image.setColour(kShade.alpha(0.6));
    cairo_set_line_width(cr, (width + 2.2) * canvas.size);
    cairo_stroke_preserve(cr);
    canvas.image.setColour(colour);
    cairo_set_line_width(cr, width * canvas.size);
    cairo_stroke(cr);
    cairo_set_dash(cr, nullptr, 0, 0.0);
}

void arrow(const Canvas& canvas, glm::dvec2 a, glm::dvec2 b, Colour colour, double width) {
    const double length = glm::distance(a, b);
    if (!(length >= 2.0)) {
        return;
    }
    const glm::dvec2 along = (b - a) / length;
    const glm::dvec2 across(-along.y, along.x);
    const double head = std::min(12.0 * canvas.size, length);
    cairo_t* cr = canvas.image.cr();
    cairo_move_to(cr, a.x, a.y);
    cairo_line_to(cr, b.x, b.y);
    for (double side : {-0.5, 0.5}) {
        const glm::dvec2 barb = b - head * along + side * head * across;
        cairo_move_to(cr, b.x, b.y);
        cairo_line_to(cr, barb.x, barb.y);
    }
    strokeOnShade(canvas, colour, width);
}

void drawGuidance(const Canvas& canvas, const OverlayInput& input) {
    for (const GuidancePose& guidance : input.set->guidance) {
        if (guidance.present) {
            target(canvas, guidance);
        }
    }
}

void drawGuidanceNames(const Canvas& canvas, const OverlayInput& input) {
    for (const GuidancePose& guidance : input.set->guidance) {
        const Pixel position = canvas.view.ofBase(guidance.position);
        if (guidance.present && position) {
            const bool named = guidance.fixture < input.classNames.size();
            const std::string name = named ? input.classNames[guidance.fixture] : "guidance";
            const std::string text = name + ", " + std::to_string(guidance.count) + " points";
            const auto [left, right] = extentOf(canvas, guidance, *position);
            const double gap = 12.0 * canvas.size,
                         width = canvas.image.textWidth(text, 14.0 * canvas.size, true);
            const bool toLeft = right + gap + width > canvas.view.width() - 8.0 && left - gap - width > 6.0;
            words(canvas, {toLeft ? left - gap : right + gap, position->y + 5.0 * canvas.size}, text,
                  {0.72, 0.87, 1.0}, toLeft);
        }
    }
}

void drawTool(const Canvas& canvas, const OverlayInput& input) {
    const StepRecord& tick = input.tick;
    if (!isFinite(tick.device) || !isFinite(tick.tool)) {
        return;
    }
    toolOutline(canvas, input.leaves, tick.device, true);
    leafCircles(canvas, input.leaves, tick.tool);
    toolOutline(canvas, input.leaves, tick.tool, false);
    const Pixel hand = canvas.view.ofBase(tick.device.position);
    const Pixel tool = canvas.view.ofBase(tick.tool.position);
    if (hand && tool) {
        cairo_t* cr = canvas.image.cr();
        cairo_move_to(cr, hand->x, hand->y);
        cairo_line_to(cr, tool->x, tool->y);
        strokeOnShade(canvas, kTool, 1.4);
        cairo_arc(cr, hand->x, hand->y, 3.0 * canvas.size, 0.0, kTurn);
        strokeOnShade(canvas, kTool, 1.6);
    }
}

void drawForce(const Canvas& canvas, const OverlayInput& input) {
    constexpr double kMetresPerNewton = 0.006;
    const dvec3& force = input.tick.wrench.force;
    if (!isFinite(force) || !isFinite(input.tick.tool) || glm::length(force) < kMinArrow) {
        return;
    }
    const Pixel from = canvas.view.ofBase(input.tick.tool.position);
    const Pixel to = canvas.view.ofBase(input.tick.tool.position + kMetresPerNewton * force);
    if (!from || !to) {
        return;
    }
    arrow(canvas, *from, *to, kForce, 3.4);
    const bool toLeft = to->x < from->x; // text beyond the tip does not cover the arrow
    words(canvas, *to + canvas.size * glm::dvec2(toLeft ? -14.0 : 14.0, 5.0),
          shortNumber(glm::length(force)) + " N", kForce, toLeft);
}

} // namespace fathom::overlay
