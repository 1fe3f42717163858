// SPDX-License-Identifier: Apache-2.0
// Compares Fathom with other libraries in one run: depth smoothing, points, and contact queries. Only in
// builds with -DFATHOM_PEERS=ON.
#include "apps/profile/peers_rows.h"
#include "apps/profile/studies.h"

#include <algorithm>
#include <map>

namespace fathom::profile {

namespace {

bool isOurs(const StudyRow& row) {
    return row.setting.starts_with("Fathom");
}

bool isFilter(const StudyRow& row) {
    return row.source.starts_with("filter ");
}

bool isContact(const StudyRow& row) {
    return row.source.starts_with(kContactPrefix);
}

std::vector<std::string> sourcesOf(const Study& study) {
    std::vector<std::string> names;
    for (const StudyRow& row : study.rows) {
        if (names.empty() || names.back() != row.source) {
            names.push_back(row.source);
        }
    }
    return names;
}

// Judges defaults by the compared times. For filters, where no answer is wrong, the error is the distance
// from the exact surface.
void judgeOurs(Study& study) {
    study.rankBy.time = peerTime;
    study.rankBy.error = [](const StudyRow& row) { return isFilter(row) ? row.more[kFromTruth] : row.error; };
    study.rankBy.errorUnit = [](const StudyRow& row) { return isFilter(row) ? "mm" : "wrong"; };
    markFront(study);
}

// One sentence per source: Fathom's time, and every other time as a multiple of it.
void reportRatios(Study& study) {
    study.findings.push_back(
        "xN: N times Fathom's time on that source, in brackets for the build. Filter and points: device time "
        "of Fathom's pass, wall time of the others. Contact: CPU time of the calling thread, which does not "
        "depend on other work; for the GPU, wall time from submission to result");
    for (const std::string& source : sourcesOf(study)) {
        std::string text;
        for (const StudyRow& row : study.rows) {
            if (row.source != source) {
                continue;
            }
            if (row.isDefault) {
                text = source + ": " + row.setting + " " + digits(peerTime(row)) + " ms";
                text += std::isfinite(row.more[kBuild]) ? " (build " + digits(row.more[kBuild]) + ")" : "";
                continue;
            }
            text += "; " + row.setting + " x" + digits(row.more[kRatio]);
            text += std::isfinite(row.more[kBuildRatio]) ? " (x" + digits(row.more[kBuildRatio]) + ")" : "";
            text += row.error > 0.0 ? " [" + digits(row.error) + " wrong]" : "";
        }
        study.findings.push_back(text);
    }
}

// Per setting: the number of sources with `value` in (0, below), and the range of these values.
std::string tally(const Study& study, size_t column, double below) {
    std::map<std::string, std::vector<double>> all;
    for (const StudyRow& row : study.rows) {
        if (!isOurs(row) && row.more[column] < below) {
            all[row.setting].push_back(row.more[column]);
        }
    }
    std::string text;
    for (const auto& [setting, values] : all) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        text += (text.empty() ? "" : "; ") + setting + " on " + std::to_string(values.size()) +
                " sources, x" + digits(*least) + " to x" + digits(*most);
    }
    return text.empty() ? "none" : text;
}

// Reports separately where other libraries are faster than Fathom, or wrong.
void reportWinners(Study& study) {
    std::string wrong;
    for (const StudyRow& row : study.rows) {
        if (row.error > 0.0) {
            wrong += (wrong.empty() ? "" : "; ") + row.setting + " on " + row.source + " (" +
                     digits(row.error) + ")";
        }
    }
    study.findings.push_back("faster than ours: " + tally(study, kRatio, 1.0));
    study.findings.push_back("build faster than ours: " + tally(study, kBuildRatio, 1.0));
    study.findings.push_back("answers that differ from float64: " + (wrong.empty() ? "none" : wrong));
}

// One line per method over the number of spheres. Shows `value` of each row if it is positive.
PlotPanel contactPanel(const Study& study, const std::string& leaves, const std::string& title,
                       const RowValue& value) {
    PlotPanel panel{title, "region spheres [thousands]", "p50 [ms]", true, true, false, {}};
    for (const StudyRow& row : study.rows) {
        if (!isContact(row) || row.source.find(" x " + leaves + " leaves") == std::string::npos ||
            !(value(row) > 0.0)) {
            continue;
        }
        const auto same = [&](const PlotSeries& s) { return s.name == row.setting; };
        auto at = std::find_if(panel.series.begin(), panel.series.end(), same);
        if (at == panel.series.end()) {
            at = panel.series.insert(at, {row.setting, {}, true});
        }
        const double thousands = std::stod(row.source.substr(std::string(kContactPrefix).size()));
        at->points.push_back({thousands, value(row), "", row.isDefault, false});
    }
    return panel;
}

std::string shortLabel(const StudyRow& row) { // little space next to a bar
    const std::string name = row.isDefault ? "Fathom" : row.setting;
    return row.source.substr(row.source.find(' ') + 1) + ": " + name;
}

PlotPanel depthPanel(const Study& study) {
    PlotPanel panel{"filter and points: p50, Fathom's by device time of the pass",
                    "p50 [ms]",
                    "",
                    false,
                    false,
                    true,
                    {}};
    for (const std::string& source : sourcesOf(study)) {
        PlotSeries series{source, {}, false};
        for (const StudyRow& row : study.rows) {
            if (row.source == source && !isContact(row) && row.setting != "Fathom float64 twin") {
                series.points.push_back({peerTime(row), 0.0, shortLabel(row), row.isDefault, false});
            }
        }
        if (!series.points.empty()) {
            panel.series.push_back(std::move(series));
        }
    }
    return panel;
}

} // namespace

