// SPDX-License-Identifier: Apache-2.0
// A folder in the layout of TUM RGB-D.
#pragma once

#include "apps/convert/frame_sink.h"
#include "devices/recorded/recording_writer.h"

namespace fathom {

// What RecordingWriter writes, and rgb.txt, depth.txt and groundtruth.txt for the tools of that data set.
class TumFolder final : public FrameSink {
public:
    // Throws BadInput for a folder that has a recording.
    TumFolder(const std::filesystem::path& folder, const CameraInfo& camera);

    void add(const Frame& frame) override { writer_.add(frame); }
    void finish() override;

private:
    void writeIndexes() const;

    std::filesystem::path folder_;
    bool colour_;
    RecordingWriter writer_;
};

} // namespace fathom
