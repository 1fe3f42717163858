// SPDX-License-Identifier: Apache-2.0
// The caption of overlay.png: state and force at the moment shown, and the legend.
#include "apps/output/plot_axis.h"
#include "apps/replay/overlay_layers.h"
#include "engine/types/angle.h"
#include "engine/types/printed.h"

#include <cmath>

namespace fathom::overlay {

namespace {

constexpr Colour kWords{0.90, 0.92, 0.94};
constexpr Colour kQuietWords{0.60, 0.64, 0.69};

std::string moment(const OverlayInput& input) {
    const StepRecord& tick = input.tick;
    const int64_t frame = input.set != nullptr ? input.set->frame : -1;
    std::string text = frame >= 0 ? "frame " + std::to_string(frame) : std::string("no frame");
    text += printed("   %.3f s   ", tick.t) + stateName(tick.state);
    if (isFinite(tick.wrench.force) && isFinite(tick.wrench.torque)) {
        text += "   force " + shortNumber(glm::length(tick.wrench.force)) + " N   torque " +
                shortNumber(glm::length(tick.wrench.torque)) + " N m";
    }
    if (tick.guidance > 0.0) {
        text += "   guidance " + std::to_string(std::lround(100.0 * tick.guidance)) + " %";
    }
    return text;
}

// Draws the entries of the legend in one row; each swatch is a small version of the mark.
class Legend {
public:
    Legend(const Canvas& canvas, double left, double base)
        : canvas_(canvas)
        , x_(left)
        , base_(base) {}

    void region(const char* words, bool held) {
        cairo_t* cr = canvas_.image.cr();
        const double size = canvas_.size, top = base_ - 12.0 * size, height = 15.0 * size;
        cairo_save(cr);
        cairo_rectangle(cr, x_, top, swatch(), height);
        canvas_.image.setColour(kRegion.alpha(held ? 0.18 : 0.38));
        cairo_fill_preserve(cr);
        cairo_clip(cr);
        for (double foot = -swatch(); foot < 2.0 * swatch(); foot += 7.0 * size) {
            const double lean = held ? -height : height;
            cairo_move_to(cr, x_ + foot, top + height);
            cairo_line_to(cr, x_ + foot + lean, top);
        }
        canvas_.image.setColour(kRegion.alpha(0.8));
        cairo_set_line_width(cr, 1.4 * size);
        cairo_stroke(cr);
        cairo_restore(cr);
        name(words);
    }

    void dots(const char* words) {
        for (double k : {0.15, 0.38, 0.61, 0.84}) {
            canvas_.image.box(x_ + k * swatch(), middle() - canvas_.size, 2.0 * canvas_.size,
                              2.0 * canvas_.size, {1.0, 0.60, 0.54});
        }
        name(words);
    }

    void cross(const char* words) {
        const double arm = 6.0 * canvas_.size, u = x_ + 0.5 * swatch();
        for (double direction : {-1.0, 1.0}) {
            cairo_move_to(canvas_.image.cr(), u - arm, middle() - direction * arm);
            cairo_line_to(canvas_.image.cr(), u + arm, middle() + direction * arm);
        }
        strokeOnShade(canvas_, kGuidance, 2.6);
        name(words);
    }

    void outline(const char* words, bool dashed) {
        const double r = 6.5 * canvas_.size;
        cairo_new_sub_path(canvas_.image.cr());
        cairo_arc(canvas_.image.cr(), x_ + 0.5 * swatch(), middle(), r, 0.0, kTurn);
        const double dashes[] = {3.4 * canvas_.size, 3.4 * canvas_.size};
        if (dashed) {
            cairo_set_dash(canvas_.image.cr(), dashes, 2, 0.0);
        }
        canvas_.image.setColour(kTool);
        cairo_set_line_cap(canvas_.image.cr(), CAIRO_LINE_CAP_BUTT);
        cairo_set_line_width(canvas_.image.cr(), (dashed ? 1.6 : 2.2) * canvas_.size);
        cairo_stroke(canvas_.image.cr());
        cairo_set_dash(canvas_.image.cr(), nullptr, 0, 0.0);
        name(words);
    }

    void force(const char* words) {
        arrow(canvas_, {x_ + 2.0, middle()}, {x_ + swatch() - 2.0, middle()}, kForce, 2.6);
        name(words);
    }

private:
    double swatch() const { return 26.0 * canvas_.size; }
    double middle() const { return base_ - 5.0 * canvas_.size; }

    void name(const char* words) {
        const double size = 14.0 * canvas_.size;
        canvas_.image.text(x_ + swatch() + 0.6 * size, base_, words, size, kWords);
        x_ += swatch() + 0.6 * size + canvas_.image.textWidth(words, size) + 1.8 * size;
    }

    const Canvas& canvas_;
    double x_, base_;
};

} // namespace

void drawCaption(const Canvas& canvas, const OverlayInput& input, double captionHeight) {
    const double margin = 18.0 * canvas.size, size = 16.0 * canvas.size;
    const double top = canvas.image.height() - captionHeight;
    const double line = top + 0.40 * captionHeight;
    const std::string text = moment(input);
    canvas.image.text(margin, line, text, size, kWords, Align::Left, true);
    const double room = canvas.view.width() - 3.0 * margin - canvas.image.textWidth(text, size, true);
    if (canvas.image.textWidth(input.title, 0.88 * size) <= room) {
        canvas.image.text(canvas.view.width() - margin, line, input.title, 0.88 * size, kQuietWords,
                          Align::Right);
    }
    Legend legend(canvas, margin, top + 0.80 * captionHeight);
    const SeenLayers seen = seenLayers(canvas.view, input);
    if (seen.regions) {
        legend.region("forbidden region", false);
    }
    if (seen.held) {
        legend.region("held region", true);
    }
    if (seen.points) {
        legend.dots("region points");
    }
    if (seen.guidance) {
        legend.cross("guidance");
    }
    if (seen.tool) {
        legend.outline("tool", false);
    }
    if (seen.hand) {
        legend.outline("hand", true);
    }
    if (seen.force) {
        legend.force("force");
    }
}

} // namespace fathom::overlay
