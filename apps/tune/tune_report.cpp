// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_report.h"

#include "apps/output/csv.h"
#include "apps/profile/study_plot.h"
#include "apps/tune/tune_words.h"
#include "engine/types/output_file.h"

#include <algorithm>

namespace fathom::tune {

namespace {

using profile::PlotPanel;
using profile::PlotPoint;
using profile::PlotSeries;

constexpr const char* kHead =
    "point,varied,filter_radius,filter_sigma_mm,memory_frames,error_budget_mm,friction,reach_mm,width,height,"
    "error_mm,bias_mm,ripple_N,ripple_10_35_Hz_N,step_N,passive_margin_N_s_per_m,published_ms,query_ms,"
    "query_p90_ms,tick_ms,to_force_ms,on_front,dominated_by,meets,chosen,not_chosen_because,time_scale\n";

std::string withoutCommas(std::string text) {
    std::ranges::replace(text, ',', ';');
    return text.empty() ? "-" : text;
}

void addSetting(CsvRow& row, const TunePoint& p) {
    row.add(static_cast<int64_t>(p.setting.radius));
    row.add(1e3 * p.setting.sigma);
    row.add(static_cast<int64_t>(p.setting.memory));
    row.add(1e3 * p.setting.errorBudget);
    row.add(p.setting.friction);
    row.add(1e3 * p.setting.reach);
    row.add(static_cast<int64_t>(p.width));
    row.add(static_cast<int64_t>(p.height));
}

void addMeasured(CsvRow& row, const TunePoint& p) {
    for (const double value : {p.score.error, 1e3 * p.felt.bias, p.felt.ripple, p.felt.band, p.felt.step,
                               p.felt.passive, p.published, p.felt.query.submit.p50, p.felt.query.submit.p90,
                               p.felt.tick.submit.p50, p.score.time}) {
        row.add(value);
    }
}

// A dashed line along the limit.
PlotSeries limitLine(const Request& request, const PlotPanel& panel, bool alongX) {
    double low = HUGE_VAL, high = 0.0;
    for (const PlotSeries& series : panel.series) {
        for (const PlotPoint& p : series.points) {
            const double value = alongX ? p.x : p.y;
            low = value > 0.0 ? std::min(low, value) : low;
            high = std::max(high, value);
        }
    }
    PlotSeries line{"asked for", {}, true, 7.0};
    const double at = request.error ? *request.error : *request.time;
    for (const double end : {low, high}) {
        line.points.push_back({alongX ? end : at, alongX ? at : end, ""});
    }
    return line;
}

PlotPanel panelOf(const TuneResult& result, const std::string& title, double Score::*value) {
    PlotPanel panel;
    panel.title = title;
    panel.xLabel = "camera to force, p50 [ms]";
    const std::vector<bool> front = frontOf(result.scores());
    PlotSeries best{"Pareto front", {}};
    std::vector<PlotSeries> others;
    for (size_t i = 0; i < result.points.size(); ++i) {
        const TunePoint& p = result.points[i];
        if (!p.score.valid()) {
            continue;
        }
        PlotPoint point{p.score.time, p.score.*value,
                        p.varied == nameOf(Vary::Size) ? valueIn(p, Vary::Size) : settingNameOf(p)};
        point.isDefault = result.choice.point == i;
        point.isFront = value == &Score::error && front[i];
        if (point.isFront) {
            best.points.push_back(point);
            continue;
        }
        const auto same = std::ranges::find(others, p.varied, &PlotSeries::name);
        (same == others.end() ? others.emplace_back(PlotSeries{p.varied, {}}) : *same)
            .points.push_back(point);
    }
    if (!best.points.empty()) {
        panel.series.push_back(std::move(best));
    }
    panel.series.insert(panel.series.end(), others.begin(), others.end());
    return panel;
}

} // namespace

void writePoints(const TuneResult& result, const Request& request, OutputFile& out) {
    const std::vector<Score> scores = result.scores();
    const std::vector<bool> front = frontOf(scores);
    out.write(kHead);
    CsvRow row;
    for (size_t i = 0; i < result.points.size(); ++i) {
        const TunePoint& p = result.points[i];
        const std::optional<size_t> better = dominatorOf(scores, i);
        row.add(static_cast<int64_t>(i + 1));
        row.add(p.varied);
        addSetting(row, p);
        addMeasured(row, p);
        row.add(int64_t{front[i]});
        row.add(better ? std::to_string(*better + 1) : "-");
        row.add(int64_t{meets(p.score, request)});
        row.add(int64_t{result.choice.point == i});
        row.add(withoutCommas(p.score.why));
        row.add(p.timeScale);
        out.write(row.end());
    }
}

Image curveOf(const TuneResult& result, const Request& request, const std::string& title,
              const std::string& subtitle) {
    profile::Study study;
    study.title = title;
    PlotPanel error = panelOf(result, "where the surface is felt", &Score::error);
    error.yLabel = "error of the felt surface, RMS [mm]";
    error.ringed = "chosen";
    error.series.push_back(limitLine(request, error, request.error.has_value()));
    PlotPanel ripple = panelOf(result, "vibration of the force at a still hand", &Score::ripple);
    ripple.yLabel = "force in 10 to 35 Hz at 1000 N/m [N]";
    ripple.ringed = "chosen";
    study.panels = {std::move(error), std::move(ripple)};
    return studyPlot(study, subtitle);
}

} // namespace fathom::tune
