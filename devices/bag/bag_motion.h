// SPDX-License-Identifier: Apache-2.0
// Signs in a file of messages that its camera moves. Poses of messages are not read: the camera counts as
// fixed.
#pragma once

#include "devices/bag/message_file.h"

#include <string>

namespace fathom {

// A warning that names the link of tf that moves the frame of depth, or else the topic of poses that move and
// may be the camera's; empty = neither. Reads some messages over the whole file.
std::string cameraMotion(MessageFile& file, const std::string& frame);

} // namespace fathom
