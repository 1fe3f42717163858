// SPDX-License-Identifier: Apache-2.0
// What one image topic of a file holds, and its lens.
#pragma once

#include "devices/bag/image_pixels.h"
#include "devices/bag/message_file.h"
#include "devices/bag/stream_names.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom {

// One topic of images.
struct ImageStream {
    size_t topic = 0; // in MessageFile::topics()
    std::string name, frame, encoding;
    ros::Content content = ros::Content::None;
    NamedRole role = NamedRole::None;         // never Either
    bool painted = false;                     // by its name depth in colours that a program chose
    uint32_t width = 0, height = 0;           // [pixels]; 0: not readable
    bool compressed = false, metres = false;  // metres: of depth
    ColourFormat format = ColourFormat::Rgba; // of colour
    // The lens of its images, rectified or not; `raw` compares with that of another topic of the same camera.
    std::optional<Intrinsics> lens;
    Intrinsics raw;
    std::optional<size_t> info; // topic of the lens, in MessageFile::topics()
    bool rectified = false, turned = false;
    bool unsized = false;  // the lens states no size: that of the images is taken
    dvec3 shift{0.0};      // [m] as in ros::CameraInfo
    std::string noLens;    // why there is no lens
    double skew = 0.0;     // [pixels] of its lens, which is not used
    bool infoless = false; // no topic of a lens was recorded for it
    std::string lensOf;    // the topic of colour whose lens it has, as depth that is aligned to it
};

// Depth by its encoding, and not said to be something else by its name. mono16 is also what grey cameras of
// 16 bits send: it is depth only under a name that says so.
bool mayBeDepth(const ImageStream& stream);

// Every topic of sensor_msgs/Image or CompressedImage that has messages, by the first of five messages that
// can be read and has a lens. The lens comes likewise from the camera_info next to the images, or
// from the topic `info` if it is not empty: of depth, and of others without such a camera_info.
std::vector<ImageStream> imageStreams(MessageFile& file, const std::string& info);

} // namespace fathom
