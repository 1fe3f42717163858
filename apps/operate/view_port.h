// SPDX-License-Identifier: Apache-2.0
// A view in the window: maps the base frame to a rectangle of the window and back.
#pragma once

#include "apps/operate/painter.h"
#include "apps/output/image_view.h"

#include <imgui.h>
#include <optional>

namespace fathom::operate {

// A camera or 3D view and the rectangle that shows it.
struct ViewPort {
    ImageView view;
    PixelRect where; // [pixels] of the window

    double scale() const { return static_cast<double>(where.width) / std::max(1, view.width()); }
    ImVec2 ofFrame(glm::dvec2 p) const {
        return {static_cast<float>(where.x + p.x * scale()), static_cast<float>(where.y + p.y * scale())};
    }
    // Window pixel of a point of the base frame [m]; empty when it is not in front of the eye.
    std::optional<ImVec2> of(const dvec3& base) const {
        const auto p = view.ofBase(base);
        return p ? std::optional(ofFrame(*p)) : std::nullopt;
    }
    glm::dvec2 toImage(ImVec2 p) const {
        return {(double{p.x} - where.x) / scale(), (double{p.y} - where.y) / scale()};
    }
    bool holds(ImVec2 p) const {
        const double x = double{p.x} - where.x, y = double{p.y} - where.y;
        return x >= 0.0 && y >= 0.0 && x < where.width && y < where.height;
    }
    // Width of a window pixel [m] at this distance along the axis of the eye.
    double metresPerPixel(double z) const { return z / (view.lens.fx * view.scale * scale()); }
};

// The largest centred rectangle in `room` with the aspect ratio width : height.
inline PixelRect fitted(PixelRect room, double width, double height) {
    const double scale = std::min(room.width / width, room.height / height);
    const int w = std::max(2, static_cast<int>(width * scale)),
              h = std::max(2, static_cast<int>(height * scale));
    return {room.x + (room.width - w) / 2, room.y + (room.height - h) / 2, w, h};
}

} // namespace fathom::operate
