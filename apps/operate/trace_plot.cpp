// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/trace_plot.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace fathom::operate {

namespace {

constexpr ImU32 kPlotBackground = IM_COL32(12, 16, 23, 255), kResidualInk = IM_COL32(200, 206, 216, 220);
constexpr ImU32 kZeroLine = IM_COL32(70, 84, 106, 255), kLimitLine = IM_COL32(255, 92, 84, 150);

// Curves of one plot.
class Curves {
public:
    Curves(const TraceArea& area, double limit, const TraceColumns& columns)
        : area_(area)
        , most_(std::max(limit, 1e-9) / double{kLimitShare})
        , columns_(columns) {}

    float y(double v) const {
        return area_.at.y + 0.5f * area_.size.y * static_cast<float>(1.0 - std::clamp(v / most_, -1.0, 1.0));
    }

    // dash [pixels]: 0 = a solid line.
    void draw(size_t curve, ImU32 colour, float width, int dash) const {
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const auto stroke = [&](int first, int last, float low, float high) {
            const float x = area_.at.x + 0.5f;
            list.AddRectFilled({x + static_cast<float>(first) - 0.5f * width, y(high) - 0.5f * width},
                               {x + static_cast<float>(last) + 0.5f * width, y(low) + 0.5f * width}, colour);
        };
        columns_.each(curve, [&](int first, int last, float low, float high) {
            for (int i = first; i <= last && dash > 0; ++i) {
                if (i / dash % 2 == 0) {
                    stroke(i, i, low, high);
                }
            }
            if (dash == 0) {
                stroke(first, last, low, high);
            }
        });
    }

private:
    const TraceArea& area_;
    double most_;
    const TraceColumns& columns_;
};

// Background, seconds, the limits and their numbers.
void drawScale(const WrenchFigures& plot, const TraceArea& area, const Curves& curves) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float right = area.at.x + area.size.x, bottom = area.at.y + area.size.y;
    list.AddRectFilled(area.at, {right, bottom}, kPlotBackground, 4.0f);
    for (double s = std::ceil(area.from); s <= area.to; s += 1.0) {
        list.AddLine({area.x(s), area.at.y}, {area.x(s), bottom}, IM_COL32(40, 50, 66, 255));
    }
    for (const double share : {1.0, 0.0, -1.0}) {
        const float y = curves.y(share * plot.limit);
        list.AddLine({area.at.x, y}, {right, y}, share == 0.0 ? kZeroLine : kLimitLine,
                     share == 0.0 ? 1.0f : 1.5f);
        const std::string text = printed("%.3g", share * plot.limit);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        const float top = std::clamp(y - 0.5f * size.y, area.at.y, std::max(area.at.y, bottom - size.y));
        list.AddText({area.at.x - 4.0f - size.x, top}, colour::kQuiet, text.c_str());
    }
}

// The names and values right of the curves, as many lines as there is room for.
void drawFigures(const WrenchFigures& plot, const TraceArea& area) {
    const std::pair<ImU32, std::string> lines[] = {
        {plot.colour, printed("%s [%s]", plot.name, plot.unit)},
        {colour::kText, printed("now %.2f  peak %.2f", plot.delivered, plot.peak)},
        {kResidualInk,
         std::isfinite(plot.residual) ? printed("residual %.2f", plot.residual) : "residual unknown"},
        {colour::kText,
         std::isfinite(plot.ripple) ? printed("ripple/frame %.3f", plot.ripple) : "ripple/frame -"}};
    const float x = area.at.x + area.size.x + ImGui::GetFontSize(), step = ImGui::GetTextLineHeight();
    float y = area.at.y;
    for (const auto& [colour, text] : lines) {
        if (y + step > area.at.y + area.size.y + 1.0f) {
            break;
        }
        ImGui::GetWindowDrawList()->AddText({x, y}, colour, text.c_str());
        y += step;
    }
}

// The largest delivered value, as an arrow right of the curves.
void drawPeak(const WrenchFigures& plot, const TraceArea& area, float y) {
    const float x = area.at.x + area.size.x;
    ImGui::GetWindowDrawList()->AddTriangleFilled({x + 9.0f, y - 4.5f}, {x + 9.0f, y + 4.5f}, {x + 1.0f, y},
                                                  plot.colour);
}

const char* fadeWord(FadeReason reason) {
    constexpr const char* kWords[]{"fading",      "old frame",   "off",        "fading",
                                   "device lost", "region gone", "device lost"};
    return kWords[static_cast<size_t>(reason)];
}

