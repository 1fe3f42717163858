// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/traces_bands.h"

#include "apps/replay/trace_phases.h"
#include "apps/replay/traces_style.h"

#include <algorithm>

namespace fathom::traces {

namespace {

struct Span {
    double from, to; // [pixels] in x
};

// Spans of the bins that satisfy `chosen`, at least one pixel wide. Spans that touch are merged, so that
// translucent paint is applied once.
template <class Chosen>
std::vector<Span> spansOf(const std::vector<TraceBin>& bins, const PlotAxis& time, Chosen chosen) {
    std::vector<Span> spans;
    for (size_t i = 0; i < bins.size(); ++i) {
        if (!chosen(bins[i])) {
            continue;
        }
        const double end = i + 1 < bins.size() ? bins[i + 1].begin : bins[i].end;
        const double from = time.at(bins[i].begin);
        const double to = std::min(std::max(time.at(end), from + 1.0), time.to);
        if (!spans.empty() && from <= spans.back().to + 0.5) {
            spans.back().to = std::max(spans.back().to, to);
        } else {
            spans.push_back({from, to});
        }
    }
    return spans;
}

void fill(const Image& image, const std::vector<Span>& spans, const Panel& panel, Colour colour,
          bool hatched) {
    for (const Span& span : spans) {
        const double width = span.to - span.from, height = panel.bottom - panel.top;
        image.box(span.from, panel.top, width, height, colour);
        if (hatched) {
            hatch(image, span.from, panel.top, width, height, kAlarm.alpha(0.55));
        }
    }
}

Colour colourOf(PhaseKind kind) {
    switch (kind) {
    case PhaseKind::Contact:
        return kContact.alpha(0.42);
    case PhaseKind::Guidance:
        return kGuidance.alpha(0.26);
    case PhaseKind::Trapped:
        return kAlarm.alpha(0.30);
    case PhaseKind::Off:
    case PhaseKind::Fading:
        return kIdle.alpha(0.30);
    case PhaseKind::Free:
        break;
    }
    return kIdle.alpha(0.10);
}

// Draws a swatch with its text; returns the x of the next entry.
template <class Swatch>
double entry(const Image& image, double x, const std::string& words, Swatch swatch) {
    constexpr double kSwatch = 30.0, kGap = 10.0, kApart = 34.0;
    swatch(x, kLegendBase - 13.0, kSwatch, 16.0);
    image.text(x + kSwatch + kGap, kLegendBase, words, 15.0, kInk);
    return x + kSwatch + kGap + image.textWidth(words, 15.0) + kApart;
}

} // namespace

void dashedLine(const Image& image, double from, double to, double y) {
    cairo_t* cr = image.cr();
    const double dashes[] = {8.0, 5.0};
    cairo_set_dash(cr, dashes, 2, 0.0);
    image.line(from, y, to, y, kAlarm, 1.6);
    cairo_set_dash(cr, nullptr, 0, 0.0);
}

void hatch(const Image& image, double x, double y, double width, double height, Colour colour) {
    constexpr double kApart = 9.0;
    cairo_t* cr = image.cr();
    cairo_save(cr);
    cairo_rectangle(cr, x, y, width, height);
    cairo_clip(cr);
    // All spans share one lattice of lines, so that the hatch continues across neighbours.
    const double first = kApart * static_cast<double>(static_cast<int64_t>((x - height) / kApart) - 1);
    for (double foot = first; foot < x + width + height; foot += kApart) {
        cairo_move_to(cr, foot, y + height);
        cairo_line_to(cr, foot + height, y);
    }
    image.setColour(colour);
    cairo_set_line_width(cr, 1.3);
    cairo_stroke(cr);
    cairo_restore(cr);
}

BandsSeen drawBands(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel) {
    const auto& bins = history.bins();
    const auto idle = spansOf(bins, time, [](const TraceBin& bin) {
        return 2 * (bin.in(StepState::Off) + bin.in(StepState::Fading)) > bin.ticks;
    });
    const auto contact = spansOf(bins, time, [](const TraceBin& bin) {
        return bin.in(StepState::Contact) + bin.in(StepState::Escape) > 0;
    });
    const auto guidance = spansOf(bins, time, [](const TraceBin& bin) { return bin.guidance > 0.0; });
    const auto alarm = spansOf(bins, time, [](const TraceBin& bin) {
        return bin.in(StepState::Escape) + bin.in(StepState::Trapped) > 0;
    });
    fill(image, idle, panel, kIdle.alpha(0.16), false);
    fill(image, contact, panel, kContact.alpha(0.20), false);
    fill(image, guidance, panel, kGuidance.alpha(0.13), false);
    fill(image, alarm, panel, kAlarm.alpha(0.10), true);
    return {!contact.empty(), !guidance.empty(), !alarm.empty(), !idle.empty(), false};
}

void drawPhaseStrip(const Image& image, const TraceHistory& history, const PlotAxis& time) {
    constexpr double kBase = kStripBottom - 10.0;
    char letter = 'A';
    for (const Phase& phase : findPhases(history)) {
        const double from = time.at(phase.begin);
        const double width = std::max(1.0, time.at(phase.end) - from);
        image.box(from, kStripTop, width, kStripBottom - kStripTop, colourOf(phase.kind));
        if (phase.kind == PhaseKind::Trapped) {
            hatch(image, from, kStripTop, width, kStripBottom - kStripTop, kAlarm.alpha(0.5));
        }
        image.box(from - 0.5, kStripTop, 1.0, kTorqueBottom - kStripTop, kInk.alpha(0.22));
        const std::string name(1, letter++);
        const std::string words = phaseName(phase.kind);
        const double middle = from + 0.5 * width;
        const double letterWidth = image.textWidth(name, 18.0, true);
        const double both = letterWidth + 9.0 + image.textWidth(words, 15.0);
        if (both + 14.0 <= width) {
            image.text(middle - 0.5 * both, kBase, name, 18.0, kInk, Align::Left, true);
            image.text(middle + 0.5 * both, kBase, words, 15.0, kInk, Align::Right);
        } else if (letterWidth + 4.0 <= width) {
            image.text(middle, kBase, name, 18.0, kInk, Align::Centre, true);
        }
    }
}

bool drawFrameTicks(const Image& image, const TraceHistory& history, const PlotAxis& time,
                    const Panel& panel) {
    constexpr double kMinApart = 4.0; // [pixels]
    if (history.newFrames() == 0 ||
        (time.to - time.from) / static_cast<double>(history.newFrames()) < kMinApart) {
        return false;
    }
    for (const TraceBin& bin : history.bins()) {
        if (bin.newFrames > 0) {
            image.box(time.at(bin.begin) - 0.6, panel.bottom - 8.0, 1.2, 8.0, kQuietInk.alpha(0.8));
        }
    }
    return true;
}

void drawLegend(const Image& image, const BandsSeen& seen, bool frameTicks, bool limits,
                const std::string& remark) {
    double x = kLeft;
    const auto line = [&](const char* words, Colour colour) {
        x = entry(image, x, words, [&](double left, double top, double w, double h) {
            image.box(left, top + 0.5 * h - 1.1, w, 2.2, colour);
        });
    };
    line("delivered (norm)", kTrace);
    if (seen.residual) {
        line("residual: not on an axis of the device", kResidual);
    }
    const auto band = [&](bool present, const char* words, Colour colour, bool hatched) {
        if (present) {
            x = entry(image, x, words, [&](double left, double top, double w, double h) {
                image.box(left, top, w, h, colour);
                if (hatched) {
                    hatch(image, left, top, w, h, kAlarm.alpha(0.55));
                }
            });
        }
    };
    band(seen.contact, "in contact", kContact.alpha(0.28), false);
    band(seen.guidance, "guidance on", kGuidance.alpha(0.20), false);
    band(seen.alarm, "escaping or trapped", kAlarm.alpha(0.12), true);
    band(seen.idle, "off or fading", kIdle.alpha(0.22), false);
    if (frameTicks) {
        x = entry(image, x, "new frame", [&](double left, double top, double w, double h) {
            for (double k : {0.2, 0.5, 0.8}) {
                image.box(left + k * w, top + 0.5 * h, 1.2, 8.0, kQuietInk);
            }
        });
    }
    if (limits) {
        entry(image, x, "limit", [&](double left, double top, double w, double h) {
            dashedLine(image, left, left + w, top + 0.5 * h);
        });
    }
    image.text(kRight, kLegendBase, remark, 15.0, kQuietInk, Align::Right);
}

} // namespace fathom::traces
