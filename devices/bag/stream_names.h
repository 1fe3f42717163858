// SPDX-License-Identifier: Apache-2.0
// Guesses from the name of a topic what its images hold.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

// What the images of a topic hold, by its name.
enum class NamedRole {
    None,
    Depth,
    Colour,
    Infrared, // also confidence, error and the like
    Either,   // depth, or depth in colours that a program chose: the encoding tells
};

// By the last word that decides: "/camera/ir/image" is Infrared, "/kinect2/sd/image_depth_rect" Depth. Words
// after "to" and "in" are a target: "/aligned_depth_to_color/image_raw" is Depth. Either: words of depth and
// then of colour in one part ("/cam/depth_color/image"), or an image of colour in a folder of depth.
NamedRole namedRole(const std::string& topic);
// Of a topic that is Either: "/cam/depth_color/", below which all is painted unless a topic there names depth
// once more; empty where its last part decides.
std::string folderOfEither(const std::string& topic);
// "/tof/distances", "/cam/z_image": depth by a word that counts less than those of depth.
bool namedDistance(const std::string& topic);
// "/camera/depth/image_colored", but not "/depth_camera/image_raw": its colour would be painted depth.
bool namedDepthImage(const std::string& topic);
// "/camera/depth/image_raw", but not "/camera/depth_filled/image": no unusual word follows that of depth.
bool namedPlainly(const std::string& topic);
// "image_rect", "image_rect_raw": rectified images.
bool namedRectified(const std::string& topic);
// "aligned_depth...", "depth_registered": shown by another camera's lens.
bool namedRegistered(const std::string& topic);
// "/zed/right/image_rect_color": of the right camera of a stereo pair.
bool namedRight(const std::string& topic);
// Images of the RealSense SDK: /device_D/sensor_S/Stream_I/image/data, also with the suffix of a transport.
bool isRealSenseTopic(const std::string& topic);
// The sensor of images of the Orbbec SDK, /cam/sensor_S/frameType_F: "S"; empty for another topic.
std::string orbbecSensor(const std::string& topic);
// Of one of these SDKs: the frames that its headers name mean nothing.
bool isSdkTopic(const std::string& topic);
// Where an SDK has the options of the sensor: "/device_D/sensor_S/option/"; empty for another topic.
std::string optionsPrefix(const std::string& topic);
// "Depth Units", "Depth_Units" among such options: the name changed between versions of the SDK.
bool namedDepthUnits(const std::string& topic);
// Where a camera has the lens of these images, the likeliest topic first.
std::vector<std::string> lensTopics(const std::string& topic);
// Number of path parts that both topics begin with.
size_t sharedParts(const std::string& a, const std::string& b);
// Number of words that both topics have, whatever their order: 1 of "/depth_left" and "/rgb_left", of
// "/depth2" and "/rgb2", and of "/frontDepth" and "/frontColor".
size_t sharedWords(const std::string& a, const std::string& b);
// Whether the parts before the first one that names depth, colour or infrared are those of one camera:
// "/a/depth/image" and "/a/rgb/image" or "/a/left/image_color", but not "/b/rgb/image".
bool namedOneCamera(const std::string& a, const std::string& b);
// Whether both image topics are of the camera that publishes .../extrinsics/depth_to_color as `extrinsics`.
bool namedExtrinsicsOf(const std::string& extrinsics, const std::string& depth, const std::string& colour);
// "/a/b/image_raw" -> "/a/b", `levels` times.
std::string parentTopic(std::string topic, int levels);
// Without the suffix of a compressed transport: "/a/image_raw/compressed" -> "/a/image_raw".
std::string baseTopic(const std::string& topic);

} // namespace fathom