const char* eventWord(const TraceSample& sample) {
    switch (sample.state) {
    case StepState::Escape:
        return "escape";
    case StepState::Trapped:
        return "trapped";
    case StepState::Fading:
        return fadeWord(sample.fade);
    case StepState::Waiting:
        return "lags";
    default:
        return "";
    }
}

// Bars, and over them the names that have room.
void drawSpans(const TraceArea& lane, std::vector<TraceSpan> spans) {
    constexpr float kRoom = 12.0f; // [pixels] between names
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float top = lane.at.y, bottom = lane.at.y + lane.size.y, right = lane.at.x + lane.size.x;
    for (const TraceSpan& span : spans) {
        constexpr ImU32 kDim = IM_COL32(255, 255, 255, 90); // under its name
        list.AddRectFilled({lane.x(span.from), top + 2.0f},
                           {std::max(lane.x(span.to), lane.x(span.from) + 2.0f), bottom - 3.0f},
                           span.colour & kDim);
    }
    std::ranges::sort(spans, {}, &TraceSpan::from);
    float free = -1e9f;
    for (const TraceSpan& span : spans) {
        const float x = lane.x(span.from) + 4.0f, end = x + ImGui::CalcTextSize(span.word).x;
        if (x > free && end < right) {
            list.AddText({x, bottom - ImGui::GetTextLineHeight()}, colour::kText, span.word);
            free = end + kRoom;
        }
    }
}

} // namespace

float scaleColumn() {
    return ImGui::CalcTextSize("-0.25").x + 6.0f;
}

float figuresColumn() {
    return ImGui::CalcTextSize("now 00.00  peak 00.00").x + 1.2f * ImGui::GetFontSize();
}

void drawTracePlot(const WrenchFigures& plot, const TraceArea& area, const TraceColumns& columns) {
    const Curves curves(area, plot.limit, columns);
    drawScale(plot, area, curves);
    const size_t first = plot.part == &TraceWrench::force ? size_t{0} : size_t{TraceColumns::kOfPart};
    for (size_t axis = 0; axis < 3; ++axis) {
        curves.draw(first + axis, kAxisColours[axis], 1.0f, 0);
    }
    if (std::isfinite(plot.residual)) {
        constexpr int kDash = 5;
        curves.draw(first + TraceColumns::Residual, kResidualInk, 1.5f, kDash);
    }
    curves.draw(first + TraceColumns::Size, plot.colour, 2.0f, 0);
    if (plot.peak > 0.0) {
        drawPeak(plot, area, curves.y(plot.peak));
    }
    drawFigures(plot, area);
}

std::vector<TraceSpan> traceSpans(const std::deque<TraceSample>& trace) {
    std::vector<TraceSpan> spans;
    const auto collect = [&](ImU32 colour, auto wordOf) {
        constexpr double kFlicker = 0.1 - 1e-6; // [s] shorter breaks are part of a span
        const size_t first = spans.size();
        size_t now = first; // the span of `before`
        std::string_view before;
        for (const TraceSample& sample : trace) {
            const char* const name = wordOf(sample);
            const std::string_view word = name;
            if (!before.empty()) {
                spans[now].to = sample.t;
            }
            if (word != before && !word.empty()) {
                for (now = spans.size(); now > first && spans[now - 1].word != word; --now) {
                }
                if (now > first && sample.t - spans[now - 1].to < kFlicker) {
                    --now;
                } else {
                    now = spans.size();
                    spans.push_back({sample.t, sample.t, name, colour});
                }
            }
            before = word;
        }
    };
    collect(colour::kGuidance, [](const TraceSample& s) { return s.guided ? "guide" : ""; });
    collect(colour::kCaution, [](const TraceSample& s) { return eventWord(s); });
    return spans;
}

void drawEvents(const TraceArea& lane, const std::deque<TraceSample>& trace) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float top = lane.at.y, bottom = lane.at.y + lane.size.y, right = lane.at.x + lane.size.x;
    list.AddRectFilled(lane.at, {right, bottom}, kPlotBackground, 3.0f);
    const auto column = [&](float x, float from, ImU32 colour) { // of whole pixels: hundreds are cheap
        list.AddRectFilled({std::floor(x), from}, {std::floor(x) + 1.0f, bottom}, colour);
    };
    for (size_t i = 1; i < trace.size(); ++i) {
        if (trace[i].frame != trace[i - 1].frame) {
            column(lane.x(trace[i].t), bottom - 3.0f, IM_COL32(120, 134, 156, 200));
        }
        if (trace[i].late) {
            column(lane.x(trace[i].t), top + 2.0f, colour::kWarning);
        }
    }
    drawSpans(lane, traceSpans(trace));
}

} // namespace fathom::operate
