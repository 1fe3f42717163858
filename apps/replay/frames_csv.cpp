// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/frames_csv.h"

#include "engine/types/error.h"

#include <algorithm>

namespace fathom {

FramesCsv::FramesCsv(const std::filesystem::path& file, std::vector<std::string> passes)
    : file_(file)
    , passes_(std::move(passes)) {
    std::string header = "index,t_s,valid,forbidden_points,spheres,patches,nodes,guidance_count,upload_ms";
    for (const std::string& pass : passes_) {
        header += "," + pass + "_ms";
    }
    file_.write(header + ",publish_ms\n");
}

void FramesCsv::add(const FrameRecord& frame) {
    for (const PassTime& pass : frame.passes) {
        if (std::find(passes_.begin(), passes_.end(), pass.first) == passes_.end()) {
            throw Error(file_.path().string() + ": no column for pass " + pass.first);
        }
    }
    row_.add(int64_t{frame.index});
    row_.add(frame.t);
    for (uint64_t count : {frame.valid, frame.forbiddenPoints, frame.spheres, frame.patches, frame.nodes,
                           frame.guidanceCount}) {
        row_.add(static_cast<int64_t>(count));
    }
    row_.add(frame.uploadMs);
    for (const std::string& name : passes_) {
        const auto found = std::find_if(frame.passes.begin(), frame.passes.end(),
                                        [&name](const PassTime& pass) { return pass.first == name; });
        row_.add(found == frame.passes.end() ? kUnknown : found->second);
    }
    row_.add(frame.publishMs);
    file_.write(row_.end());
}

void FramesCsv::commit() {
    file_.commit();
}

} // namespace fathom