double peerTime(const StudyRow& row) {
    if (isContact(row) && row.setting != "Fathom GPU tree") {
        return row.cost.cpu.p50;
    }
    return row.cost.gpu ? row.cost.gpu.p50 : row.cost.submit.p50;
}

void fillRatios(std::vector<StudyRow>& rows, size_t first, size_t ours, size_t gpu) {
    const double time = peerTime(rows[ours]), build = rows[ours].more[kBuild];
    for (size_t i = first; i < rows.size(); ++i) {
        rows[i].more[kRatio] = peerTime(rows[i]) / time;
        rows[i].more[kRatioSubmit] = rows[i].cost.submit.p50 / rows[gpu].cost.submit.p50;
        rows[i].more[kBuildRatio] = rows[i].more[kBuild] / build;
    }
}

Study peersStudy(const StudyContext& context) {
    Study study;
    study.name = "peers";
    study.title = "Peers: the same work by OpenCV, PCL, Embree, FCL and Bullet";
    study.verified = "Fathom's results against float64: points to 20 um, every sphere within reach. "
                     "Different answers of the others are counted; of smoothed depths only the distance is "
                     "given, because each filter computes another average";
    study.errorName = "answers that differ";
    study.errorUnit = "count";
    study.rankBy.reason = "Fathom's needs no library, gives the same bits on every machine, and later steps "
                          "of the tick or frame use its result directly";
    study.timeName = "p50";
    study.moreNames = {"ratio_to_ours",    "ratio_to_ours_submit", "build_p50_ms",    "build_ratio",
                       "threads",          "found_mean",           "ties_within_1um", "rms_from_ours_mm",
                       "rms_from_truth_mm"};
    addPeerFilters(context, study.rows);
    addPeerPoints(context, study.rows);
    addPeerCollision(context, study.rows);
    judgeOurs(study);
    reportRatios(study);
    reportWinners(study);
    for (const char* leaves : {"1", "64", "1024"}) {
        PlotPanel panel = contactPanel(
            study, leaves, std::string("what lies within reach, tool leaves: ") + leaves, peerTime);
        if (!panel.series.empty()) {
            study.panels.push_back(std::move(panel));
        }
    }
    study.panels.push_back(contactPanel(study, "64", "building what queries need",
                                        [](const StudyRow& row) { return row.more[kBuild]; }));
    study.panels.push_back(depthPanel(study));
    return study;
}

} // namespace fathom::profile
