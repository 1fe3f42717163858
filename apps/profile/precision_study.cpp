// SPDX-License-Identifier: Apache-2.0
// Half, single and double precision for stored centres, tree nodes, depth pixels, filter weights and pair
// gaps.
#include "apps/profile/interleave.h"
#include "apps/profile/precision.h"
#include "apps/profile/studies.h"

namespace fathom::profile {

StudyRow precisionRow(const std::string& source, const std::string& setting, bool isDefault, double errorMm,
                      double bytes, double elements, double found) {
    StudyRow row;
    row.source = source;
    row.setting = setting;
    row.isDefault = isDefault;
    row.error = errorMm;
    row.more = {bytes, elements, found};
    return row;
}

namespace {

// Times the formats of each source, interleaved. Loops of one source must be adjacent.
void timeLoops(const StudyContext& context, std::vector<PrecisionLoop> loops, Study& study) {
    for (size_t begin = 0, end = 0; begin < loops.size(); begin = end) {
        std::vector<std::function<void()>> works;
        for (; end < loops.size() && loops[end].row.source == loops[begin].row.source; ++end) {
            works.push_back(loops[end].run);
        }
        const std::vector<Cost> costs = timeCpuInterleaved(context.settings.repeats(), works);
        for (size_t i = begin; i < end; ++i) {
            loops[i].row.cost = costs[i - begin];
            study.rows.push_back(std::move(loops[i].row));
        }
    }
}

// A panel of the sources whose names start with `source`.
PlotPanel panelOf(const Study& study, const std::string& title, const std::string& source) {
    return frontPanel(study, title, [&](const StudyRow& row) {
        return row.source.starts_with(source) ? study.rankBy.time(row) : NAN;
    });
}

} // namespace

Study precisionStudy(const StudyContext& context) {
    Study study;
    study.name = "precision";
    study.title = "Precision: half, single and double for the most frequent values and sums";
    study.verified = "every format agrees with double within its own rounding; no region sphere is outside "
                     "its node in any format; culls find every node that the double nodes find";
    study.errorName = "largest error";
    study.errorUnit = "mm";
    study.rankBy.time = cpuTime;
    study.timeName = "the whole loop, CPU time p50";
    study.moreNames = {"bytes_an_element", "elements", "nodes_found"};
    study.rankBy.reason = "half precision exceeds the error budget or costs time for conversion; single "
                          "precision keeps every bit of the sensor, in half the memory of double";
    for (const auto part : {centreRows, nodeRows, depthRows, weightRows, gapRows}) {
        timeLoops(context, part(context), study);
    }
    markFront(study);
    study.panels.push_back(
        panelOf(study, "nearest centre, every sphere scanned: error of a distance", "centres"));
    study.panels.push_back(panelOf(study, "tree nodes culled: growth of a node", "tree nodes"));
    study.panels.push_back(
        panelOf(study, "a frame's points, filter and gaps: error of a depth or gap", "frame"));
    return study;
}

} // namespace fathom::profile
