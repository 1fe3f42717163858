// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/traces_bands.h"

#include "apps/replay/trace_phases.h"
#include "apps/replay/traces_style.h"

#include <algorithm>
#include <cmath>

namespace fathom::traces {

namespace {

constexpr double kFrameTick = 8.0; // [pixels] height of the mark of a new frame

struct Span {
    double from, to; // [pixels] in x
};

// Spans that touch are merged, so that translucent paint is applied once.
void append(std::vector<Span>& spans, const Span& next) {
    if (!spans.empty() && next.from <= spans.back().to + 0.5) {
        spans.back().to = std::max(spans.back().to, next.to);
    } else {
        spans.push_back(next);
    }
}

// Spans of the bins that satisfy `chosen`, at least one pixel wide.
template <class Chosen>
std::vector<Span> spansOf(const std::vector<TraceBin>& bins, const PlotAxis& time, Chosen chosen) {
    std::vector<Span> spans;
    for (size_t i = 0; i < bins.size(); ++i) {
        if (!chosen(bins[i])) {
            continue;
        }
        const double end = i + 1 < bins.size() ? bins[i + 1].begin : bins[i].end;
        const double from = time.at(bins[i].begin);
        append(spans, {from, std::min(std::max(time.at(end), from + 1.0), time.to)});
    }
    return spans;
}

// Where the tool escaped or was trapped.
struct Alarms {
    std::vector<Span> spans;   // most ticks of each column
    std::vector<double> marks; // x of a few ticks, which as a span would look like all of their neighbours
};

// By columns of a pixel, because a column may hold many ticks and a tick may be many columns wide.
Alarms alarmsOf(const std::vector<TraceBin>& bins, const PlotAxis& time) {
    constexpr double kNarrow = 6.0; // [pixels] narrower spans have no room for a hatch
    Alarms alarms;
    for (size_t i = 0; i < bins.size();) {
        const double from = time.at(bins[i].begin), column = std::floor(from);
        uint32_t alarmed = 0, ticks = 0;
        for (; i < bins.size() && std::floor(time.at(bins[i].begin)) == column; ++i) {
            alarmed += bins[i].in(StepState::Escape) + bins[i].in(StepState::Trapped);
            ticks += bins[i].ticks;
        }
        const double end = time.at(i < bins.size() ? bins[i].begin : bins.back().end);
        const double to = std::min(std::max(end, from + 1.0), time.to);
        if (2 * alarmed > ticks) {
            append(alarms.spans, {from, to});
        } else if (alarmed > 0) {
            alarms.marks.push_back(0.5 * (from + to));
        }
    }
    std::erase_if(alarms.spans, [&](const Span& span) {
        const bool narrow = span.to - span.from < kNarrow;
        if (narrow) {
            alarms.marks.push_back(0.5 * (span.from + span.to));
        }
        return narrow;
    });
    return alarms;
}

void alarmMark(const Image& image, double x, double bottom) {
    image.box(x - 0.8, bottom - 14.0, 1.6, 14.0, kAlarm);
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

// Likewise, of a mark that occurs many times.
template <class Mark>
double marksEntry(const Image& image, double x, const std::string& words, Mark mark) {
    return entry(image, x, words, [&](double left, double top, double w, double h) {
        for (double k : {0.2, 0.5, 0.8}) {
            mark(left + k * w, top + 0.5 * h);
        }
    });
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
    const Alarms alarms = alarmsOf(bins, time);
    fill(image, idle, panel, kIdle.alpha(0.16), false);
    fill(image, contact, panel, kContact.alpha(0.20), false);
    fill(image, guidance, panel, kGuidance.alpha(0.13), false);
    fill(image, alarms.spans, panel, kAlarm.alpha(0.10), true);
    for (const double x : alarms.marks) {
        alarmMark(image, x, panel.bottom - kFrameTick);
    }
    return {!contact.empty(),      !guidance.empty(), !alarms.spans.empty(),
            !alarms.marks.empty(), !idle.empty(),     false};
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
            image.box(time.at(bin.begin) - 0.6, panel.bottom - kFrameTick, 1.2, kFrameTick,
                      kQuietInk.alpha(0.8));
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
    if (seen.brief) {
        x = marksEntry(image, x, seen.alarm ? "briefly" : "briefly escaping or trapped",
                       [&](double at, double middle) { alarmMark(image, at, middle + 8.0); });
    }
    band(seen.idle, "off or fading", kIdle.alpha(0.22), false);
    if (frameTicks) {
        x = marksEntry(image, x, "new frame",
                       [&](double at, double middle) { image.box(at, middle, 1.2, 8.0, kQuietInk); });
    }
    if (limits) {
        entry(image, x, "limit", [&](double left, double top, double w, double h) {
            dashedLine(image, left, left + w, top + 0.5 * h);
        });
    }
    image.text(kRight, kLegendBase, remark, 15.0, kQuietInk, Align::Right);
}

} // namespace fathom::traces
