// SPDX-License-Identifier: Apache-2.0
// A type of Cyclone DDS whose samples are their own serialised bytes, so that one reader and one writer serve
// every message type.
#pragma once

#include "devices/ros2/raw_message.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <span>
#include <string>

namespace fathom {

// A type of that name, for dds_create_topic_sertype(), which takes it over. `name` as DDS has it:
// "sensor_msgs::msg::dds_::Image_".
ddsi_sertype* newRawType(const std::string& name);

// The content of a sample of such a type; valid while the sample is. Null when it holds no data.
const RawMessage* rawContent(const ddsi_serdata* sample);

// A sample for dds_writecdr(), which takes it over. Throws std::bad_alloc.
ddsi_serdata* newRawSample(const ddsi_sertype* type, std::span<const uint8_t> bytes);

} // namespace fathom
