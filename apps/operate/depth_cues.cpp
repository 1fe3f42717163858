// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/depth_cues.h"

#include "apps/operate/view_lines.h"
#include "apps/operate/view_marks.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::operate {

namespace {

constexpr double kTolerance = 0.008; // [m] noise of depth; less behind a surface is not hidden
constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);

// Silhouettes of spheres in a view, as circles.
class Discs {
public:
    Discs(const ViewPort& port, std::span<const Sphere> spheres) {
        for (const Sphere& s : spheres) {
            const dvec3 eye = port.view.cameraTbase.apply(s.centre);
            if (const auto p = port.view.ofCamera(eye)) {
                discs_.push_back({*p, s.radius * port.view.lens.fx * port.view.scale / eye.z, eye.z});
            }
        }
    }

    // The depth [m] of the sphere whose silhouette is nearest to a pixel of the view, or that of the previous
    // answer if it still is within a pixel: an outline follows a silhouette for a while.
    double depthAt(glm::dvec2 at) {
        const auto off = [&](const Disc& disc) { return std::abs(glm::distance(disc.at, at) - disc.r); };
        if (discs_.empty() || off(discs_[last_]) < 1.0) {
            return discs_.empty() ? 0.0 : discs_[last_].z;
        }
        double least = 1e300;
        for (size_t i = 0; i < discs_.size(); ++i) {
            if (const double here = off(discs_[i]); here < least) {
                least = here;
                last_ = i;
            }
        }
        return discs_[last_].z;
    }

private:
    struct Disc {
        glm::dvec2 at;  // [pixels]
        double r = 0.0; // [pixels]
        double z = 0.0; // [m]
    };
    std::vector<Disc> discs_;
    size_t last_ = 0;
};

// One run of an outline: solid, or dots.
void outlineRun(ImDrawList& list, std::vector<ImVec2>& points, bool hidden, ImU32 colour, float width) {
    if (points.size() < 2) {
        return;
    }
    if (!hidden) {
        thin(points);
        list.AddPolyline(points.data(), static_cast<int>(points.size()), colour::kShade, 0, width + 2.0f);
        list.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, width);
        return;
    }
    const float gap = 3.2f * width;
    float since = gap;
    for (size_t i = 1; i < points.size(); ++i) {
        since += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
        if (since >= gap) {
            since = 0.0f;
            list.AddCircleFilled(points[i], 0.75f * width + 1.0f, colour::kShade, 8);
            list.AddCircleFilled(points[i], 0.75f * width, colour, 8);
        }
    }
}

} // namespace

GapLook lookOf(double gap) {
    return gap < kCloseGap ? GapLook::Close : gap < kNearGap ? GapLook::Near : GapLook::Far;
}

ImU32 gapColour(GapLook look) {
    return look == GapLook::Close ? colour::kWarning : look == GapLook::Near ? colour::kCaution : kWhite;
}

const char* gapName(GapLook look) {
    return look == GapLook::Close ? "close" : look == GapLook::Near ? "near" : "far";
}

std::string gapText(double gap) {
    if (!std::isfinite(gap)) {
        return std::isnan(gap) ? "unknown" : "no region";
    }
    const double mm = 1e3 * std::max(0.0, gap);
    return mm < 999.5 ? printed(mm < 9.95 ? "%.1f mm" : "%.0f mm", mm) : printed("%.2f m", 1e-3 * mm);
}

DepthCues depthCues(const HostFixtures& set, std::vector<Sphere> tool, double measured) {
    DepthCues cues;
    cues.tool = std::move(tool);
    cues.nearest = nearestRegion(set, cues.tool);
    cues.gap = measured;
    if (std::isnan(measured) && !cues.tool.empty()) {
        cues.gap = cues.nearest ? cues.nearest->gap : std::numeric_limits<double>::infinity();
    }
    cues.shadow = shadowOf(set, cues.tool);
    return cues;
}

void drawShadow(ImDrawList& list, const ViewPort& port, const DepthCues& cues) {
    std::vector<Circle> circles;
    for (const Sphere& s : cues.shadow) {
        const auto at = port.of(s.centre);
        const double z = port.view.cameraTbase.apply(s.centre).z;
        if (at && z > 0.02) {
            circles.push_back({at->x, at->y, static_cast<float>(s.radius / port.metresPerPixel(z))});
        }
    }
    if (!circles.empty()) {
        fillUnion(list, circles, IM_COL32(0, 0, 0, 120));
    }
}

double drawBody(ImDrawList& list, const ViewPort& port, std::span<const Sphere> spheres,
                const SurfaceDepth& surface, ImU32 colour, float width) {
    size_t hidden = 0, all = 0;
    std::vector<ImVec2> points;
    Discs discs(port, spheres);
    for (const OutlineLine& line : outlineOf(port.view, spheres)) {
        bool before = false;
        points.clear();
        for (const glm::dvec2& p : line) {
            const double under = surface(p);
            const bool now = under > 0.0 && under < discs.depthAt(p) - kTolerance;
            points.push_back(port.ofFrame(p));
            if (now != before) {
                outlineRun(list, points, before, colour, width);
                points = {port.ofFrame(p)};
            }
            before = now;
            hidden += now ? 1 : 0;
            ++all;
        }
        outlineRun(list, points, before, colour, width);
    }
    return all == 0 ? 0.0 : static_cast<double>(hidden) / static_cast<double>(all);
}

ImVec4 drawTether(ImDrawList& list, const ViewPort& port, const DepthCues& cues, bool label) {
    if (!cues.nearest) {
        return {};
    }
    const auto from = port.of(cues.nearest->from), to = port.of(cues.nearest->to);
    if (!from || !to) {
        return {};
    }
    const GapLook look = lookOf(cues.gap);
    const ImU32 colour = gapColour(look);
    const float width = look == GapLook::Close ? 5.0f : look == GapLook::Near ? 3.0f : 1.6f;
    list.AddLine(*from, *to, colour::kShade, width + 2.4f);
    list.AddLine(*from, *to, colour, width);
    for (const ImVec2 end : {*from, *to}) {
        list.AddCircleFilled(end, 1.2f + width, colour::kShade, 12);
        list.AddCircleFilled(end, 0.4f + width, colour, 12);
    }
    if (!label || !std::isfinite(cues.gap) || !(cues.gap > 1e-3)) {
        return {};
    }
    const std::string text = gapText(cues.gap);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float x = 0.5f * (from->x + to->x) + 12.0f, y = 0.5f * (from->y + to->y) - size.y - 6.0f;
    return drawWords(list, {x, y}, text, colour);
}

} // namespace fathom::operate
