// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/study.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr double kSame = 0.95; // repeats differ by up to 5 %

std::vector<std::string> sourcesOf(const Study& study) {
    std::vector<std::string> names;
    for (const StudyRow& row : study.rows) {
        if (std::ranges::find(names, row.source) == names.end()) {
            names.push_back(row.source);
        }
    }
    return names;
}

// The error and time by which rows are ranked.
class Ranking {
public:
    explicit Ranking(const Study& study)
        : by_(study.rankBy)
        , studyUnit_(study.errorUnit) {}
    double time(const StudyRow& row) const { return by_.time(row); }
    double error(const StudyRow& row) const { return by_.error(row); }
    std::string unit(const StudyRow& row) const { return by_.errorUnit ? by_.errorUnit(row) : studyUnit_; }
    std::string reason() const { return by_.reason.empty() ? "" : "; it stays the default: " + by_.reason; }
    bool counts(const StudyRow& row) const { return std::isfinite(error(row)) && time(row) > 0.0; }
    bool dominates(const StudyRow& a, const StudyRow& b, double margin) const {
        return a.source == b.source && counts(a) && time(a) <= time(b) && error(a) <= error(b) &&
               (time(a) < margin * time(b) || error(a) < margin * error(b));
    }

private:
    const RankingRule& by_;
    const std::string& studyUnit_;
};

// Marks the Pareto front of the points.
void markPoints(std::vector<PlotPoint>& points) {
    for (PlotPoint& p : points) {
        p.isFront = std::ranges::none_of(
            points, [&](const PlotPoint& o) { return o.x <= p.x && o.y <= p.y && (o.x < p.x || o.y < p.y); });
    }
}

std::string wordsOf(const Ranking& ranking, const StudyRow& chosen, const StudyRow* best) {
    if (!ranking.counts(chosen)) {
        return "is not judged: it has no error or no time on this source";
    }
    if (best == nullptr) {
        return "lies on the Pareto front";
    }
    return "is off the front: '" + best->setting + "' has " + digits(ranking.error(*best)) + " against " +
           digits(ranking.error(chosen)) + " " + ranking.unit(chosen) + " at " + digits(ranking.time(*best)) +
           " against " + digits(ranking.time(chosen)) + " ms" + ranking.reason();
}

void judgeDefault(Study& study, const Ranking& ranking, const StudyRow& chosen) {
    const StudyRow* best = nullptr;
    for (const StudyRow& row : study.rows) {
        if (ranking.dominates(row, chosen, kSame) &&
            (best == nullptr || ranking.time(row) < ranking.time(*best))) {
            best = &row;
        }
    }
    Verdict verdict{chosen.source, chosen.setting, best == nullptr && ranking.counts(chosen),
                    wordsOf(ranking, chosen, best)};
    study.findings.push_back("default '" + verdict.setting + "' on " + verdict.source + " " + verdict.words);
    study.verdicts.push_back(std::move(verdict));
}

} // namespace

double gpuTime(const StudyRow& row) {
    return row.cost.gpu ? row.cost.gpu.p50 : row.cost.submit.p50;
}

double submitTime(const StudyRow& row) {
    return row.cost.submit.p50;
}

double cpuTime(const StudyRow& row) {
    return row.cost.cpu.p50;
}

double p90Of(const StudyRow& row, double p50) {
    for (const Spread* s : {&row.cost.gpu, &row.cost.submit, &row.cost.cpu, &row.cost.wall}) {
        if (*s && s->p50 == p50) {
            return s->p90;
        }
    }
    return NAN;
}

void markFront(Study& study) {
    const Ranking ranking(study);
    for (StudyRow& row : study.rows) {
        row.onFront = ranking.counts(row) && std::ranges::none_of(study.rows, [&](const StudyRow& other) {
                          return &other != &row && ranking.dominates(other, row, 1.0);
                      });
    }
    for (const StudyRow& row : study.rows) {
        if (row.isDefault) {
            judgeDefault(study, ranking, row);
        }
    }
}

PlotPanel frontPanel(const Study& study, const std::string& title, const RowValue& x, const RowValue& y) {
    const Ranking ranking(study);
    PlotPanel panel;
    panel.title = title;
    panel.xLabel = study.timeName + " [ms]";
    panel.yLabel = study.errorName + " [" + study.errorUnit + "]";
    for (const std::string& source : sourcesOf(study)) {
        PlotSeries series{source, {}, false};
        for (const StudyRow& row : study.rows) {
            const double time = x ? x(row) : ranking.time(row), error = y ? y(row) : ranking.error(row);
            if (row.source == source && time > 0.0 && std::isfinite(error)) {
                series.points.push_back({time, error, row.setting, row.isDefault, false, p90Of(row, time)});
            }
        }
        if (!series.points.empty()) {
            markPoints(series.points);
            panel.series.push_back(std::move(series));
        }
    }
    return panel;
}

std::optional<PowerLaw> fitPower(const std::vector<PlotPoint>& points) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const PlotPoint& p : points) {
        if (p.x > 0.0 && p.y > 0.0) {
            const double x = std::log(p.x), y = std::log(p.y);
            n += 1;
            sx += x;
            sy += y;
            sxx += x * x;
            sxy += x * y;
        }
    }
    const double spread = n * sxx - sx * sx;
    if (n < 2 || !(spread > 1e-9)) {
        return std::nullopt;
    }
    const double exponent = (n * sxy - sx * sy) / spread;
    return PowerLaw{exponent, std::exp((sy - exponent * sx) / n)};
}

void verify(bool holds, const std::string& study, const std::string& setting, const std::string& what) {
    if (!holds) {
        throw Error("profile " + study + ": '" + setting + "' is wrong and was not timed: " + what);
    }
}

std::string digits(double value, int most) {
    return significant(value, most);
}

} // namespace fathom::profile
