// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/frames_csv.h"

namespace fathom {

FramesCsv::FramesCsv(const std::filesystem::path& file, const std::vector<std::string>& passes)
    : file_(file)
    , passes_(passes.size()) {
    std::string header = "index,t_s,valid,forbidden_points,spheres,patches,nodes,guidance_count,upload_ms";
    for (const std::string& pass : passes) {
        header += "," + pass + "_ms";
    }
    file_.write(header + ",publish_ms,answerable_ms\n");
}

void FramesCsv::add(const FrameReport& report, double t) {
    const cloud::FrameCounts& counts = report.counts;
    row_.add(int64_t{report.index});
    row_.add(t);
    for (uint32_t count : {counts.valid, counts.forbidden, counts.spheres, counts.patches, counts.nodes,
                           report.guidanceCount}) {
        row_.add(int64_t{count});
    }
    row_.add(report.uploadMs);
    for (size_t i = 0; i < passes_; ++i) {
        row_.add(i < report.passMs.size() ? report.passMs[i] : kNotKnown);
    }
    row_.add(report.publishMs);
    row_.add(report.answerableMs);
    file_.write(row_.end());
}

} // namespace fathom
